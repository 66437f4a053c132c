//! Photons against what they should do: a closed form, an estimator that shares no code, and walls without
//! leaks.

use std::f64::consts::PI;

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use serde_json::Value;
use varikernel::glam::{DVec3, Vec3};
use varikernel::photon::{Photon, TraceSettings};
use varikernel::scene::Scene;

use crate::{load, settings, shipped_text, traced};

/// How far photons may be from a sum that should be normally distributed, in deviations.
const TOLERANCE: f64 = 4.5;

/// Form factor from a point of a plane to the part of a parallel plane `height` above it that lies between
/// the point's foot and (`along`, `across`); negative on one negative side (E. Sparrow, R. Cess, "Radiation
/// Heat Transfer", 1978; catalogue number B-3).
fn corner(along: f64, across: f64, height: f64) -> f64 {
    let (x, y) = (along / height, across / height);
    let (by_x, by_y) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    (x / by_x * (y / by_x).atan() + y / by_y * (x / by_y).atan()) / (2.0 * PI)
}

/// Share of the lamp's light that arrives between (x0, z0) and (x1, z1) on the floor of the Cornell box,
/// without walls.
fn share_of_floor([x0, x1]: [f64; 2], [z0, z1]: [f64; 2], lamp_height: f64) -> f64 {
    const STEPS: u32 = 12;
    let (width, depth) = (x1 - x0, z1 - z0);
    let mut sum = 0.0;
    for i in 0..STEPS {
        for j in 0..STEPS {
            let middle = |index: u32| (f64::from(index) + 0.5) / f64::from(STEPS);
            let (x, z) = (x0 + middle(i) * width, z0 + middle(j) * depth);
            let to = |x1: f64, z1: f64| corner(x1 - x, z1 - z, lamp_height);
            sum += to(343.0, 332.0) - to(213.0, 332.0) - to(343.0, 227.0) + to(213.0, 227.0);
        }
    }
    // By reciprocity the lamp sends to the patch what the patch would send to the lamp.
    sum / f64::from(STEPS * STEPS) * width * depth / (130.0 * 105.0)
}

/// How far the first landings on the floor are from the closed form, in deviations: over 8 x 8 patches by
/// their squares, and in all.
fn floor_deviations(photons: &[Photon], emitted: f64, lamp_height: f64) -> [f64; 2] {
    // Inside the slanted wall.
    let (width, depth) = (549.0 / 8.0, f64::from(559.2_f32) / 8.0);
    let mut found = [[0_u32; 8]; 8];
    for photon in photons.iter().filter(|photon| photon.bounce == 0 && photon.position.y < 1e-3) {
        let (i, j) = (f64::from(photon.position.x) / width, f64::from(photon.position.z) / depth);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "saturates, and is bounded next"
        )]
        if let Some(count) = found.get_mut(i as usize).and_then(|row| row.get_mut(j as usize)) {
            *count += 1;
        }
    }
    let (mut squares, mut difference, mut total) = (0.0, 0.0, 0.0);
    for (i, row) in found.iter().enumerate() {
        for (j, &count) in row.iter().enumerate() {
            let [x, z] = [i as f64 * width, j as f64 * depth];
            let expected = emitted * share_of_floor([x, x + width], [z, z + depth], lamp_height);
            squares += (f64::from(count) - expected).powi(2) / expected;
            difference += f64::from(count) - expected;
            total += expected;
        }
    }
    // 64 squares of normal numbers have a mean of 64 and a variance of 128.
    [(squares - 64.0) / 128.0_f64.sqrt(), difference.abs() / total.sqrt()]
}

#[test]
fn the_form_factor_is_that_of_the_books() {
    // A square of side 2 at distance 1 above its middle: 4 (2 / (√2 · 2π)) atan(1 / √2) = 0.5541.
    assert!((4.0 * corner(1.0, 1.0, 1.0) - 0.554_126).abs() < 1e-6);
    // An endless quarter of a plane.
    assert!((corner(1e9, 1e9, 1.0) - 0.25).abs() < 1e-9);
}

#[test]
fn direct_light_on_the_floor_has_its_closed_form() {
    let scene = Scene::shipped("cornell-empty").unwrap();
    let emitted = 200_000;
    let (photons, tally) = traced(&scene, &settings(emitted));
    let emitted = f64::from(emitted);
    let [patches, all] = floor_deviations(&photons, emitted, 548.3);
    assert!(patches < TOLERANCE && all < TOLERANCE, "{patches} and {all} deviations");
    // A lamp 3 cm lower is seen in the patches, and one photon in 40 that is gone in all.
    assert!(floor_deviations(&photons, emitted, 518.3)[0] > TOLERANCE);
    assert!(floor_deviations(&photons, emitted * 1.025, 548.3)[1] > TOLERANCE);
    assert_eq!(tally.photons, 200_000);
}

