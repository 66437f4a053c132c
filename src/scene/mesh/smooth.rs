//! Normals of smooth surfaces.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::Part;

/// A sum of normals that is shorter than this has no direction: the faces cancel each other, as those of a
/// sheet with two sides do.
const LEAST_SUM: f64 = 1e-6;

/// The normals of each part's vertices: the file's, or else the means of all faces of the surface around the
/// vertex's position, whatever their part, by the angle that each has there, so that it does not matter how a
/// face is cut into triangles.
///
/// `triangles` are those of each part that have an area.
pub(super) fn normals(parts: &[Part], triangles: &[Vec<[u32; 3]>]) -> Vec<Vec<Vec3>> {
    let positions = places(parts);
    let count = positions.iter().flatten().max().map_or(0, |last| last + 1);
    let mut sums = vec![DVec3::ZERO; count];
    for ((part, triangles), places) in parts.iter().zip(triangles).zip(&positions) {
        for triangle in triangles {
            let corners = part.corners(triangle).map(Vec3::as_dvec3);
            for (number, &vertex) in triangle.iter().enumerate() {
                let to = |step: usize| corners[(number + step) % 3] - corners[number];
                let (next, previous) = (to(1), to(2));
                sums[places[vertex as usize]] +=
                    next.cross(previous).normalize() * next.angle_between(previous);
            }
        }
    }
    let of_part = |((part, triangles), places): ((&Part, &Vec<[u32; 3]>), Vec<usize>)| {
        let mean = |vertex: usize| Some(sums[places[vertex]]).filter(|sum| sum.length() > LEAST_SUM);
        let mut normals: Vec<_> = (0..part.positions.len())
            .map(|vertex| {
                let given =
                    part.normals.get(vertex).map(|normal| normal.as_dvec3()).and_then(DVec3::try_normalize);
                given.or_else(|| mean(vertex)?.try_normalize())
            })
            .collect();
        // What has neither has the normal of a face.
        for triangle in triangles {
            for &vertex in triangle {
                normals[vertex as usize].get_or_insert_with(|| {
                    let [a, b, c] = part.corners(triangle).map(Vec3::as_dvec3);
                    (b - a).cross(c - a).normalize()
                });
            }
        }
        // A vertex without faces is never asked for its normal.
        normals.into_iter().map(|normal| normal.unwrap_or(DVec3::Y).as_vec3()).collect()
    };
    parts.iter().zip(triangles).zip(positions).map(of_part).collect()
}

/// A number for each vertex of each part, the same for all that are at one position.
fn places(parts: &[Part]) -> Vec<Vec<usize>> {
    let mut known = HashMap::new();
    let mut number = |position: &Vec3| {
        let next = known.len();
        // Zero has two signs.
        *known.entry((*position + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(next)
    };
    parts.iter().map(|part| part.positions.iter().map(&mut number).collect()).collect()
}
