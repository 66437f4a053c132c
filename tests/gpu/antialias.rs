//! Pixels that are areas: by hand, and where nothing should change.

use glam::UVec2;
use varikernel::photon::TraceSettings;
use varikernel::render::{Layers, Renderer};
use varikernel::scene::Scene;
use varikernel::settings::{Estimate, Kernel, KernelRadius, PictureSettings, PixelFilter};
use varikernel::{Gl, Image};

use crate::furnace::room;
use crate::stage::{scene, settings};
use crate::support::egl;

fn asked(side: u32, antialias: u32) -> PictureSettings {
    PictureSettings { antialias, light_samples: 16, ..settings(side, Kernel::Box, KernelRadius::Fixed(1)) }
}

fn picture(gl: &Gl, scene: &Scene, settings: &PictureSettings) -> Layers {
    Renderer::with_photons(gl, scene, settings, &[]).unwrap().picture(settings).unwrap().0
}

/// A lamp of radiance 1 whose right side goes through (`x`, 0) and (`x` + `slope`, 1), seen at a distance
/// where the picture is 2 wide. Behind it is nothing.
fn lamp(x: f64, slope: f64) -> Scene {
    scene(&format!(
        "
[camera]
position = [0, 0, 1]
direction = [0, 0, -1]
up = [0, 1, 0]
vertical_fov_degrees = 90
[materials]
glow = {{ lambert = [0, 0, 0], emission = [1, 1, 1] }}
[surfaces.lamp]
material = \"glow\"
quads = [[[-6, -2, 0], [{}, -2, 0], [{}, 2, 0], [-6, 2, 0]]]
",
        x - 2.0 * slope,
        x + 2.0 * slope
    ))
}

/// The part of a pixel of a picture of 8 by 8 that is left of the lamp's side, by a fine grid.
fn covered(x: f64, slope: f64, column: u32, row: u32) -> f64 {
    const STEPS: u32 = 200;
    let at =
        |index: u32, step: u32| (f64::from(index) + (f64::from(step) + 0.5) / f64::from(STEPS)) / 4.0 - 1.0;
    let inside = (0..STEPS * STEPS).filter(|step| {
        // The first row of a picture is its top.
        let (across, up) = (at(column, step % STEPS), -at(row, step / STEPS));
        across < x + slope * up
    });
    f64::from(u32::try_from(inside.count()).unwrap()) / f64::from(STEPS * STEPS)
}

#[test]
fn a_pixel_is_as_bright_as_the_part_of_it_that_shines() {
    let gl = egl();
    for (x, slope) in [(0.3, 0.0), (0.07, 0.5), (-0.4, -1.3)] {
        let scene = lamp(x, slope);
        let hard = picture(&gl, &scene, &asked(8, 1)).beauty;
        for (samples, tolerance) in [(4, 0.5), (16, 0.16), (64, 0.05), (1024, 0.006)] {
            let soft = picture(&gl, &scene, &asked(8, samples)).beauty;
            let mut worst: f64 = 0.0;
            let mut worst_without: f64 = 0.0;
            for (column, row) in (0..64).map(|pixel| (pixel % 8, pixel / 8)) {
                let known = covered(x, slope, column, row);
                let error = |image: &Image<[f32; 3]>| (f64::from(image.at(column, row)[1]) - known).abs();
                worst = worst.max(error(&soft));
                worst_without = worst_without.max(error(&hard));
            }
            assert!(worst < tolerance, "{x} {slope}, {samples}: {worst}");
            assert!(worst_without > 0.15, "stairs are seen: {worst_without}");
        }
    }
}

#[test]
fn pixels_inside_of_faces_stay_as_they_are_and_edges_do_not() {
    let gl = egl();
    let scene = Scene::shipped("cornell-boxes").unwrap();
    let trace = TraceSettings { photons: 20_000, ..TraceSettings::default() };
    let of = |antialias| {
        let settings = PictureSettings { estimate: Estimate::Tables, ..asked(64, antialias) };
        Renderer::new(&gl, &scene, &settings, &trace, &mut |_| ()).unwrap().picture(&settings).unwrap().0
    };
    let (middles, areas) = (of(1), of(16));
    let differing = |layer: fn(&Layers) -> &Image<[f32; 3]>| {
        let pairs = layer(&middles).values().iter().zip(layer(&areas).values());
        pairs.filter(|(middle, area)| middle.map(f32::to_bits) != area.map(f32::to_bits)).count()
    };
    for (count, name) in [
        (differing(|layers| &layers.beauty), "beauty"),
        (differing(|layers| &layers.direct), "direct"),
        (differing(|layers| &layers.indirect), "indirect"),
    ] {
        // Of 4096 pixels.
        assert!((200..1500).contains(&count), "{name}: {count}");
    }
    for (layer, name) in [
        (differing(|layers| &layers.irradiance), "irradiance"),
        (differing(|layers| &layers.normal), "normal"),
        (differing(|layers| &layers.albedo), "albedo"),
    ] {
        assert_eq!(layer, 0, "{name} is that of pixels' middles");
    }
    assert_eq!(middles.radius, areas.radius);
    // All of the light is still there.
    let mean = |image: &Image<[f32; 3]>| {
        image.values().iter().map(|light| f64::from(light[1])).sum::<f64>() / f64::from(64 * 64)
    };
    let (before, after) = (mean(&middles.indirect), mean(&areas.indirect));
    assert!((after / before - 1.0).abs() < 0.01, "{before} {after}");
}

