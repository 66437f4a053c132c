/* Light by hand: a wall across the view, 2 units away, and photons on it. A pixel is 1/8 units wide there, so that it covers
 * 1/64 of a square unit. */
#include <math.h>

#include "check.h"

enum { SIDE = 32, MIDDLE = 16 };

static const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
/* 90 degrees, from 1 to 3 units: depth 2 is 0.75 in the depth buffer. */
static const float projection[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -2, -1, 0, 0, -3, 0};
/* In the middle of pixel (16, 16). */
static const varikernel_photon photon = {{0.0625f, 0.0625f, -2}, {0, 0, 1}, {1, 2, 4}, 1};

static varikernel_context *context = NULL;
static varikernel_irradiance *irradiance = NULL;
static varikernel_irradiance_settings settings;
static varikernel_irradiance_frame frame;
static float light[SIDE][SIDE][4];
static GLuint radii[SIDE][SIDE];

static GLuint texture_of(GLenum internal, GLenum format, const void *texels) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, (GLint)internal, SIDE, SIDE, 0, format, GL_FLOAT, texels);
    return texture;
}

/* The wall as positions, normals and depth. */
static void draw_wall(GLuint *positions, GLuint *normals, GLuint *depth) {
    static float places[SIDE][SIDE][4], directions[SIDE][SIDE][4], depths[SIDE][SIDE];
    int x, y;
    for (y = 0; y < SIDE; y++) {
        for (x = 0; x < SIDE; x++) {
            const float place[4] = {((float)x + 0.5f) / 8 - 2, ((float)y + 0.5f) / 8 - 2, -2, 2};
            const float direction[4] = {0, 0, 1, 1};
            memcpy(places[y][x], place, sizeof place);
            memcpy(directions[y][x], direction, sizeof direction);
            depths[y][x] = 0.75f;
        }
    }
    *positions = texture_of(GL_RGBA32F, GL_RGBA, places);
    *normals = texture_of(GL_RGBA32F, GL_RGBA, directions);
    *depth = texture_of(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, depths);
}

static varikernel_status render(void) {
    GLuint of_light = 0, of_radii = 0;
    const varikernel_status status = varikernel_irradiance_render(irradiance, &frame, &of_light, &of_radii);
    if (status == VARIKERNEL_STATUS_OK) {
        glBindTexture(GL_TEXTURE_2D, of_light);
        glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, light);
        EXPECT_TRUE((of_radii == 0) == (settings.fixed_radius != 0));
        if (of_radii) {
            glBindTexture(GL_TEXTURE_2D, of_radii);
            glGetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, radii);
        }
    } else {
        EXPECT_TRUE(of_light == 0 && of_radii == 0);
    }
    return status;
}

/* Whether a pixel holds this much of the photon's power on a square unit. */
static int is_lit(int x, int y, double expected) {
    return fabs(light[y][x][0] - expected) <= 1e-4 * expected && fabs(light[y][x][1] - 2 * expected) <= 2e-4 * expected &&
           fabs(light[y][x][2] - 4 * expected) <= 4e-4 * expected;
}

/* Power in the whole picture, red. */
static double power(void) {
    double sum = 0;
    int x, y;
    for (y = 0; y < SIDE; y++) {
        for (x = 0; x < SIDE; x++) {
            sum += light[y][x][0] / 64.0;
        }
    }
    return sum;
}

static uint64_t held(void) {
    uint64_t bytes = 0;
    EXPECT_OK(varikernel_memory_held(context, &bytes));
    return bytes;
}

static varikernel_status make(void) {
    varikernel_irradiance *made = NULL;
    const varikernel_status status = varikernel_irradiance_create(context, SIDE, SIDE, &settings, &made);
    EXPECT_TRUE((made != NULL) == (status == VARIKERNEL_STATUS_OK));
    if (made) {
        EXPECT_OK(varikernel_irradiance_destroy(irradiance));
        irradiance = made;
    }
    return status;
}

/* A disc with the area of a box of side 7 has a radius of 3.95 pixels and covers 45 middles of pixels. */
static void a_photon_of_radius_3_lights_45_pixels(void) {
    EXPECT_OK(render());
    EXPECT_TRUE(is_lit(MIDDLE, MIDDLE, 64.0 / 45));
    EXPECT_TRUE(!is_lit(MIDDLE, MIDDLE, 64.0 / 44) && !is_lit(MIDDLE, MIDDLE, 64.0 / 46));
    EXPECT_TRUE(is_lit(MIDDLE - 3, MIDDLE + 2, 64.0 / 45));
    EXPECT_TRUE(is_lit(MIDDLE + 4, MIDDLE, 0) && is_lit(MIDDLE + 3, MIDDLE + 3, 0));
    EXPECT_TRUE(fabs(power() - 1) < 1e-4);
}