/// A quad of the committed JSON, as two triangles.
struct Wall {
    name: String,
    reflectance: DVec3,
    halves: [[DVec3; 3]; 2],
}

fn vector(numbers: &Value) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|axis| numbers[axis].as_f64().unwrap()))
}

fn walls(scene: &str) -> Vec<Wall> {
    let scenes: Value = serde_json::from_str(include_str!("cornell_scenes.json")).unwrap();
    let scene = &scenes[scene];
    let mut walls = Vec::new();
    let mut add = |name: &str, reflectance: DVec3, quad: &Value| {
        let corners: Vec<_> = quad.as_array().unwrap().iter().map(vector).collect();
        let halves = [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
        walls.push(Wall { name: name.to_owned(), reflectance, halves });
    };
    for (name, surface) in scene["diffuse"].as_object().unwrap() {
        for quad in surface["quads"].as_array().unwrap() {
            add(name, vector(&surface["reflectance"]), quad);
        }
    }
    add("lamp", DVec3::ZERO, &scene["lamp"]["quad"]);
    walls
}

/// Distance to a triangle, by Cramer's rule for the plane's two coordinates and the distance.
fn solve(corners: &[DVec3; 3], origin: DVec3, direction: DVec3) -> Option<f64> {
    let (first, second, right) = (corners[1] - corners[0], corners[2] - corners[0], origin - corners[0]);
    let determinant = |one: DVec3, two: DVec3, three: DVec3| one.dot(two.cross(three));
    let all = determinant(first, second, -direction);
    let along_first = determinant(right, second, -direction) / all;
    let along_second = determinant(first, right, -direction) / all;
    let distance = determinant(first, second, right) / all;
    let inside = along_first >= 0.0 && along_second >= 0.0 && along_first + along_second <= 1.0;
    (inside && distance > 1e-6).then_some(distance)
}

/// Lambert's law as a unit normal plus a point of the unit sphere.
fn lambert(normal: DVec3, random: &mut Pcg64) -> DVec3 {
    loop {
        let point = DVec3::from_array(std::array::from_fn(|_| random.random_range(-1.0..1.0)));
        if (1e-6..1.0).contains(&point.length_squared()) {
            return (normal + point.normalize()).normalize();
        }
    }
}

/// Sums and sums of squares over samples.
#[derive(Clone, Copy, Default)]
struct Sums {
    sum: f64,
    squares: f64,
}

impl Sums {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.squares += value * value;
    }

    fn variance_of_mean(&self, samples: f64) -> f64 {
        (self.squares / samples - (self.sum / samples).powi(2)) / samples
    }
}

const BOUNCES: usize = 4;
const NAMES: [&str; 6] = ["back", "ceiling", "floor", "lamp", "left", "right"];

/// Flux (R, G, B) and landings by surface, per bounce, of one way at a time through the walls.
fn estimate(walls: &[Wall], samples: u32) -> Vec<[Sums; 9]> {
    let mut random = Pcg64::seed_from_u64(99);
    let mut sums = vec![[Sums::default(); 9]; BOUNCES];
    for _ in 0..samples {
        let mut origin =
            DVec3::new(random.random_range(213.0..343.0), 548.3, random.random_range(227.0..332.0));
        let mut direction = lambert(-DVec3::Y, &mut random);
        let mut power = DVec3::ONE;
        for bounce in &mut sums {
            let hits = walls.iter().flat_map(|wall| wall.halves.iter().map(move |half| (wall, half)));
            let hits = hits.filter_map(|(wall, half)| Some((solve(half, origin, direction)?, wall, half)));
            let Some((distance, wall, [a, b, c])) = hits.min_by(|a, b| a.0.total_cmp(&b.0)) else { break };
            for (sum, flux) in bounce.iter_mut().zip(power.to_array()) {
                sum.add(flux);
            }
            bounce[3 + NAMES.iter().position(|name| *name == wall.name).unwrap()].add(1.0);
            origin += distance * direction;
            let normal = (*b - *a).cross(*c - *a).normalize();
            direction = lambert(if normal.dot(direction) < 0.0 { normal } else { -normal }, &mut random);
            power *= wall.reflectance;
            if power == DVec3::ZERO {
                break;
            }
        }
    }
    sums
}

