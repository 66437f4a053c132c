// An engine with varikernel in its frame, in ten steps. It splats photons as points, has their radii found,
// reads them in a shader of its own, and checks each one against plain loops; then it has the photons' light
// found on its g-buffer.
// Exit code 0 if all of it is right.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine.hpp"
#include "headless.h"
#include "varikernel.h"

namespace {

constexpr int photons_drawn = 20000;

void check(varikernel_status status, const char *what) {
    require(status == VARIKERNEL_STATUS_OK, what + std::string(": ") + varikernel_last_error());
}

// The engine's own programs and photons.
struct Engine {
    GLuint points = program(
        "#version 330 core\nlayout(location = 0) in vec3 place; uniform mat4 projection;"
        "void main() { gl_Position = projection * vec4(place, 1); }",
        "#version 330 core\nout float count; void main() { count = 1; }");
    GLuint splat = program(
        "#version 330 core\nvoid main() { gl_Position = vec4(4 * (gl_VertexID & 1) - 1, 2 * (gl_VertexID & 2) - 1, 0, 1); }",
        "#version 330 core\nuniform usampler2D radii; out float radius;"
        "void main() { radius = float(texelFetch(radii, ivec2(gl_FragCoord.xy), 0).r); }");
    GLuint photons = 0;
    Engine() {
        const auto scattered = photons_on_a_floor(photons_drawn);
        GLuint vertex_array = 0;
        glGenVertexArrays(1, &vertex_array);
        glBindVertexArray(vertex_array);
        glGenBuffers(1, &photons);
        glBindBuffer(GL_ARRAY_BUFFER, photons);
        glBufferData(GL_ARRAY_BUFFER, photons_drawn * sizeof(varikernel_photon), scattered.data(), GL_STATIC_DRAW);
        glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(varikernel_photon), nullptr);
        glEnableVertexAttribArray(0);
    }
    // Photons as points that add 1 to their pixel.
    void draw_photons(const Target &density, const float *projection) const {
        density.begin();
        glClear(GL_COLOR_BUFFER_BIT);
        glUseProgram(points);
        glUniformMatrix4fv(glGetUniformLocation(points, "projection"), 1, GL_FALSE, projection);
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE);
        glDrawArrays(GL_POINTS, 0, photons_drawn);
        glDisable(GL_BLEND);
    }
};

// The definition: the smallest radius whose box holds n photons, scaled by the box's area inside the map.
uint32_t definition(const std::vector<float> &density, int width, int height, int x, int y, const varikernel_settings &asked) {
    for (int radius = 1; radius < static_cast<int>(asked.max_radius); radius++) {
        uint64_t held = 0, inside = 0;
        for (int v = std::max(y - radius, 0); v <= std::min(y + radius, height - 1); v++)
            for (int u = std::max(x - radius, 0); u <= std::min(x + radius, width - 1); u++, inside++)
                held += static_cast<uint64_t>(density[v * width + u]);
        const uint64_t area = (2 * radius + 1) * (2 * radius + 1);
        if (held * area >= asked.min_photons * inside) return radius;
    }
    return asked.max_radius;
}

// What the engine had set before a call, and finds set after it.
std::vector<GLint> state() {
    std::vector<GLint> values;
    for (GLenum name : {GL_CURRENT_PROGRAM, GL_VERTEX_ARRAY_BINDING, GL_DRAW_FRAMEBUFFER_BINDING, GL_BLEND, GL_BLEND_SRC_RGB,
                        GL_READ_FRAMEBUFFER_BINDING, GL_ACTIVE_TEXTURE, GL_TEXTURE_BINDING_2D, GL_UNPACK_ALIGNMENT})
        glGetIntegerv(name, &values.emplace_back());
    values.resize(values.size() + 4);
    glGetIntegerv(GL_VIEWPORT, &values[values.size() - 4]);
    return values;
}

// One frame of the engine at one size, and its check.
void frame(varikernel_pipeline *pipeline, const varikernel_settings &asked, const Engine &engine, int width, int height) {
    // Step 7: a density texture of yours, photons per pixel; you know how many you have drawn.
    const Texture counts(width, height);
    const Target density(counts.name, width, height);
    engine.draw_photons(density, Floor(width, height).projection);
    varikernel_frame brought;
    check(varikernel_frame_default(&brought, sizeof brought), "a frame's defaults");
    brought.density_texture = counts.name;
    brought.photons_at_most = photons_drawn;

    // Step 8: render in your frame, between your own passes. Your OpenGL state comes back as it was.
    glUseProgram(engine.points);
    glEnable(GL_BLEND);
    const auto before = state();
    GLuint radius_texture = 0;
    check(varikernel_pipeline_render(pipeline, &brought, &radius_texture, nullptr), "rendering radii");
    require(state() == before, "the OpenGL state is as it was");
    glDisable(GL_BLEND);
    require(state() != before, "a change of the OpenGL state is seen");

    // Step 9: bind the radius texture in your shader, a usampler2D.
    const Texture drawn(width, height);
    const Target splatted(drawn.name, width, height);
    glUseProgram(engine.splat);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, radius_texture);
    glDrawArrays(GL_TRIANGLES, 0, 3);

    const auto held = density.read(), radii = splatted.read();
    varikernel_settings other = asked;
    other.min_photons++;
    uint64_t wrong = 0, different = 0, sum = 0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const auto found = static_cast<uint32_t>(radii[y * width + x]);
            wrong += found != definition(held, width, height, x, y, asked);
            different += found != definition(held, width, height, x, y, other);
            sum += found;
        }
    std::printf("%d x %d: mean radius %.2f, %d pixels differ from the definition\n", width, height,
                static_cast<double>(sum) / (width * height), static_cast<int>(wrong));
    require(wrong == 0, "every radius is the definition's");
    require(different != 0, "one photon more gives other radii");
}

