//! What flows between the stages, each with its unit, and which sums of it are exact.

mod density;
pub mod exactness;
mod flux;
mod frame;
mod host_depth;
mod irradiance;
mod mask;
mod photon_totals;
mod photons;
mod position;
mod power;
mod radius;
mod surfaces;

pub use density::DensityMap;
pub use exactness::CountBounds;
pub use flux::{FluxMap, FluxUnits};
pub(crate) use frame::Rectangle;
pub use frame::{Changed, Frame};
pub use host_depth::HostDepth;
pub use irradiance::IrradianceMap;
pub use mask::{Mask, MaskMaker};
pub use photon_totals::PhotonTotals;
pub use photons::{KernelRadii, PhotonPoints};
pub use position::PositionMaker;
pub use power::PowerMap;
pub use radius::RadiusMap;
pub use surfaces::{HostSurfaces, SurfaceMaps};

use glam::UVec2;

use crate::gl::TextureFormat;

/// Size and format for a reader.
pub(crate) fn describe(size: UVec2, format: TextureFormat) -> String {
    format!("{} x {} {}", size.x, size.y, format.name())
}
