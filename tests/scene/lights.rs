//! Lights: places on them, weak ones beside strong ones, and those that are far from everything.

use std::f64::consts::PI;
use std::sync::Arc;

use varikernel::glam::{DVec3, UVec2, Vec2, Vec3};
use varikernel::photon::{Emission, TraceSettings, reflected_by_pane};
use varikernel::scene::{AreaLight, LightShape, PlacedTexture, Scene, Texture, Wrap};

use crate::{load, settings, shipped_text, traced};

/// Mean intensity of samples on a grid, and how many of them lie where x is less than `x`.
fn sampled(light: &AreaLight, x: f64) -> (DVec3, usize) {
    const SIDE: u32 = 100;
    let middle = |step: u32| (f64::from(step) + 0.5) / f64::from(SIDE);
    let cells = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| [middle(row), middle(column)]));
    let samples: Vec<_> = cells.map(|uv| light.sample(uv)).collect();
    let sum: DVec3 = samples.iter().map(|sample| sample.intensity).sum();
    let left = samples.iter().filter(|sample| sample.position.x < x).count();
    (sum / f64::from(SIDE * SIDE), left)
}

#[test]
fn places_on_a_light_are_even_by_area_in_the_logarithm_of_its_triangles() {
    // A strip of 1000 squares of side 1, and one of side 100 beside it, each of two triangles.
    let square = |x: f32, side: f32| {
        let [a, b, c, d] = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)]
            .map(|(across, up)| Vec3::new(x + across, 0.0, -up));
        [[a, b, c], [a, c, d]]
    };
    let strip = (0..1000_u16).flat_map(|index| square(f32::from(index), 1.0));
    let triangles: Vec<_> = strip.chain(square(2000.0, 100.0)).collect();
    let light = AreaLight::new(triangles, Vec3::new(1.0, 2.0, 0.0), None);
    let (mean, left) = sampled(&light, 1500.0);
    assert!((mean - 11_000.0 * DVec3::new(1.0, 2.0, 0.0)).length() < 1e-6, "{mean}");
    // One of eleven places.
    assert!(left.abs_diff(909) <= 100, "{left}");
    assert!(light.sample([0.5, 0.5]).normal.distance(DVec3::Y) < 1e-12);
}

#[test]
fn a_light_with_a_texture_shines_where_the_texture_is_bright() {
    // Black on the left and white on the right, without a blend between.
    let texture =
        Texture::new("halves".to_owned(), UVec2::new(2, 1), vec![[0; 3], [255; 3]], [Wrap::Clamp; 2], false);
    let texture = Arc::new(texture);
    let corners = [Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0), Vec3::new(4.0, 2.0, 0.0), Vec3::new(0.0, 2.0, 0.0)];
    let places = corners.map(|corner| Vec2::new(corner.x / 4.0, corner.y / 2.0));
    let halves = |of: [usize; 3]| (of.map(|index| corners[index]), of.map(|index| places[index]));
    let (first, second) = (halves([0, 1, 2]), halves([0, 2, 3]));
    let hung = PlacedTexture { texture, coordinates: vec![first.1, second.1] };
    let light = AreaLight::new(vec![first.0, second.0], Vec3::splat(3.0), Some(hung));
    // Radiance 3 on half of an area of 8; most places are on the triangle with the larger bright part.
    let (mean, _) = sampled(&light, 0.0);
    assert!((mean.x - 12.0).abs() < 0.1, "{mean}");
    for uv in [[0.1, 0.2], [0.4, 0.9], [0.6, 0.5], [0.9, 0.1]] {
        let sample = light.sample(uv);
        assert_eq!(sample.intensity.x > 0.0, sample.position.x >= 2.0, "{sample:?}");
    }
}

#[test]
fn a_few_bright_texels_of_a_large_image_are_a_light() {
    // 2 x 2 of 512 x 512 texels, between all samples of 8 x 8 and of 256 x 256.
    let mut texels = vec![[0; 3]; 512 * 512];
    for (row, column) in [(300, 200), (300, 201), (301, 200), (301, 201)] {
        texels[row * 512 + column] = [255; 3];
    }
    let texture = Texture::new("led".to_owned(), UVec2::splat(512), texels, [Wrap::Clamp; 2], false);
    let corners = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    let half = |of: [usize; 3]| of.map(|index| corners[index]);
    let coordinates = vec![half([0, 1, 2]), half([0, 2, 3])];
    let triangles = coordinates.iter().map(|places| places.map(|place| place.extend(0.0))).collect();
    let hung = PlacedTexture { texture: Arc::new(texture), coordinates };
    let light = AreaLight::new(triangles, Vec3::splat(1e5), Some(hung));
    let light = varikernel::scene::Light { name: "led".to_owned(), of: None, shape: LightShape::Area(light) };
    assert!(light.flux().min_element() > 0.0);
}

