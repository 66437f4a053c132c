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

#[cfg(test)]
mod tests {
    use glam::{UVec2, Vec2, Vec3};

    use super::extents;
    use crate::image::Image;

    const SIZE: UVec2 = UVec2::new(201, 101);
    const MIDDLE: UVec2 = UVec2::new(100, 50);

    /// The extents of what a pixel shows: its height above the middle of the map, one pixel for one unit, its
    /// normal and its number.
    fn of(shown: impl Fn(Vec2) -> (f32, Vec3, u32)) -> Image<[u8; 4]> {
        let at = |x: u32, y: u32| {
            let place = UVec2::new(x, y).as_vec2() - MIDDLE.as_vec2();
            (place, shown(place))
        };
        let position = Image::from_fn(SIZE, |x, y| {
            let (place, (height, ..)) = at(x, y);
            place.extend(height).extend(1.0).to_array()
        });
        #[expect(clippy::cast_precision_loss, reason = "small numbers")]
        let normal = Image::from_fn(SIZE, |x, y| {
            let (_, (_, normal, number)) = at(x, y);
            normal.normalize().extend(number as f32).to_array()
        });
        extents(&position, &normal)
    }

    fn in_the_middle(extents: &Image<[u8; 4]>) -> [u8; 4] {
        extents.at(MIDDLE.x, MIDDLE.y)
    }

    /// Height and normal of a sphere, or a cylinder along the columns, of a radius.
    fn round(place: Vec2, radius: f32) -> (f32, Vec3) {
        let height = (radius * radius - place.length_squared()).max(0.0).sqrt();
        (height, place.extend(height))
    }

    #[test]
    fn a_plane_ends_with_the_picture_and_another_surface_beside_it_with_the_surface() {
        assert_eq!(in_the_middle(&of(|_| (0.0, Vec3::Z, 1))), [100, 100, 50, 50]);
        // A wide plane, longer than an extent can be.
        assert_eq!(of(|_| (0.0, Vec3::Z, 1)).at(0, 0), [0, 128, 0, 100]);
        let two = of(|place| (0.0, Vec3::Z, if place.x > 7.0 { 2 } else { 1 }));
        assert_eq!(in_the_middle(&two), [100, 7, 50, 50]);
        // The same surface, a step of a pixel's height higher; and a plane that is not lit.
        let step = of(|place| (if place.y > 3.0 { 1.0 } else { 0.0 }, Vec3::Z, 1));
        assert_eq!(in_the_middle(&step), [100, 100, 50, 3]);
        assert_eq!(in_the_middle(&of(|_| (0.0, Vec3::Z, 0))), [0; 4]);
    }

    #[test]
    fn a_slanted_plane_is_one_face() {
        // As a floor is seen: from pixel to pixel twice as far away as aside.
        let slanted = of(|place| (2.0 * place.x, Vec3::new(-2.0, 0.0, 1.0), 1));
        assert_eq!(in_the_middle(&slanted), [100, 100, 50, 50]);
    }

    #[test]
    fn a_sphere_ends_where_it_has_turned_by_26_degrees() {
        // The cosine of 0.9 has a sine of 0.4359.
        let sphere = of(|place| {
            let (height, normal) = round(place, 100.0);
            (height, normal, 1)
        });
        assert_eq!(in_the_middle(&sphere), [43; 4]);
        // Towards its rim a pixel turns by more, and away from it by less.
        let [inwards, outwards, ..] = sphere.at(MIDDLE.x + 80, MIDDLE.y);
        assert!(outwards < 20 && inwards > 30, "{inwards} {outwards}");
    }

    #[test]
    fn a_cylinder_ends_across_and_goes_on_along() {
        let cylinder = of(|place| {
            let (height, normal) = round(Vec2::new(place.x, 0.0), 50.0);
            (height, normal, 1)
        });
        assert_eq!(in_the_middle(&cylinder), [21, 21, 50, 50]);
    }

    #[test]
    fn a_fine_mesh_is_the_surface_that_it_stands_for_and_a_coarse_one_its_facets() {
        // A cylinder of facets that are so wide, each with its own normal.
        let mesh = |width: f32| {
            of(move |place| {
                let facet = width * (place.x / width).round();
                let (height, normal) = round(Vec2::new(facet, 0.0), 50.0);
                let slope = -normal.x / normal.z;
                (height + slope * (place.x - facet), normal, 1)
            })
        };
        // Facets turn by 3.4 degrees: the last one whose middle is within 21.8 pixels is whole.
        assert_eq!(in_the_middle(&mesh(3.0)), [22, 22, 50, 50]);
        // By 13.9 degrees at least.
        assert_eq!(in_the_middle(&mesh(12.0)), [5, 5, 50, 50]);
    }

    #[test]
    fn leaves_end_where_they_end() {
        // A thousand, each a surface, or all one that faces about; 4 pixels wide and 5 high.
        let leaf = |place: Vec2| ((place.x + 100.0) / 4.0).floor() + 51.0 * ((place.y + 50.0) / 5.0).floor();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small numbers")]
        let surfaces = of(move |place| (0.0, Vec3::Z, 1 + leaf(place) as u32));
        let facing = of(move |place| {
            let angle = 2.4 * leaf(place);
            let slope = Vec2::from_angle(angle);
            (-slope.dot(place), slope.extend(1.0), 1)
        });
        for (x, y) in (0..SIZE.x).flat_map(|x| (0..SIZE.y).map(move |y| (x, y))) {
            let last = |place: u32, side: u32, count: u32| (side - 1 - place % side).min(count - 1 - place);
            let expected = [x % 4, last(x, 4, SIZE.x), y % 5, last(y, 5, SIZE.y)]
                .map(|extent| u8::try_from(extent).unwrap());
            assert_eq!(surfaces.at(x, y), expected, "({x}, {y})");
            assert_eq!(facing.at(x, y), expected, "({x}, {y})");
        }
    }
}
