//! Light around places that are seen in mirrors and through glass, from discs as wide as a test of noise
//! allows: the rule of [`Tables`](crate::reference::tables::Tables), on surfaces instead of pixels.
//!
//! - Discs have radii of 0.65, 1.3, ... 83 times the side of what a pixel shows, by how far apart the places
//!   of neighbours are. Weights fall off as in Epanechnikov's kernel, so that the narrowest averages noise
//!   as a pixel does and the widest as a box of 128 pixels.
//! - Each is compared with the one before: where the light differs by no more than noise would make it, the
//!   wider one is better. Tests are pooled over 25 pixels around, as far as they show places near to this
//!   one; between widths light is mixed.
//! - A disc that goes over the end of a surface is too dark; there narrower ones are taken.
//!
//! After F. Rousselle, C. Knaus, M. Zwicker, "Adaptive sampling and reconstruction using greedy error
//! minimization" (2011).

use std::f64::consts::PI;

use glam::{DVec3, IVec2};
use rayon::prelude::*;

use super::neighbours::Neighbours;
use super::photon_sums::PhotonSums;
use super::rings::{DISCS, Held, mean, radius};
use super::sight::Place;
use crate::view::View;

/// Radius of the narrowest disc in sides of a pixel: three quarters of its area are that of the pixel.
const NARROWEST: f64 = 0.651_470_015_870_558_9;
/// Variance of the difference between a disc and the one before, times the disc's area over the squares for
/// each unit of area: the integral of the squared difference of their kernels.
const DIFFERENCE: f64 = 3.0;
/// A squared difference up to which the wider disc is better, in its variances: 1 + 3/5 of what the light's
/// variance lessens, 16/3 - 4/3, over [`DIFFERENCE`]; 3/5 as the wider disc has 4 times the area.
const LIMIT: f64 = 1.8;
/// The most that a squared difference counts, in its variances.
const MOST: f64 = 6.0;
/// Ratios so far from 1 decide all.
const SOFT: f64 = 0.4;
/// Tests are pooled over so many pixels to each side, each half a disc's width from the next.
const POOL: i32 = 2;
/// So many tests that find noise alone are pooled with those of places: what is known where there are none.
const SUPPOSED: f64 = 2.0;
/// Tests are pooled over places at most so many radii away.
const NEAR: f64 = 4.0;

/// Mirrors and glass make what a pixel shows at most so many times as wide or narrow, along each axis.
const MOST_BENT: f64 = 16.0;

/// Of a place.
struct Tested {
    light: [DVec3; DISCS],
    /// Of each disc with the one before: the squared difference over its limit.
    ratios: [f64; DISCS - 1],
}

/// Irradiance at each place; places are in the order of their pixels.
pub(super) fn widened(view: &View, places: &[Place], sums: &PhotonSums) -> Vec<DVec3> {
    let around = Neighbours::new(view.size(), places);
    let narrowest: Vec<f64> = places
        .par_iter()
        .map(|place| NARROWEST * around.side(place, f64::from(view.pixel_side()) * place.distance))
        .collect();
    let tested: Vec<Tested> = places
        .par_iter()
        .zip(&narrowest)
        .map(|(place, &narrowest)| {
            let held = sums.around(place, narrowest);
            let ratio = |disc: usize| {
                let area = PI * radius(narrowest, disc + 1).powi(2);
                ratio(&held[disc], &held[disc + 1], area, sums.usual_power())
            };
            Tested { light: held.map(|held| held.power), ratios: std::array::from_fn(ratio) }
        })
        .collect();
    let light = |(index, place): (usize, &Place)| {
        let mut light = tested[index].light[0];
        let mut share = 1.0_f64;
        for disc in 1..DISCS {
            let near = NEAR * radius(narrowest[index], disc);
            let ratio = around.pooled(place, 1 << (disc - 1), near, |index| tested[index].ratios[disc - 1]);
            share = share.min(((1.0 + SOFT - ratio) / (2.0 * SOFT)).clamp(0.0, 1.0));
            if share == 0.0 {
                break;
            }
            light += share * (tested[index].light[disc] - light);
        }
        light
    };
    places.par_iter().enumerate().map(light).collect()
}

/// The test of noise: 1 where a disc of that area is as good as the one before.
fn ratio(fine: &Held, coarse: &Held, area: f64, usual: f64) -> f64 {
    // One usual photon more: no photons tell nothing of noise.
    let variance = usual * usual * DIFFERENCE * (coarse.squares + 1.0 / area) / area;
    if variance > 0.0 { (mean(coarse.power - fine.power).powi(2) / variance).min(MOST) / LIMIT } else { 0.0 }
}