static void answers(GLuint positions, GLuint depth) {
    settings.fixed_radius = 3;
    settings.kernel = VARIKERNEL_KERNEL_BOX;
    EXPECT_OK(make());
    a_photon_of_radius_3_lights_45_pixels();
    frame.added = 1;
    EXPECT_OK(render());
    EXPECT_TRUE(fabs(power() - 2) < 2e-4);
    frame.added = 0;
    a_photon_of_radius_3_lights_45_pixels();
    frame.photon_count = 0;
    EXPECT_OK(render());
    EXPECT_TRUE(power() == 0);
    frame.photon_count = 1;

    settings.from_depth = 1;
    EXPECT_OK(make());
    frame.position_texture = depth;
    a_photon_of_radius_3_lights_45_pixels();
    a_photon_of_radius_3_lights_45_pixels();
    /* Read as depth from 0 to 1 in clip space, it is another place, where no photon is. */
    frame.depth_zero_to_one = 1;
    EXPECT_OK(render());
    EXPECT_TRUE(power() == 0);
    frame.depth_zero_to_one = 0;
    a_photon_of_radius_3_lights_45_pixels();
    frame.position_texture = positions;
    settings.from_depth = 0;

    /* The radius of the photon's own pixel is 1: a disc of 1.69 pixels, which covers 9. */
    settings.fixed_radius = 0;
    settings.min_photons = 1;
    settings.max_radius = 5;
    settings.edges = VARIKERNEL_EDGES_ZERO;
    EXPECT_OK(make());
    EXPECT_OK(render());
    EXPECT_TRUE(is_lit(MIDDLE + 1, MIDDLE + 1, 64.0 / 9) && is_lit(MIDDLE + 2, MIDDLE, 0));
    EXPECT_TRUE(radii[MIDDLE][MIDDLE] == 1 && radii[MIDDLE][MIDDLE + 4] == 4 && radii[0][0] == 5);
}

#define WRONG(struct_name, call, field, value, status, word) \
    do {                                                     \
        const varikernel_irradiance_##struct_name kept = struct_name; \
        struct_name.field = value;                           \
        EXPECT(call, status, word);                          \
        struct_name = kept;                                  \
    } while (0)

static void statuses(const headless *host) {
    const varikernel_status invalid = VARIKERNEL_STATUS_INVALID_ARGUMENT, setting = VARIKERNEL_STATUS_SETTING;
    const varikernel_status mismatch = VARIKERNEL_STATUS_MISMATCH;
    GLuint colours = 0, name = 0;
    uint64_t bytes = 0;
    EXPECT(varikernel_irradiance_settings_default(NULL, sizeof settings), invalid, "settings is null");
    EXPECT(varikernel_irradiance_settings_default(&settings, 4), invalid, "4 bytes");
    EXPECT(varikernel_irradiance_frame_default(NULL, sizeof frame), invalid, "frame is null");
    EXPECT(varikernel_irradiance_frame_default(&frame, 4), invalid, "4 bytes");
    EXPECT(varikernel_irradiance_create(NULL, SIDE, SIDE, NULL, &irradiance), invalid, "context is null");
    EXPECT(varikernel_irradiance_create(context, SIDE, SIDE, NULL, NULL), invalid, "irradiance is null");
    EXPECT(varikernel_irradiance_memory_required(SIDE, SIDE, NULL, NULL), invalid, "bytes is null");
    EXPECT(varikernel_irradiance_memory_required(SIDE, 0, NULL, &bytes), setting, "size");
    EXPECT(varikernel_irradiance_resize(NULL, SIDE, SIDE), invalid, "irradiance is null");
    EXPECT(varikernel_irradiance_resize(irradiance, 0, SIDE), setting, "size");
    EXPECT(varikernel_irradiance_resize(irradiance, 1u << 20, SIDE), VARIKERNEL_STATUS_TOO_LARGE, "1048576");
    EXPECT(varikernel_irradiance_render(NULL, &frame, &name, NULL), invalid, "irradiance is null");
    EXPECT(varikernel_irradiance_render(irradiance, NULL, &name, NULL), invalid, "frame is null");
    EXPECT(varikernel_irradiance_render(irradiance, &frame, NULL, NULL), invalid, "irradiance_texture is null");
    WRONG(settings, make(), fixed_radius, 97, setting, "radius");
    WRONG(settings, make(), max_radius, 97, setting, "max_radius");
    WRONG(settings, make(), min_photons, 0, setting, "min_photons");
    WRONG(settings, make(), edges, 2, setting, "edges");
    WRONG(settings, make(), kernel, 5, setting, "kernel");
    WRONG(settings, make(), from_depth, 2, setting, "from_depth");
    WRONG(settings, make(), struct_size, 0, invalid, "irradiance_settings_default");

    glGenTextures(1, &colours);
    glBindTexture(GL_TEXTURE_2D, colours);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, SIDE, SIDE, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    WRONG(frame, render(), position_texture, 0, invalid, "position_texture is null");
    WRONG(frame, render(), normal_texture, 0, invalid, "normal_texture is null");
    WRONG(frame, render(), photon_buffer, 0, invalid, "photon_buffer is null");
    WRONG(frame, render(), position_texture, colours, mismatch, "GL_RGBA8");
    WRONG(frame, render(), normal_texture, colours, mismatch, "GL_RGBA8");
    WRONG(frame, render(), photon_count, 2, mismatch, "bytes");
    WRONG(frame, render(), added, 2, setting, "added");
    WRONG(frame, render(), depth_reversed, 2, setting, "depth_reversed");
    WRONG(frame, render(), depth_zero_to_one, 2, setting, "depth_zero_to_one");
    WRONG(frame, render(), view[0], 2, setting, "view");
    WRONG(frame, render(), projection[11], 0, setting, "projection");
    WRONG(frame, render(), struct_size, 0, invalid, "irradiance_frame_default");
    glDeleteTextures(1, &colours);
    EXPECT_TRUE(headless_make_current(host, 0));
    EXPECT(render(), VARIKERNEL_STATUS_NO_CONTEXT, "help:");
    EXPECT(varikernel_irradiance_destroy(irradiance), VARIKERNEL_STATUS_NO_CONTEXT, "help:");
    EXPECT_TRUE(headless_make_current(host, 1));
    EXPECT_OK(render());
}

