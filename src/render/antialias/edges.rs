//! Pixels that may show more than one thing: beside them something else begins.

use glam::{DVec3, IVec2, UVec2, Vec3};

use crate::image::Image;
use crate::render::neighbours::Neighbours;
use crate::render::sight::{First, Sight};

/// The least cosine between the normals of neighbours on one face.
const AGREEMENT: f32 = 0.98;
/// A neighbour lies off the other's plane by at most this part of what is between them.
const ASIDE: f32 = 0.2;
/// Reflectances differ by more than this at an edge of a texture.
const CONTRAST: f32 = 0.1;
/// Direct light differs at an edge of a shadow by more than this part of the larger one, and than that of the
/// mean of the picture: else it is penumbra, or its noise.
const SHADOW: f32 = 0.25;
const SHADOW_OF_MEAN: f32 = 0.1;

/// Right, and the next row: with those before, all four neighbours.
const WAYS: [IVec2; 2] = [IVec2::X, IVec2::Y];

/// The pixels at edges, in their order; `direct` is the light at their middles.
pub(super) fn edges(sight: &Sight, size: UVec2, direct: &Image<[f32; 4]>) -> Vec<u32> {
    let bent = Neighbours::new(size, &sight.bent);
    let least = SHADOW_OF_MEAN * mean(direct);
    let differ = |pixel: u32, other: u32| {
        !share_a_face(&sight.firsts[pixel as usize], &sight.firsts[other as usize])
            || in_contrast(of(direct, pixel), of(direct, other), least)
            || show_differs(&bent, pixel, other)
    };
    let mut is_edge = vec![false; size.element_product() as usize];
    for pixel in 0..size.element_product() {
        for way in WAYS {
            let at = UVec2::new(pixel % size.x, pixel / size.x).as_ivec2() + way;
            let other = at.as_uvec2();
            if other.cmplt(size).all() {
                let other = other.y * size.x + other.x;
                if differ(pixel, other) {
                    is_edge[pixel as usize] = true;
                    is_edge[other as usize] = true;
                }
            }
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

/// Over the pixels with any light.
fn mean(direct: &Image<[f32; 4]>) -> Vec3 {
    let lit = direct.values().iter().map(|&[red, green, blue, _]| Vec3::new(red, green, blue).as_dvec3());
    let (sum, count) = lit
        .filter(|light| light.max_element() > 0.0)
        .fold((DVec3::ZERO, 0.0), |(sum, count), light| (sum + light, count + 1.0));
    (sum / f64::max(count, 1.0)).as_vec3()
}

fn in_contrast(light: Vec3, other: Vec3, least: Vec3) -> bool {
    ((light - other).abs().cmpgt(least.max(SHADOW * light.max(other)))).any()
}

/// Whether two pixels show different things in mirrors and through glass.
fn show_differs(bent: &Neighbours<'_>, pixel: u32, other: u32) -> bool {
    let [mine, others] = [pixel, other].map(|pixel| &bent.places[bent.of_pixel(pixel)]);
    let alike = |(place, other): (&_, &_)| {
        let (place, other): (&super::Place, &super::Place) = (place, other);
        (place.surface - other.surface).abs() < 0.5
            && place.normal.dot(other.normal) >= f64::from(AGREEMENT)
            && (place.share - other.share).abs().max_element() <= CONTRAST
    };
    mine.len() != others.len() || !mine.iter().zip(others).all(alike)
}
