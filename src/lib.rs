//! How wide must the filter be?
//!
//! Photon mapping turns photons into light by averaging over a neighbourhood. A fixed radius blurs caustics or leaves
//! walls patchy; this library finds, for every pixel of a photon density map, the smallest box radius that holds at
//! least n photons, with textures and fragment shaders alone: OpenGL 3.3 core, no compute shaders, no extensions. It
//! reproduces E. W. Bjønnes' thesis (Oslo 2010, "the thesis" below) and is exact where the thesis rounds.
//!
//! # Use
//! ```no_run
//! # fn host(
//! #     loader: impl FnMut(&std::ffi::CStr) -> *const std::ffi::c_void,
//! #     host_texture: glow::Texture,
//! #     photons_drawn: u64,
//! # ) -> varikernel::Result<()> {
//! use varikernel::settings::{Edges, Order, Planning, Search};
//! use varikernel::{CountBounds, DensityMap, Frame, Gl, RadiusPipeline, Settings};
//!
//! // SAFETY: the host's context is current on this thread while `gl`, or anything made from it, is used.
//! let gl = unsafe { Gl::from_loader(loader) }?;
//!
//! // The host's texture: GL_R32UI, GL_R32F or GL_R8UI, photons per pixel.
//! let density = DensityMap::borrow(&gl, host_texture, CountBounds::total_at_most(photons_drawn))?;
//! let search = Search { min_photons: 25, max_radius: 32, edges: Edges::Scale, order: Order::Bracketed };
//! let settings = Settings { search, planning: Planning::EachFrame, ..Settings::default() };
//! let mut pipeline = RadiusPipeline::new(&gl, density.size(), density.format(), settings)?;
//!
//! // Each frame; with `changed` and `mask` it costs only what has changed, where a radius is needed:
//! let radii = pipeline.update(&Frame::new(&density))?;
//! let texture = radii.texture(); // a usampler2D for the host's own shaders
//! # Ok(())
//! # }
//! ```
//! From C and C++, the feature `capi` gives the same by `include/varikernel.h`; `examples/cpp` is a host.
//! The [`guide`] goes through all of it in ten steps, from photons or a density map to radii or light, with the costs.
//! Without a host, `context::open` (features `egl` and `osmesa`) makes a headless context.
//!
//! # The idea that keeps it small
//! The thesis has one question, "how many photons lie in this box?", several answers to it, a search over radii and an
//! edge rule. They stay apart: `glsl/radius.frag` holds the search and calls `count_in_box`, which each file of
//! `glsl/count/` defines, and `glsl/common/enough.glsl` holds the edge rule. A program is one search and one counter.
//! [`ShaderSource::resolved`](gl::ShaderSource::resolved) gives each as plain text, for engines with code of their own.
//!
//! # Rooms
//! Data flows from top to bottom, and a module names only modules below it (checked by `tests/layers.rs`):
//!
//! | module | what it holds |
//! |---|---|
//! | `cli`, `main` | the program, built on the public library: one file a verb |
//! | `capi` | the C interface of `include/varikernel.h`: handles, plain structs, status codes |
//! | [`measure`] | how right and how fast a result is: differences, errors of pictures, timing runs (`bench`), rivals on the processor (`rivals`), the thesis's tables and claims (`thesis`), both together (`reproduce`), a page of them (`report`), run time against error (`study`), promises about numbers put to the test (`stress`) |
//! | `render` | scene in, picture out: the stages of a picture in order, soft shadows, what is seen in mirrors and through glass; `render::Live`, a picture that gets better step by step |
//! | `bounce_map`, `gbuffer`, `shadow_map`, `shade` | a stage of a scene's picture each: what photons meet first, what pixels show, direct light, light added up |
//! | `cube_map` | what is nearest around a place, rasterised |
//! | [`irradiance`] | [`IrradiancePipeline`]: photons and a g-buffer in, irradiance out |
//! | `density`, `splat` | its stages beside the radii: photons counted, kernels drawn |
//! | `position` | a host's depth buffer to the places that its pixels show |
//! | `frame_planner` | plans each frame by the photons of the ones before, for [`Planning::EachFrame`](settings::Planning::EachFrame) |
//! | [`planner`] | which table, build and search suit a map |
//! | [`pipeline`] | the stages in order; what a host calls |
//! | [`certificate`] | proof that a radius map is the definition's, without computing that |
//! | `radius` | density map and structure in, radius map out: stepwise as the thesis, or by brackets |
//! | [`structure`] | brute force, mipmaps, pyramid, summed-area table: a section of the thesis each |
//! | `driver_limits` | what software renderers would silently get wrong |
//! | [`frame`] | what a host's frame brings, and what differs from the one before |
//! | [`maps`], `mask` | what flows between the stages, each with its unit; which pixels need a radius |
//! | [`exactness`] | which sums fit which storage, decided before computing |
//! | [`reference`](mod@reference) | the definition: the same in plain Rust, without OpenGL |
//! | `photon` | scene in, photons out: traced on the CPU, landing after landing, with statistics |
//! | `scene` | scene files: camera, lights, materials, triangles and spheres; ray casting |
//! | `photon_point`, [`view`] | a photon as a vertex; a camera and its pixels: where a place is seen, along which ray a pixel looks |
//! | `synth` | seeded test maps |
//! | `context` | contexts: EGL devices and OSMesa without a window, and a window's |
//! | [`gl`] | programs, textures, passes, timers, saved state; with `context` and `capi` the only unsafe code |
//! | [`settings`], [`image`], [`error`] | plain data that every module may name |
//!
//! # The host's OpenGL state
//! Each public call puts back what it touches, also when it fails; or, under [`StatePolicy::Defaults`], it starts from
//! OpenGL's default state, leaves it behind, and asks the driver for nothing. The page [`gl::state_contract`] lists all
//! that is touched, and says what has to be current, what contexts share, and what of a host's queries.
//!
//! # Memory, sizes, and the end of a context
//! [`RadiusPipeline::memory_required`] says how many bytes a pipeline takes before there is a context, and
//! [`RadiusPipeline::resize`] moves one to another size of maps without compiling anything. GL_OUT_OF_MEMORY is
//! [`Error::OutOfMemory`]: what the call had made is freed, and what was there before is still good.
//!
//! Objects may be dropped in any order while the context is current. A host that destroys its context first calls
//! [`Gl::abandon`] before: from then on nothing calls OpenGL, drops delete nothing, and calls answer [`Error::ContextLost`], as
//! they do when the driver reports GL_CONTEXT_LOST. Dropping without a current context and without that word does
//! nothing on Mesa, but may crash on drivers whose commands belong to a context, as on Windows.
//!
//! [`gl::StageTimes`] tells how long each pass takes on the GPU, without waiting and beside a host's own GL_TIME_ELAPSED query.
//!
//! # Glossary
//! | word | meaning |
//! |---|---|
//! | n, `min_photons` | photons that a box has to hold; "MP" in the thesis's listings |
//! | MR, `max_radius` | the radius at which a search ends |
//! | R, radius | half the side of a box without its middle pixel: the box of radius r has side 2 r + 1 |
//! | S | photons of a box that are inside the map |
//! | T, I | area of a box, and of its part inside the map |
//! | density map | photons per pixel |
//! | radius map | R per pixel: the smallest r >= 1 whose box holds n photons, MR where none does |
//! | limited | a pixel whose box of radius MR still holds too few |
//! | SAT | summed-area table |

#[cfg(feature = "capi")]
mod capi;
#[cfg(any(feature = "egl", feature = "osmesa", feature = "window"))]
pub mod context;
pub mod error;
pub mod gl;
#[doc = include_str!("guide.md")]
pub mod guide {}
pub mod image;
pub mod light;
pub mod maps;
pub mod measure;
pub mod photon;
pub mod radius;
pub mod reference;
#[cfg(feature = "scene")]
pub mod render;
#[cfg(feature = "scene")]
pub mod scene;
pub mod settings;
pub mod view;

pub use {glam, glow};

pub use error::{Error, Result};
pub use gl::{Gl, StatePolicy};
pub use image::Image;
pub use light::{DensityStage, GatherStage, IrradiancePipeline, SplatStage};
pub use maps::{
    Changed, ChosenRadius, CountBounds, DensityMap, Frame, HostDepth, HostSurfaces, IrradianceMap, Mask,
    MaskMaker, PhotonPoints, PositionMaker, RadiusMap, SurfaceMaps,
};
pub use photon::PhotonPoint;
pub use radius::{Certificate, MemoryRequired, RadiusPipeline};
pub use settings::Settings;
pub use view::View;
