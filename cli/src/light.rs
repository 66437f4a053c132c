//! `--light` of a picture and of the window.

use serde::{Deserialize, Serialize};
use varikernel::settings::Estimate;

/// How photons become light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Light {
    /// Each pixel gathers from summed-area tables, as wide as a test of noise allows: fast, and without n.
    Tables,
    /// Each photon is drawn as its kernel, which keeps its energy (thesis 2.6.2).
    Splat,
    /// Each pixel gathers the photons around it with its own kernel.
    Gather,
}

impl Light {
    /// The library's word for it; `count_correction` is for a gather.
    pub(crate) fn estimate(self, count_correction: bool) -> Estimate {
        match self {
            Self::Tables => Estimate::Tables,
            Self::Splat => Estimate::Splat,
            Self::Gather => Estimate::Gather { count_correction },
        }
    }
}
