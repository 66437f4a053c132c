//! A room with a glass ball, whose lamp and camera move.

use glam::Vec3;
use varikernel::error::Result;
use varikernel::scene::Scene;

/// Width of the room; it is as high and as deep.
const SIDE: f32 = 2.0;

/// The room with its lamp moved sideways, in scene units, and the camera as well.
pub(super) fn room(lamp: f32, camera: f32) -> Result<Scene> {
    let [left, right] = [lamp - 0.25, lamp + 0.25];
    let mut scene = Scene::parse(&format!(
        r#"
title = "A room with a glass ball"
[camera]
position = [0, 1, 4.6]
direction = [0, 0, -1]
up = [0, 1, 0]
vertical_fov_degrees = 34
[lights.lamp]
quad = [[{left}, 1.99, -0.25], [{right}, 1.99, -0.25], [{right}, 1.99, 0.25], [{left}, 1.99, 0.25]]
radiance = [10, 10, 10]
[materials]
white = {{ lambert = [0.7, 0.7, 0.7] }}
red = {{ lambert = [0.6, 0.1, 0.1] }}
glass = {{ dielectric = 1.5 }}
[surfaces.walls]
material = "white"
quads = [
  [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]],
  [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]],
  [[-1, 0, -1], [1, 0, -1], [1, 2, -1], [-1, 2, -1]],
  [[1, 0, -1], [1, 0, 1], [1, 2, 1], [1, 2, -1]],
]
[surfaces.side]
material = "red"
quads = [[[-1, 0, 1], [-1, 0, -1], [-1, 2, -1], [-1, 2, 1]]]
[surfaces.ball]
material = "glass"
spheres = [{{ centre = [0.3, 0.45, 0.2], radius = 0.35 }}]
"#
    ))?;
    scene.camera.position += Vec3::new(camera, 0.0, 0.0);
    Ok(scene)
}

/// A place between the two ends of a way that is a part of the room's width, for one of some frames.
#[expect(clippy::cast_precision_loss, reason = "a few frames")]
pub(super) fn along(part: f32, frame: u32, frames: u32) -> f32 {
    part * SIDE * (frame as f32 / (frames - 1).max(1) as f32 - 0.5)
}
