//! What is asked of an [`IrradiancePipeline`](crate::IrradiancePipeline).

use super::{Kernel, MAX_PICTURE_RADIUS, RadiusChoice, Settings};
use crate::error::{Error, Result};

/// How photons become irradiance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct IrradianceSettings {
    /// Where the radius of each kernel comes from.
    pub radius: RadiusChoice,
    /// How radii are searched, if they are variable; MR goes up to [`MAX_PICTURE_RADIUS`], and there is no mask.
    pub search: Settings,
    /// The falloff.
    pub kernel: Kernel,
}

impl Default for IrradianceSettings {
    /// Variable radii for n = 400 up to MR = 64 with Silverman's kernel, as pictures have them.
    fn default() -> Self {
        let usual = Settings::default();
        let search = super::Search { min_photons: 400, max_radius: 64, ..usual.search };
        Self {
            radius: RadiusChoice::Variable,
            search: Settings { search, ..usual },
            kernel: Kernel::Silverman,
        }
    }
}

impl IrradianceSettings {
    /// Checks every range.
    ///
    /// # Errors
    /// [`Error::Setting`] with the field's name.
    pub fn validate(&self) -> Result<()> {
        self.search.validate()?;
        let refuse = |name, value: String, reason: &str| {
            Err(Error::Setting { name, value, reason: reason.to_owned() })
        };
        if self.search.masked {
            return refuse(
                "masked",
                "true".to_owned(),
                "a kernel needs the radius of every pixel with a photon",
            );
        }
        let (name, radius) = match self.radius {
            RadiusChoice::Variable => ("max_radius", self.search.search.max_radius),
            RadiusChoice::Fixed(radius) => ("radius", radius),
        };
        if !(1..=MAX_PICTURE_RADIUS).contains(&radius) {
            return refuse(name, radius.to_string(), "a kernel's radius goes from 1 to 96 pixels");
        }
        Ok(())
    }
}
