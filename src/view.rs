//! A camera and the pixels of its picture: where a place is seen, and along which ray a pixel looks.

use glam::{DVec3, Mat4, UVec2, Vec3};

use crate::scene::{Camera, Ray, Scene};

/// A picture's geometry. Row 0 is the top of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    size: UVec2,
    camera: Camera,
    to_clip: Mat4,
    direction: Vec3,
    pixel_side: f32,
}

impl View {
    /// The scene as its camera sees it in a picture of `size`, all of it between the near and the far plane.
    #[must_use]
    pub fn new(scene: &Scene, size: UVec2) -> Self {
        let camera = scene.camera;
        let (min, max) = scene.bounds();
        let (near, far) = camera.depth_range(min, max);
        #[expect(clippy::cast_precision_loss, reason = "sides are far below 2^24")]
        let [width, height] = size.to_array().map(|side| side as f32);
        let tall = 2.0 * (camera.vertical_fov_degrees.to_radians() / 2.0).tan();
        // Row 0 is the first in memory, which for OpenGL is at the bottom.
        let flipped = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0));
        let to_clip = flipped * camera.projection(width / height, near, far) * camera.view();
        Self { size, camera, to_clip, direction: camera.direction.normalize(), pixel_side: tall / height }
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// The pinhole, in scene units.
    #[must_use]
    pub fn position(&self) -> Vec3 {
        self.camera.position
    }

    /// The way the camera looks, of length 1.
    #[must_use]
    pub fn direction(&self) -> Vec3 {
        self.direction
    }

    /// From scene units to OpenGL's clip space, with row 0 at the bottom.
    #[must_use]
    pub fn to_clip(&self) -> Mat4 {
        self.to_clip
    }

    /// Side of a pixel at depth 1 along the view.
    #[must_use]
    pub fn pixel_side(&self) -> f32 {
        self.pixel_side
    }

    /// The pixel in which a place is seen if nothing is before it; nothing outside of the picture.
    #[must_use]
    pub fn pixel_of(&self, place: Vec3) -> Option<UVec2> {
        let clip = self.to_clip * place.extend(1.0);
        if clip.w <= 0.0 {
            return None;
        }
        let pixel = ((clip.truncate().truncate() / clip.w * 0.5 + 0.5) * self.size.as_vec2()).floor();
        let inside = pixel.cmpge(glam::Vec2::ZERO).all() && pixel.cmplt(self.size.as_vec2()).all();
        inside.then(|| pixel.as_uvec2())
    }

    /// The ray through the middle of a pixel.
    #[must_use]
    pub fn ray(&self, x: u32, y: u32) -> Ray {
        let forward = self.direction.as_dvec3();
        let right = forward.cross(self.camera.up.as_dvec3()).normalize();
        let up = right.cross(forward);
        let side = f64::from(self.pixel_side);
        let across = (f64::from(x) + 0.5 - f64::from(self.size.x) / 2.0) * side;
        let above = (f64::from(self.size.y) / 2.0 - f64::from(y) - 0.5) * side;
        let direction: DVec3 = forward + across * right + above * up;
        Ray { origin: self.position().as_dvec3(), direction: direction.normalize() }
    }
}
