//! The g-buffer against rays.

use glam::{UVec2, Vec3};
use varikernel::Image;
use varikernel::render::Renderer;
use varikernel::scene::{Scattering, Scene};
use varikernel::settings::{Kernel, RadiusChoice};
use varikernel::view::View;

use crate::stage::settings;
use crate::support::egl;

/// Pixels whose surface is another than the ray's, and the largest distance from the ray's place where it is the same.
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
        let settings = settings(96, Kernel::Box, RadiusChoice::Fixed(1));
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
