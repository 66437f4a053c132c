//! What is asked of a picture: its size, photons and light.

use glam::UVec2;

use super::{Estimate, IrradianceSettings, Kernel, KernelRadius, PixelFilter, Search, Settings};
use crate::error::{Error, Result};

/// As many shadow rays as a penumbra may begin with.
pub const MOST_LIGHT_SAMPLES: u32 = 4096;

/// As many samples as a pixel at an edge may have.
pub const MOST_ANTIALIAS: u32 = 1024;

/// How photons find what they meet first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum FirstBounce {
    /// By a ray each, on the CPU.
    Rays,
    /// From maps that are rasterised from some places on the lights (thesis 2.6.1).
    Maps,
}

/// How direct light finds what is in its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum DirectLight {
    /// By shadow rays on the CPU, to other places of the lights from each pixel.
    Traced,
    /// By shadow maps on the GPU (thesis 2.2), around places of the lights that are the same for all pixels;
    /// what is seen in mirrors and through glass is traced all the same.
    ShadowMap,
}

/// Everything that a picture depends on beside the scene and its photons.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PictureSettings {
    /// Columns and rows.
    #[cfg_attr(feature = "serde", serde(serialize_with = "columns_and_rows"))]
    pub size: UVec2,
    /// n: photons that a box has to hold, at least 1.
    pub min_photons: u32,
    /// MR: the largest radius in pixels, from 1 to [`MAX_PICTURE_RADIUS`](super::MAX_PICTURE_RADIUS).
    pub max_radius: u32,
    /// Variable or fixed.
    pub radius: KernelRadius,
    /// The falloff.
    pub kernel: Kernel,
    /// By rays or maps.
    pub first_bounce: FirstBounce,
    /// Splat or gather.
    pub estimate: Estimate,
    /// Shadow rays or shadow maps.
    pub direct: DirectLight,
    /// Shadow rays of a pixel in penumbra to each area light at first, up to 16 times as many in all where noise
    /// asks for them; or cubes of shadow maps. From 1 to [`MOST_LIGHT_SAMPLES`]; a power of 4 is best.
    pub light_samples: u32,
    /// Samples of a pixel at an edge, spread over its area, from 1 to [`MOST_ANTIALIAS`]; 1 shows what pixels'
    /// middles do.
    pub antialias: u32,
    /// How a pixel weighs the light around its middle.
    pub filter: PixelFilter,
    /// The seed of the places on the lights.
    pub seed: u64,
}

impl Default for PictureSettings {
    /// 512 x 512 pixels, n = 400, MR = 64, splatted with Silverman's kernel, 16 shadow rays in
    /// penumbras, 16 samples at edges.
    ///
    /// Of n = 50, 200, 400 and 800, 400 has the least RMSE and 800 the least relative MSE in the glass
    /// Cornell box (256 x 256 pixels, 400,000 photons, a reference of 16 seeds); other scenes were not tried.
    /// Of 4, 8, 16 and 32 samples at edges, 16 leave a tenth less error there than 8 for 3 to 6 % more time, and
    /// 32 hardly less (Cornell boxes and glass, 256 x 256 pixels, 500,000 photons in tables, a path tracer's
    /// reference).
    fn default() -> Self {
        Self {
            size: UVec2::splat(512),
            min_photons: 400,
            max_radius: 64,
            radius: KernelRadius::Variable,
            kernel: Kernel::Silverman,
            first_bounce: FirstBounce::Rays,
            estimate: Estimate::Splat,
            direct: DirectLight::Traced,
            light_samples: 16,
            antialias: 16,
            filter: PixelFilter::Box,
            seed: 1,
        }
    }
}

impl PictureSettings {
    /// What the light from photons depends on, as [`IrradiancePipeline`](crate::IrradiancePipeline) takes it,
    /// with the pixels that even MR does not satisfy marked.
    #[must_use]
    pub fn irradiance(&self) -> IrradianceSettings {
        let usual = Settings::default();
        let search = Search { min_photons: self.min_photons, max_radius: self.max_radius, ..usual.search };
        IrradianceSettings {
            radius: self.radius,
            radii: Settings { search, limited_mask: true, ..usual },
            kernel: self.kernel,
            estimate: self.estimate,
        }
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`Error::Setting`] with the field's name.
    pub fn validate(&self) -> Result<()> {
        let refuse = |name, value: String, reason: &str| {
            Err(Error::Setting { name, value, reason: reason.to_owned() })
        };
        if self.size.min_element() == 0 {
            let value = format!("{} x {}", self.size.x, self.size.y);
            return refuse("size", value, "a picture has at least one pixel");
        }
        // MR is in the program's options even where radii are fixed, and answers for itself.
        let irradiance = self.irradiance();
        IrradianceSettings { radius: KernelRadius::Variable, ..irradiance }.validate()?;
        irradiance.validate()?;
        if !(1..=MOST_LIGHT_SAMPLES).contains(&self.light_samples) {
            let reason = format!("a penumbra begins with 1 to {MOST_LIGHT_SAMPLES} shadow rays");
            return refuse("light_samples", self.light_samples.to_string(), &reason);
        }
        if !(1..=MOST_ANTIALIAS).contains(&self.antialias) {
            let reason = format!("a pixel at an edge takes 1 to {MOST_ANTIALIAS} samples");
            return refuse("antialias", self.antialias.to_string(), &reason);
        }
        Ok(())
    }
}

#[cfg(feature = "serde")]
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
fn columns_and_rows<S: serde::Serializer>(size: &UVec2, serializer: S) -> Result<S::Ok, S::Error> {
    serde::Serialize::serialize(&size.to_array(), serializer)
}
