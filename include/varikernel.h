/* varikernel: the smallest box radius that holds n photons, for every pixel of a photon density map, in OpenGL 3.3
 * core, inside the context of a host.
 *
 * Generated from src/capi by `VARIKERNEL_UPDATE=1 cargo test --test capi header`; do not edit. Licence: MIT or
 * Apache-2.0.
 *
 * Threads: a handle is used and destroyed on the thread that made it, with the OpenGL context current that was current
 * then. Several contexts, each on its thread, may live side by side. Of contexts that share objects, ours are usable in
 * one: vertex arrays and framebuffers are not shared. The textures are, after a fence of yours.
 *
 * OpenGL state: each call puts back what it touches, also when it fails, or leaves the defaults: VARIKERNEL_STATE_... All of
 * it is listed in src/gl/state_contract.md. GL errors that were pending are taken. Frames wait for nothing.
 *
 * Errors: a call answers with a status; varikernel_last_error() has the text. No handle and no texture name is written
 * by a call that fails. A status is no promise for pointers that are dangling or handles that were destroyed.
 */

#ifndef VARIKERNEL_H
#define VARIKERNEL_H

#include <stdbool.h>
#include <stdint.h>

/**
 * The version of this header, major part.
 */
#define VARIKERNEL_VERSION_MAJOR 0

/**
 * The version of this header, minor part.
 */
#define VARIKERNEL_VERSION_MINOR 2

/**
 * The version of this header, patch part.
 */
#define VARIKERNEL_VERSION_PATCH 0

/**
 * level: something of the library failed, and no status tells.
 */
#define VARIKERNEL_LOG_ERROR 1

/**
 * level: what the host should know, such as an OpenGL error that was pending when a call began.
 */
#define VARIKERNEL_LOG_WARNING 2

/**
 * level: what happened.
 */
#define VARIKERNEL_LOG_INFO 3

/**
 * level: details, such as what was decided on a frame.
 */
#define VARIKERNEL_LOG_DEBUG 4

/**
 * state_policy: each call asks the driver for what it touches, and puts it back. Fits any host.
 */
#define VARIKERNEL_STATE_RESTORE 0

/**
 * state_policy: the host guarantees for OpenGL's defaults when a call starts, and finds them afterwards, but
 * for the viewport. Faster: 90 to 165 questions less a call.
 */
#define VARIKERNEL_STATE_DEFAULTS 1

/**
 * rule: the smallest box that holds at least n photons.
 */
#define VARIKERNEL_RULE_NEAREST 0

/**
 * rule: the widest box over which the density is even but for noise, with a radius of 0, 1, 2, 4, ... MR,
 * which is a power of two of at most 64. There is no n and no order; with VARIKERNEL_EDGES_ZERO the map's
 * edge is one of the density.
 */
#define VARIKERNEL_RULE_EVEN 1

/**
 * edges: nothing is outside the map.
 */
#define VARIKERNEL_EDGES_ZERO 0

/**
 * edges: outside is as much, per area, as the box holds inside.
 */
#define VARIKERNEL_EDGES_SCALE 1

/**
 * order: halving the few radii that bounds for tiles and blocks leave; fast whatever MR and density.
 */
#define VARIKERNEL_ORDER_BRACKETED 0

/**
 * order: 1, 2, 3, ...; the fastest where radii are small.
 */
#define VARIKERNEL_ORDER_FORWARD 1

/**
 * order: halving 1 to MR.
 */
#define VARIKERNEL_ORDER_BINARY 2

/**
 * order: chosen for each frame by the photons of the ones before, without waiting. Memory grows when an
 * order is first used.
 */
#define VARIKERNEL_ORDER_ADAPTIVE 3

/**
 * photons_at_most: the host does not know.
 */
#define VARIKERNEL_PHOTONS_UNKNOWN UINT64_MAX

/**
 * changed: anything may have.
 */
#define VARIKERNEL_CHANGED_EVERYTHING 0

/**
 * changed: nothing has; the textures of the frame before are the answer, and nothing is drawn.
 */
#define VARIKERNEL_CHANGED_NOTHING 1

/**
 * changed: a rectangle of the density map or the mask; what reaches past the map is ignored.
 */
