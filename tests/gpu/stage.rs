//! Scenes and photons that the tests of the picture's stages share.

use glam::{DVec3, UVec2, Vec3};
use varikernel::photon::{Emission, PhotonPoint, TraceSettings, trace};
use varikernel::reference::Shown;
use varikernel::render::Renderer;
use varikernel::scene::Scene;
use varikernel::settings::{Kernel, KernelRadius, PictureSettings};
use varikernel::view::View;
use varikernel::{Gl, Image};

/// A wall of 2 x 2 that fills the square picture of a camera at distance 1 exactly.
pub(crate) fn wall() -> Scene {
    let text = r#"
        title = "A wall"
        units = "m"
        [camera]
        position = [0, 0, 0]
        direction = [0, 0, -1]
        up = [0, 1, 0]
        vertical_fov_degrees = 90
        [lights.lamp]
        quad = [[-0.1, 3, 0.5], [0.1, 3, 0.5], [0.1, 3, 0.7], [-0.1, 3, 0.7]]
        radiance = [1, 1, 1]
        [materials]
        white = { lambert = [0.5, 0.5, 0.5] }
        [surfaces.wall]
        material = "white"
        quads = [[[-4, -4, -1], [4, -4, -1], [4, 4, -1], [-4, 4, -1]]]
    "#;
    scene(text)
}

/// Surfaces before a camera at the origin that looks along -z over 90 degrees; materials `white` and `glass`.
pub(crate) fn before_the_camera(surfaces: &str) -> Scene {
    let text = "
        [camera]
        position = [0, 0, 0]
        direction = [0, 0, -1]
        up = [0, 1, 0]
        vertical_fov_degrees = 90
        [lights.lamp]
        point = [0, 0, 0]
        intensity = [1, 1, 1]
        [materials]
        white = { lambert = [0.5, 0.5, 0.5] }
        glass = { dielectric = 1.5 }
    ";
    scene(&format!("{text}{surfaces}"))
}

pub(crate) fn scene(text: &str) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.toml");
    std::fs::write(&file, text).unwrap();
    Scene::load(&file).unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn settings(side: u32, kernel: Kernel, radius: KernelRadius) -> PictureSettings {
    PictureSettings {
        size: UVec2::splat(side),
        kernel,
        radius,
        light_samples: 1,
        antialias: 1,
        ..PictureSettings::default()
    }
}

/// A photon where the pixel `x + dx`, `y + dy` looks, on the side that is seen.
pub(crate) fn photon_at(scene: &Scene, view: &View, x: u32, y: u32, power: f32) -> Option<PhotonPoint> {
    let ray = view.ray(x, y);
    let hit = scene.cast(&ray)?;
    let side = if hit.normal.dot(ray.direction) <= 0.0 { 1.0 } else { -1.0 };
    #[expect(clippy::cast_precision_loss, reason = "few surfaces")]
    let surface = (hit.surface + 1) as f32;
    Some(PhotonPoint {
        position: hit.position.as_vec3(),
        normal: (side * hit.normal).as_vec3(),
        power: Vec3::splat(power),
        surface,
    })
}

/// The indirect photons of a scene.
pub(crate) fn traced(scene: &Scene, photons: u32, seed: u64) -> Vec<PhotonPoint> {
    let settings = TraceSettings { photons, bounces: Some(4), seed, ..TraceSettings::default() };
    let emission = Emission::new(scene, &settings).unwrap();
    let (photons, _) = trace(scene, &emission);
    photons.iter().filter(|photon| !photon.is_direct()).map(PhotonPoint::new).collect()
}

/// What the renderer's pixels show, for the definition on the CPU.
pub(crate) fn shown(renderer: &Renderer) -> Shown {
    let surfaces = renderer.surfaces();
    Shown {
        view: *surfaces.view(),
        position: surfaces.read_position().unwrap(),
        normal: surfaces.read_normal().unwrap(),
    }
}

/// Irradiance by photons that the test gives.
pub(crate) fn irradiance(
    gl: &Gl,
    scene: &Scene,
    settings: &PictureSettings,
    photons: &[PhotonPoint],
) -> (Image<[f32; 3]>, Renderer) {
    let mut renderer = Renderer::with_photons(gl, scene, settings, photons).unwrap();
    let (layers, _) = renderer.picture(settings).unwrap();
    (layers.irradiance, renderer)
}

/// Root of the mean squared difference over that of `expected`.
pub(crate) fn relative_difference(found: &Image<[f32; 3]>, expected: &Image<[f64; 3]>) -> f64 {
    let pairs = found.values().iter().zip(expected.values());
    let (mut apart, mut whole) = (0.0, 0.0);
    for (found, expected) in pairs {
        let found = Vec3::from(*found).as_dvec3();
        let expected = DVec3::from(*expected);
        apart += found.distance_squared(expected);
        whole += expected.length_squared();
    }
    (apart / whole).sqrt()
}
