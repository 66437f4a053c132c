//! What is asked of a picture: its size, photons, kernel and radius.

use glam::UVec2;

use crate::error::{Error, Result};

/// The largest radius of a kernel, in pixels: its disc then still fits the loops that every renderer finishes.
pub const MAX_PICTURE_RADIUS: u32 = 96;

/// How a photon's power falls off from the middle of its disc to the edge (thesis 2.6.2); unit energy always.
///
/// With d the distance from the middle, in radii:
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Kernel {
    /// 1: the same everywhere on the disc.
    Box,
    /// 1 - d.
    Cone,
    /// 1 - d²: the least mean squared error for smooth densities.
    Epanechnikov,
    /// (1 - d²)²: smooth at the edge (B. W. Silverman, "Density Estimation", 1986, 4.2).
    Silverman,
    /// exp(-4.5 d²): a bell, cut off at three standard deviations.
    Gaussian,
}

impl Kernel {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Box, Self::Cone, Self::Epanechnikov, Self::Silverman, Self::Gaussian];

    /// The weight for the square of the distance from the middle, in radii; 1 in the middle, 0 from the edge on.
    #[must_use]
    pub fn profile(self, squared: f64) -> f64 {
        if squared >= 1.0 {
            return 0.0;
        }
        match self {
            Self::Box => 1.0,
            Self::Cone => 1.0 - squared.sqrt(),
            Self::Epanechnikov => 1.0 - squared,
            Self::Silverman => (1.0 - squared) * (1.0 - squared),
            Self::Gaussian => (-4.5 * squared).exp(),
        }
    }

    /// The mean weight on the disc.
    #[must_use]
    pub fn mean(self) -> f64 {
        match self {
            Self::Box => 1.0,
            Self::Cone | Self::Silverman => 1.0 / 3.0,
            Self::Epanechnikov => 0.5,
            Self::Gaussian => (1.0 - (-4.5_f64).exp()) / 4.5,
        }
    }

    /// The define that chooses it in `common/kernel.glsl`.
    pub(crate) fn define(self) -> &'static str {
        match self {
            Self::Box => "KERNEL_BOX",
            Self::Cone => "KERNEL_CONE",
            Self::Epanechnikov => "KERNEL_EPANECHNIKOV",
            Self::Silverman => "KERNEL_SILVERMAN",
            Self::Gaussian => "KERNEL_GAUSSIAN",
        }
    }
}

/// The radius of each pixel's kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum RadiusChoice {
    /// From the radius map: the smallest box that holds n photons.
    Variable,
    /// The same for all, in pixels.
    Fixed(u32),
}

/// How photons become irradiance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum Estimate {
    /// Each photon spreads its power over the pixels around it, with the radius of its own pixel.
    Splat,
    /// Each pixel gathers the power around it, with its own radius.
    Gather {
        /// Whether (c - 1) / c of what c photons give is taken, as a radius that ends at a photon asks for.
        count_correction: bool,
    },
}

/// How photons find what they meet first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum FirstBounce {
    /// By a ray each, on the CPU.
    Rays,
    /// From maps that are rasterised from some places on the lights (thesis 2.6.1).
    Maps,
}

/// How direct light finds what is in its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum DirectLight {
    /// By shadow rays on the CPU, to other places of the lights from each pixel.
    Traced,
    /// By shadow maps on the GPU (thesis 2.2), around places of the lights that are the same for all pixels; what is seen in
    /// mirrors and through glass is traced all the same.
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
    /// MR: the largest radius in pixels, from 1 to [`MAX_PICTURE_RADIUS`].
    pub max_radius: u32,
    /// Variable or fixed.
    pub radius: RadiusChoice,
    /// The falloff.
    pub kernel: Kernel,
    /// By rays or maps.
    pub first_bounce: FirstBounce,
    /// Splat or gather.
    pub estimate: Estimate,
    /// Shadow rays or shadow maps.
    pub direct: DirectLight,
    /// Shadow rays of each pixel, or cubes of shadow maps, for each area light; a square number is best, at least 1.
    pub light_samples: u32,
    /// The seed of the places on the lights.
    pub seed: u64,
}

impl Default for PictureSettings {
    /// 512 x 512 pixels, n = 400, MR = 64, splatted with Silverman's kernel, 16 shadow rays.
    ///
    /// Of n = 50, 200, 400 and 800, 400 has the least RMSE and 800 the least relative MSE in the glass Cornell box (256 x 256
    /// pixels, 400,000 photons, a reference of 16 seeds); other scenes were not tried.
    fn default() -> Self {
        Self {
            size: UVec2::splat(512),
            min_photons: 400,
            max_radius: 64,
            radius: RadiusChoice::Variable,
            kernel: Kernel::Silverman,
            first_bounce: FirstBounce::Rays,
            estimate: Estimate::Splat,
            direct: DirectLight::Traced,
            light_samples: 16,
            seed: 1,
        }
    }
}

impl PictureSettings {
    /// Checks every range.
    ///
    /// # Errors
    /// [`Error::Setting`] with the field's name.
    pub fn validate(&self) -> Result<()> {
        let refuse = |name, value: String, reason: &str| {
            Err(Error::Setting { name, value, reason: reason.to_owned() })
        };
        if self.size.min_element() == 0 {
            return refuse(
                "size",
                format!("{} x {}", self.size.x, self.size.y),
                "a picture has at least one pixel",
            );
        }
        if self.min_photons == 0 {
            return refuse("min_photons", "0".to_owned(), "every box holds 0 photons; ask for at least 1");
        }
        let fits = |radius: u32| (1..=MAX_PICTURE_RADIUS).contains(&radius);
        let range = "a kernel's radius goes from 1 to 96 pixels";
        if !fits(self.max_radius) {
            return refuse("max_radius", self.max_radius.to_string(), range);
        }
        if let RadiusChoice::Fixed(radius) = self.radius
            && !fits(radius)
        {
            return refuse("radius", format!("fixed:{radius}"), range);
        }
        if self.light_samples == 0 {
            return refuse("light_samples", "0".to_owned(), "a light takes at least 1 shadow ray");
        }
        Ok(())
    }
}

#[cfg(feature = "serde")]
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
fn columns_and_rows<S: serde::Serializer>(size: &UVec2, serializer: S) -> Result<S::Ok, S::Error> {
    serde::Serialize::serialize(&size.to_array(), serializer)
}