/// The largest difference between photons and the estimator, in deviations of both.
fn farthest(walls: &[Wall], photons: f64, found: &varikernel::photon::Landings) -> f64 {
    let samples = 100_000;
    let mut farthest = 0.0_f64;
    for (bounce, sums) in estimate(walls, samples).iter().enumerate() {
        let of_photons = found.flux[bounce].into_iter().chain(NAMES.map(|name| found.landings[bounce][name]));
        for (ours, sums) in of_photons.zip(sums) {
            let samples = f64::from(samples);
            let theirs = sums.sum / samples;
            let variance = sums.variance_of_mean(samples) * (1.0 + samples / photons);
            // What neither has met has no deviation.
            if ours != theirs {
                farthest = farthest.max((ours - theirs).abs() / variance.sqrt());
            }
        }
    }
    farthest
}

#[test]
fn flux_and_landings_per_bounce_are_those_of_an_independent_estimate() {
    let scene = Scene::shipped("cornell-empty").unwrap();
    let settings = settings(200_000);
    let (_, tally) = traced(&scene, &settings);
    let emission = varikernel::photon::Emission::new(&scene, &settings).unwrap();
    let found = tally.landings(&scene, &emission);
    let mut walls = walls("empty");
    let deviation = farthest(&walls, 200_000.0, &found);
    assert!(deviation < TOLERANCE, "{deviation} deviations");

    // A floor 3 % darker is seen, and so is a lamp that is missing.
    let floor = walls.iter_mut().find(|wall| wall.name == "floor").unwrap();
    floor.reflectance *= 0.97;
    assert!(farthest(&walls, 200_000.0, &found) > TOLERANCE);
    walls.retain(|wall| wall.name != "lamp");
    assert!(farthest(&walls, 200_000.0, &found) > TOLERANCE);
}

#[test]
fn the_map_of_another_renderer_has_the_same_number_of_landings() {
    // 3,730,881 of 10^6 photons, with a deviation of about 2.9 √10^6 on that side (assets/maps/README.md).
    let scene = Scene::shipped("cornell-glass").unwrap();
    let emitted = 200_000;
    let (photons, _) = traced(&scene, &TraceSettings { bounces: Some(8), ..settings(emitted) });
    let per_photon = photons.len() as f64 / f64::from(emitted);
    let deviation = 2.9 * (1e-6 + 1.0 / f64::from(emitted)).sqrt();
    assert!((per_photon - 3.730_881).abs() < TOLERANCE * deviation, "{per_photon}");
}

/// The boxes' room with its open side closed by a wall that leaves `gap` at the floor.
fn closed(gap: f64) -> Scene {
    let front = format!(
        "\n[surfaces.front]\nmaterial = \"white\"\nquads = [
        [[0, {gap}, 0], [552.8, {gap}, 0], [556, 548.8, 0], [0, 548.8, 0]]]\n"
    );
    load(&(shipped_text("cornell_boxes.toml") + &front)).unwrap()
}

#[test]
fn no_light_leaks_through_walls() {
    let left = |gap| traced(&closed(gap), &settings(100_000)).1.ends.left;
    // About 700,000 rays, none of which gets out; a slit of a hundredth of a millimetre is seen.
    assert_eq!(left(0.0), 0);
    assert!(left(0.05) > 0);
}

#[test]
fn no_photon_lands_outside_the_room_or_inside_a_box() {
    let (photons, _) = traced(&closed(0.0), &settings(100_000));
    let walls = walls("boxes");
    let inside_box = |name: &str, position: DVec3| {
        walls.iter().filter(|wall| wall.name == name).all(|wall| {
            let [a, b, c] = wall.halves[0];
            (position - a).dot((b - a).cross(c - a).normalize()) < -1e-3
        })
    };
    // The middles of the boxes, to check the test itself.
    assert!(
        inside_box("tall", DVec3::new(368.0, 165.0, 351.0))
            && inside_box("short", DVec3::new(185.0, 82.0, 169.0))
    );
    for photon in &photons {
        let outside = photon.position.cmplt(Vec3::splat(-1e-3))
            | photon.position.cmpgt(Vec3::new(556.001, 548.801, 559.201));
        assert!(!outside.any(), "{photon:?}");
        let position = photon.position.as_dvec3();
        assert!(
            position.y < 1e-3 || !inside_box("tall", position) && !inside_box("short", position),
            "{photon:?}"
        );
    }
}
