/* Radii by hand: with n = 1 and nothing outside, a radius is the distance to the nearest photon, in king's moves, at
 * least 1 and at most MR. */
#include "check.h"

enum { SIDE = 6 };

/* Photons at column 1, row 1 of a map of 6 x 6; MR 3. */
static const unsigned char first_photon[SIDE][SIDE] = {{0}, {0, 1}};
static const GLuint first_radii[SIDE][SIDE] = {
    {1, 1, 1, 2, 3, 3}, {1, 1, 1, 2, 3, 3}, {1, 1, 1, 2, 3, 3},
    {2, 2, 2, 2, 3, 3}, {3, 3, 3, 3, 3, 3}, {3, 3, 3, 3, 3, 3}};
/* 1 where the distance is more than MR. */
static const GLubyte first_limited[SIDE][SIDE] = {
    {0, 0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, 1},
    {0, 0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, 1}, {1, 1, 1, 1, 1, 1}};
/* Another at column 5, row 4. */
static const unsigned char second_photon[SIDE][SIDE] = {{0}, {0}, {0}, {0}, {0, 0, 0, 0, 0, 1}};
static const unsigned char both_photons[SIDE][SIDE] = {{0}, {0, 1}, {0}, {0}, {0, 0, 0, 0, 0, 1}};
static const GLuint both_radii[SIDE][SIDE] = {
    {1, 1, 1, 2, 3, 3}, {1, 1, 1, 2, 3, 3}, {1, 1, 1, 2, 2, 2},
    {2, 2, 2, 2, 1, 1}, {3, 3, 3, 2, 1, 1}, {3, 3, 3, 2, 1, 1}};
/* No radius is needed in row 0. */
static const unsigned char all_but_row_0[SIDE][SIDE] = {
    {0}, {1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}};
static const GLuint zeros[SIDE] = {0};

static int holds_radii(GLuint texture, const GLuint (*expected)[SIDE]) {
    GLuint found[SIDE][SIDE];
    glBindTexture(GL_TEXTURE_2D, texture);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, found);
    glBindTexture(GL_TEXTURE_2D, 0);
    return memcmp(found, expected, sizeof found) == 0;
}

static int holds_bytes(GLuint texture, const GLubyte (*expected)[SIDE]) {
    GLubyte found[SIDE][SIDE];
    glBindTexture(GL_TEXTURE_2D, texture);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, found);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glBindTexture(GL_TEXTURE_2D, 0);
    return memcmp(found, expected, sizeof found) == 0;
}

static void frames(varikernel_pipeline *pipeline, GLuint density) {
    const GLuint second = texture_of_bytes(SIDE, SIDE, second_photon[0]);
    GLuint radii = 0, limited = 0;
    varikernel_frame frame;
    EXPECT_OK(varikernel_frame_default(&frame, sizeof frame));
    frame.density_texture = density;
    frame.photons_at_most = 1;
    EXPECT_OK(varikernel_pipeline_render(pipeline, &frame, &radii, &limited));
    EXPECT_TRUE(holds_radii(radii, first_radii));
    EXPECT_TRUE(holds_bytes(limited, first_limited));
    EXPECT_TRUE(!holds_radii(radii, both_radii) && !holds_bytes(limited, both_photons));

    /* The map becomes that of both photons, but it is said that nothing has changed. */
    put_bytes(density, SIDE, SIDE, both_photons[0]);
    frame.photons_at_most = 2;
    frame.changed = VARIKERNEL_CHANGED_NOTHING;
    EXPECT_OK(varikernel_pipeline_render(pipeline, &frame, &radii, &limited));
    EXPECT_TRUE(holds_radii(radii, first_radii));
    frame.changed = VARIKERNEL_CHANGED_RECTANGLE;
    frame.changed_x = 5;
    frame.changed_y = 4;
    frame.changed_width = frame.changed_height = 1;
    EXPECT_OK(varikernel_pipeline_render(pipeline, &frame, &radii, &limited));
    EXPECT_TRUE(holds_radii(radii, both_radii));

    /* From the first photon alone, the second is added. */
    put_bytes(density, SIDE, SIDE, first_photon[0]);
    frame.changed = VARIKERNEL_CHANGED_EVERYTHING;
    EXPECT_OK(varikernel_pipeline_render(pipeline, &frame, &radii, &limited));
    EXPECT_TRUE(holds_radii(radii, first_radii));
    frame.density_texture = second;
    frame.photons_at_most = 1;
    frame.changed = VARIKERNEL_CHANGED_ADDED;
    EXPECT_OK(varikernel_pipeline_render(pipeline, &frame, &radii, &limited));
    EXPECT_TRUE(holds_radii(radii, both_radii));
    glDeleteTextures(1, &second);
}