/* What another size takes is known before, and the size of the textures comes back. */
static void sizes(void) {
    uint64_t small = 0, large = 0, before;
    GLuint name = 0;
    EXPECT_OK(make());
    EXPECT_OK(varikernel_irradiance_memory_required(SIDE, SIDE, &settings, &small));
    EXPECT_OK(varikernel_irradiance_memory_required(2 * SIDE, 2 * SIDE, &settings, &large));
    EXPECT_TRUE(large > small);
    before = held();
    EXPECT_OK(varikernel_irradiance_resize(irradiance, 2 * SIDE, 2 * SIDE));
    EXPECT_TRUE(held() - before == large - small);
    EXPECT(varikernel_irradiance_render(irradiance, &frame, &name, NULL), VARIKERNEL_STATUS_MISMATCH, "64 x 64");
    EXPECT_OK(varikernel_irradiance_resize(irradiance, SIDE, SIDE));
    EXPECT_OK(varikernel_irradiance_render(irradiance, &frame, &name, NULL));
}

int main(void) {
    headless host;
    GLuint positions = 0, normals = 0, depth = 0, buffer = 0;
    EXPECT_TRUE(headless_open(&host));
    EXPECT_OK(varikernel_context_create(headless_loader, NULL, VARIKERNEL_STATE_RESTORE, &context));
    EXPECT_OK(varikernel_irradiance_settings_default(&settings, sizeof settings));
    EXPECT_TRUE(settings.fixed_radius == 0 && settings.min_photons == 400 && settings.max_radius == 64);
    EXPECT_TRUE(settings.kernel == VARIKERNEL_KERNEL_SILVERMAN && settings.edges == VARIKERNEL_EDGES_SCALE);
    draw_wall(&positions, &normals, &depth);
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof photon, &photon, GL_STATIC_DRAW);
    EXPECT_OK(varikernel_irradiance_frame_default(&frame, sizeof frame));
    frame.position_texture = positions;
    frame.normal_texture = normals;
    frame.photon_buffer = buffer;
    frame.photon_count = 1;
    memcpy(frame.view, identity, sizeof identity);
    memcpy(frame.projection, projection, sizeof projection);
    answers(positions, depth);
    sizes();
    statuses(&host);
    EXPECT_OK(varikernel_irradiance_destroy(irradiance));
    EXPECT_OK(varikernel_irradiance_destroy(NULL));
    EXPECT_OK(varikernel_context_destroy(context));
    EXPECT_TRUE(glGetError() == GL_NO_ERROR);
    headless_close(&host);
    printf("%d failures\n", failures);
    return failures != 0;
}
