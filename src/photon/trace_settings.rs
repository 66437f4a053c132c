//! How photons are traced.

use serde::Serialize;

use crate::error::{Error, Result};

/// How photons are traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct TraceSettings {
    /// Photons that leave the lights, at least 1.
    pub photons: u32,
    /// Diffuse landings after which a photon is followed no further, at least 1. Without a number, it is
    /// followed to its end: after [`ROULETTE_AFTER`](super::ROULETTE_AFTER) landings by Russian roulette, and
    /// at the latest after [`MAX_BOUNCES`](super::MAX_BOUNCES).
    pub bounces: Option<u32>,
    /// The same seed gives the same photons.
    pub seed: u64,
    /// Whether a photon ends at any landing by chance, in proportion to what the surface absorbs, instead of
    /// going on with less power. The mean is the same.
    pub russian_roulette: bool,
}

impl Default for TraceSettings {
    /// 10^6 photons, each followed to its end.
    fn default() -> Self {
        Self { photons: 1_000_000, bounces: None, seed: 1, russian_roulette: false }
    }
}

impl TraceSettings {
    /// Checks every range.
    ///
    /// # Errors
    /// [`Error::Setting`] with the field's name.
    pub fn validate(&self) -> Result<()> {
        let refuse = |name, reason: &str| {
            Err(Error::Setting { name, value: "0".to_owned(), reason: reason.to_owned() })
        };
        if self.photons == 0 {
            return refuse("photons", "give at least 1");
        }
        if self.bounces == Some(0) {
            return refuse("bounces", "give at least 1");
        }
        Ok(())
    }
}