static void masked_frame(const varikernel_context *context, varikernel_settings settings, GLuint density) {
    const GLuint mask = texture_of_bytes(SIDE, SIDE, all_but_row_0[0]);
    varikernel_pipeline *pipeline = NULL;
    GLuint radii = 0, found[SIDE][SIDE];
    varikernel_frame frame;
    settings.masked = 1;
    EXPECT_OK(varikernel_pipeline_create(context, SIDE, SIDE, GL_R8UI, &settings, &pipeline));
    EXPECT_OK(varikernel_frame_default(&frame, sizeof frame));
    frame.density_texture = density;
    frame.mask_texture = mask;
    EXPECT_OK(varikernel_pipeline_render(pipeline, &frame, &radii, NULL));
    glBindTexture(GL_TEXTURE_2D, radii);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, found);
    glBindTexture(GL_TEXTURE_2D, 0);
    EXPECT_TRUE(memcmp(found[0], zeros, sizeof zeros) == 0);
    EXPECT_TRUE(memcmp(found[1], first_radii[1], sizeof found - sizeof zeros) == 0);
    /* The next frame has none, whatever it says of what changed. */
    frame.mask_texture = 0;
    frame.changed = VARIKERNEL_CHANGED_NOTHING;
    EXPECT_OK(varikernel_pipeline_render(pipeline, &frame, &radii, NULL));
    glBindTexture(GL_TEXTURE_2D, radii);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, found);
    glBindTexture(GL_TEXTURE_2D, 0);
    EXPECT_TRUE(memcmp(found, first_radii, sizeof found) == 0);
    EXPECT_OK(varikernel_pipeline_destroy(pipeline));
    glDeleteTextures(1, &mask);
}

/* What is not at its default comes back, or becomes it. */
static void left_state(varikernel_pipeline *pipeline, GLuint density, uint32_t state_policy) {
    GLuint radii = 0;
    varikernel_frame frame;
    EXPECT_OK(varikernel_frame_default(&frame, sizeof frame));
    frame.density_texture = density;
    glEnable(GL_CULL_FACE);
    EXPECT_OK(varikernel_pipeline_render(pipeline, &frame, &radii, NULL));
    EXPECT_TRUE(glIsEnabled(GL_CULL_FACE) == (state_policy == VARIKERNEL_STATE_RESTORE));
    glDisable(GL_CULL_FACE);
}

static uint64_t held(const varikernel_context *context) {
    uint64_t bytes = 0;
    EXPECT_OK(varikernel_memory_held(context, &bytes));
    return bytes;
}

