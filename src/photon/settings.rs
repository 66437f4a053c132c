//! How photons are traced.

use serde::Serialize;

use crate::error::{Error, Result};

/// How photons are traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct TraceSettings {
    /// Photons that leave the lights, at least 1.
    pub photons: u32,
    /// Diffuse landings after which a photon is followed no further, at least 1.
    pub bounces: u32,
    /// The same seed gives the same photons.
    pub seed: u64,
    /// Whether a photon ends at a landing by chance, in proportion to what the surface absorbs, instead of going on with
    /// less power. The mean is the same.
    pub russian_roulette: bool,
}

impl Default for TraceSettings {
    /// 10^6 photons, 8 landings each, all of them followed.
    fn default() -> Self {
        Self { photons: 1_000_000, bounces: 8, seed: 1, russian_roulette: false }
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
            return refuse("photons", "it is at least 1, since no photon means no light");
        }
        if self.bounces == 0 {
            return refuse("bounces", "it is at least 1, the first landing");
        }
        Ok(())
    }
}
