//! `--light` of a picture and of the window.

use anyhow::{Result, bail};
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
    /// Refuses the first of the options about kernels that were given, where there are none.
    pub(crate) fn check_kernels(self, given: impl IntoIterator<Item = &'static str>) -> Result<()> {
        match given.into_iter().next() {
            Some(option) if self == Self::Tables => {
                bail!("{option} is for kernels, and light from tables has none\nhelp: add `--light splat`")
            }
            _ => Ok(()),
        }
    }

    /// The library's word for it; `count_correction` is for a gather.
    pub(crate) fn estimate(self, count_correction: bool) -> Estimate {
        match self {
            Self::Tables => Estimate::Tables,
            Self::Splat => Estimate::Splat,
            Self::Gather => Estimate::Gather { count_correction },
        }
    }
}