#[test]
fn a_room_that_shines_evenly_has_no_seams() {
    let gl = egl();
    let ball = "[materials.glass]\ndielectric = 1.5\n[surfaces.ball]\nmaterial = \"glass\"\n\
                spheres = [{ centre = [-0.2, 0, -0.6], radius = 0.3 }]";
    for (others, tolerance) in [("", 1e-6), (ball, 5e-3)] {
        let scene = room("lambert = [0, 0, 0], emission = [1, 1, 1]", others);
        for filter in [PixelFilter::Box, PixelFilter::BlackmanHarris, PixelFilter::Mitchell] {
            let beauty = picture(&gl, &scene, &PictureSettings { filter, ..asked(24, 8) }).beauty;
            for light in beauty.values() {
                // Glass takes and gives nothing, but for ways that carry less than a thousandth.
                assert!(light.iter().all(|value| (value - 1.0).abs() <= tolerance), "{filter:?}: {light:?}");
            }
        }
    }
}

#[test]
fn a_pixel_of_one_a_row_and_a_view_of_nothing_are_possible() {
    let gl = egl();
    let scene = Scene::shipped("cornell-glass").unwrap();
    for size in [UVec2::new(1, 1), UVec2::new(40, 1), UVec2::new(1, 40)] {
        for filter in [PixelFilter::Box, PixelFilter::Mitchell] {
            let layers = picture(&gl, &scene, &PictureSettings { size, filter, ..asked(1, 8) });
            assert!(layers.beauty.values().iter().flatten().all(|value| value.is_finite() && *value >= 0.0));
        }
    }
    let mut away = scene.clone();
    away.camera.direction = -away.camera.direction;
    away.camera.position.z = -1e4;
    let layers = picture(&gl, &away, &asked(16, 8));
    assert!(layers.beauty.values().iter().flatten().all(|value| *value == 0.0));
}

#[test]
fn another_filter_keeps_what_is_even_and_where_things_are() {
    let gl = egl();
    // The floor's light falls off evenly to both sides of the picture's middle.
    let scene = scene(
        "
[camera]
position = [0, 0, 1]
direction = [0, 0, -1]
up = [0, 1, 0]
vertical_fov_degrees = 60
[lights.lamp]
point = [0, 0, 1]
intensity = [3, 3, 3]
[materials]
grey = { lambert = [0.5, 0.5, 0.5] }
[surfaces.wall]
material = \"grey\"
quads = [[[-4, -4, 0], [4, -4, 0], [4, 4, 0], [-4, 4, 0]]]
",
    );
    let usual = picture(&gl, &scene, &asked(16, 1)).beauty;
    for filter in [PixelFilter::BlackmanHarris, PixelFilter::Mitchell] {
        for antialias in [1, 8] {
            let found = picture(&gl, &scene, &PictureSettings { filter, ..asked(16, antialias) }).beauty;
            for (x, y) in (0..256).map(|pixel| (pixel % 16, pixel / 16)) {
                let [light, mirrored] = [(x, y), (15 - x, 15 - y)].map(|(x, y)| found.at(x, y)[1]);
                assert!((light / mirrored - 1.0).abs() < 1e-4, "{filter:?} {antialias}: nothing is moved");
                let is_inside = (2..14).contains(&x) && (2..14).contains(&y);
                assert!(!is_inside || (light / usual.at(x, y)[1] - 1.0).abs() < 0.02);
            }
        }
    }
}

#[test]
fn another_size_or_number_of_samples_is_that_of_before() {
    let gl = egl();
    let scene = Scene::shipped("cornell-boxes").unwrap();
    let before = PictureSettings { filter: PixelFilter::Mitchell, ..asked(24, 8) };
    let mut renderer = Renderer::with_photons(&gl, &scene, &before, &[]).unwrap();
    let first = renderer.picture(&before).unwrap().0.beauty;
    for size in [UVec2::splat(48), UVec2::splat(8)] {
        let after = PictureSettings { size, antialias: 1024, ..before };
        assert_eq!(renderer.picture(&after).unwrap().0.beauty, first);
    }
}
