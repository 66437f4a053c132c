//! Direct light of pictures by its definition: everywhere, and exactly where nothing is between.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use varikernel::render::{Layers, Renderer};
use varikernel::scene::{LightShape, Scattering, Scene};
use varikernel::settings::{DirectLight, Kernel, KernelRadius, PictureSettings};
use varikernel::{Gl, Image, reference};

use crate::stage::{scene, settings};
use crate::support::egl;

const SIDE: u32 = 40;

fn asked(direct: DirectLight, seed: u64) -> PictureSettings {
    PictureSettings { direct, seed, light_samples: 16, ..settings(SIDE, Kernel::Box, KernelRadius::Fixed(1)) }
}

fn picture(gl: &Gl, scene: &Scene, settings: &PictureSettings) -> Layers {
    Renderer::with_photons(gl, scene, settings, &[]).unwrap().picture(settings).unwrap().0
}

/// Radiance by the definition where a pixel shows a diffuse surface that does not shine; else nothing.
fn defined(scene: &Scene, steps: u32) -> Image<Option<Vec3>> {
    let view = scene.view(glam::UVec2::splat(SIDE));
    Image::from_fn(view.size(), |x, y| {
        let ray = view.ray(x, y);
        let hit = scene.cast(&ray)?;
        let Scattering::Lambert(reflectance) = scene.scattering(&hit) else { return None };
        let facing = if hit.normal.dot(ray.direction) < 0.0 { hit.normal } else { -hit.normal };
        let is_dark = scene.emission(&hit, ray.direction) == Vec3::ZERO;
        let irradiance = reference::direct(scene, hit.position, facing, steps);
        is_dark.then(|| (reflectance.as_dvec3() * irradiance / PI).as_vec3())
    })
}

/// RMSE of green over its mean, and the largest difference over it.
fn differences(picture: &Image<[f32; 3]>, defined: &Image<Option<Vec3>>) -> (f64, f64) {
    let both = picture.values().iter().zip(defined.values());
    let pairs: Vec<_> =
        both.filter_map(|(found, known)| Some((f64::from(found[1]), f64::from(known.as_ref()?.y)))).collect();
    let count = f64::from(u32::try_from(pairs.len()).unwrap());
    let mean = pairs.iter().map(|(_, known)| known).sum::<f64>() / count;
    let squares: f64 = pairs.iter().map(|(found, known)| (found - known).powi(2)).sum();
    let largest = pairs.iter().map(|(found, known)| (found - known).abs()).fold(0.0, f64::max);
    ((squares / count).sqrt() / mean, largest / mean)
}

#[test]
fn a_picture_has_the_direct_light_of_the_definition() {
    let gl = egl();
    for (name, direct, rmse, largest) in [
        ("cornell-boxes", DirectLight::Traced, 0.01, 0.08),
        ("cornell-glass", DirectLight::Traced, 0.01, 0.08),
        ("still-life", DirectLight::Traced, 0.01, 0.2),
        ("cornell-boxes", DirectLight::ShadowMap, 0.05, 0.3),
    ] {
        let scene = Scene::shipped(name).unwrap();
        let known = defined(&scene, 24);
        let mut found = picture(&gl, &scene, &asked(direct, 1)).direct;
        let (by, most) = differences(&found, &known);
        assert!(by < rmse && most < largest, "{name}, {direct:?}: {by} {most}");
        // A pixel that is brighter by half is seen.
        let at = known.values().iter().position(|light| light.is_some_and(|light| light.y > 0.05)).unwrap();
        let (x, y) = (u32::try_from(at).unwrap() % SIDE, u32::try_from(at).unwrap() / SIDE);
        found.set(x, y, found.at(x, y).map(|light| 1.5 * light + 1.0));
        assert!(differences(&found, &known).1 > largest);
    }
}

#[test]
fn without_anything_between_there_is_no_noise_and_no_error() {
    let gl = egl();
    let scene = Scene::shipped("cornell-empty").unwrap();
    let [first, second] = [1, 2].map(|seed| picture(&gl, &scene, &asked(DirectLight::Traced, seed)).direct);
    assert_eq!(first.values(), second.values());
    let view = scene.view(glam::UVec2::splat(SIDE));
    for (x, y) in [(20, 35), (5, 20), (20, 20), (34, 12)] {
        let hit = scene.cast(&view.ray(x, y)).unwrap();
        let Scattering::Lambert(reflectance) = scene.scattering(&hit) else { panic!("a wall") };
        let lights = scene.lights().iter().map(|light| match &light.shape {
            LightShape::Area(area) => area.irradiance(hit.position, hit.normal).unwrap(),
            LightShape::Point { .. } => DVec3::ZERO,
        });
        let known = (reflectance.as_dvec3() * lights.sum::<DVec3>() / PI).as_vec3();
        let found = Vec3::from_array(first.at(x, y));
        assert!((found - known).abs().max_element() <= 1e-5 * known.max_element(), "{found} {known}");
    }
}

/// A floor below a lamp of `material`, and a board between them.
fn below(material: &str, lamps: &str) -> Scene {
    scene(&format!(
        "
[camera]
position = [0, 3, 0]
direction = [0, -1, 0]
up = [0, 0, -1]
vertical_fov_degrees = 60
[materials]
grey = {{ lambert = [0.5, 0.5, 0.5] }}
glow = {{ lambert = [0, 0, 0], emission = [3, 1.5, 1] }}
[surfaces.floor]
material = \"grey\"
quads = [[[-5, 0, 5], [5, 0, 5], [5, 0, -5], [-5, 0, -5]]]
[surfaces.board]
material = \"grey\"
quads = [[[-0.5, 1.5, -0.5], [0.5, 1.5, -0.5], [0.5, 1.5, 0.5], [-0.5, 1.5, 0.5]]]
[surfaces.lamp]
material = \"{material}\"
quads = [{lamps}]
"
    ))
}

