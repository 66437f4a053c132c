//! Photons to light: counted, then spread or gathered with the radii that the density asks for (thesis 2.6).

mod density;
mod gather;
mod irradiance;
mod kernel_pass;
mod sources;
mod splat;
mod spread;
mod tables;

pub use density::DensityStage;
pub use gather::GatherStage;
pub use irradiance::IrradiancePipeline;
pub use sources::{density_source, shader_sources, spread_sources, tables_sources};
pub use splat::SplatStage;
pub use tables::TablesStage;