impl Neighbours<'_> {
    /// The side of what a pixel shows around a place: to the places of the next pixels, or `straight` without
    /// any.
    fn side(&self, place: &Place, straight: f64) -> f64 {
        let to = |way: IVec2| {
            let near = |away| self.of(place, away).map(|index| self.places[index].position);
            let found = near(way).chain(near(-way)).map(|other| other.distance_squared(place.position));
            found.min_by(f64::total_cmp).map(f64::sqrt)
        };
        let side =
            |found: Option<f64>| found.unwrap_or(straight).clamp(straight / MOST_BENT, straight * MOST_BENT);
        (side(to(IVec2::X)) * side(to(IVec2::Y))).sqrt()
    }

    /// The mean of a test over places near to one, in pixels a number of steps apart.
    fn pooled(&self, place: &Place, step: i32, near: f64, test: impl Fn(usize) -> f64) -> f64 {
        let (mut sum, mut count) = (SUPPOSED / LIMIT, SUPPOSED);
        for y in -POOL..=POOL {
            for x in -POOL..=POOL {
                for index in self.of(place, step * IVec2::new(x, y)) {
                    if self.places[index].position.distance_squared(place.position) <= near * near {
                        sum += test(index);
                        count += 1.0;
                    }
                }
            }
        }
        sum / count
    }
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, reason = "small numbers, and random bits")]
mod tests {
    use glam::{UVec2, Vec3};

    use super::*;
    use crate::photon::PhotonPoint;
    use crate::view::Camera;

    const SIDE: u32 = 48;

    /// Looks down at the plane of y = 0, of which a pixel shows 1 by 1.
    fn view() -> View {
        let height = 0.5 * SIDE as f32;
        let camera = Camera {
            position: Vec3::new(0.0, height, 0.0),
            direction: Vec3::NEG_Y,
            up: Vec3::Z,
            vertical_fov_degrees: 90.0,
        };
        View::new(&camera, (0.1, 100.0), UVec2::splat(SIDE))
    }

    fn places() -> Vec<Place> {
        let height = f64::from(SIDE) / 2.0;
        let place = |pixel: u32| {
            let ray = view().ray(pixel % SIDE, pixel / SIDE);
            let position = ray.origin - ray.direction * (ray.origin.y / ray.direction.y);
            Place { pixel, position, normal: DVec3::Y, share: Vec3::ONE, distance: height, surface: 1.0 }
        };
        (0..SIDE * SIDE).map(place).collect()
    }

    /// Four photons for each unit of area up to 150 away, where `power` is not 0.
    fn photons(power: impl Fn(f32) -> f32) -> Vec<PhotonPoint> {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            300.0 * (((state >> 40) as f32) / 16_777_216.0 - 0.5)
        };
        let photon = |_| {
            let position = Vec3::new(random(), 0.0, random());
            let power = Vec3::splat(power(position.x));
            PhotonPoint { position, normal: Vec3::Y, power, surface: 1.0 }
        };
        (0..360_000).map(photon).filter(|photon| photon.power.x > 0.0).collect()
    }

    fn lit(power: impl Fn(f32) -> f32) -> Vec<(f64, f64)> {
        let found = widened(&view(), &places(), &PhotonSums::new(&photons(power)));
        places().iter().zip(found).map(|(place, light)| (place.position.x, light.x)).collect()
    }

    #[test]
    fn even_light_comes_from_the_widest_discs() {
        let found = lit(|_| 0.25);
        let squares: f64 = found.iter().map(|(_, light)| (light - 1.0).powi(2)).sum();
        // That of a pixel would be 0.5, and that of the widest 0.004.
        let rmse = (squares / found.len() as f64).sqrt();
        assert!(rmse < 0.02, "{rmse}");
    }

    #[test]
    fn a_step_keeps_its_edge() {
        for (x, light) in lit(|x| if x < 0.0 { 0.025 } else { 0.25 }) {
            let truth = if x < 0.0 { 0.1 } else { 1.0 };
            // Narrow discs are left near to the edge, and their noise.
            assert!((light - 0.55).abs() > 0.05 || x.abs() < 2.0, "{x}: {light}");
            assert!((light > 0.55) == (x > 0.0) || x.abs() < 2.0, "{x}: {light}");
            assert!((light / truth - 1.0).abs() < 0.4 || x.abs() < 12.0, "{x}: {light}");
        }
    }

    #[test]
    fn no_photons_and_a_single_one_give_no_light_that_is_no_number() {
        let one = photons(|_| 1.0)[..1].to_vec();
        for photons in [vec![], one, vec![PhotonPoint { power: Vec3::ZERO, ..photons(|_| 1.0)[0] }]] {
            let found = widened(&view(), &places(), &PhotonSums::new(&photons));
            assert!(found.iter().all(|light| light.is_finite() && light.min_element() >= 0.0));
        }
        assert_eq!(widened(&view(), &[], &PhotonSums::new(&[])), []);
    }
}
