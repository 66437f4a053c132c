/* What C can get wrong is a status with a text. */
#include <pthread.h>

#include "check.h"

enum { SIDE = 64 };

static varikernel_context *context = NULL;
static varikernel_pipeline *pipeline = NULL;
static varikernel_settings settings;
static varikernel_frame frame;
static GLuint radii = 0;

static void *knows_nothing(const char *name, void *user) {
    (void)name;
    (void)user;
    return NULL;
}

static void *knows_one_command(const char *name, void *user) {
    return strcmp(name, "glGetString") == 0 ? headless_loader(name, user) : NULL;
}

static varikernel_status make(uint32_t width, uint32_t height, uint32_t format) {
    varikernel_pipeline *made = NULL;
    varikernel_status status = varikernel_pipeline_create(context, width, height, format, &settings, &made);
    EXPECT_TRUE((made != NULL) == (status == VARIKERNEL_STATUS_OK));
    varikernel_pipeline_destroy(made);
    return status;
}

/* Renders; a call that fails writes no name. */
static varikernel_status render(void) {
    GLuint found = 12345;
    varikernel_status status = varikernel_pipeline_render(pipeline, &frame, &found, NULL);
    EXPECT_TRUE((found != 12345) == (status == VARIKERNEL_STATUS_OK));
    radii = status == VARIKERNEL_STATUS_OK ? found : radii;
    return status;
}

static void a_planted_difference_is_seen(void) {
    EXPECT_TRUE(is_expected(varikernel_pipeline_render(NULL, NULL, NULL, NULL),
                            VARIKERNEL_STATUS_INVALID_ARGUMENT, "null"));
    EXPECT_TRUE(!is_expected(varikernel_pipeline_render(NULL, NULL, NULL, NULL),
                             VARIKERNEL_STATUS_SETTING, "null"));
    EXPECT_TRUE(!is_expected(varikernel_pipeline_render(NULL, NULL, NULL, NULL),
                             VARIKERNEL_STATUS_INVALID_ARGUMENT, "zzz"));
}

static unsigned lines = 0;

static void keep(uint32_t level, const char *line, void *user) {
    lines += level == VARIKERNEL_LOG_WARNING && strstr(line, "GL_INVALID_ENUM") != NULL && user == &lines;
}

/* An error of the host that was pending is told, once, and only while somebody listens. */
static void logs(void) {
    EXPECT(varikernel_set_log(keep, &lines, 0), VARIKERNEL_STATUS_SETTING, "most");
    EXPECT(varikernel_set_log(keep, &lines, 5), VARIKERNEL_STATUS_SETTING, "most");
    for (uint32_t most = VARIKERNEL_LOG_ERROR; most <= VARIKERNEL_LOG_DEBUG; most++) {
        const unsigned before = lines;
        EXPECT_OK(varikernel_set_log(keep, &lines, most));
        glEnable(0xFFFF);
        EXPECT_OK(render());
        EXPECT_TRUE(lines - before == (most >= VARIKERNEL_LOG_WARNING));
    }
    const unsigned before = lines;
    EXPECT_OK(varikernel_set_log(NULL, NULL, 0));
    glEnable(0xFFFF);
    EXPECT_OK(render());
    EXPECT_TRUE(lines == before);
}

static void versions(void) {
    EXPECT_TRUE(varikernel_is_compatible(VARIKERNEL_VERSION_MAJOR, VARIKERNEL_VERSION_MINOR));
    EXPECT_TRUE(!varikernel_is_compatible(VARIKERNEL_VERSION_MAJOR, VARIKERNEL_VERSION_MINOR + 1));
    EXPECT_TRUE(!varikernel_is_compatible(VARIKERNEL_VERSION_MAJOR + 1, VARIKERNEL_VERSION_MINOR));
    EXPECT_TRUE(strlen(varikernel_version()) >= 5);
}

static void contexts(const headless *host) {
    varikernel_context *none = NULL;
    EXPECT(varikernel_context_create(NULL, NULL, 0, &none), VARIKERNEL_STATUS_INVALID_ARGUMENT, "loader is null");
    EXPECT(varikernel_context_create(headless_loader, NULL, 0, NULL), VARIKERNEL_STATUS_INVALID_ARGUMENT, "context is null");
    EXPECT(varikernel_context_create(knows_nothing, NULL, 0, &none), VARIKERNEL_STATUS_NO_CONTEXT, "glGetString");
    EXPECT(varikernel_context_create(headless_loader, NULL, 2, &none), VARIKERNEL_STATUS_SETTING, "state_policy");
    EXPECT(varikernel_context_create(knows_one_command, NULL, 0, &none), VARIKERNEL_STATUS_NO_CONTEXT, "does not find glActiveTexture");
    EXPECT_TRUE(headless_make_current(host, 0));
    EXPECT(varikernel_context_create(headless_loader, NULL, VARIKERNEL_STATE_RESTORE, &none), VARIKERNEL_STATUS_NO_CONTEXT, "current");
    EXPECT_TRUE(headless_make_current(host, 1));
    EXPECT_TRUE(none == NULL);
    EXPECT_OK(varikernel_context_create(headless_loader, NULL, VARIKERNEL_STATE_RESTORE, &context));
}