#define VARIKERNEL_CHANGED_RECTANGLE 2

/**
 * changed: the density map holds new photons alone, to be added to those before.
 */
#define VARIKERNEL_CHANGED_ADDED 3

/**
 * kernel: the same everywhere on the disc.
 */
#define VARIKERNEL_KERNEL_BOX 0

/**
 * kernel: 1 - d, with d the distance from the middle in radii.
 */
#define VARIKERNEL_KERNEL_CONE 1

/**
 * kernel: 1 - d^2.
 */
#define VARIKERNEL_KERNEL_EPANECHNIKOV 2

/**
 * kernel: (1 - d^2)^2.
 */
#define VARIKERNEL_KERNEL_SILVERMAN 3

/**
 * kernel: exp(-4.5 d^2), cut off at three standard deviations.
 */
#define VARIKERNEL_KERNEL_GAUSSIAN 4

/**
 * estimate: each photon spreads its power over the pixels around it, with the radius of its own pixel.
 */
#define VARIKERNEL_ESTIMATE_SPLAT 0

/**
 * estimate: each pixel gathers the power around it, with its own radius.
 */
#define VARIKERNEL_ESTIMATE_GATHER 1

/**
 * estimate: the same, and of what c photons give (c - 1) / c is taken, as a radius that ends at a photon
 * asks for.
 */
#define VARIKERNEL_ESTIMATE_GATHER_CORRECTED 2

/**
 * estimate: each pixel gathers from summed-area tables, as wide as a test of noise allows. No kernel, no
 * min_photons and no radius is asked for; frames have to bring photon_totals.
 */
#define VARIKERNEL_ESTIMATE_TABLES 3

/**
 * How a call ended.
 */
typedef enum varikernel_status {
    /**
     * All went well.
     */
    VARIKERNEL_STATUS_OK = 0,
    /**
     * A pointer or texture name is null, or a struct has the size of another version.
     */
    VARIKERNEL_STATUS_INVALID_ARGUMENT = 1,
    /**
     * The handle was made on another thread.
     */
    VARIKERNEL_STATUS_WRONG_THREAD = 2,
    /**
     * No OpenGL context is current on this thread.
     */
    VARIKERNEL_STATUS_NO_CONTEXT = 3,
    /**
     * The context is older than OpenGL 3.3 core.
     */
    VARIKERNEL_STATUS_VERSION = 4,
    /**
     * A setting is outside its range; the text names it.
     */
    VARIKERNEL_STATUS_SETTING = 5,
    /**
     * A map is larger than the device's textures.
     */
    VARIKERNEL_STATUS_TOO_LARGE = 6,
    /**
     * A texture does not fit: another target, format or size; a mask that is not expected.
     */
    VARIKERNEL_STATUS_MISMATCH = 7,
    /**
     * The radii could be wrong, since sums might wrap; nothing was drawn. The text says what would be exact.
     */
    VARIKERNEL_STATUS_INEXACT = 8,
    /**
     * The driver refused a shader; the text has its log.
     */
    VARIKERNEL_STATUS_SHADER = 9,
    /**
     * GL_OUT_OF_MEMORY; what was there before is as it was.
     */
    VARIKERNEL_STATUS_OUT_OF_MEMORY = 10,
    /**
     * The driver lost the context, or the host gave it up: destroy the handles, and make all anew in a new
     * context.
     */
    VARIKERNEL_STATUS_CONTEXT_LOST = 11,
    /**
     * Another GL error; the text names it.
     */
    VARIKERNEL_STATUS_OPEN_GL = 12,
    /**
     * A mistake of the library, reported on stderr as well. A pipeline is of no more use then; destroy it.
     */
    VARIKERNEL_STATUS_INTERNAL = 13,
} varikernel_status;

/**
 * An OpenGL context of the host: its commands, and what pipelines share.
 */
typedef struct varikernel_context varikernel_context;

/**
 * Photons and surfaces in, irradiance out, for one size and one set of settings.
 */
typedef struct varikernel_irradiance varikernel_irradiance;

/**
 * Density map in, radius map out, for one size and one set of settings.
 */
typedef struct varikernel_pipeline varikernel_pipeline;

