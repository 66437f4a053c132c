//! Direct light with soft shadows: rays from a place to the lights, on the CPU.
//!
//! Area lights are sampled evenly by area, one ray in each cell of a grid; glass casts a hard shadow, since photons bring
//! the light that passes it.

use glam::{DVec3, Vec3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use crate::scene::{LightShape, Ray, Scene, area};

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

    fn number(&mut self) -> f64 {
        self.0.random()
    }
}

/// Irradiance from all lights at `position`, on the side to which `normal` points.
pub(super) fn irradiance(
    scene: &Scene,
    position: DVec3,
    normal: DVec3,
    samples: u32,
    dice: &mut Dice,
) -> DVec3 {
    let start = scene.start(position, normal);
    let visible = |to: DVec3| {
        let away = to - start;
        let distance = away.length();
        let ray = Ray { origin: start, direction: away / distance };
        scene.cast(&ray).is_none_or(|hit| hit.distance >= distance * (1.0 - BEFORE_LIGHT))
    };
    let mut total = DVec3::ZERO;
    for light in scene.lights() {
        match &light.shape {
            LightShape::Point { position: at, direction, half_angle, intensity } => {
                let away = at.as_dvec3() - position;
                let squared = away.length_squared();
                let to_light = away / squared.sqrt();
                let cos = normal.dot(to_light);
                let in_cone = (-to_light).angle_between(direction.as_dvec3()) <= f64::from(*half_angle);
                if cos > 0.0 && in_cone && visible(at.as_dvec3()) {
                    total += intensity.as_dvec3() * cos / squared;
                }
            }
            LightShape::Area { triangles, radiance } => {
                let areas: Vec<f64> = triangles.iter().map(area).collect();
                let whole: f64 = areas.iter().sum();
                let side = f64::from(samples).sqrt().floor().max(1.0);
                let mut received = 0.0;
                for index in 0..samples {
                    // What is left over after the square grid is taken at random.
                    let index = f64::from(index);
                    let (row, column) = ((index / side).floor(), index % side);
                    let stratified = row < side;
                    let place = if stratified {
                        [(column + dice.number()) / side, (row + dice.number()) / side]
                    } else {
                        [dice.number(), dice.number()]
                    };
                    let (at, facing) = place_on(triangles, &areas, whole, place);
                    let away = at - position;
                    let squared = away.length_squared();
                    let to_light = away / squared.sqrt();
                    let (cos, cos_light) = (normal.dot(to_light), -facing.dot(to_light));
                    if cos > 0.0 && cos_light > 0.0 && visible(at) {
                        received += cos * cos_light / squared;
                    }
                }
                total += radiance.as_dvec3() * (received * whole / f64::from(samples));
            }
        }
    }
    total
}

/// A place on the triangles, evenly by area, for a point (u, v) of the unit square, and the normal there.
fn place_on(triangles: &[[Vec3; 3]], areas: &[f64], whole: f64, [u, v]: [f64; 2]) -> (DVec3, DVec3) {
    let mut left = u * whole;
    let mut index = 0;
    while index + 1 < areas.len() && left >= areas[index] {
        left -= areas[index];
        index += 1;
    }
    let [corner, second, third] = triangles[index].map(Vec3::as_dvec3);
    let share = (left / areas[index]).clamp(0.0, 1.0);
    let at = corner + share.sqrt() * (second - corner + v * (third - second));
    (at, (second - corner).cross(third - corner).normalize())
}

/// Radiance of a light that the ray meets before `limit`.
pub(super) fn seen_light(scene: &Scene, ray: &Ray, limit: f64) -> Vec3 {
    let mut nearest = (limit * (1.0 + BEFORE_LIGHT), Vec3::ZERO);
    for light in scene.lights() {
        let LightShape::Area { triangles, radiance } = &light.shape else { continue };
        for [a, b, c] in triangles.iter().map(|corners| corners.map(Vec3::as_dvec3)) {
            let edges = crate::scene::TriangleEdges { corner: a, edge1: b - a, edge2: c - a };
            if (b - a).cross(c - a).dot(ray.direction) < 0.0
                && let Some((distance, _)) = edges.intersect(ray)
                && distance < nearest.0
            {
                nearest = (distance, *radiance);
            }
        }
    }
    nearest.1
}
