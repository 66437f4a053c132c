//! placeholder

#[cfg(any(feature = "egl", feature = "osmesa"))]
pub mod context;
pub mod error;
pub mod exactness;
pub mod gl;
pub mod image;
mod loop_limit;
pub mod maps;
pub mod measure;
pub mod pipeline;
mod radius;
pub mod reference;
pub mod settings;
pub mod structure;
#[cfg(feature = "synth")]
pub mod synth;

pub use error::{Error, Result};
pub use exactness::CountBounds;
pub use gl::Gl;
pub use image::Image;
pub use maps::{DensityMap, RadiusMap};
pub use pipeline::RadiusPipeline;
pub use settings::Settings;
