//! The smallest box that holds n photons, for each pixel of a density map (thesis 3 and 4).
//!
//! A table is built of the map ([`tables`]), then searched (`search`); [`RadiusPipeline`] does both.
//! [`planner`] says which table, build and order suit a map, and [`certificate`] proves a result without the
//! definition.

mod census;
pub mod certificate;
mod driver_limits;
mod frame_planner;
mod pipeline;
pub mod planner;
pub(crate) mod search;
pub mod tables;

pub use census::{CENSUS_SIDE, Census};
pub use certificate::Certificate;
pub(crate) use pipeline::check_fits;
pub use pipeline::{MemoryRequired, RadiusPipeline, shader_sources};
