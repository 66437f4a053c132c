//! Photons: from the lights into the scene, landing after landing (thesis 2.4, 2.6.1), on the CPU.

mod aim;
mod emission;
mod files;
mod landings;
mod path;
mod point;
mod random;
mod records;
mod scatter;
mod tracer;

pub use emission::{Emission, EmittedPhoton};
pub use files::{PhotonFormat, write};
pub use landings::{Ends, Landings, Tally};
#[cfg(feature = "render")]
pub(crate) use scatter::mirrored;
pub use scatter::{reflect, reflected_by_pane, refract};
pub use tracer::{trace, trace_from, trace_from_hits, trace_in_batches};

pub use crate::photon_point::PhotonPoint;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use serde::Serialize;

use crate::{Error, Result};

/// How often in a row a photon may meet mirrors and glass before it is given up.
pub const MAX_SPECULAR: u32 = 256;

/// A diffuse landing of a photon (thesis, Table 2.1, the photon map's columns).
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Photon {
    /// In scene units.
    pub position: Vec3,
    /// The way that the photon went, of length 1: towards the surface.
    pub incoming: Vec3,
    /// Before absorption, linear RGB.
    pub power: Vec3,
    /// Of the surface, of length 1, on the side from which the photon came.
    pub normal: Vec3,
    /// k: how many times the photon had landed before, from 0.
    pub bounce: u32,
    /// Index into the scene's surfaces.
    pub surface: u32,
    /// 1 if glass has refracted the photon anywhere on its way from the light, else 0.
    pub through_glass: u32,
    /// 1 if a mirror or glass has passed the photon on since it last landed or left its light, else 0.
    pub from_specular: u32,
}

impl Photon {
    /// Whether the photon came straight from its light: what direct light counts already.
    #[must_use]
    pub fn is_direct(&self) -> bool {
        self.bounce == 0 && self.from_specular == 0
    }

    /// Whether glass has refracted the photon anywhere on its way from the light.
    #[must_use]
    pub fn passed_glass(&self) -> bool {
        self.through_glass != 0
    }
}

/// A photon and what it meets first, as rasterised from its light (thesis 2.6.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit {
    /// As it leaves the light.
    pub photon: EmittedPhoton,
    /// The first triangle (its index), or sphere (the number of triangles plus its index).
    ///
    /// The place is computed again from it, exactly; where the ray does not meet it, the ray is cast.
    pub primitive: u32,
}

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
            return refuse("photons", "no photon means no light; ask for at least 1");
        }
        if self.bounces == 0 {
            return refuse("bounces", "the first landing is one; ask for at least 1");
        }
        Ok(())
    }
}
