//! The g-buffer against rays.

use glam::{UVec2, Vec3};
use varikernel::Image;
use varikernel::render::Renderer;
use varikernel::scene::{Scattering, Scene};
use varikernel::settings::{Kernel, KernelRadius};
use varikernel::view::View;

use crate::stage::settings;
use crate::support::egl;

/// Pixels whose surface is another than the ray's, and the largest distance from the ray's place where it is
/// the same.
fn differences(
    scene: &Scene,
    view: &View,
    position: &Image<[f32; 4]>,
    normal: &Image<[f32; 4]>,
) -> (u32, f32) {
    let (mut others, mut farthest) = (0, 0.0_f32);
    for y in 0..view.size().y {
        for x in 0..view.size().x {
            let hit = scene.cast(&view.ray(x, y));
            #[expect(clippy::cast_precision_loss, reason = "few surfaces")]
            let number = hit.map_or(0.0, |hit| {
                let is_diffuse =
                    matches!(scene.materials()[hit.material as usize].scattering, Scattering::Lambert(_));
                (hit.surface + 1) as f32 * if is_diffuse { 1.0 } else { -1.0 }
            });
            let [place_x, place_y, place_z, _] = position.at(x, y);
            if (normal.at(x, y)[3] - number).abs() > 0.5 {
                others += 1;
            } else if let Some(hit) = hit {
                let place = Vec3::new(place_x, place_y, place_z);
                farthest = farthest.max(place.distance(hit.position.as_vec3()));
            }
        }
    }
    (others, farthest)
}

#[test]
fn surfaces_are_where_rays_meet_them() {
    let gl = egl();
    for name in Scene::shipped_names() {
        let scene = Scene::shipped(name).unwrap();
        let settings = settings(96, Kernel::Box, KernelRadius::Fixed(1));
        let renderer = Renderer::with_photons(&gl, &scene, &settings, &[]).unwrap();
        let surfaces = renderer.surfaces();
        let (position, normal) = (surfaces.read_position().unwrap(), surfaces.read_normal().unwrap());
        let (low, high) = scene.bounds();
        let extent = (high - low).max_element();
        let (others, farthest) = differences(&scene, surfaces.view(), &position, &normal);
        assert!(others <= 96 * 96 / 200, "{name}: {others} pixels show another surface");
        assert!(farthest <= 2e-3 * extent, "{name}: a place is {farthest} of {extent} off");

        // A camera that looks by a pixel more to the right is seen.
        let mut moved = scene.clone();
        let right = moved.camera.direction.cross(moved.camera.up).normalize();
        moved.camera.direction =
            moved.camera.direction.normalize() + right * scene.view(UVec2::splat(96)).pixel_side();
        let view = moved.view(UVec2::splat(96));
        let (_, planted) = differences(&moved, &view, &position, &normal);
        assert!(planted > 2e-3 * extent, "{name}: {planted}");
    }
}

/// A box on a ground, seen from above, and `more`; all lengths times `scale`.
fn box_on_ground(scale: f64, more: &str) -> Scene {
    let place = |[x, y, z]: [f64; 3]| format!("[{:e}, {:e}, {:e}]", x * scale, y * scale, z * scale);
    let quad = |corners: [[f64; 3]; 4]| format!("[{}]", corners.map(place).join(", "));
    let floor = quad([[-3.0, 0.0, 3.0], [3.0, 0.0, 3.0], [3.0, 0.0, -3.0], [-3.0, 0.0, -3.0]]);
    let top = quad([[-0.4, 0.8, -0.4], [-0.4, 0.8, 0.4], [0.4, 0.8, 0.4], [0.4, 0.8, -0.4]]);
    let side = quad([[0.4, 0.0, -0.4], [0.4, 0.8, -0.4], [0.4, 0.8, 0.4], [0.4, 0.0, 0.4]]);
    crate::stage::scene(&format!(
        r#"
        [camera]
        position = {}
        direction = [-1, -0.9, -1]
        up = [0, 1, 0]
        vertical_fov_degrees = 40
        [lights.lamp]
        point = {}
        intensity = [30, 30, 30]
        [materials]
        grey = {{ lambert = [0.5, 0.5, 0.5] }}
        [surfaces]
        floor = {{ material = "grey", quads = [{floor}] }}
        box = {{ material = "grey", quads = [{top}, {side}], spheres = [{{ centre = {}, radius = {:e} }}] }}
        {more}
        "#,
        place([3.0, 3.0, 3.0]),
        place([0.0, 3.0, 0.0]),
        place([0.0, 1.0, 0.0]),
        0.2 * scale,
    ))
}

/// How many pixels show a surface, after a check that each shows the one that its ray meets, at its place.
#[track_caller]
fn seen(gl: &varikernel::Gl, scene: &Scene, scale: f64) -> usize {
    let settings = settings(96, Kernel::Box, KernelRadius::Fixed(1));
    let renderer = Renderer::with_photons(gl, scene, &settings, &[]).unwrap();
    let surfaces = renderer.surfaces();
    let (position, normal) = (surfaces.read_position().unwrap(), surfaces.read_normal().unwrap());
    let (others, farthest) = differences(scene, surfaces.view(), &position, &normal);
    assert!(others <= 96, "{others} pixels show another surface");
    // A pixel is 0.04 wide where the camera looks; places are a hundred times finer.
    assert!(f64::from(farthest) < 4e-4 * scale, "a place is {farthest} off");
    normal.values().iter().filter(|normal| normal[3] != 0.0).count()
}

#[test]
fn what_the_camera_sees_is_shown_however_large_or_small_the_rest_is() {
    let gl = egl();
    let alone = seen(&gl, &box_on_ground(1.0, ""), 1.0);
    assert!((3000..9000).contains(&alone), "{alone}");
    for (far, radius) in [(1e3, 1.0), (1e6, 1.0), (5e8, 1e8), (1e6, 1e-6)] {
        let stray = format!(
            "stray = {{ material = \"grey\", spheres = [{{ centre = [-{far:e}, -{far:e}, -{far:e}], radius = \
             {radius:e} }}] }}"
        );
        assert_eq!(seen(&gl, &box_on_ground(1.0, &stray), 1.0), alone, "a sphere of {radius} at {far}");
    }
    for scale in [1e-6, 1e-3, 1e3, 1e6] {
        assert_eq!(seen(&gl, &box_on_ground(scale, ""), scale), alone, "all lengths times {scale}");
    }
}

#[test]
fn a_ground_of_any_size_is_seen_to_the_horizon() {
    let gl = egl();
    for half in [1e3, 1e5, 1e6] {
        let ground = format!(
            "ground = {{ material = \"grey\", quads = [[[-{half:e}, -0.01, {half:e}], [{half:e}, -0.01, \
             {half:e}], [{half:e}, -0.01, -{half:e}], [-{half:e}, -0.01, -{half:e}]]] }}"
        );
        let scene = box_on_ground(1.0, &ground);
        assert_eq!(seen(&gl, &scene, 1.0), 96 * 96, "a ground of {half}");
    }
}