#[test]
fn a_weak_light_beside_a_strong_one_gets_a_photon_with_all_of_its_power() {
    let weak = "\n[lights.led]\npoint = [100, 300, 100]\nintensity = [1e-6, 0, 0]\n\
                [lights.second]\npoint = [300, 100, 300]\nintensity = [1e-6, 1e-6, 0]\n";
    let scene = load(&(shipped_text("cornell_empty.toml") + weak)).unwrap();
    for photons in [3, 1000] {
        let settings = settings(photons);
        let emission = Emission::new(&scene, &settings).unwrap();
        let powers: Vec<_> = (0..photons).map(|id| emission.photon(id).power.as_dvec3()).collect();
        let sum: DVec3 = powers.iter().sum();
        assert!((sum / emission.flux() - 1.0).abs().max_element() < 1e-5, "{sum}");
        let led = 4.0 * PI * 1e-6;
        let of_led = powers.iter().filter(|power| (power.x / led - 1.0).abs() < 1e-5).count();
        assert_eq!(of_led, 2, "one for each of the weak lights");
    }
    let error = Emission::new(&scene, &settings(2)).unwrap_err().to_string();
    assert!(
        error.contains("photons = 2") && error.contains("3 lights") && error.contains("3 or more"),
        "{error}"
    );
}