/**
 * Takes a line of the log, in UTF-8, which is gone afterwards. `user` is passed on.
 *
 * It must not throw, nor call the library; it is called on the threads that do.
 */
typedef void (*varikernel_log)(uint32_t level, const char *line, void *user);

/**
 * Finds an OpenGL command by name in the context that is current: eglGetProcAddress, glfwGetProcAddress,
 * SDL_GL_GetProcAddress, wglGetProcAddress with its fallback. Null where there is no such command. `user` is
 * passed on.
 *
 * It must not throw, and is called by varikernel_context_create alone.
 */
typedef void *(*varikernel_loader)(const char *name, void *user);

/**
 * What is asked of a pipeline. Fill it with varikernel_settings_default, then change what you like.
 *
 * Boxes are counted in a summed-area table, exact or refused. The order of the search changes no radius.
 */
typedef struct varikernel_settings {
    /**
     * sizeof(varikernel_settings), by which another version's struct is told.
     */
    uint32_t struct_size;
    /**
     * By which rule a radius is found: VARIKERNEL_RULE_... Default VARIKERNEL_RULE_NEAREST.
     */
    uint32_t rule;
    /**
     * n: photons that a box has to hold, at least 1. Default 25. Not asked for by VARIKERNEL_RULE_EVEN.
     */
    uint32_t min_photons;
    /**
     * MR: where the search ends, in pixels, 1 to 32767. Pixels that find too few photons get it. Default 32.
     * With VARIKERNEL_RULE_EVEN a power of two from 1 to 64.
     */
    uint32_t max_radius;
    /**
     * What a box holds outside the map: VARIKERNEL_EDGES_... Default VARIKERNEL_EDGES_SCALE.
     */
    uint32_t edges;
    /**
     * In which order radii are tried: VARIKERNEL_ORDER_... Default VARIKERNEL_ORDER_BRACKETED. Not asked for
     * by VARIKERNEL_RULE_EVEN, which refuses VARIKERNEL_ORDER_ADAPTIVE alone.
     */
    uint32_t order;
    /**
     * 1 for a texture that marks the pixels that MR ended, with too few photons or a density that is even
     * still, else 0. Default 0.
     */
    uint32_t limited_mask;
    /**
     * 1 if frames may bring a mask of the pixels that need a radius, else 0. Default 0.
     */
    uint32_t masked;
} varikernel_settings;

/**
 * One frame. Fill it with varikernel_frame_default, then say what you know.
 */
typedef struct varikernel_frame {
    /**
     * sizeof(varikernel_frame), by which another version's struct is told.
     */
    uint32_t struct_size;
    /**
     * Photons per pixel: a GL_TEXTURE_2D in the pipeline's format and size, whole numbers that are not
     * negative. It stays the host's and is only read.
     */
    uint32_t density_texture;
    /**
     * No more photons than these are in the map: how many were drawn. 0 leaves the counting out. Default
     * VARIKERNEL_PHOTONS_UNKNOWN, with which a frame is refused unless n and MR alone prove it exact.
     */
    uint64_t photons_at_most;
    /**
     * For a pipeline with masks: a GL_R8UI, GL_R16UI or GL_R32UI texture of the map's size, 0 where no
     * radius is needed; such pixels get radius 0. The name 0 where every pixel needs one. Default 0.
     */
    uint32_t mask_texture;
    /**
     * What differs from the frame before: VARIKERNEL_CHANGED_... Default VARIKERNEL_CHANGED_EVERYTHING.
     */
    uint32_t changed;
    /**
     * First column of the changed rectangle.
     */
    uint32_t changed_x;
    /**
     * First row of the changed rectangle, as OpenGL counts them.
     */
    uint32_t changed_y;
    /**
     * Columns of the changed rectangle.
     */
    uint32_t changed_width;
    /**
     * Rows of the changed rectangle.
     */
    uint32_t changed_height;
} varikernel_frame;

/**
 * How photons become irradiance. Fill it with varikernel_irradiance_settings_default, then change what you
 * like.
 */
