//! What is asked of an [`IrradiancePipeline`](crate::IrradiancePipeline).

use super::{Kernel, KernelRadius, MAX_PICTURE_RADIUS, Rule, Search, Settings};
use crate::error::{Error, Result};

/// How photons become irradiance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Estimate {
    /// Each photon spreads its power over the pixels around it, with the radius of its own pixel.
    #[default]
    Splat,
    /// Each pixel gathers the power around it, with its own radius.
    #[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
    Gather {
        /// Whether (c - 1) / c of what c photons give is taken, as a radius that ends at a photon asks for.
        count_correction: bool,
    },
    /// Each pixel gathers from summed-area tables, as wide as a test of noise allows; radii and kernels are
    /// not asked for.
    Tables,
}

/// Everything that light from photons depends on beside the photons and surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct IrradianceSettings {
    /// Where the radius of each kernel comes from.
    pub radius: KernelRadius,
    /// How radii are searched, if they are variable; MR goes up to [`MAX_PICTURE_RADIUS`], and there is no
    /// mask.
    #[cfg_attr(feature = "serde", serde(rename = "search"))]
    pub radii: Settings,
    /// The falloff.
    pub kernel: Kernel,
    /// Splat or gather.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Estimate::is_splat"))]
    pub estimate: Estimate,
}

#[cfg(feature = "serde")]
impl Estimate {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
    fn is_splat(&self) -> bool {
        *self == Self::Splat
    }
}

impl Default for IrradianceSettings {
    /// Variable radii for n = 400 up to MR = 64, splatted with Silverman's kernel, as pictures have them.
    fn default() -> Self {
        let usual = Settings::default();
        let search = Search { min_photons: 400, max_radius: 64, ..usual.search };
        Self {
            radius: KernelRadius::Variable,
            radii: Settings { search, ..usual },
            kernel: Kernel::Silverman,
            estimate: Estimate::Splat,
        }
    }
}

impl IrradianceSettings {
    /// Whether each pixel's radius is searched.
    #[must_use]
    pub fn searches_radii(&self) -> bool {
        self.radius == KernelRadius::Variable && self.estimate != Estimate::Tables
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`Error::Setting`] with the field's name.
    pub fn validate(&self) -> Result<()> {
        self.radii.validate()?;
        if self.radii.masked {
            return Err(Error::Setting {
                name: "masked",
                value: "true".to_owned(),
                reason: "a kernel needs the radius of every pixel with a photon".to_owned(),
            });
        }
        if self.radii.rule != Rule::Nearest {
            return Err(Error::Setting {
                name: "rule",
                value: self.radii.rule.name().to_owned(),
                reason:
                    "it knows of densities alone, and light has surfaces as well; light from tables tests \
                         for the same within each face"
                        .to_owned(),
            });
        }
        match self.radius {
            KernelRadius::Variable => check_radius("max_radius", self.radii.search.max_radius, ""),
            KernelRadius::Fixed(radius) => check_radius("radius", radius, "fixed:"),
        }
    }
}

/// Refuses a kernel that is too wide or empty; its setting's value is written with `prefix`.
fn check_radius(name: &'static str, radius: u32, prefix: &str) -> Result<()> {
    if (1..=MAX_PICTURE_RADIUS).contains(&radius) {
        return Ok(());
    }
    let reason = format!("a kernel's radius goes from 1 to {MAX_PICTURE_RADIUS} pixels");
    Err(Error::Setting { name, value: format!("{prefix}{radius}"), reason })
}