static void all_orders(uint32_t state_policy) {
    varikernel_context *context = NULL;
    varikernel_settings settings;
    uint32_t order;
    EXPECT_OK(varikernel_context_create(headless_loader, NULL, state_policy, &context));
    EXPECT_OK(varikernel_settings_default(&settings, sizeof settings));
    settings.min_photons = 1;
    settings.max_radius = 3;
    settings.edges = VARIKERNEL_EDGES_ZERO;
    settings.limited_mask = 1;
    for (order = VARIKERNEL_ORDER_BRACKETED; order <= VARIKERNEL_ORDER_ADAPTIVE; order++) {
        const GLuint density = texture_of_bytes(SIDE, SIDE, first_photon[0]);
        const uint64_t before = held(context);
        uint64_t at_creation = 0, at_most = 0;
        varikernel_pipeline *pipeline = NULL;
        settings.order = order;
        EXPECT_OK(
            varikernel_pipeline_memory_required(context, SIDE, SIDE, &settings, &at_creation, &at_most));
        EXPECT_TRUE(held(context) == before && at_creation < at_most);
        EXPECT_OK(varikernel_pipeline_create(context, SIDE, SIDE, GL_R8UI, &settings, &pipeline));
        EXPECT_TRUE(held(context) == before + at_creation);
        frames(pipeline, density);
        /* Photons were added, which takes the rest; orders were chosen or not. */
        EXPECT_TRUE(order == VARIKERNEL_ORDER_ADAPTIVE ? held(context) <= before + at_most : held(context) == before + at_most);
        masked_frame(context, settings, density);
        left_state(pipeline, density, state_policy);
        EXPECT_OK(varikernel_pipeline_destroy(pipeline));
        EXPECT_TRUE(held(context) == before);
        glDeleteTextures(1, &density);
    }
    EXPECT_OK(varikernel_context_destroy(context));
}

/* 200 photons at column 1, row 1, by the other rule with MR 1: all tests of radius 1 that see them fail as far as
 * a test can, 6 variances, and the mean of a box may be 1.8. So three in ten of its tests may see them. */
static void even_radii(void) {
    static const unsigned char photons[SIDE][SIDE] = {{0}, {0, 200}};
    static const GLuint expected[SIDE][SIDE] = {
        {0, 0, 0, 0, 1, 1}, {0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1, 1},
        {0, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}};
    static const GLubyte still_even[SIDE][SIDE] = {
        {0, 0, 0, 0, 1, 1}, {0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1, 1},
        {0, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1}};
    const GLuint density = texture_of_bytes(SIDE, SIDE, photons[0]);
    varikernel_context *context = NULL;
    varikernel_pipeline *pipeline = NULL;
    varikernel_settings settings;
    varikernel_frame frame;
    GLuint radii = 0, limited = 0;
    uint64_t at_creation = 0, at_most = 0;
    EXPECT_OK(varikernel_context_create(headless_loader, NULL, VARIKERNEL_STATE_RESTORE, &context));
    EXPECT_OK(varikernel_settings_default(&settings, sizeof settings));
    EXPECT_TRUE(settings.rule == VARIKERNEL_RULE_NEAREST);
    settings.rule = VARIKERNEL_RULE_EVEN;
    settings.max_radius = 1;
    settings.limited_mask = 1;
    EXPECT_OK(varikernel_pipeline_memory_required(context, SIDE, SIDE, &settings, &at_creation, &at_most));
    EXPECT_OK(varikernel_pipeline_create(context, SIDE, SIDE, GL_R8UI, &settings, &pipeline));
    EXPECT_TRUE(held(context) == at_creation);
    EXPECT_OK(varikernel_frame_default(&frame, sizeof frame));
    frame.density_texture = density;
    frame.photons_at_most = 200;
    EXPECT_OK(varikernel_pipeline_render(pipeline, &frame, &radii, &limited));
    EXPECT_TRUE(holds_radii(radii, expected) && holds_bytes(limited, still_even));
    EXPECT_TRUE(!holds_radii(radii, both_radii));
    EXPECT_OK(varikernel_pipeline_destroy(pipeline));
    EXPECT_OK(varikernel_context_destroy(context));
    glDeleteTextures(1, &density);
}

int main(void) {
    headless host;
    EXPECT_TRUE(headless_open(&host));
    even_radii();
    all_orders(VARIKERNEL_STATE_RESTORE);
    all_orders(VARIKERNEL_STATE_DEFAULTS);
    EXPECT_TRUE(glGetError() == GL_NO_ERROR);
    headless_close(&host);
    printf("%d failures\n", failures);
    return failures != 0;
}