/// A floor of 2 x 2 under `light`.
fn floor_under(light: &str) -> Scene {
    load(&format!(
        "
[camera]
position = [0, 5, 0]
direction = [0, -1, 0]
up = [0, 0, 1]
vertical_fov_degrees = 40
[materials]
black = {{ lambert = [0, 0, 0] }}
glow = {{ lambert = [0, 0, 0], emission = [2, 2, 2] }}
[surfaces.floor]
material = \"black\"
quads = [[[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]]
{light}"
    ))
    .unwrap()
}

/// A square of side 0.2 that shines downwards at a height.
fn square(height: f64) -> String {
    format!("[[-0.1, {height}, -0.1], [0.1, {height}, -0.1], [0.1, {height}, 0.1], [-0.1, {height}, 0.1]]")
}

/// Power that lands on the floor, and how many photons do.
fn lands(scene: &Scene) -> (f64, usize) {
    let (photons, _) = traced(scene, &TraceSettings { bounces: Some(1), ..settings(4000) });
    let floor = photons.iter().filter(|photon| photon.position.y.abs() < 1e-3);
    (floor.clone().map(|photon| f64::from(photon.power.x)).sum(), floor.count())
}

#[test]
fn a_light_that_is_far_aims_at_the_scene_with_the_power_that_goes_there() {
    for height in [100.0, 5e3, 1e6, 9e8] {
        let near_square = height * height;
        // Radiance · area of the light · area of the floor / height².
        let area = 2.0 * 0.04 * 4.0 / near_square;
        // Intensity · area / height²; the spot's cone holds the floor.
        let point = 3.0 * 4.0 / near_square;
        for (light, expected) in [
            (format!("[lights.lamp]\nquad = {}\nradiance = [2, 2, 2]", square(height)), area),
            (format!("[surfaces.lamp]\nmaterial = \"glow\"\nquads = [{}]", square(height)), area),
            (format!("[lights.lamp]\npoint = [0, {height}, 0]\nintensity = [3, 3, 3]"), point),
            (
                format!(
                    "[lights.lamp]\npoint = [0, {height}, 0]\nintensity = [3, 3, 3]\n\
                     direction = [0, -1, 0]\nangle_degrees = 20"
                ),
                point,
            ),
        ] {
            let scene = floor_under(&light);
            let (power, count) = lands(&scene);
            // The floor covers 4 / (2 π) of the sphere's disc, so that a share of 0.64 lands, within four
            // deviations.
            assert!(
                (count as f64 / 4000.0 - 2.0 / PI).abs() < 4.0 * (0.23_f64 / 4000.0).sqrt(),
                "{count}: {light}"
            );
            assert!((power / expected - 1.0).abs() < 0.05, "{power} instead of {expected}: {light}");
            // However far, no two land at one place.
            let (photons, tally) = traced(&scene, &TraceSettings { bounces: Some(1), ..settings(4000) });
            let places: std::collections::BTreeSet<_> =
                photons.iter().map(|photon| photon.position.to_array().map(f32::to_bits)).collect();
            assert!(places.len() + 5 > photons.len(), "{} of {}: {light}", places.len(), photons.len());
            // What is sent is what goes to the sphere around the floor, whose disc is π / 2 of the floor.
            assert!((tally.power_emitted().x / (expected * PI / 2.0) - 1.0).abs() < 0.01, "{light}");
        }
    }
}

#[test]
fn a_far_light_that_is_turned_away_sends_nothing() {
    let upwards = "[[-0.1, 100, 0.1], [0.1, 100, 0.1], [0.1, 100, -0.1], [-0.1, 100, -0.1]]";
    let away = format!("[surfaces.lamp]\nmaterial = \"glow\"\nquads = [{upwards}]");
    assert_eq!(lands(&floor_under(&away)).0, 0.0);
    // A spot that looks past the floor.
    let spot = "[lights.lamp]\npoint = [0, 100, 0]\nintensity = [3, 3, 3]\ndirection = [1, 0, 0]\n\
                angle_degrees = 20";
    assert_eq!(lands(&floor_under(spot)).0, 0.0);
}

#[test]
fn a_light_that_lights_itself_is_not_aimed_at_a_small_thing_beside_it() {
    // Two squares that face each other, and the floor far below.
    let other = "[[-0.1, 99, 0.1], [0.1, 99, 0.1], [0.1, 99, -0.1], [-0.1, 99, -0.1]]";
    let double = format!("[surfaces.lamp]\nmaterial = \"glow\"\nquads = [{}, {other}]", square(100.0));
    let scene = floor_under(&double);
    let settings = settings(1000);
    let emission = Emission::new(&scene, &settings).unwrap();
    let sum: f64 = (0..1000).map(|id| f64::from(emission.photon(id).power.x)).sum();
    assert!((sum / (PI * 0.08 * 2.0) - 1.0).abs() < 1e-5, "{sum}");
}

#[test]
fn a_sun_leaves_photons_for_a_lamp_by_what_both_send_to_the_scene() {
    // The sun sends 4π times as much as it takes to put on the sphere around the floor what the lamp sends in
    // all.
    let (lamp, distance) = (2.0, 1e7_f64);
    let sun = lamp * 4.0 * distance * distance / 2.0;
    let scene = floor_under(&format!(
        "[lights.sun]\npoint = [0, {distance:e}, 0]\nintensity = [{sun:e}, {sun:e}, {sun:e}]\n\
         [lights.lamp]\npoint = [0, 3, 0]\nintensity = [{lamp}, {lamp}, {lamp}]"
    ));
    let settings = settings(1000);
    let emission = Emission::new(&scene, &settings).unwrap();
    let of_lamp = (0..1000).filter(|&id| emission.photon(id).origin == Vec3::new(0.0, 3.0, 0.0)).count();
    assert_eq!(of_lamp, 500);
}

#[test]
fn a_light_inside_or_near_the_scene_is_not_aimed() {
    let near = format!("[lights.lamp]\nquad = {}\nradiance = [2, 2, 2]", square(2.0));
    let scene = floor_under(&near);
    let emission_settings = settings(1000);
    let emission = Emission::new(&scene, &emission_settings).unwrap();
    let LightShape::Area(light) = &scene.lights()[0].shape else { panic!("an area light") };
    assert_eq!(light.triangles().len(), 2);
    let sum: f64 = (0..1000).map(|id| f64::from(emission.photon(id).power.x)).sum();
    assert!((sum / (PI * 0.04 * 2.0) - 1.0).abs() < 1e-5, "{sum}");
}

#[test]
fn what_the_last_landing_cuts_off_is_what_reflection_would_have_sent_on() {
    // An integrating sphere: each landing keeps 0.9 of the power.
    let text = "
[camera]
position = [0, 0, 0]
direction = [0, 0, -1]
up = [0, 1, 0]
vertical_fov_degrees = 60
[lights.lamp]
point = [0, 0, 0]
intensity = [1, 2, 3]
[materials]
grey = { lambert = [0.9, 0.9, 0.9] }
[surfaces.sphere]
material = \"grey\"
spheres = [{ centre = [0, 0, 0], radius = 1 }]
";
    let scene = load(text).unwrap();
    for (bounces, left) in [(1, 0.9), (8, 0.430_467_21)] {
        let settings = TraceSettings { bounces: Some(bounces), ..settings(500) };
        let (_, tally) = traced(&scene, &settings);
        let share = tally.power_cut_off() / (4.0 * PI * DVec3::new(1.0, 2.0, 3.0));
        assert!((share - left).abs().max_element() < 1e-5, "{share}");
        let stats = tally.landings(&scene, &Emission::new(&scene, &settings).unwrap());
        assert!((DVec3::from_array(stats.cut_off) - left).abs().max_element() < 1e-5, "{:?}", stats.cut_off);
    }
}

#[test]
fn a_pane_reflects_twice_what_its_faces_do_less_what_goes_to_and_fro() {
    // (0.5 / 2.5)² = 0.04 for one face: 0.08 / 1.04.
    assert!((reflected_by_pane(1.0, 1.5) - 0.076_923).abs() < 1e-6);
    assert!((reflected_by_pane(0.0, 1.5) - 1.0).abs() < 1e-9);
    assert_eq!(reflected_by_pane(0.5, 1.0), 0.0);
}
