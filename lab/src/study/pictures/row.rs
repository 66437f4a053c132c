//! One picture of the study.

use serde::{Deserialize, Serialize};

use crate::picture::{LightError, PictureError};
use varikernel::settings::{Estimate, Kernel, KernelRadius};

/// How photons become light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Way {
    /// Each photon drawn as its kernel, as wide as the smallest box that holds n photons.
    Variable {
        /// n.
        min_photons: u32,
    },
    /// Each photon drawn with the same radius.
    Fixed {
        /// In pixels.
        radius: u32,
    },
    /// Each pixel gathering with the smallest box that holds n photons.
    Gather {
        /// n.
        min_photons: u32,
    },
    /// Each pixel gathering from tables, as wide as a test of noise allows.
    Tables,
}

/// Ways that differ by a number alone: the best of each is found by a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Splats with variable radii.
    Variable,
    /// Splats with a fixed radius.
    Fixed,
    /// Gathers with variable radii.
    Gather,
    /// Light from tables, where there is nothing to choose.
    Tables,
}

impl Way {
    /// What it belongs to.
    #[must_use]
    pub fn family(self) -> Family {
        match self {
            Self::Variable { .. } => Family::Variable,
            Self::Fixed { .. } => Family::Fixed,
            Self::Gather { .. } => Family::Gather,
            Self::Tables => Family::Tables,
        }
    }

    /// n, of variable radii.
    #[must_use]
    pub fn min_photons(self) -> Option<u32> {
        match self {
            Self::Variable { min_photons } | Self::Gather { min_photons } => Some(min_photons),
            Self::Fixed { .. } | Self::Tables => None,
        }
    }

    /// The radius, if it is fixed.
    #[must_use]
    pub fn radius(self) -> Option<u32> {
        match self {
            Self::Fixed { radius } => Some(radius),
            _ => None,
        }
    }

    /// Its name in files: `splat`, `gather` or `tables`.
    #[must_use]
    pub fn method(self) -> &'static str {
        match self {
            Self::Variable { .. } | Self::Fixed { .. } => "splat",
            Self::Gather { .. } => "gather",
            Self::Tables => "tables",
        }
    }

    /// Whether nothing smaller can be asked for.
    pub(super) fn is_least(self) -> bool {
        matches!(self, Self::Variable { min_photons: 1 } | Self::Fixed { radius: 1 } | Self::Tables)
    }

    pub(crate) fn choice(self) -> KernelRadius {
        self.radius().map_or(KernelRadius::Variable, KernelRadius::Fixed)
    }

    pub(crate) fn estimate(self) -> Estimate {
        match self {
            Self::Variable { .. } | Self::Fixed { .. } => Estimate::Splat,
            Self::Gather { .. } => Estimate::Gather { count_correction: false },
            Self::Tables => Estimate::Tables,
        }
    }
}

impl std::fmt::Display for Way {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Variable { min_photons } => write!(formatter, "splat, n = {min_photons}"),
            Self::Fixed { radius } => write!(formatter, "splat, radius {radius}"),
            Self::Gather { min_photons } => write!(formatter, "gather, n = {min_photons}"),
            Self::Tables => formatter.write_str("tables"),
        }
    }
}

/// A picture of one seed: its error is the same, bit for bit, whenever it is drawn again on the same
/// renderer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PictureRow {
    /// The scene's name.
    pub scene: String,
    /// Photons that left the lights.
    pub photons: u32,
    /// Their seed.
    pub seed: u64,
    /// The falloff; tables have none.
    pub kernel: Kernel,
    /// What was drawn.
    pub way: Way,
    /// RMSE and relative MSE of indirect light over all pixels, without the reference's noise; SSIM and FLIP
    /// of the whole picture.
    pub error: PictureError,
    /// The first two, of pixels inside of faces alone: what is seen straight on diffuse surfaces, with all
    /// eight neighbours on the same face.
    pub inside: LightError,
    /// The mean radius over the pixels on diffuse surfaces, in pixels.
    pub mean_radius: f64,
    /// Share of pixels on diffuse surfaces whose search MR ended; 0 where nothing is searched.
    pub limited_share: f64,
    /// Seconds of the clock until the photons are traced; direct light isn't in it. All pictures of a seed
    /// share it.
    pub seconds_before: f64,
    /// Seconds from photons on the GPU to the picture, shaders being there: photons counted, table and search
    /// if radii are searched, then light, mirrors and glass with the sorting of photons for them, shading,
    /// and reading back.
    pub seconds_drawing: f64,
}

impl PictureRow {
    /// Seconds of all of it.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.seconds_before + self.seconds_drawing
    }
}
