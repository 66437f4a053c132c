/* Light by each estimate, and what light from tables asks for, on a wall across the view; tests/capi/tables.rs has the same
 * host in Rust, and compares what this one prints: light and radii, a pixel a line, as bits. */
#include <math.h>

#include "check.h"

enum { SIDE = 64, PHOTONS = 3000 };

static const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
/* 90 degrees, from 1 to 3 units. */
static const float projection[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -2, -1, 0, 0, -3, 0};

static varikernel_context *context = NULL;
static varikernel_irradiance *irradiance = NULL;
static varikernel_irradiance_settings settings;
static varikernel_irradiance_frame frame;
static varikernel_photon photons[PHOTONS];
static varikernel_photon_totals totals;
static float light[SIDE * SIDE][4];
static GLuint radii[SIDE * SIDE];

/* A number from 0 to 1 in 16 bits, which no rounding changes. */
static float next_number(void) {
    static uint32_t state = 1;
    state = state * 1664525u + 1013904223u;
    return (float)(state >> 16) / 65536;
}

static void make_photons(void) {
    int i;
    for (i = 0; i < PHOTONS; i++) {
        const float x = 4 * next_number() - 2, y = 4 * next_number() - 2, red = 1 + next_number();
        const varikernel_photon photon = {{x, y, -2}, {0, 0, 1}, {red, 0.5f, 0.25f}, 1};
        photons[i] = photon;
    }
}

static void upload_photons(void) {
    glBufferData(GL_ARRAY_BUFFER, sizeof photons, photons, GL_STATIC_DRAW);
}

static GLuint texture_of(const void *texels) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, SIDE, SIDE, 0, GL_RGBA, GL_FLOAT, texels);
    return texture;
}

/* The places of a wall so far away, which fills the view. */
static GLuint wall_at(float distance) {
    static float places[SIDE][SIDE][4];
    int x, y;
    for (y = 0; y < SIDE; y++) {
        for (x = 0; x < SIDE; x++) {
            const float right = ((float)x + 0.5f) / (SIDE / 2) - 1, up = ((float)y + 0.5f) / (SIDE / 2) - 1;
            const float place[4] = {right * distance, up * distance, -distance, distance};
            memcpy(places[y][x], place, sizeof place);
        }
    }
    return texture_of(places);
}

static GLuint normals(void) {
    static float directions[SIDE * SIDE][4];
    int i;
    for (i = 0; i < SIDE * SIDE; i++) {
        directions[i][2] = directions[i][3] = 1;
    }
    return texture_of(directions);
}

static uint64_t held(void) {
    uint64_t bytes = 0;
    EXPECT_OK(varikernel_memory_held(context, &bytes));
    return bytes;
}

/* Makes it anew; it takes the memory that it says. */
static void make(void) {
    uint64_t before, required = 0;
    EXPECT_OK(varikernel_irradiance_destroy(irradiance));
    before = held();
    EXPECT_OK(varikernel_irradiance_memory_required(SIDE, SIDE, &settings, &required));
    EXPECT_OK(varikernel_irradiance_create(context, SIDE, SIDE, &settings, &irradiance));
    EXPECT_TRUE(held() - before == required);
}

static varikernel_status render(void) {
    GLuint of_light = 0, of_radii = 0;
    const varikernel_status status = varikernel_irradiance_render(irradiance, &frame, &of_light, &of_radii);
    EXPECT_TRUE((of_light != 0) == (status == VARIKERNEL_STATUS_OK) && (of_radii != 0) == (of_light != 0));
    if (of_light) {
        glBindTexture(GL_TEXTURE_2D, of_light);
        glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, light);
        glBindTexture(GL_TEXTURE_2D, of_radii);
        glGetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, radii);
    }
    return status;
}

static double mean(void) {
    double sum = 0;
    int i;
    for (i = 0; i < SIDE * SIDE; i++) {
        sum += light[i][0];
    }
    return sum / (SIDE * SIDE);
}

/* Whether the mean light is so many times what it was, but for widths that noise asks for. */
static int is_times(double before, double times) {
    return fabs(mean() - times * before) < 1e-2 * times * before;
}

static void print(void) {
    int i;
    for (i = 0; i < SIDE * SIDE; i++) {
        uint32_t bits[4];
        memcpy(bits, light[i], sizeof bits);
        printf("%08x %08x %08x %u\n", (unsigned)bits[0], (unsigned)bits[1], (unsigned)bits[2], (unsigned)radii[i]);
    }
}

static void each_estimate(void) {
    uint32_t estimate;
    for (estimate = VARIKERNEL_ESTIMATE_SPLAT; estimate <= VARIKERNEL_ESTIMATE_TABLES; estimate++) {
        settings.estimate = estimate;
        frame.photon_totals = estimate == VARIKERNEL_ESTIMATE_TABLES ? &totals : NULL;
        make();
        EXPECT_OK(render());
        print();
    }
}

