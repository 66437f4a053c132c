//! What "the same face" means, and how far it goes.

use glam::{IVec2, Vec3, Vec4};

use crate::image::Image;

/// Extents go up to 2 to this, in pixels.
const DOUBLINGS: u32 = 7;
/// The least cosine between the normals of neighbours.
const NEIGHBOURS_AGREE: f32 = 0.98;
/// The least cosine between the normals of a box's middle and its ends.
const ENDS_AGREE: f32 = 0.9;

const WAYS: [IVec2; 4] = [IVec2::NEG_X, IVec2::X, IVec2::NEG_Y, IVec2::Y];

fn is_inside(size: glam::UVec2, at: IVec2) -> bool {
    at.cmpge(IVec2::ZERO).all() && at.cmplt(size.as_ivec2()).all()
}

/// Place, normal and number of what a pixel shows.
fn surface(position: &Image<[f32; 4]>, normal: &Image<[f32; 4]>, at: IVec2) -> (Vec3, Vec3, f32) {
    let at = at.as_uvec2();
    let facing = Vec4::from_array(normal.at(at.x, at.y));
    (Vec4::from_array(position.at(at.x, at.y)).truncate(), facing.truncate(), facing.w)
}

/// How many pixels the face of each goes on to the left, to the right, down (to lower rows) and up, from
/// what [`SurfaceMaps`](crate::SurfaceMaps) hold.
#[must_use]
pub fn extents(position: &Image<[f32; 4]>, normal: &Image<[f32; 4]>) -> Image<[u8; 4]> {
    let size = position.size();
    let surface = |at: IVec2| surface(position, normal, at);
    let agrees = |at: IVec2, other: IVec2| surface(at).1.dot(surface(other).1) >= ENDS_AGREE;
    Image::from_fn(size, |x, y| {
        let home = glam::UVec2::new(x, y).as_ivec2();
        WAYS.map(|way| {
            let mut chain = 0;
            while chain < 1 << DOUBLINGS {
                let (here, next) = (home + chain * way, home + (chain + 1) * way);
                if !is_inside(size, next) || !share_a_face(surface(here), surface(next)) {
                    break;
                }
                chain += 1;
            }
            if agrees(home, home + chain * way) {
                return u8::try_from(chain).unwrap_or_else(|_| unreachable!("at most 128"));
            }
            // By halving, as a curve that turns one way asks for.
            let mut length = 0;
            for step in (0..DOUBLINGS).rev().map(|step| 1 << step) {
                if length + step < chain && agrees(home, home + (length + step) * way) {
                    length += step;
                }
            }
            u8::try_from(length).unwrap_or_else(|_| unreachable!("less than 128"))
        })
    })
}

/// Which neighbours of each pixel are on its face: left, right, down and up; nothing past the picture's edge.
pub(super) fn links(position: &Image<[f32; 4]>, normal: &Image<[f32; 4]>) -> Image<[Option<bool>; 4]> {
    let size = position.size();
    let surface = |at: IVec2| surface(position, normal, at);
    Image::from_fn(size, |x, y| {
        let home = glam::UVec2::new(x, y).as_ivec2();
        WAYS.map(|way| is_inside(size, home + way).then(|| share_a_face(surface(home), surface(home + way))))
    })
}

/// Whether two neighbours are on one face: on the same surface, about as it faces, and neither off the other's
/// plane by more than a fifth of what lies between them.
#[expect(clippy::float_cmp, reason = "numbers of surfaces are whole")]
fn share_a_face(
    (position, normal, number): (Vec3, Vec3, f32),
    (other_position, other_normal, other_number): (Vec3, Vec3, f32),
) -> bool {
    if number <= 0.0 || number != other_number || normal.dot(other_normal) < NEIGHBOURS_AGREE {
        return false;
    }
    let away = other_position - position;
    let aside = normal.dot(away).abs().max(other_normal.dot(away).abs());
    aside * aside <= 0.04 * away.dot(away)
}
