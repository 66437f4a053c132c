//! A pinhole camera and its matrices.

use glam::camera::rh::{proj, view};
use glam::{Mat4, Vec3};

/// A pinhole camera.
///
/// The picture's right is `direction × up`, as in OpenGL's right-handed view space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The pinhole, in scene units.
    pub position: Vec3,
    /// The way it looks; any length but zero.
    pub direction: Vec3,
    /// What is up in the picture; any length but zero, not along `direction`.
    pub up: Vec3,
    /// The angle between the lower and the upper edge of the picture, in degrees, more than 0 and less than
    /// 180.
    pub vertical_fov_degrees: f32,
}

impl Camera {
    /// From world space to view space, where the camera looks along -z.
    #[must_use]
    pub fn view(&self) -> Mat4 {
        view::look_to_mat4(self.position, self.direction.normalize(), self.up.normalize())
    }

    /// From view space to OpenGL's clip space, whose depth goes from -1 at `near` to 1 at `far`.
    ///
    /// `aspect` is width over height; `near` and `far` are distances along the view in scene units, with
    /// 0 < `near` < `far`.
    #[must_use]
    pub fn projection(&self, aspect: f32, near: f32, far: f32) -> Mat4 {
        proj::opengl::perspective(self.vertical_fov_degrees.to_radians(), aspect, near, far)
    }

    /// Distances that hold all of a box between its corners `min` and `max`, for [`Camera::projection`].
    ///
    /// Where the camera is inside the box or close to it, `near` is 10^-12 of `far`: enough for a projection,
    /// and for depth that a shader writes by distance, but too little for an ordinary depth buffer.
    #[must_use]
    pub fn depth_range(&self, min: Vec3, max: Vec3) -> (f32, f32) {
        let direction = self.direction.normalize();
        let depths = (0..8).map(|corner| {
            let pick = |bit: u8, low: f32, high: f32| if corner & (1 << bit) == 0 { low } else { high };
            let at = Vec3::new(pick(0, min.x, max.x), pick(1, min.y, max.y), pick(2, min.z, max.z));
            (at - self.position).dot(direction)
        });
        let (nearest, farthest) = depths
            .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), depth| (low.min(depth), high.max(depth)));
        // A little air, so that rounding cuts nothing off.
        let far = if farthest > 0.0 { farthest * 1.001 } else { 1.0 };
        ((0.999 * nearest).max(1e-12 * far), far)
    }
}
