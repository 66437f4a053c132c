//! A camera and the pixels of its picture: where a place is seen, along which ray a pixel looks.

mod camera;
mod ray;

pub use camera::Camera;
pub use ray::Ray;

use glam::{DVec2, DVec3, Mat4, UVec2, Vec3};

use crate::error::{Error, Result};

/// A picture's geometry: a pinhole camera with square pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    size: UVec2,
    to_clip: Mat4,
    position: Vec3,
    direction: Vec3,
    pixel_side: f32,
    /// The ray of a pixel goes along `to_corner + x * to_right + y * to_next_row`, for the pixel's middle in
    /// pixels.
    to_corner: DVec3,
    to_right: DVec3,
    to_next_row: DVec3,
}

impl View {
    /// What a camera sees between the distances `near` and `far` along its direction, in a picture of `size`;
    /// row 0 is the top of the picture.
    #[must_use]
    pub fn new(camera: &Camera, (near, far): (f32, f32), size: UVec2) -> Self {
        let [width, height] = size.as_vec2().to_array();
        let tall = 2.0 * (camera.vertical_fov_degrees.to_radians() / 2.0).tan();
        // Row 0 is the first in memory, which for OpenGL is at the bottom.
        let flipped = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0));
        let to_clip = flipped * camera.projection(width / height, near, far) * camera.view();
        let direction = camera.direction.normalize();
        let pixel_side = tall / height;

        let forward = direction.as_dvec3();
        let right = forward.cross(camera.up.as_dvec3()).normalize();
        let half = size.as_dvec2() / 2.0;
        let step = f64::from(pixel_side);
        let (to_right, to_next_row) = (step * right, -step * right.cross(forward));
        let to_corner = forward - half.x * to_right - half.y * to_next_row;
        let position = camera.position;
        Self { size, to_clip, position, direction, pixel_side, to_corner, to_right, to_next_row }
    }

    /// A host's camera by its matrices, column by column as for glUniformMatrix4fv: `view` from scene units
    /// to view space, where the camera looks along -z, and `projection` from there to OpenGL's clip space.
    ///
    /// Row 0 of the maps is what the host draws at the bottom of its viewport, unless its projection is
    /// flipped. A projection may be off centre, as one that is shifted by parts of a pixel, and its depth may
    /// be reversed or infinite.
    ///
    /// # Errors
    /// [`Error::Setting`] unless `view` only turns and moves, `projection` is a perspective one along z, and
    /// a pixel is as wide as it is tall (to a thousandth).
    pub fn from_matrices(view: Mat4, projection: Mat4, size: UVec2) -> Result<Self> {
        let refuse = |name, matrix: Mat4, reason: &str| {
            Err(Error::Setting { name, value: matrix.to_string(), reason: reason.to_owned() })
        };
        let turn = glam::Mat3::from_mat4(view);
        let identity = (turn * turn.transpose()).abs_diff_eq(glam::Mat3::IDENTITY, 1e-3);
        if !identity || turn.determinant() < 0.0 || view.row(3) != glam::Vec4::W {
            return refuse("view", view, "a view turns and moves, without scale, shear or reflection");
        }
        let columns = projection.to_cols_array_2d();
        let is_perspective = projection.row(3) == glam::Vec4::NEG_Z
            && columns[0][0] > 0.0
            && columns[1][1] != 0.0
            && [columns[0][1], columns[1][0], columns[3][0], columns[3][1]].iter().all(|&zero| zero == 0.0);
        if !is_perspective {
            return refuse(
                "projection",
                projection,
                "a perspective projection has 0, 0, -1, 0 as its last row",
            );
        }
        // Sides of a pixel at depth 1; row 0 is at the bottom if the second is not negative.
        let [width, height] = size.as_vec2().to_array();
        let [across, up] = [2.0 / (columns[0][0] * width), 2.0 / (columns[1][1] * height)];
        if size.min_element() == 0 || (across / up.abs() - 1.0).abs() > 1e-3 {
            return refuse(
                "projection",
                projection,
                "pixels have to be square; fit its aspect to the size of the maps",
            );
        }
        let [right, above, backward] = [0, 1, 2].map(|row| view.row(row).truncate().as_dvec3());
        let position = -(turn.transpose() * view.w_axis.truncate());
        let (to_right, to_next_row) = (f64::from(across) * right, f64::from(up) * above);
        // Where clip x and y are -1; an off-centre projection shifts both.
        let shift = |column: [f32; 4], axis: usize| -1.0 + f64::from(column[axis]);
        let to_corner = -backward
            + shift(columns[2], 0) / f64::from(columns[0][0]) * right
            + shift(columns[2], 1) / f64::from(columns[1][1]) * above;
        Ok(Self {
            size,
            to_clip: projection * view,
            position,
            direction: -backward.as_vec3(),
            pixel_side: across,
            to_corner,
            to_right,
            to_next_row,
        })
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Checks that maps of `size` go with it.
    pub(crate) fn check_size(&self, size: UVec2) -> Result<()> {
        if self.size == size {
            return Ok(());
        }
        Err(Error::size("view", size, self.size))
    }

    /// The pinhole, in scene units.
    #[must_use]
    pub fn position(&self) -> Vec3 {
        self.position
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

    /// From the pinhole to the picture's corner at depth 1, where column 0 and row 0 begin, and to the next
    /// column and row.
    #[cfg(feature = "scene")]
    pub(crate) fn rays(&self) -> [Vec3; 3] {
        [self.to_corner, self.to_right, self.to_next_row].map(DVec3::as_vec3)
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
        self.ray_at(DVec2::new(f64::from(x), f64::from(y)) + 0.5)
    }

    /// The ray through a place of the picture, in pixels from its corner.
    #[must_use]
    pub fn ray_at(&self, DVec2 { x, y }: DVec2) -> Ray {
        let direction = self.to_corner + x * self.to_right + y * self.to_next_row;
        Ray { origin: self.position.as_dvec3(), direction: direction.normalize() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera {
            position: Vec3::new(3.0, -2.0, 5.0),
            direction: Vec3::new(-0.4, 0.3, -2.0),
            up: Vec3::new(0.1, 1.0, 0.2),
            vertical_fov_degrees: 50.0,
        }
    }

    /// A place at `depth` on the ray of a pixel is seen in that pixel.
    fn assert_rays_agree(view: &View) {
        for (x, y) in [(0, 0), (7, 3), (31, 17), (12, 16)] {
            let ray = view.ray(x, y);
            let place = (ray.origin + 4.0 * ray.direction).as_vec3();
            assert_eq!(view.pixel_of(place), Some(UVec2::new(x, y)));
        }
    }

    #[test]
    fn rays_and_pixels_agree() {
        assert_rays_agree(&View::new(&camera(), (0.1, 100.0), UVec2::new(32, 18)));
    }

    #[test]
    fn the_matrices_of_a_camera_give_its_view_upside_down() {
        let (camera, size) = (camera(), UVec2::new(32, 18));
        let projection = camera.projection(32.0 / 18.0, 0.1, 100.0);
        let ours = View::new(&camera, (0.1, 100.0), size);
        let host = View::from_matrices(camera.view(), projection, size).unwrap();
        assert_rays_agree(&host);
        assert!(host.position().abs_diff_eq(ours.position(), 1e-5));
        assert!(host.direction().abs_diff_eq(ours.direction(), 1e-6));
        assert!((host.pixel_side() / ours.pixel_side() - 1.0).abs() < 1e-6);
        for (x, y) in [(0, 0), (31, 17), (12, 5)] {
            let (a, b) = (ours.ray(x, y).direction, host.ray(x, 17 - y).direction);
            assert!(a.abs_diff_eq(b, 1e-6), "{a} {b}");
        }
        // Flipped, as a host that draws to a texture with row 0 at the top.
        let flip = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0));
        let flipped = View::from_matrices(camera.view(), flip * projection, size).unwrap();
        assert_rays_agree(&flipped);
        assert!(flipped.ray(3, 4).direction.abs_diff_eq(ours.ray(3, 4).direction, 1e-6));
    }

    #[test]
    fn a_shifted_projection_shifts_its_rays() {
        let (camera, size) = (camera(), UVec2::new(32, 18));
        let mut projection = camera.projection(32.0 / 18.0, 0.1, 100.0);
        // By a quarter of a pixel to the right and half a pixel down.
        projection.z_axis.x += 0.25 * 2.0 / 32.0;
        projection.z_axis.y -= 0.5 * 2.0 / 18.0;
        let view = View::from_matrices(camera.view(), projection, size).unwrap();
        assert_rays_agree(&view);
        let ray = view.ray(7, 3);
        let clip = view.to_clip() * (ray.origin + 4.0 * ray.direction).as_vec3().extend(1.0);
        let pixel = (clip.truncate().truncate() / clip.w * 0.5 + 0.5) * size.as_vec2();
        assert!(pixel.abs_diff_eq(glam::Vec2::new(7.5, 3.5), 1e-3), "{pixel}");
    }

    #[test]
    fn matrices_that_are_no_camera_with_square_pixels_are_refused() {
        let camera = camera();
        let (size, good) = (UVec2::new(32, 18), camera.projection(32.0 / 18.0, 0.1, 100.0));
        let refused = |view, projection| match View::from_matrices(view, projection, size) {
            Err(Error::Setting { name, .. }) => name,
            other => panic!("{other:?}"),
        };
        assert_eq!(refused(camera.view(), camera.projection(1.0, 0.1, 100.0)), "projection");
        assert_eq!(refused(camera.view(), Mat4::IDENTITY), "projection");
        assert_eq!(refused(Mat4::from_scale(Vec3::splat(2.0)), good), "view");
        assert_eq!(refused(good, good), "view");
    }
}