typedef struct varikernel_irradiance_settings {
    /**
     * sizeof(varikernel_irradiance_settings), by which another version's struct is told.
     */
    uint32_t struct_size;
    /**
     * 0 for kernels that fit the photons' density, else the radius of all kernels, 1 to 96 pixels. Default
     * 0.
     */
    uint32_t fixed_radius;
    /**
     * n: photons that a kernel has to hold, at least 1. Default 400.
     */
    uint32_t min_photons;
    /**
     * MR: the largest radius of a kernel, 1 to 96 pixels. Default 64.
     */
    uint32_t max_radius;
    /**
     * What a box holds outside the map: VARIKERNEL_EDGES_... Default VARIKERNEL_EDGES_SCALE.
     */
    uint32_t edges;
    /**
     * How a photon's power falls off to the edge: VARIKERNEL_KERNEL_... Default VARIKERNEL_KERNEL_SILVERMAN.
     */
    uint32_t kernel;
    /**
     * 1 if the host brings a depth buffer in place of positions, else 0. Default 0.
     */
    uint32_t from_depth;
    /**
     * How photons become light: VARIKERNEL_ESTIMATE_... Default VARIKERNEL_ESTIMATE_SPLAT.
     */
    uint32_t estimate;
} varikernel_irradiance_settings;

/**
 * What photons carry together, or more: an upper bound will do, and costs a bit of exactness for each
 * doubling.
 */
typedef struct varikernel_photon_totals {
    /**
     * The sum of their power, linear RGB: finite and not negative.
     */
    double power[3];
    /**
     * The sum of (red + green + blue)^2 of each photon's power: finite and not negative.
     */
    double squares;
} varikernel_photon_totals;

/**
 * One frame of photons on surfaces. Fill it with varikernel_irradiance_frame_default, then say what you
 * have.
 */
typedef struct varikernel_irradiance_frame {
    /**
     * sizeof(varikernel_irradiance_frame), by which another version's struct is told.
     */
    uint32_t struct_size;
    /**
     * A GL_TEXTURE_2D in GL_RGBA32F: the place that each pixel shows in scene units, and as fourth value its
     * depth along the view, 0 where nothing is seen. With from_depth, a texture with depth, drawn with the
     * whole depth range; it keeps its format and size.
     */
    uint32_t position_texture;
    /**
     * A GL_TEXTURE_2D in GL_RGBA32F, GL_RGBA16F, GL_RGB32F or GL_RGB16F: the normal of length 1 towards the
     * camera, and as fourth value the surface's number from 1 on, negative where photons do not land, 0
     * where nothing is seen. Without a fourth value all surfaces are number 1.
     */
    uint32_t normal_texture;
    /**
     * A vertex buffer of varikernel_photon.
     */
    uint32_t photon_buffer;
    /**
     * Photons to take from its beginning.
     */
    uint32_t photon_count;
    /**
     * What these photons carry together, for VARIKERNEL_ESTIMATE_TABLES; else it may be null, the default.
     */
    const struct varikernel_photon_totals *photon_totals;
    /**
     * 1 to add these photons' light to that of the frames before, for the same surfaces and camera: of k
     * such frames, the sum is k times the light. 0 to forget those. Default 0.
     */
    uint32_t added;
    /**
     * 1 if camera and surfaces are those of the frame before, though the photons are new: what
     * VARIKERNEL_ESTIMATE_TABLES needs of them alone is then kept. 0 to make it anew. Default 0.
     */
    uint32_t same_camera;
    /**
     * With from_depth: 1 if the far plane is at 0, else 0. Default 0.
     */
    uint32_t depth_reversed;
    /**
     * With from_depth: 1 if depth in clip space goes from 0 to 1, as GL_ZERO_TO_ONE of glClipControl, else
     * 0. Default 0.
     */
    uint32_t depth_zero_to_one;
    /**
     * From scene units to view space, where the camera looks along -z: column by column as for
     * glUniformMatrix4fv. It turns and moves only.
     */
    float view[16];
    /**
     * From view space to clip space, column by column: a perspective with square pixels.
     */
    float projection[16];
} varikernel_irradiance_frame;

/**
 * A photon in a vertex buffer of the host.
 */
