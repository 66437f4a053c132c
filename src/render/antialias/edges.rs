//! Pixels that may show more than one thing: beside them something else begins.

use glam::{IVec2, UVec2, Vec3};

use crate::image::Image;
use crate::render::neighbours::Neighbours;
use crate::render::sight::{First, Place};

/// The least cosine between the normals of neighbours on one face.
const AGREEMENT: f64 = 0.98;
/// A neighbour lies off the other's plane by at most this part of what is between them.
const ASIDE: f64 = 0.2;
/// Reflectances differ by more than this at an edge of a texture.
const CONTRAST: f32 = 0.1;
/// Direct light differs at an edge of a shadow by more than this part of the larger one, and than that of the
/// picture's median: else it is penumbra, or its noise.
const SHADOW: f32 = 0.25;
const SHADOW_OF_USUAL: f32 = 0.1;

/// Direct light that differs by so many times the usual one is a lamp and what is beside it.
const LAMP: f32 = 4.0;

/// Right, and the next row: with those before, all four neighbours.
const WAYS: [IVec2; 2] = [IVec2::X, IVec2::Y];
/// Those at corners, where lamps alone are so bright that the corner of a pixel counts.
const CORNERS: [IVec2; 2] = [IVec2::ONE, IVec2::new(-1, 1)];

/// The pixels at edges, in their order, by what each meets first, what is `bent` there, and the direct light at
/// its middle, which is [`usual`] in the picture.
pub(super) fn edges(
    firsts: &[First],
    bent: &Neighbours<'_>,
    direct: &Image<[f32; 4]>,
    usual: f32,
) -> Vec<u32> {
    let size = direct.size();
    let least = SHADOW_OF_USUAL * usual;
    let differ = |pixel: u32, other: u32| {
        !share_a_face(&firsts[pixel as usize], &firsts[other as usize])
            || in_contrast(of(direct, pixel), of(direct, other), least)
            || show_differs(bent, pixel, other)
    };
    let is_lamps_edge =
        |pixel: u32, other: u32| in_contrast(of(direct, pixel), of(direct, other), LAMP * usual);
    let mut is_edge = vec![false; size.element_product() as usize];
    for pixel in 0..size.element_product() {
        let beside = |way: &IVec2| {
            let at = UVec2::new(pixel % size.x, pixel / size.x).as_ivec2() + *way;
            let is_inside = at.cmpge(IVec2::ZERO).all() && at.cmplt(size.as_ivec2()).all();
            is_inside.then(|| at.as_uvec2().y * size.x + at.as_uvec2().x)
        };
        let others = WAYS.iter().filter_map(beside).filter(|&other| differ(pixel, other));
        let corners = CORNERS.iter().filter_map(beside).filter(|&other| is_lamps_edge(pixel, other));
        for other in others.chain(corners) {
            is_edge[pixel as usize] = true;
            is_edge[other as usize] = true;
        }
    }
    (0..).zip(is_edge).filter_map(|(pixel, is_edge)| is_edge.then_some(pixel)).collect()
}

fn of(image: &Image<[f32; 4]>, pixel: u32) -> Vec3 {
    let [red, green, blue, _] = image.values()[pixel as usize];
    Vec3::new(red, green, blue)
}

/// Whether two neighbours show one face, whatever it is made of; or nothing, both.
fn share_a_face(first: &First, other: &First) -> bool {
    if first.surface != other.surface {
        return false;
    }
    let away = other.position - first.position;
    let aside = first.normal.dot(away).abs().max(other.normal.dot(away).abs());
    first.surface == 0
        || first.normal.dot(other.normal) >= AGREEMENT
            && aside <= ASIDE * away.length()
            && (first.reflectance - other.reflectance).abs().max_element() <= CONTRAST
}

/// The median of direct light over the pixels that show a lit surface straight: lamps are far brighter.
pub(super) fn usual(direct: &Image<[f32; 4]>) -> f32 {
    let lit = direct.values().iter().filter(|light| light[3] > 0.0);
    let mut values: Vec<f32> = lit.map(|light| light[0].max(light[1]).max(light[2])).collect();
    values.retain(|&value| value > 0.0);
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f32::total_cmp).1 }
}

fn in_contrast(light: Vec3, other: Vec3, least: f32) -> bool {
    ((light - other).abs().cmpgt((SHADOW * light.max(other)).max(Vec3::splat(least)))).any()
}

/// Whether two pixels show different things in mirrors and through glass.
fn show_differs(bent: &Neighbours<'_>, pixel: u32, other: u32) -> bool {
    let [mine, others] = [pixel, other].map(|pixel| &bent.places[bent.of_pixel(pixel)]);
    let alike = |(place, other): (&Place, &Place)| {
        (place.surface - other.surface).abs() < 0.5
            && place.normal.dot(other.normal) >= AGREEMENT
            && (place.share - other.share).abs().max_element() <= CONTRAST
    };
    mine.len() != others.len() || !mine.iter().zip(others).all(alike)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// The edges of 5 by 5 pixels of one face, that in the middle brighter by a factor.
    fn around_a_bright_pixel(factor: f32) -> Vec<u32> {
        let size = UVec2::splat(5);
        let first = |pixel: u32| First {
            surface: 1,
            position: UVec2::new(pixel % 5, pixel / 5).as_dvec2().extend(0.0),
            normal: DVec3::Z,
            reflectance: Vec3::ONE,
        };
        let firsts: Vec<First> = (0..25).map(first).collect();
        let light = |x, y| if (x, y) == (2, 2) { [factor, factor, factor, 1.0] } else { [1.0; 4] };
        edges(&firsts, &Neighbours::new(size, &[]), &Image::from_fn(size, light), 1.0)
    }

    #[test]
    fn corners_of_pixels_count_beside_lamps_alone() {
        assert!(around_a_bright_pixel(1.2).is_empty(), "noise");
        assert_eq!(around_a_bright_pixel(3.0), [7, 11, 12, 13, 17], "a shadow's edge");
        assert_eq!(around_a_bright_pixel(17.0), [6, 7, 8, 11, 12, 13, 16, 17, 18], "a lamp");
    }
}