/* What is known of the camera is made anew unless the host says that it stands. */
static void frames_of_tables(GLuint far_wall, GLuint near_wall) {
    static float first[SIDE * SIDE][4];
    double far_light;
    int i;
    memcpy(first, light, sizeof first);
    far_light = mean();
    /* All photons land on 16 square units, with a red power of 1.5 on average. */
    EXPECT_TRUE(fabs(far_light / (PHOTONS * 1.5 / 16) - 1) < 0.1);
    frame.same_camera = 1;
    EXPECT_OK(render());
    EXPECT_TRUE(memcmp(first, light, sizeof first) == 0);
    frame.added = 1;
    EXPECT_OK(render());
    EXPECT_TRUE(is_times(far_light, 2));
    frame.added = 0;
    for (i = 0; i < 4; i++) {
        (i < 3 ? &totals.power[i] : &totals.squares)[0] *= 2;
    }
    EXPECT_OK(render());
    EXPECT_TRUE(is_times(far_light, 1));
    /* At half the distance the same photons land on a quarter of the area. */
    frame.position_texture = near_wall;
    for (i = 0; i < PHOTONS; i++) {
        photons[i].position[0] /= 2;
        photons[i].position[1] /= 2;
        photons[i].position[2] = -1;
    }
    upload_photons();
    EXPECT_OK(render());
    EXPECT_TRUE(is_times(far_light, 1));
    frame.same_camera = 0;
    EXPECT_OK(render());
    EXPECT_TRUE(is_times(far_light, 4));
    /* A size that comes back knows no camera. */
    EXPECT_OK(varikernel_irradiance_resize(irradiance, 2 * SIDE, SIDE));
    EXPECT_OK(varikernel_irradiance_resize(irradiance, SIDE, SIDE));
    frame.same_camera = 1;
    EXPECT_OK(render());
    EXPECT_TRUE(is_times(far_light, 4));
    frame.same_camera = 0;
    frame.position_texture = far_wall;
}

static void refused(double *part, double value, const char *word) {
    const double kept = *part;
    *part = value;
    EXPECT(render(), VARIKERNEL_STATUS_SETTING, word);
    *part = kept;
}

static void statuses(void) {
    const varikernel_status invalid = VARIKERNEL_STATUS_INVALID_ARGUMENT, setting = VARIKERNEL_STATUS_SETTING;
    const varikernel_irradiance_frame kept = frame;
    varikernel_photon_totals none;
    varikernel_irradiance *made = NULL;
    EXPECT(varikernel_photon_totals_of(photons, 1, NULL), invalid, "totals is null");
    EXPECT(varikernel_photon_totals_of(NULL, 1, &none), invalid, "photons is null");
    EXPECT_OK(varikernel_photon_totals_of(NULL, 0, &none));
    EXPECT_TRUE(none.power[0] == 0 && none.squares == 0);
    frame.photon_totals = NULL;
    EXPECT(render(), invalid, "photon_totals is null");
    EXPECT(render(), invalid, "varikernel_photon_totals_of");
    frame = kept;
    refused(&totals.power[0], -1, "photon_totals.power[0]");
    refused(&totals.power[1], (double)NAN, "photon_totals.power[1]");
    refused(&totals.power[2], (double)INFINITY, "photon_totals.power[2]");
    refused(&totals.squares, -0.5, "photon_totals.squares");
    frame.same_camera = 2;
    EXPECT(render(), setting, "same_camera");
    frame = kept;
    EXPECT_OK(render());
    settings.estimate = 4;
    EXPECT(varikernel_irradiance_create(context, SIDE, SIDE, &settings, &made), setting, "VARIKERNEL_ESTIMATE_...");
    EXPECT_TRUE(made == NULL);
}

int main(void) {
    headless host;
    GLuint far_wall, near_wall, buffer = 0;
    EXPECT_TRUE(headless_open(&host));
    EXPECT_OK(varikernel_context_create(headless_loader, NULL, VARIKERNEL_STATE_RESTORE, &context));
    EXPECT_OK(varikernel_irradiance_settings_default(&settings, sizeof settings));
    EXPECT_TRUE(settings.estimate == VARIKERNEL_ESTIMATE_SPLAT);
    far_wall = wall_at(2);
    near_wall = wall_at(1);
    make_photons();
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    upload_photons();
    EXPECT_OK(varikernel_irradiance_frame_default(&frame, sizeof frame));
    EXPECT_TRUE(frame.photon_totals == NULL && frame.same_camera == 0);
    frame.position_texture = far_wall;
    frame.normal_texture = normals();
    frame.photon_buffer = buffer;
    frame.photon_count = PHOTONS;
    memcpy(frame.view, identity, sizeof identity);
    memcpy(frame.projection, projection, sizeof projection);
    EXPECT_OK(varikernel_photon_totals_of(photons, PHOTONS, &totals));
    each_estimate();
    frames_of_tables(far_wall, near_wall);
    statuses();
    EXPECT_OK(varikernel_irradiance_destroy(irradiance));
    EXPECT_OK(varikernel_context_destroy(context));
    EXPECT_TRUE(glGetError() == GL_NO_ERROR);
    headless_close(&host);
    printf("%d failures\n", failures);
    return failures != 0;
}
