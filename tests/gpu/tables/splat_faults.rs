//! What splats do wrong and light from tables does not: light piled up in the middle of small faces, widths
//! that faint photons shrink, noise that stays as photons come.

use glam::{UVec2, Vec3};
use varikernel::photon::PhotonPoint;
use varikernel::render::draw_surfaces;
use varikernel::settings::{Estimate, IrradianceSettings, Search, Settings};
use varikernel::{Gl, Image, IrradiancePipeline, PhotonPoints, SurfaceMaps};

use crate::stage::before_the_camera;
use crate::support::egl;

const SIZE: UVec2 = UVec2::splat(64);
/// Half of the plate's side; pixels of 0.028125 at its distance: 16 x 16 whole ones, from pixel 24 on.
const HALF: f32 = 0.225;

/// A wall that fills the picture, number 1, with a plate before it, number 2.
fn plate(gl: &Gl) -> SurfaceMaps {
    let scene = before_the_camera(
        r#"
        [surfaces.a_wall]
        material = "white"
        quads = [[[-4, -4, -1], [4, -4, -1], [4, 4, -1], [-4, 4, -1]]]
        [surfaces.plate]
        material = "white"
        quads = [[[-0.225, -0.225, -0.9], [0.225, -0.225, -0.9], [0.225, 0.225, -0.9], [-0.225, 0.225, -0.9]]]
        "#,
    );
    draw_surfaces(gl, &scene, scene.view(SIZE)).unwrap()
}

/// Photons of one power scattered evenly over a square in the plane of a surface.
fn even(count: u32, half: f32, z: f32, surface: f32, power: f32) -> Vec<PhotonPoint> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64 ^ u64::from(count);
    let mut place = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        #[expect(clippy::cast_precision_loss, reason = "24 bits")]
        let share = (state >> 40) as f32 / 16_777_216.0;
        half * (2.0 * share - 1.0)
    };
    let photon = |_| PhotonPoint {
        position: Vec3::new(place(), place(), z),
        normal: Vec3::Z,
        power: Vec3::splat(power),
        surface,
    };
    (0..count).map(photon).collect()
}

/// Light and radii of photons.
fn lit(gl: &Gl, surfaces: &SurfaceMaps, photons: &[PhotonPoint], settings: IrradianceSettings) -> Lit {
    let mut pipeline = IrradiancePipeline::new(gl, SIZE, settings).unwrap();
    let mut points = PhotonPoints::new(gl);
    points.upload(photons).unwrap();
    let light = pipeline.render(surfaces, &points).unwrap().read().unwrap();
    Lit { light: light.map(|pixel| pixel[0]), radius: pipeline.radii().unwrap().read().unwrap() }
}

/// By an estimate, and n for splats.
fn settings(estimate: Estimate, min_photons: u32) -> IrradianceSettings {
    let usual = IrradianceSettings::default();
    let search = Search { min_photons, ..usual.radii.search };
    IrradianceSettings { estimate, radii: Settings { search, ..usual.radii }, ..usual }
}

struct Lit {
    light: Image<f32>,
    radius: Image<u32>,
}

/// Means over the pixels that are so many away from the plate's rim: 0 to 7.
fn rings(light: &Image<f32>) -> [f32; 8] {
    let mut sums = [(0.0, 0.0); 8];
    for (x, y) in (0..16).flat_map(|x| (0..16_u32).map(move |y| (x, y))) {
        let ring = [x, y, 15 - x, 15 - y].into_iter().min().unwrap();
        let (sum, count) = &mut sums[ring as usize];
        *sum += light.at(24 + x, 24 + y);
        *count += 1.0;
    }
    sums.map(|(sum, count)| sum / count)
}

#[test]
fn a_small_face_is_as_bright_at_its_rim_as_in_its_middle() {
    let gl = egl();
    let surfaces = plate(&gl);
    let mut photons = even(100_000, HALF, -0.9, 2.0, 1.0);
    photons.extend(even(20_000, 1.0, -1.0, 1.0, 1.0));
    let exact = 100_000.0 / (4.0 * HALF * HALF);
    let of = |estimate| {
        // 50 of the 256 pixels.
        let light = lit(&gl, &surfaces, &photons, settings(estimate, 20_000)).light;
        rings(&light).map(|light| light / exact)
    };
    let tables = of(Estimate::Tables);
    assert!(tables.iter().all(|ring| (ring - 1.0).abs() < 0.04), "{tables:?}");
    let splat = of(Estimate::Splat);
    assert!(splat[7] > 1.1 * splat[0], "{splat:?}");
}

#[test]
fn faint_photons_do_not_make_light_noisier() {
    let gl = egl();
    let surfaces = plate(&gl);
    let few = even(4000, 1.0, -1.0, 1.0, 1.0);
    let mut many = few.clone();
    many.extend(even(40_000, 1.0, -1.0, 1.0, 1e-4));
    let mean = |estimate, photons: &[PhotonPoint]| {
        let radius = lit(&gl, &surfaces, photons, settings(estimate, 400)).radius;
        radius.values().iter().map(|&radius| f64::from(radius)).sum::<f64>()
    };
    let of = |estimate| mean(estimate, &many) / mean(estimate, &few);
    let tables = of(Estimate::Tables);
    assert!((0.95..1.05).contains(&tables), "{tables}");
    let splat = of(Estimate::Splat);
    assert!(splat < 0.5, "{splat}");
}

#[test]
fn noise_falls_as_photons_come() {
    let gl = egl();
    let surfaces = plate(&gl);
    let is_wall = |x: u32, y: u32| !((24..40).contains(&x) && (24..40).contains(&y));
    let noise = |estimate, count: u32| {
        let photons = even(count, 1.0, -1.0, 1.0, 1.0);
        let light = lit(&gl, &surfaces, &photons, settings(estimate, 400)).light;
        #[expect(clippy::cast_precision_loss, reason = "a count")]
        let exact = count as f32 / 4.0;
        let wall = (0..SIZE.x).flat_map(|x| (0..SIZE.y).map(move |y| (x, y))).filter(|&(x, y)| is_wall(x, y));
        wall.map(|(x, y)| (light.at(x, y) / exact - 1.0).powi(2)).sum::<f32>().sqrt()
    };
    let of = |estimate| noise(estimate, 100_000) / noise(estimate, 4000);
    let tables = of(Estimate::Tables);
    // By the square root of 25.
    assert!(tables < 0.4, "{tables}");
    let splat = of(Estimate::Splat);
    assert!(splat > 0.5, "{splat}");
}