typedef struct varikernel_photon {
    /**
     * Where it landed, in scene units.
     */
    float position[3];
    /**
     * Of the surface, of length 1, on the side from which the photon came.
     */
    float normal[3];
    /**
     * Linear RGB: its share of the power of all lights.
     */
    float power[3];
    /**
     * The number of the surface, as normal_texture has it; 1 where surfaces have none.
     */
    float surface;
} varikernel_photon;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * The version of the library that was loaded, such as "0.2.0"; never null, valid forever.
 */
const char *varikernel_version(void);

/**
 * Whether the loaded library is what a header of this version describes.
 *
 * Call it with VARIKERNEL_VERSION_MAJOR and VARIKERNEL_VERSION_MINOR before anything else. Before version
 * 1.0 both have to be the library's own.
 */
bool varikernel_is_compatible(uint32_t major,
                              uint32_t minor);

/**
 * What went wrong in the last call on this thread that failed: what, where, and what to do; "" if none did.
 *
 * Never null, UTF-8, one or several lines. Valid until the next failing call on this thread.
 */
const char *varikernel_last_error(void);

/**
 * Hands lines of the log to `log` from now on, up to the level `most`: one of VARIKERNEL_LOG_... Null for `log`
 * ends that, but for lines that other threads are just handing on: `user` outlives those. For the whole
 * process; nothing is logged before.
 *
 * Fails with SETTING for another level, and with INTERNAL where the process hands lines of Rust's `tracing` to
 * another receiver already.
 */
enum varikernel_status varikernel_set_log(varikernel_log log,
                                          void *user,
                                          uint32_t most);

/**
 * Takes the OpenGL context that is current on this thread, 3.3 core or newer; no extension is needed.
 *
 * `*context` is the host's to destroy. `user` may be null and is not used later. `state_policy` is one of
 * VARIKERNEL_STATE_... and holds for all that is made of the handle; handles of both kinds may be used side
 * by side.
 *
 * Fails with NO_CONTEXT, VERSION, SETTING, INVALID_ARGUMENT.
 */
enum varikernel_status varikernel_context_create(varikernel_loader loader,
                                                 void *user,
                                                 uint32_t state_policy,
                                                 struct varikernel_context **context);

/**
 * Tells the bytes of textures and buffers that the library holds by this handle and all that was made of it.
 *
 * Fails with WRONG_THREAD, NO_CONTEXT, CONTEXT_LOST, INVALID_ARGUMENT.
 */
enum varikernel_status varikernel_memory_held(const struct varikernel_context *context,
                                              uint64_t *bytes);

/**
 * Says that the OpenGL context has gone, or is about to: nothing made of this handle calls OpenGL from now
 * on. Destroying then frees memory alone, and all other calls answer CONTEXT_LOST.
 *
 * Fails with WRONG_THREAD, INVALID_ARGUMENT.
 */
enum varikernel_status varikernel_context_abandon(const struct varikernel_context *context);

/**
 * Frees a context; null is fine. Pipelines made in it stay usable: the last of them frees what they share.
 *
 * Fails with WRONG_THREAD and NO_CONTEXT, and frees nothing then; see varikernel_context_abandon.
 */
enum varikernel_status varikernel_context_destroy(struct varikernel_context *context);

/**
 * Fills `settings` with the defaults. `size` is sizeof(varikernel_settings).
 *
 * Fails with INVALID_ARGUMENT.
 */
enum varikernel_status varikernel_settings_default(struct varikernel_settings *settings,
                                                   uint32_t size);

/**
 * Fills `frame` with the defaults, without a texture. `size` is sizeof(varikernel_frame).
 *
 * Fails with INVALID_ARGUMENT.
 */
enum varikernel_status varikernel_frame_default(struct varikernel_frame *frame, uint32_t size);

/**
 * Tells the memory that a pipeline takes, before it is made: bytes of textures and buffers, as large as
 * their formats say.
 *
 * `*at_creation` is what varikernel_pipeline_create and varikernel_pipeline_resize allocate; `*at_most` adds
 * what is allocated on demand, by VARIKERNEL_CHANGED_ADDED and, for VARIKERNEL_ORDER_ADAPTIVE, by each
 * order; the pointer may be null. `settings` may be null for the defaults.
 *
 * Fails with SETTING, TOO_LARGE, INVALID_ARGUMENT, WRONG_THREAD, NO_CONTEXT, CONTEXT_LOST.
 */
