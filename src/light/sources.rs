//! The shaders by which photons become irradiance.

use super::{density, gather, splat, tables};
use crate::gl::ShaderSource;
use crate::settings::{Estimate, IrradianceSettings, Kernel, KernelRadius};

/// Every shader that photons become irradiance by, beside those of the radius map: density, splats and
/// gathers of all kernels.
#[must_use]
pub fn shader_sources() -> Vec<ShaderSource> {
    let radii = [KernelRadius::Variable, KernelRadius::Fixed(1)];
    let kernels = Kernel::ALL.into_iter().flat_map(|kernel| radii.map(|radius| (kernel, radius)));
    let spreads = kernels.flat_map(|(kernel, radius)| spread_sources(kernel, radius));
    std::iter::once(density_source()).chain(spreads).chain(tables_sources()).collect()
}

/// The shader that counts photons.
#[must_use]
pub fn density_source() -> ShaderSource {
    density::source(false)
}

/// The shaders of light from tables, from the one that counts photons on.
#[must_use]
pub fn tables_sources() -> Vec<ShaderSource> {
    [density::source(true), density::coarser_source()].into_iter().chain(tables::all_sources()).collect()
}

/// The shaders of splats and gathers by one kernel, for variable radii, or fixed ones of any width.
#[must_use]
pub fn spread_sources(kernel: Kernel, radius: KernelRadius) -> Vec<ShaderSource> {
    let usual = IrradianceSettings { radius, kernel, ..IrradianceSettings::default() };
    let gather = |count_correction| {
        gather::source(&IrradianceSettings { estimate: Estimate::Gather { count_correction }, ..usual })
    };
    splat::sources(&usual).into_iter().chain([gather(false), gather(true)]).collect()
}
