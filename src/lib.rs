//! Radius maps and light from photon density maps, in OpenGL 3.3 core.
//!
//! Photon mapping turns photons into light by averaging over a neighbourhood. A fixed radius blurs caustics
//! or leaves walls patchy; this library finds, for every pixel of a photon density map, the smallest box
//! radius that holds at least n photons, with textures and fragment shaders alone: no compute shaders, no
//! extensions. It reproduces E. W. Bjønnes' thesis (Oslo 2010, "the thesis" below) and is exact where the
//! thesis rounds.
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
//! With `Planning::EachFrame` in its settings, a pipeline plans each frame by the photons of those before
//! it; without, it searches as the settings say. From C and C++, the feature `capi` gives the same by
//! `include/varikernel.h`; `examples/cpp` is a host. Without a host, `context::open` (features `egl` and
//! `osmesa`) makes a headless context.
//!
//! # Where to go on
//! - [`guide`]: ten steps from photons or a density map to radii or light, with costs and the usual mistakes.
//! - `docs/engines.md`: the interface in Rust, C and GLSL, and the features.
//! - `docs/methods.md`: how radii are found, the variants, which sums are exact.
//! - `docs/light.md`: light from tables. `docs/pictures.md`: how a picture is made, the window, files.
//! - `docs/results.md`: what was measured. `docs/devices.md`: renderers and drivers.
//! - [`gl::state_contract`]: every OpenGL state that is touched.
//!
//! Two packages in the same repository use this library: `varikernel-lab` (`lab/`) measures, and
//! `varikernel-cli` (`cli/`) is the program `varikernel`, a file or folder for each verb. Neither is needed
//! by a host.
//!
//! # One search, many counters
//! The thesis has one question, "how many photons lie in this box?", several answers to it, a search over
//! radii and an edge rule. They stay apart: `glsl/radius/search/stepwise.frag` holds the search and calls
//! `count_in_box`, which the `count` files of `glsl/radius/tables/` define, and `glsl/common/enough.glsl`
//! holds the edge rule. A program is one search and one counter.
//! [`ShaderSource::resolved`](gl::ShaderSource::resolved) gives each as plain text, for engines with code of
//! their own.
//!
//! # Rooms
//! Data flows from bottom to top: a module names only modules below it (checked by `tests/layers`).
//!
//! | module | what it holds |
//! |---|---|
//! | `capi` | the C interface of `include/varikernel.h`: handles, plain structs, status codes |
//! | `render` | scene in, picture out, stage by stage; `render::Live`, a picture that gets better by steps |
//! | [`measure`] | what `varikernel-lab` needs of the inside: units of time, approximations to compare with |
//! | [`light`] | [`IrradiancePipeline`]: photons and a g-buffer in, irradiance out; its stages apart |
//! | [`radius`] | [`RadiusPipeline`]: density map in, radius map out; tables, search, planner, certificate |
//! | [`maps`] | what flows between the stages, each with its unit; what changed; which sums are exact |
//! | [`reference`](mod@reference) | the definition: the same in plain Rust, without OpenGL |
//! | [`photon`] | a photon as a vertex; scene in, photons out: traced on the CPU, landing after landing |
//! | `scene` | scene files: camera, lights, materials, triangles and spheres; ray casting |
//! | `context` | contexts: EGL devices and OSMesa without a window, and a window's |
//! | [`gl`] | programs, textures, passes, timers, saved state; `gl`, `context` and `capi` alone are unsafe |
//! | [`view`] | a camera and its pixels: where a place is seen, along which ray a pixel looks |
//! | [`settings`], [`image`], [`error`] | plain data that every module may name |
//!
//! In [`radius`], [`radius::tables`] says how each method of the thesis counts a box, [`radius::planner`]
//! which table and search suit a map, and [`radius::certificate`] how a result is proved. [`maps::exactness`]
//! has the rules of what is exact. In [`light`], [`DensityStage`] counts photons, [`SplatStage`] spreads
//! them, and [`GatherStage`] gathers them; [`TablesStage`] gathers them without a kernel.
//!
//! # The host's OpenGL state
//! Each public call puts back what it touches, also when it fails; or, under [`StatePolicy::Defaults`], it
//! starts from OpenGL's default state, leaves it behind, and asks the driver for nothing. The page
//! [`gl::state_contract`] lists all that is touched, and says what has to be current, what contexts share,
//! and what of a host's queries.
//!
//! # Memory, sizes, and the end of a context
//! [`RadiusPipeline::memory_required`] says how many bytes a pipeline takes before there is a context, and
//! [`RadiusPipeline::resize`] moves one to another size of maps without compiling anything. GL_OUT_OF_MEMORY
//! is [`Error::OutOfMemory`]: what the call had made is freed, and what was there before is still good.
//!
//! Objects may be dropped in any order while the context is current. A host that destroys its context first
//! calls [`Gl::abandon`] before: from then on nothing calls OpenGL, drops delete nothing, and calls answer
//! [`Error::ContextLost`], as they do when the driver reports GL_CONTEXT_LOST. Dropping without a current
//! context and without `abandon` does nothing on Mesa, but may crash on drivers whose commands belong to a
//! context, as on Windows.
//!
//! [`gl::StageTimes`] tells how long each pass takes on the GPU, without waiting and beside a host's own
//! GL_TIME_ELAPSED query.
//!
//! # Glossary
//! | word | also called | meaning |
//! |---|---|---|
//! | n, `min_photons` | "MP" in the thesis, k of k nearest neighbours | photons that a box has to hold |
//! | MR, `max_radius` | | the radius at which a search ends |
//! | R, radius | bandwidth, filter width | half a box's side less its middle pixel: the side is 2 r + 1 |
//! | S | | photons of a box that are inside the map |
//! | T, I | | area of a box, and of its part inside the map |
//! | landing | hit, deposit, photon record | where a photon meets a diffuse surface, with its power |
//! | density map | photon counts, histogram | photons per pixel |
//! | radius map | adaptive bandwidth | R per pixel: the smallest r >= 1 whose box holds n photons, else MR |
//! | rule | | by what a radius is found: that, or the widest box of even density, without n |
//! | departure | | how far a box and one of half its radius are from even, in variances of noise |
//! | limited | saturated | a pixel whose box of radius MR still holds too few, or is even still |
//! | SAT | summed-area table, integral image | sums of all pixels up to each: a box takes four texels |
//! | pyramid | summed mipmap, quadtree of sums | sums of 2 x 2, 4 x 4, ... pixels |
//! | kernel | filter, footprint | how a photon's light falls off with distance |
//! | Silverman's kernel | biweight, quartic | (1 - d²)², with d the distance in radii |
//! | variable radii | nearest-n, k-nearest-neighbour density estimation | kernels that hold n photons each |
//! | spread | splat, scatter | each photon is drawn over the pixels around it |
//! | gather | | each pixel collects the photons around it |
//! | flux | | power of the photons of a pixel, in whole units whose sums are exact |
//! | totals | | what photons carry together, by which the units of flux are chosen |
//! | width | | how far around a pixel light from tables was gathered |
//! | surfaces | g-buffer | place, normal and surface number of each pixel |
//! | changed rectangle | dirty rectangle, damage | what differs from the frame before |
//! | mask | stencil | the pixels that need a radius |
//! | census | | the photons of each tile of 64 x 64 pixels, by which a search is planned |
//! | definition | oracle, ground truth | what results are compared with: [`reference`](mod@reference) |
//! | copy, probe | unit of time | passes that read and write one texel, and that read four |
//! | rival | baseline | the same radii by plain code on the processor, in `varikernel-lab` |
//! | host | engine, application | the program whose OpenGL context is used |

#[cfg(feature = "capi")]
mod capi;
#[cfg(any(feature = "egl", feature = "osmesa", feature = "window"))]
pub mod context;
pub mod error;
pub mod gl;
#[doc = include_str!("../docs/guide.md")]
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
pub use light::{DensityStage, GatherStage, IrradiancePipeline, SplatStage, TablesStage};
pub use maps::{
    Changed, CountBounds, DensityMap, FluxMap, FluxUnits, Frame, HostDepth, HostSurfaces, IrradianceMap,
    KernelRadii, Mask, MaskMaker, PhotonPoints, PhotonTotals, PositionMaker, PowerMap, RadiusMap,
    SurfaceMaps,
};
pub use photon::PhotonPoint;
pub use radius::{Certificate, MemoryRequired, RadiusPipeline};
pub use settings::Settings;
pub use view::View;
