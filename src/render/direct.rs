//! Direct light with soft shadows: rays from a place to the lights, on the CPU.
//!
//! Area lights are sampled by power among their triangles and by area on each, one ray in each cell of a
//! grid; glass casts a hard shadow, since photons bring the light that passes it.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use super::sight::Place;
use crate::scene::{Ray, Scene};

/// A shadow ray ends this share of its length before the light, which may itself be a surface.
const BEFORE_LIGHT: f64 = 1e-6;

/// Random numbers of one pixel.
pub(super) struct Dice(Pcg64Mcg);

impl Dice {
    pub(super) fn new(seed: u64, pixel: u32) -> Self {
        // Odd multiples keep neighbouring pixels and seeds apart; the generator's own seeding mixes them.
        let number =
            seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ u64::from(pixel).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        Self(Pcg64Mcg::seed_from_u64(number))
    }

    pub(super) fn number(&mut self) -> f64 {
        self.0.random()
    }
}

/// Radiance of direct light that a place sends to the camera.
pub(super) fn reflected(scene: &Scene, place: &Place, samples: u32, dice: &mut Dice) -> DVec3 {
    // What reflects nothing, as most lights, needs no shadow rays.
    if place.share == Vec3::ZERO {
        return DVec3::ZERO;
    }
    place.share.as_dvec3() * irradiance(scene, place.position, place.normal, samples, dice) / PI
}

/// Irradiance from all lights at `position`, on the side to which `normal` points.
fn irradiance(scene: &Scene, position: DVec3, normal: DVec3, samples: u32, dice: &mut Dice) -> DVec3 {
    let start = scene.start(position, normal);
    let visible = |to: DVec3| {
        let away = to - start;
        let distance = away.length();
        let ray = Ray { origin: start, direction: away / distance };
        scene.cast(&ray).is_none_or(|hit| hit.distance >= distance * (1.0 - BEFORE_LIGHT))
    };
    let mut number = || dice.number();
    let mut total = DVec3::ZERO;
    for place in scene.lights().iter().flat_map(|light| light.places(samples, &mut number)) {
        let arrives = place.irradiance(position, normal);
        if arrives != DVec3::ZERO && visible(place.position) {
            total += arrives;
        }
    }
    total
}