enum varikernel_status varikernel_pipeline_memory_required(const struct varikernel_context *context,
                                                           uint32_t width,
                                                           uint32_t height,
                                                           const struct varikernel_settings *settings,
                                                           uint64_t *at_creation,
                                                           uint64_t *at_most);

/**
 * Allocates and compiles for density maps of `width` x `height` pixels in `density_format`: GL_R32F, as
 * additive blending of points fills it, GL_R32UI, GL_R16UI or GL_R8UI. Takes milliseconds to seconds; frames
 * only draw.
 *
 * `*pipeline` is the host's to destroy, before or after `context`. `settings` may be null for the defaults.
 *
 * Fails with SETTING, TOO_LARGE, MISMATCH for another format, SHADER, OUT_OF_MEMORY, OPEN_GL,
 * INVALID_ARGUMENT, WRONG_THREAD, NO_CONTEXT.
 */
enum varikernel_status varikernel_pipeline_create(const struct varikernel_context *context,
                                                  uint32_t width,
                                                  uint32_t height,
                                                  uint32_t density_format,
                                                  const struct varikernel_settings *settings,
                                                  struct varikernel_pipeline **pipeline);

/**
 * Finds the radii of a frame: draws only, reads nothing back, waits for nothing.
 *
 * `*radius_texture` is a GL_TEXTURE_2D in GL_R32UI, a usampler2D in your shaders: radii from 1 to MR in
 * pixels (by VARIKERNEL_RULE_EVEN from 0 on), 0 where the mask says that none is needed. `*limited_texture`
 * is one in GL_R8UI that is 1 where MR ended the search, or 0 if the settings ask for none; the pointer may
 * be null. Both belong to the pipeline, are complete without a sampler, and hold until its next frame. Take the
 * names anew each frame: textures may take turns.
 *
 * Fails with MISMATCH, INEXACT, SETTING, OUT_OF_MEMORY, CONTEXT_LOST, OPEN_GL, INVALID_ARGUMENT,
 * WRONG_THREAD, NO_CONTEXT; the next frame may succeed.
 */
enum varikernel_status varikernel_pipeline_render(struct varikernel_pipeline *pipeline,
                                                  const struct varikernel_frame *frame,
                                                  uint32_t *radius_texture,
                                                  uint32_t *limited_texture);

/**
 * From now on for density maps of another size, with the same format and settings; the next frame starts
 * from nothing. Nothing is compiled. Textures of earlier frames are gone; the new ones are made before the
 * old ones are freed.
 *
 * Fails with SETTING, TOO_LARGE, OUT_OF_MEMORY, CONTEXT_LOST, OPEN_GL, INVALID_ARGUMENT, WRONG_THREAD,
 * NO_CONTEXT, and the pipeline then goes on at its old size.
 */
enum varikernel_status varikernel_pipeline_resize(struct varikernel_pipeline *pipeline,
                                                  uint32_t width,
                                                  uint32_t height);

/**
 * Draws a frame of a map without photons, waits for it, and forgets it: what a driver puts off until a shader
 * first draws is done when this returns. Worth its time while a host loads, after
 * varikernel_pipeline_create and varikernel_pipeline_resize. Takes the memory of one more density map meanwhile.
 *
 * Fails with OUT_OF_MEMORY, CONTEXT_LOST, OPEN_GL, INVALID_ARGUMENT, WRONG_THREAD, NO_CONTEXT.
 */
enum varikernel_status varikernel_pipeline_warm_up(struct varikernel_pipeline *pipeline);

/**
 * Frees a pipeline with its textures; null is fine.
 *
 * Fails with WRONG_THREAD and NO_CONTEXT, and frees nothing then; see varikernel_context_abandon.
 */
enum varikernel_status varikernel_pipeline_destroy(struct varikernel_pipeline *pipeline);

/**
 * Allocates and compiles for surfaces of `width` x `height` pixels. Takes milliseconds to seconds; frames
 * only draw.
 *
 * `*irradiance` is the host's to destroy, before or after `context`. `settings` may be null for the
 * defaults.
 *
 * Fails with SETTING, TOO_LARGE, SHADER, OUT_OF_MEMORY, OPEN_GL, INVALID_ARGUMENT, WRONG_THREAD, NO_CONTEXT.
 */
