//! Statistics of landings: where photons land, with what power, and how their ways end.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use serde::Serialize;

use super::{Emission, Photon};
use crate::scene::{Scattering, Scene};

/// How the ways of photons end; the sum is the number of photons.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Ends {
    /// They leave the scene.
    pub left: u64,
    /// They are absorbed: by a black surface, or by Russian roulette.
    pub absorbed: u64,
    /// They have landed as often as was asked for, or else [`super::MAX_BOUNCES`] times.
    pub bounces_used: u64,
    /// They met mirrors and glass [`super::MAX_SPECULAR`] times without a landing, and were given up.
    pub given_up: u64,
}

/// Counts and sums over landings; those of parts add up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Photons that were followed.
    pub photons: u64,
    /// How their ways ended.
    pub ends: Ends,
    /// Power with which they left their lights, linear RGB.
    emitted: DVec3,
    /// Landings by bounce, then by surface.
    counts: Vec<Vec<u64>>,
    /// Power before absorption by bounce, linear RGB.
    flux: Vec<DVec3>,
    /// Power that would have gone on where photons were followed no further, linear RGB.
    cut_off: DVec3,
}

/// Where photons land, in shares; the file of `varikernel photons --stats`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Landings {
    /// The power of all lights, linear RGB; of a far light, photons carry what goes towards the rest of the
    /// scene, and that is the emitted power that shares refer to.
    pub emitted_flux_rgb: [f64; 3],
    /// For k = 0, 1, 2, ...: by surface, the share of the emitted photons whose k-th diffuse landing is
    /// there. Without Russian roulette only, a share of power as well.
    pub landings: Vec<BTreeMap<String, f64>>,
    /// For k = 0, 1, 2, ...: the share of the emitted power that arrives at the k-th diffuse landing, before
    /// absorption, linear RGB; 0 for a colour that is not emitted.
    pub flux: Vec<[f64; 3]>,
    /// The share of the emitted power that would have gone on where photons were followed no further: after
    /// their last landing, or between mirrors and glass; linear RGB.
    pub cut_off: [f64; 3],
}

impl Tally {
    /// Begins with a photon of that power.
    pub(super) fn leaves(&mut self, power: Vec3) {
        self.photons += 1;
        self.emitted += power.as_dvec3();
    }

    /// Counts one landing.
    pub(super) fn add(&mut self, photon: &Photon) {
        let (bounce, surface) = (photon.bounce as usize, photon.surface as usize);
        if self.counts.len() <= bounce {
            self.counts.resize(bounce + 1, Vec::new());
            self.flux.resize(bounce + 1, DVec3::ZERO);
        }
        let counts = &mut self.counts[bounce];
        if counts.len() <= surface {
            counts.resize(surface + 1, 0);
        }
        counts[surface] += 1;
        self.flux[bounce] += photon.power.as_dvec3();
    }

    /// Ends a photon that has landed as often as it may, and would have gone on with `power`.
    pub(super) fn cut_off(&mut self, power: Vec3) {
        self.ends.bounces_used += 1;
        self.cut_off += power.as_dvec3();
    }

    /// Ends a photon that goes to and fro between mirrors and glass with `power`.
    pub(super) fn give_up(&mut self, power: Vec3) {
        self.ends.given_up += 1;
        self.cut_off += power.as_dvec3();
    }

    /// Adds the numbers of `other`.
    pub(crate) fn merge(&mut self, other: &Self) {
        self.photons += other.photons;
        self.emitted += other.emitted;
        self.ends.left += other.ends.left;
        self.ends.absorbed += other.ends.absorbed;
        self.ends.bounces_used += other.ends.bounces_used;
        self.ends.given_up += other.ends.given_up;
        self.cut_off += other.cut_off;
        self.counts.resize(self.counts.len().max(other.counts.len()), Vec::new());
        self.flux.resize(self.counts.len(), DVec3::ZERO);
        for (ours, theirs) in self.counts.iter_mut().zip(&other.counts) {
            ours.resize(ours.len().max(theirs.len()), 0);
            for (our, their) in ours.iter_mut().zip(theirs) {
                *our += their;
            }
        }
        for (our, their) in self.flux.iter_mut().zip(&other.flux) {
            *our += their;
        }
    }

    /// Power with which all photons left their lights, linear RGB.
    #[must_use]
    pub fn power_emitted(&self) -> DVec3 {
        self.emitted
    }

    /// Power that would have gone on where photons were followed no further, linear RGB: after their last
    /// landing, or between mirrors and glass. This light is missing, and what it would have brought at
    /// further landings.
    #[must_use]
    pub fn power_cut_off(&self) -> DVec3 {
        self.cut_off
    }

    /// All landings.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.counts.iter().flatten().sum()
    }

    /// As shares, for every bounce that was asked for, or else that was seen, and every surface with a diffuse
    /// part.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "counts are below 2^53")]
    pub fn landings(&self, scene: &Scene, emission: &Emission<'_>) -> Landings {
        let geometry = scene.geometry();
        let triangles = geometry.triangles.iter().map(|triangle| (triangle.surface, triangle.material));
        let spheres = geometry.spheres.iter().map(|sphere| (sphere.surface, sphere.material));
        let mut is_diffuse = vec![false; geometry.surfaces.len()];
        for (surface, material) in triangles.chain(spheres) {
            let scattering = scene.materials()[material as usize].scattering;
            is_diffuse[surface as usize] |= matches!(scattering, Scattering::Lambert(_));
        }

        let emitted = self.emitted;
        let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
        let bounces = 0..emission.settings().bounces.map_or(self.counts.len(), |bounces| bounces as usize);
        let on_surfaces = |bounce: usize| {
            let count =
                |surface: usize| self.counts.get(bounce).and_then(|counts| counts.get(surface)).copied();
            let shares = geometry.surfaces.iter().enumerate().filter(|&(surface, _)| is_diffuse[surface]);
            let shares = shares.map(|(surface, name)| {
                (name.clone(), share(count(surface).unwrap_or(0) as f64, self.photons as f64))
            });
            shares.collect()
        };
        let of_emitted =
            |flux: DVec3| [share(flux.x, emitted.x), share(flux.y, emitted.y), share(flux.z, emitted.z)];
        let in_all = |bounce: usize| of_emitted(self.flux.get(bounce).copied().unwrap_or_default());
        Landings {
            emitted_flux_rgb: emission.flux().to_array(),
            landings: bounces.clone().map(on_surfaces).collect(),
            flux: bounces.map(in_all).collect(),
            cut_off: of_emitted(self.cut_off),
        }
    }
}