/// A lamp of many small squares, some 8 above the floor.
fn squares(columns: u32) -> String {
    let corner = |index: u32| f64::from(index) * 2.0 / f64::from(columns) - 1.0;
    let one = |(i, j): (u32, u32)| {
        let (x, z, next_x, next_z) = (corner(i), corner(j), corner(i + 1), corner(j + 1));
        format!("[[{x}, 8, {z}], [{next_x}, 8, {z}], [{next_x}, 8, {next_z}], [{x}, 8, {next_z}]]")
    };
    let all = (0..columns).flat_map(|i| (0..columns).map(move |j| (i, j))).map(one);
    all.collect::<Vec<_>>().join(", ")
}

/// 648 triangles are more than are added up, so that samples tell how bright the lamp is.
#[test]
fn a_lamp_of_many_triangles_is_that_of_few() {
    let gl = egl();
    let few = below("glow", &squares(1));
    let known = defined(&few, 24);
    for (columns, rmse) in [(1, 0.01), (18, 0.03)] {
        let found = picture(&gl, &below("glow", &squares(columns)), &asked(DirectLight::Traced, 1)).direct;
        let (by, most) = differences(&found, &known);
        assert!(by < rmse && most < 0.2, "{columns}: {by} {most}");
    }
}

/// A picture of one pixel has no neighbours that tell of a penumbra, and four rays often see all of a lamp of
/// which a tenth is hidden: the pixel is right all the same.
#[test]
fn one_pixel_in_penumbra_is_right_for_every_seed() {
    let gl = egl();
    let mut scene = below("glow", &squares(1));
    // Beside the board's shadow.
    scene.camera.position.x = 0.8;
    scene.camera.position.y = 1.0;
    let usual = asked(DirectLight::Traced, 1);
    let size = glam::UVec2::ONE;
    let view = scene.view(size);
    let hit = scene.cast(&view.ray(0, 0)).unwrap();
    let irradiance = reference::direct(&scene, hit.position, hit.normal, 200);
    let known = 0.5 * irradiance.y / PI;
    let LightShape::Area(lamp) = &scene.lights()[0].shape else { panic!("a lamp of triangles") };
    let share = irradiance.y / lamp.irradiance(hit.position, hit.normal).unwrap().y;
    assert!((0.85..0.95).contains(&share), "in penumbra: {share}");
    for seed in 1..=24 {
        let settings = PictureSettings { size, seed, ..usual };
        let found = f64::from(picture(&gl, &scene, &settings).direct.at(0, 0)[1]);
        assert!((found / known - 1.0).abs() < 0.05, "{seed}: {found} {known}");
    }
}

/// More lamps than are looked at one by one, in three colours, with a board in the way of some.
#[test]
fn many_lamps_are_right_together() {
    let gl = egl();
    let lamps: Vec<String> = (0..100)
        .map(|lamp| {
            let (x, z) = (0.3 * f64::from(lamp % 10) - 1.35, 0.3 * f64::from(lamp / 10) - 1.35);
            let [left, right, far, near] = [x - 0.05, x + 0.05, z - 0.05, z + 0.05];
            format!(
                "[lights.lamp{lamp}]\nradiance = [{}, {}, {}]\nquad = [[{left}, 3, {far}], [{right}, 3, {far}], \
                 [{right}, 3, {near}], [{left}, 3, {near}]]\n",
                200 * (lamp % 3),
                100 * (1 + lamp % 2),
                50 * (lamp % 5)
            )
        })
        .collect();
    let board = "[surfaces.board]\nmaterial = \"grey\"\n\
                 quads = [[[-0.5, 1, -0.5], [0.5, 1, -0.5], [0.5, 1, 0.5], [-0.5, 1, 0.5]]]\n";
    let scene = scene(&format!(
        "
[camera]
position = [0, 0.9, 0]
direction = [0, -1, 0]
up = [0, 0, -1]
vertical_fov_degrees = 100
[materials]
grey = {{ lambert = [0.5, 0.5, 0.5] }}
[surfaces.floor]
material = \"grey\"
quads = [[[-5, 0, 5], [5, 0, 5], [5, 0, -5], [-5, 0, -5]]]
{board}{}",
        lamps.concat()
    ));
    let known = defined(&scene, 3);
    let found = picture(&gl, &scene, &asked(DirectLight::Traced, 1)).direct;
    let (by, most) = differences(&found, &known);
    // As noisy as rays are left, two hundredths of the light.
    assert!(by < 0.03 && most < 0.2, "{by} {most}");
    // Each colour by itself: lamps of one colour are blocked where others are not.
    for colour in [0, 2] {
        let errors = found.values().iter().zip(known.values()).filter_map(|(found, known)| {
            let known = known.as_ref()?[colour];
            Some(((found[colour] - known).powi(2), known))
        });
        let (squares, sum, count) = errors.fold((0.0, 0.0, 0.0), |(squares, sum, count), (square, known)| {
            (squares + f64::from(square), sum + f64::from(known), count + 1.0)
        });
        let rmse = (squares / count).sqrt() / (sum / count);
        assert!(rmse < 0.04, "{colour}: {rmse}");
    }
}