enum varikernel_status varikernel_irradiance_create(const struct varikernel_context *context,
                                                    uint32_t width,
                                                    uint32_t height,
                                                    const struct varikernel_irradiance_settings *settings,
                                                    struct varikernel_irradiance **irradiance);

/**
 * Finds the light that photons bring to the surfaces: counts them, finds radii, draws a kernel for each; or
 * as settings say by estimate.
 *
 * `*irradiance_texture` is a GL_TEXTURE_2D in GL_RGBA32F, a sampler2D in your shaders: power per area in
 * scene units, linear RGB; light that leaves a diffuse surface is albedo / pi of it. `*radius_texture` is as
 * that of varikernel_pipeline_render, or 0 for a fixed radius; of VARIKERNEL_ESTIMATE_TABLES it says how
 * wide each pixel's light was gathered, 0 where nothing is lit. The pointer may be null. Both belong to the
 * handle and hold until its next frame.
 *
 * Waits for the GPU only where a pixel may hold 2^24 photons. With from_depth, a shader is compiled when a
 * depth texture is first seen.
 *
 * Fails with MISMATCH, INEXACT, SETTING, OUT_OF_MEMORY, CONTEXT_LOST, OPEN_GL, INVALID_ARGUMENT,
 * WRONG_THREAD, NO_CONTEXT; the next frame may succeed.
 */
enum varikernel_status varikernel_irradiance_render(struct varikernel_irradiance *irradiance,
                                                    const struct varikernel_irradiance_frame *frame,
                                                    uint32_t *irradiance_texture,
                                                    uint32_t *radius_texture);

/**
 * Tells the memory that irradiance takes, before the handle is made: bytes of textures and buffers, as large
 * as their formats say; surfaces, the positions of a depth buffer (16 bytes a pixel) and photons apart.
 * `settings` may be null for the defaults.
 *
 * Fails with SETTING, INVALID_ARGUMENT.
 */
enum varikernel_status varikernel_irradiance_memory_required(uint32_t width,
                                                             uint32_t height,
                                                             const struct varikernel_irradiance_settings *settings,
                                                             uint64_t *bytes);

/**
 * From now on for surfaces of another size, without photons. As varikernel_pipeline_resize.
 *
 * Fails with SETTING, TOO_LARGE, OUT_OF_MEMORY, CONTEXT_LOST, OPEN_GL, INVALID_ARGUMENT, WRONG_THREAD,
 * NO_CONTEXT, and the handle then goes on at its old size.
 */
enum varikernel_status varikernel_irradiance_resize(struct varikernel_irradiance *irradiance,
                                                    uint32_t width,
                                                    uint32_t height);

/**
 * Frees the handle with its textures; null is fine. As varikernel_pipeline_destroy.
 *
 * Fails with WRONG_THREAD and NO_CONTEXT, and frees nothing then.
 */
enum varikernel_status varikernel_irradiance_destroy(struct varikernel_irradiance *irradiance);

/**
 * Fills `frame` with the defaults, without textures, photons and camera. `size` is
 * sizeof(varikernel_irradiance_frame).
 *
 * Fails with INVALID_ARGUMENT.
 */
enum varikernel_status varikernel_irradiance_frame_default(struct varikernel_irradiance_frame *frame,
                                                           uint32_t size);

/**
 * Adds up what photons carry together, for hosts that have them in memory as well: no OpenGL is called.
 * `photons` may be null if `count` is 0.
 *
 * Fails with INVALID_ARGUMENT.
 */
enum varikernel_status varikernel_photon_totals_of(const struct varikernel_photon *photons,
                                                   uint32_t count,
                                                   struct varikernel_photon_totals *totals);

/**
 * Fills `settings` with the defaults. `size` is sizeof(varikernel_irradiance_settings).
 *
 * Fails with INVALID_ARGUMENT.
 */
enum varikernel_status varikernel_irradiance_settings_default(struct varikernel_irradiance_settings *settings,
                                                              uint32_t size);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* VARIKERNEL_H */
