//! How much of a pixel lies on the face that it shows: where photons that are counted tell the light, and
//! where they are too few because the pixel sees a part of the face.

use glam::UVec2;

use varikernel::error::Result;
use varikernel::gl::Gl;
use varikernel::image::Image;
use varikernel::reference::{Shown, tables};
use varikernel::render::draw_surfaces;
use varikernel::scene::Scene;

/// Places along each side of a pixel that are looked at: an odd number, so that one is its middle.
const FINER: u32 = 5;
/// As in the library's definition of which photons contribute: the least cosine between two normals.
const LEAST_AGREEMENT: f32 = 0.5;

/// Of each pixel of a picture.
#[derive(Debug)]
pub(super) struct Coverage {
    /// The area where photons count, over that of the plane through the pixel's middle; 0 where nothing
    /// diffuse is seen straight.
    pub(super) shares: Image<f64>,
    /// Whether the whole pixel and all eight neighbours are on one face.
    pub(super) inside: Image<bool>,
}

impl Coverage {
    /// Looks at a scene's picture of `size`, [`FINER`] times as fine.
    pub(super) fn of(gl: &Gl, scene: &Scene, size: UVec2) -> Result<Self> {
        let [coarse, fine] = [size, size * FINER].map(|size| shown(gl, scene, size));
        let (coarse, fine) = (coarse?, fine?);
        let found = Image::from_fn(size, |x, y| share(&coarse, &fine, UVec2::new(x, y)));
        let extents = tables::extents(&coarse.position, &coarse.normal);
        let is_inside = |x: u32, y: u32| {
            let on = |x: u32, ways: &[usize]| ways.iter().all(|&way| extents.at(x, y)[way] > 0);
            found.at(x, y).1 && on(x, &[0, 1, 2, 3]) && on(x - 1, &[2, 3]) && on(x + 1, &[2, 3])
        };
        let inside = |x, y| x > 0 && x + 1 < size.x && is_inside(x, y);
        Ok(Self { inside: Image::from_fn(size, inside), shares: found.map(|(share, _)| share) })
    }
}

fn shown(gl: &Gl, scene: &Scene, size: UVec2) -> Result<Shown> {
    let surfaces = draw_surfaces(gl, scene, scene.view(size))?;
    let (position, normal) = (surfaces.read_position()?, surfaces.read_normal()?);
    Ok(Shown { view: scene.view(size), position, normal })
}

/// The share of a pixel's area on which photons count, and whether they do on all of it.
fn share(coarse: &Shown, fine: &Shown, pixel: UVec2) -> (f64, bool) {
    let whole = coarse.area(pixel);
    if whole <= 0.0 {
        return (0.0, false);
    }
    let [x, y, z, depth] = coarse.position.at(pixel.x, pixel.y);
    let (place, facing) = (glam::Vec3::new(x, y, z), coarse.normal.at(pixel.x, pixel.y));
    let normal = glam::Vec3::new(facing[0], facing[1], facing[2]);
    let (mut area, mut covered) = (0.0, 0);
    for row in 0..FINER {
        for column in 0..FINER {
            let at = pixel * FINER + UVec2::new(column, row);
            let [x, y, z, _] = fine.position.at(at.x, at.y);
            let [normal_x, normal_y, normal_z, number] = fine.normal.at(at.x, at.y);
            let off = normal.dot(glam::Vec3::new(x, y, z) - place).abs();
            let agrees = normal.dot(glam::Vec3::new(normal_x, normal_y, normal_z)) > LEAST_AGREEMENT;
            let is_same = (number - facing[3]).abs() < 0.5;
            if is_same && agrees && off <= 0.5 * coarse.view.pixel_side() * depth {
                area += fine.area(at);
                covered += 1;
            }
        }
    }
    // The middle counts in any case, so that nothing is divided by 0.
    let least = 1.0 / f64::from(FINER * FINER);
    ((area / whole).max(least), covered == FINER * FINER)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use varikernel::scene::Camera;
    use varikernel::view::View;

    use super::*;

    /// A plane at a distance of 10, seen head on, whose surface a function of the column and row tells.
    fn plane(size: u32, surface: impl Fn(u32, u32) -> f32) -> Shown {
        let camera =
            Camera { position: Vec3::ZERO, direction: Vec3::NEG_Z, up: Vec3::Y, vertical_fov_degrees: 40.0 };
        let view = View::new(&camera, (1.0, 100.0), UVec2::splat(size));
        let place = |x, y| {
            let direction = view.ray(x, y).direction.as_vec3();
            let at = direction * (-10.0 / direction.z);
            [at.x, at.y, at.z, 10.0]
        };
        Shown {
            view,
            position: Image::from_fn(UVec2::splat(size), place),
            normal: Image::from_fn(UVec2::splat(size), |x, y| [0.0, 0.0, 1.0, surface(x, y)]),
        }
    }

    /// Of the five columns of a pixel's places, another face takes two, and the pixel keeps three fifths.
    #[test]
    fn a_pixel_sees_a_part_of_its_face() {
        let coarse = plane(3, |_, _| 1.0);
        let fine = plane(3 * FINER, |x, _| if x < 8 { 1.0 } else { 2.0 });
        for (pixel, expected, is_whole) in [([0, 1], 1.0, true), ([1, 0], 0.6, false), ([2, 2], 0.04, false)]
        {
            let (found, whole) = share(&coarse, &fine, UVec2::from_array(pixel));
            assert!((found - expected).abs() < 1e-4 && whole == is_whole, "{pixel:?}: {found}");
        }
        // What is not diffuse has no share.
        let (none, whole) = share(&plane(3, |_, _| 0.0), &fine, UVec2::ONE);
        assert!(none.abs() < 1e-12 && !whole);
    }
}
