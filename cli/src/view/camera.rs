//! An orbit camera: around a place that it looks at, nearer and farther, and sideways.

use glam::{Quat, Vec3};
use varikernel::view::Camera;

/// Radians that a drag by one point turns.
const TURN: f32 = 0.006;
/// Least angle between the view and what is up, in radians.
const STEEPEST: f32 = 0.1;

/// A camera and what it looks at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orbit {
    home: Camera,
    target: Vec3,
    camera: Camera,
}

impl Orbit {
    /// Around the place straight ahead of `camera` that is as deep as the middle of the scene's box.
    pub(super) fn new(camera: Camera, (min, max): (Vec3, Vec3)) -> Self {
        let direction = camera.direction.normalize();
        let depth = ((min + max) / 2.0 - camera.position).dot(direction);
        // A camera that has the scene behind it turns around a place as far as the scene is large.
        let depth = if depth > 0.0 { depth } else { (max - min).length() };
        Self { home: camera, target: camera.position + depth * direction, camera }
    }

    pub(super) fn camera(&self) -> Camera {
        self.camera
    }

    /// Whether it is where the scene put it.
    pub(super) fn is_home(&self) -> bool {
        self.camera == self.home
    }

    /// Where the scene put it.
    pub(super) fn reset(&mut self, bounds: (Vec3, Vec3)) {
        *self = Self::new(self.home, bounds);
    }

    /// Puts it somewhere else; home stays home.
    pub(super) fn place(&mut self, camera: Camera, bounds: (Vec3, Vec3)) {
        *self = Self { home: self.home, ..Self::new(camera, bounds) };
    }

    /// Turns as if the scene were dragged by so many points to the right and down.
    pub(super) fn turn(&mut self, right: f32, down: f32) {
        let (up, offset) = (self.camera.up.normalize(), self.camera.position - self.target);
        let sideways = self.camera.direction.cross(up).normalize();
        let steep = offset.angle_between(up);
        let pitch = (-TURN * down).clamp(STEEPEST - steep, std::f32::consts::PI - STEEPEST - steep);
        let turned =
            Quat::from_axis_angle(up, -TURN * right) * Quat::from_axis_angle(-sideways, -pitch) * offset;
        self.camera.position = self.target + turned;
        self.camera.direction = -turned.normalize();
    }

    /// Goes nearer by a tenth of the distance for each notch of a wheel, or away.
    pub(super) fn zoom(&mut self, notches: f32) {
        let offset = self.camera.position - self.target;
        self.camera.position = self.target + offset * 0.9_f32.powf(notches.clamp(-20.0, 20.0));
    }

    /// Moves so that what it looks at follows a drag by so many picture heights to the right and down.
    pub(super) fn pan(&mut self, right: f32, down: f32) {
        let (up, forward) = (self.camera.up.normalize(), self.camera.direction.normalize());
        let sideways = forward.cross(up).normalize();
        let upwards = sideways.cross(forward);
        let tall = 2.0 * (self.camera.vertical_fov_degrees.to_radians() / 2.0).tan();
        let height = tall * (self.camera.position - self.target).length();
        let step = height * (down * upwards - right * sideways);
        self.camera.position += step;
        self.target += step;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At 10 on the z axis, and looks at the origin, in the middle of a box.
    fn orbit() -> Orbit {
        let camera =
            Camera { position: 10.0 * Vec3::Z, direction: -Vec3::Z, up: Vec3::Y, vertical_fov_degrees: 90.0 };
        Orbit::new(camera, (Vec3::splat(-1.0), Vec3::splat(1.0)))
    }

    #[track_caller]
    fn assert_near(found: Vec3, wanted: Vec3) {
        assert!((found - wanted).length() < 1e-4, "{found} is not {wanted}");
    }

    #[test]
    fn a_quarter_turn_by_hand() {
        let mut orbit = orbit();
        // The scene follows the mouse to the right, so that the camera goes to the left.
        orbit.turn(std::f32::consts::FRAC_PI_2 / TURN, 0.0);
        assert_near(orbit.camera().position, -10.0 * Vec3::X);
        assert_near(orbit.camera().direction, Vec3::X);
        assert!(!orbit.is_home());
        orbit.reset((Vec3::splat(-1.0), Vec3::splat(1.0)));
        assert!(orbit.is_home());
        assert_eq!(orbit.camera().position, 10.0 * Vec3::Z);
    }

    #[test]
    fn a_drag_down_lifts_the_camera_not_past_the_pole() {
        let mut orbit = orbit();
        orbit.turn(0.0, std::f32::consts::FRAC_PI_6 / TURN);
        assert_near(orbit.camera().position, Vec3::new(0.0, 5.0, 75.0_f32.sqrt()));
        orbit.turn(0.0, 1e6);
        let position = orbit.camera().position;
        assert!((position.angle_between(Vec3::Y) - STEEPEST).abs() < 1e-3, "{position}");
        orbit.turn(0.0, -1e6);
        assert!((orbit.camera().position.angle_between(-Vec3::Y) - STEEPEST).abs() < 1e-3);
    }

    #[test]
    fn a_notch_is_a_tenth_and_a_pan_follows_the_mouse() {
        let mut orbit = orbit();
        orbit.zoom(1.0);
        assert_near(orbit.camera().position, 9.0 * Vec3::Z);
        orbit.zoom(-1.0);
        // With 90 degrees, the picture is 20 units high at a distance of 10.
        orbit.pan(0.5, 0.25);
        assert_near(orbit.camera().position, Vec3::new(-10.0, 5.0, 10.0));
        orbit.turn(0.0, 0.0);
        assert_near(orbit.camera().position, Vec3::new(-10.0, 5.0, 10.0));
    }
}
