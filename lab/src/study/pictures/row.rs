//! One picture of the study.

use serde::{Deserialize, Serialize};

use crate::picture::PictureError;
use varikernel::settings::{Kernel, KernelRadius};

/// What decides the radii of a picture's kernels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Width {
    /// The smallest box that holds n photons.
    Variable {
        /// n.
        min_photons: u32,
    },
    /// The same radius everywhere.
    Fixed {
        /// In pixels.
        radius: u32,
    },
}

impl Width {
    /// n, of variable radii.
    #[must_use]
    pub fn min_photons(self) -> Option<u32> {
        match self {
            Self::Variable { min_photons } => Some(min_photons),
            Self::Fixed { .. } => None,
        }
    }

    /// The radius, if it is fixed.
    #[must_use]
    pub fn radius(self) -> Option<u32> {
        match self {
            Self::Variable { .. } => None,
            Self::Fixed { radius } => Some(radius),
        }
    }

    /// Whether the radius is fixed.
    #[must_use]
    pub fn is_fixed(self) -> bool {
        self.radius().is_some()
    }

    /// Whether nothing smaller can be asked for.
    pub(super) fn is_least(self) -> bool {
        matches!(self, Self::Variable { min_photons: 1 } | Self::Fixed { radius: 1 })
    }

    pub(super) fn choice(self) -> KernelRadius {
        match self {
            Self::Variable { .. } => KernelRadius::Variable,
            Self::Fixed { radius } => KernelRadius::Fixed(radius),
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
    /// The falloff.
    pub kernel: Kernel,
    /// n, or the fixed radius.
    pub width: Width,
    /// RMSE and relative MSE of indirect light, SSIM and FLIP of the whole picture.
    pub error: PictureError,
    /// The mean radius over the pixels on diffuse surfaces, in pixels.
    pub mean_radius: f64,
    /// Share of pixels on diffuse surfaces whose search MR ended; 0 for a fixed radius.
    pub limited_share: f64,
    /// Seconds of the clock until the photons are traced, uploaded and counted; direct light isn't in it. All
    /// pictures of a seed share it.
    pub seconds_before: f64,
    /// Seconds from there to the picture, shaders being there: table and search if the radii are variable,
    /// then kernels, mirrors and glass, shading, and reading back.
    pub seconds_drawing: f64,
}

impl PictureRow {
    /// Seconds of all of it.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.seconds_before + self.seconds_drawing
    }
}