static void wrong_settings(void) {
    EXPECT(varikernel_settings_default(NULL, sizeof settings), VARIKERNEL_STATUS_INVALID_ARGUMENT, "settings is null");
    EXPECT(varikernel_settings_default(&settings, 8), VARIKERNEL_STATUS_INVALID_ARGUMENT, "8 bytes");
    EXPECT_OK(varikernel_settings_default(&settings, sizeof settings));
    EXPECT_TRUE(settings.min_photons == 25 && settings.max_radius == 32);
    EXPECT(varikernel_pipeline_create(NULL, 1, 1, GL_R32F, &settings, &pipeline), VARIKERNEL_STATUS_INVALID_ARGUMENT,
           "context is null");
    EXPECT(varikernel_pipeline_create(context, 1, 1, GL_R32F, &settings, NULL), VARIKERNEL_STATUS_INVALID_ARGUMENT,
           "pipeline is null");
    EXPECT(make(0, SIDE, GL_R32F), VARIKERNEL_STATUS_SETTING, "size");
    EXPECT(make(1u << 20, SIDE, GL_R32F), VARIKERNEL_STATUS_TOO_LARGE, "1048576");
    EXPECT(make(SIDE, SIDE, GL_RGBA8), VARIKERNEL_STATUS_MISMATCH, "0x8058");
#define WRONG(field, value, status)                                 \
    do {                                                            \
        const varikernel_settings kept = settings;                  \
        settings.field = value;                                     \
        EXPECT(make(SIDE, SIDE, GL_R32F), status, #field);          \
        settings = kept;                                            \
    } while (0)
    WRONG(min_photons, 0, VARIKERNEL_STATUS_SETTING);
    WRONG(max_radius, 0, VARIKERNEL_STATUS_SETTING);
    WRONG(max_radius, 32768, VARIKERNEL_STATUS_SETTING);
    WRONG(rule, 2, VARIKERNEL_STATUS_SETTING);
    WRONG(edges, 2, VARIKERNEL_STATUS_SETTING);
    WRONG(order, 4, VARIKERNEL_STATUS_SETTING);
    WRONG(limited_mask, 2, VARIKERNEL_STATUS_SETTING);
    WRONG(masked, 7, VARIKERNEL_STATUS_SETTING);
    settings.struct_size++;
    EXPECT(make(SIDE, SIDE, GL_R32F), VARIKERNEL_STATUS_INVALID_ARGUMENT, "settings_default");
    settings.struct_size--;
    EXPECT_OK(make(SIDE, SIDE, GL_R32F));
    EXPECT_OK(varikernel_pipeline_create(context, SIDE, SIDE, GL_R8UI, NULL, &pipeline));
}

static void wrong_frames(void) {
    static const unsigned char photons[SIDE][SIDE] = {{1}};
    const GLuint density = texture_of_bytes(SIDE, SIDE, photons[0]), small = texture_of_bytes(5, 4, photons[0]);
    GLuint none = 1, colours = 0, cube = 0;
    EXPECT(varikernel_frame_default(NULL, sizeof frame), VARIKERNEL_STATUS_INVALID_ARGUMENT, "frame is null");
    EXPECT(varikernel_frame_default(&frame, 0), VARIKERNEL_STATUS_INVALID_ARGUMENT, "0 bytes");
    EXPECT_OK(varikernel_frame_default(&frame, sizeof frame));
    EXPECT(render(), VARIKERNEL_STATUS_INVALID_ARGUMENT, "density_texture is null");
    frame.density_texture = density;
    EXPECT(varikernel_pipeline_render(NULL, &frame, &none, NULL),
           VARIKERNEL_STATUS_INVALID_ARGUMENT, "pipeline is null");
    EXPECT(varikernel_pipeline_render(pipeline, NULL, &none, NULL),
           VARIKERNEL_STATUS_INVALID_ARGUMENT, "frame is null");
    EXPECT(varikernel_pipeline_render(pipeline, &frame, NULL, NULL),
           VARIKERNEL_STATUS_INVALID_ARGUMENT, "radius_texture is null");
    EXPECT_OK(varikernel_pipeline_render(pipeline, &frame, &radii, &none));
    EXPECT_TRUE(none == 0 && glIsTexture(radii));

    glGenTextures(1, &colours);
    glBindTexture(GL_TEXTURE_2D, colours);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, SIDE, SIDE, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    glGenTextures(1, &cube);
    glBindTexture(GL_TEXTURE_CUBE_MAP, cube);
#define WRONG_FRAME(field, value, status, word) \
    do {                                        \
        const varikernel_frame kept = frame;    \
        frame.field = value;                    \
        EXPECT(render(), status, word);         \
        frame = kept;                           \
    } while (0)
    WRONG_FRAME(density_texture, colours, VARIKERNEL_STATUS_MISMATCH, "GL_RGBA8");
    WRONG_FRAME(density_texture, cube, VARIKERNEL_STATUS_MISMATCH, "GL_INVALID_OPERATION");
    WRONG_FRAME(density_texture, 4242, VARIKERNEL_STATUS_MISMATCH, "GL_INVALID_OPERATION");
    WRONG_FRAME(density_texture, small, VARIKERNEL_STATUS_MISMATCH, "5 x 4");
    WRONG_FRAME(density_texture, radii, VARIKERNEL_STATUS_MISMATCH, "own output");
    WRONG_FRAME(mask_texture, density, VARIKERNEL_STATUS_MISMATCH, "mask");
    WRONG_FRAME(changed, 4, VARIKERNEL_STATUS_SETTING, "changed");
    WRONG_FRAME(struct_size, 3, VARIKERNEL_STATUS_INVALID_ARGUMENT, "3 bytes");
    EXPECT_OK(render());
    EXPECT_TRUE(strstr(varikernel_last_error(), "3 bytes") != NULL);

    /* Two million photons in up to 64 x 64 pixels: sums that 32 bits need not hold, unless the host knows of fewer. */
    {
        const varikernel_settings usual = settings;
        varikernel_pipeline *usual_pipeline = pipeline;
        settings.min_photons = 2000000;
        EXPECT_OK(varikernel_pipeline_create(context, SIDE, SIDE, GL_R8UI, &settings, &pipeline));
        EXPECT(render(), VARIKERNEL_STATUS_INEXACT, "help:");
        frame.photons_at_most = 1000;
        EXPECT_OK(render());
        EXPECT_OK(varikernel_pipeline_destroy(pipeline));
        settings = usual;
        pipeline = usual_pipeline;
    }
    EXPECT_TRUE(glGetError() == GL_NO_ERROR);
}

static void *elsewhere(void *unused) {
    EXPECT_TRUE(strcmp(varikernel_last_error(), "") == 0);
    EXPECT(render(), VARIKERNEL_STATUS_WRONG_THREAD, "thread");
    EXPECT(make(SIDE, SIDE, GL_R32F), VARIKERNEL_STATUS_WRONG_THREAD, "thread");
    EXPECT(varikernel_pipeline_resize(pipeline, 1, 1), VARIKERNEL_STATUS_WRONG_THREAD, "thread");
    EXPECT(varikernel_pipeline_warm_up(pipeline), VARIKERNEL_STATUS_WRONG_THREAD, "thread");
    EXPECT(varikernel_pipeline_destroy(pipeline), VARIKERNEL_STATUS_WRONG_THREAD, "thread");
    EXPECT(varikernel_context_destroy(context), VARIKERNEL_STATUS_WRONG_THREAD, "thread");
    EXPECT(varikernel_context_abandon(context), VARIKERNEL_STATUS_WRONG_THREAD, "thread");
    return unused;
}

static void without_context(const headless *host) {
    EXPECT_TRUE(headless_make_current(host, 0));
    EXPECT(render(), VARIKERNEL_STATUS_NO_CONTEXT, "help:");
    EXPECT(make(SIDE, SIDE, GL_R32F), VARIKERNEL_STATUS_NO_CONTEXT, "help:");
    EXPECT(varikernel_pipeline_resize(pipeline, 1, 1), VARIKERNEL_STATUS_NO_CONTEXT, "help:");
    EXPECT(varikernel_pipeline_warm_up(pipeline), VARIKERNEL_STATUS_NO_CONTEXT, "help:");
    EXPECT(varikernel_pipeline_destroy(pipeline), VARIKERNEL_STATUS_NO_CONTEXT, "help:");
    EXPECT(varikernel_context_destroy(context), VARIKERNEL_STATUS_NO_CONTEXT, "help:");
    EXPECT_TRUE(headless_make_current(host, 1));
    EXPECT_OK(render());
}

static void wrong_sizes(void) {
    EXPECT(varikernel_pipeline_resize(NULL, 1, 1), VARIKERNEL_STATUS_INVALID_ARGUMENT, "pipeline is null");
    EXPECT(varikernel_pipeline_resize(pipeline, 1, 0), VARIKERNEL_STATUS_SETTING, "size");
    EXPECT(varikernel_pipeline_resize(pipeline, 1, 1u << 20), VARIKERNEL_STATUS_TOO_LARGE, "1048576");
    EXPECT_OK(render());
    EXPECT_OK(varikernel_pipeline_resize(pipeline, 5, 4));
    EXPECT_OK(varikernel_pipeline_warm_up(pipeline));
    EXPECT(render(), VARIKERNEL_STATUS_MISMATCH, "5 x 4");
}

static void wrong_memory(void) {
    uint64_t bytes = 12345;
    settings.order = VARIKERNEL_ORDER_BRACKETED;
    EXPECT(varikernel_pipeline_memory_required(NULL, SIDE, SIDE, NULL, &bytes, NULL), VARIKERNEL_STATUS_INVALID_ARGUMENT,
           "context is null");
    EXPECT(varikernel_pipeline_memory_required(context, SIDE, SIDE, NULL, NULL, &bytes), VARIKERNEL_STATUS_INVALID_ARGUMENT,
           "at_creation is null");
    EXPECT(varikernel_pipeline_memory_required(context, 1u << 20, SIDE, NULL, &bytes, NULL),
           VARIKERNEL_STATUS_TOO_LARGE, "1048576");
    EXPECT(varikernel_pipeline_memory_required(context, 0, SIDE, NULL, &bytes, NULL),
           VARIKERNEL_STATUS_SETTING, "size");
    settings.max_radius = 0;
    EXPECT(varikernel_pipeline_memory_required(context, SIDE, SIDE, &settings, &bytes, NULL),
           VARIKERNEL_STATUS_SETTING, "max_radius");
    settings.max_radius = 32;
    EXPECT(varikernel_memory_held(NULL, &bytes), VARIKERNEL_STATUS_INVALID_ARGUMENT, "context is null");
    EXPECT(varikernel_memory_held(context, NULL), VARIKERNEL_STATUS_INVALID_ARGUMENT, "bytes is null");
    EXPECT_TRUE(bytes == 12345);
}

/* After the context has gone, or is said to have, nothing but freeing is possible. */
static void abandoned(const headless *host) {
    uint64_t bytes = 0;
    EXPECT_OK(varikernel_context_create(headless_loader, NULL, VARIKERNEL_STATE_RESTORE, &context));
    EXPECT_OK(varikernel_pipeline_create(context, SIDE, SIDE, GL_R8UI, NULL, &pipeline));
    EXPECT(varikernel_context_abandon(NULL), VARIKERNEL_STATUS_INVALID_ARGUMENT, "context is null");
    EXPECT_OK(render());
    EXPECT_OK(varikernel_context_abandon(context));
    EXPECT(render(), VARIKERNEL_STATUS_CONTEXT_LOST, "help:");
    EXPECT(make(SIDE, SIDE, GL_R8UI), VARIKERNEL_STATUS_CONTEXT_LOST, "help:");
    EXPECT(varikernel_pipeline_resize(pipeline, 1, 1), VARIKERNEL_STATUS_CONTEXT_LOST, "help:");
    EXPECT(varikernel_pipeline_warm_up(pipeline), VARIKERNEL_STATUS_CONTEXT_LOST, "help:");
    EXPECT(varikernel_memory_held(context, &bytes), VARIKERNEL_STATUS_CONTEXT_LOST, "help:");
    EXPECT_TRUE(headless_make_current(host, 0));
    EXPECT_OK(varikernel_pipeline_destroy(pipeline));
    EXPECT_OK(varikernel_context_destroy(context));
    EXPECT_TRUE(headless_make_current(host, 1) && glIsTexture(radii));
}

int main(void) {
    headless host;
    pthread_t thread;
    EXPECT_TRUE(strcmp(varikernel_last_error(), "") == 0);
    EXPECT_TRUE(headless_open(&host));
    a_planted_difference_is_seen();
    versions();
    contexts(&host);
    wrong_settings();
    wrong_frames();
    wrong_memory();
    EXPECT_TRUE(pthread_create(&thread, NULL, elsewhere, NULL) == 0 && pthread_join(thread, NULL) == 0);
    without_context(&host);
    /* A pipeline outlives the handle that it was made with. */
    EXPECT_OK(varikernel_context_destroy(context));
    EXPECT_OK(render());
    logs();
    wrong_sizes();
    EXPECT_OK(varikernel_pipeline_destroy(pipeline));
    EXPECT_TRUE(!glIsTexture(radii));
    EXPECT_OK(varikernel_pipeline_destroy(NULL));
    EXPECT_OK(varikernel_context_destroy(NULL));
    abandoned(&host);
    headless_close(&host);
    printf("%d failures\n", failures);
    return failures != 0;
}