// Steps 6 to 9 for those who want the light itself: your photons and g-buffer in, irradiance out.
void light(const varikernel_context *context, const Engine &engine, int width, int height) {
    varikernel_irradiance *irradiance = nullptr;
    check(varikernel_irradiance_create(context, width, height, nullptr, &irradiance), "making an irradiance pipeline");
    const Floor floor(width, height);
    const Texture positions(width, height, floor.positions.data()), normals(width, height, floor.normals.data());
    varikernel_irradiance_frame brought;
    check(varikernel_irradiance_frame_default(&brought, sizeof brought), "a frame's defaults");
    brought.position_texture = positions.name;
    brought.normal_texture = normals.name;
    brought.photon_buffer = engine.photons;
    brought.photon_count = photons_drawn;
    std::copy_n(floor.view, 16, brought.view);
    std::copy_n(floor.projection, 16, brought.projection);
    GLuint irradiance_texture = 0;
    check(varikernel_irradiance_render(irradiance, &brought, &irradiance_texture, nullptr), "rendering irradiance");

    double power = 0;
    for (float value : Target(irradiance_texture, width, height).read()) power += value * std::pow(4.0 / height, 2);
    std::printf("the photons' power of 1 is %.4f in the picture\n", power);
    require(std::abs(power - 1) < 1e-4, "light is neither lost nor found");
    check(varikernel_irradiance_destroy(irradiance), "destroying the irradiance pipeline");
}

}  // namespace

int main() {
    // Step 1: your context is current on this thread, OpenGL 3.3 core or newer.
    headless host;
    require(headless_open(&host), "opening a headless OpenGL 3.3 context");

    // Step 2: header and library are of one version, and your loader becomes a handle.
    require(varikernel_is_compatible(VARIKERNEL_VERSION_MAJOR, VARIKERNEL_VERSION_MINOR), "one version of header and library");
    varikernel_context *context = nullptr;
    // Step 3: who puts the OpenGL state back: varikernel does. The other choice is to start from the defaults.
    const uint32_t policy = VARIKERNEL_STATE_RESTORE;
    check(varikernel_context_create(headless_loader, nullptr, policy, &context), "taking the context");
    std::printf("varikernel %s on %s\n", varikernel_version(), reinterpret_cast<const char *>(glGetString(GL_RENDERER)));

    // Step 4: settings: the smallest box that holds 20 photons, up to radius 16.
    varikernel_settings settings;
    check(varikernel_settings_default(&settings, sizeof settings), "the defaults");
    settings.min_photons = 20;
    settings.max_radius = 16;

    // Step 5: what it takes, before anything is allocated.
    uint64_t bytes = 0;
    check(varikernel_pipeline_memory_required(context, 160, 120, &settings, &bytes, nullptr),
          "asking for the memory");
    std::printf("160 x 120 takes %d KiB\n", static_cast<int>(bytes / 1024));

    // Step 6: a pipeline for a size; all is allocated and compiled here.
    varikernel_pipeline *pipeline = nullptr;
    check(varikernel_pipeline_create(context, 160, 120, GL_R32F, &settings, &pipeline), "making a pipeline");

    const Engine engine;
    frame(pipeline, settings, engine, 160, 120);
    light(context, engine, 160, 120);

    // What does not fit is a status and a text, and nothing was drawn.
    varikernel_frame empty;
    GLuint radius_texture = 0;
    check(varikernel_frame_default(&empty, sizeof empty), "a frame's defaults");
    const varikernel_status refused = varikernel_pipeline_render(pipeline, &empty, &radius_texture, nullptr);
    require(refused == VARIKERNEL_STATUS_INVALID_ARGUMENT, "an error");
    std::printf("a frame without a texture: %s\n", varikernel_last_error());

    // Step 10: resize with your window, and tear down while the context is current.
    check(varikernel_pipeline_resize(pipeline, 97, 61), "resizing");
    frame(pipeline, settings, engine, 97, 61);
    check(varikernel_pipeline_destroy(pipeline), "destroying the pipeline");
    check(varikernel_context_destroy(context), "destroying the context's handle");
    require(glGetError() == GL_NO_ERROR, "no OpenGL error is left");
    headless_close(&host);
}
