//! Faces of many corners, cut into triangles: as a fan where the face is convex, else by ear clipping in its
//! plane.

use earcut::Earcut;
use glam::{DVec2, DVec3, Vec3};

/// Most corners of a face that is not convex: where edges cross, cutting takes the square of their number and
/// more, a second for this many.
const MAX_CORNERS: usize = 1 << 11;

/// The sine of an angle by which a corner may be dented and the face still be taken as convex: rounding.
const LEAST_DENT: f64 = 1e-6;
/// A face has a front if its edges turn by more than this share of its size squared; all else is rounding.
const LEAST_TURN: f64 = 1e-12;

/// Cuts faces, one after the other, in memory that it keeps.
#[derive(Default)]
pub(super) struct Cutter {
    earcut: Earcut<f64>,
    places: Vec<DVec2>,
    indices: Vec<u32>,
}

impl Cutter {
    /// The triangles of a face as indices of its corners, which run as the face's do.
    ///
    /// Convex faces are cut into the fan 0, 1, 2 and 0, 2, 3 and so on. Faces that cross themselves have no
    /// right answer, but get one.
    ///
    /// # Errors
    /// What is wrong, if the face is not convex and has more than [`MAX_CORNERS`] corners.
    pub(super) fn cut(&mut self, corners: &[Vec3], mut add: impl FnMut([usize; 3])) -> Result<(), String> {
        let is_fan = corners.len() <= 3 || !self.place(corners) || is_convex(&self.places);
        if !is_fan && corners.len() > MAX_CORNERS {
            return Err(format!(
                "a face that is not convex has {} corners, more than {MAX_CORNERS}",
                corners.len()
            ));
        }
        self.indices.clear();
        if !is_fan {
            self.earcut.earcut(self.places.iter().map(DVec2::to_array), &[], &mut self.indices);
        }
        if self.indices.is_empty() {
            (2..corners.len()).for_each(|corner| add([0, corner - 1, corner]));
        }
        for &triangle in self.indices.as_chunks::<3>().0 {
            let [a, b, c] = triangle.map(|corner| corner as usize);
            let [first, second, third] = [a, b, c].map(|corner| self.places[corner]);
            let front = (second - first).perp_dot(third - first) >= 0.0;
            add(if front { [a, b, c] } else { [a, c, b] });
        }
        Ok(())
    }

    /// Lays the corners into the face's plane, counter-clockwise as seen from its front; its normal is
    /// Newell's, the sum of what the edges turn. Says whether there is one.
    fn place(&mut self, corners: &[Vec3]) -> bool {
        let origin = corners.first().copied().unwrap_or_default().as_dvec3();
        let corners = corners.iter().map(|corner| corner.as_dvec3() - origin);
        let following = corners.clone().cycle().skip(1);
        let turns = corners.clone().zip(following);
        let (sum, most) = turns.fold((DVec3::ZERO, 0.0_f64), |(sum, most), (corner, next)| {
            (sum + corner.cross(next), most.max(corner.length_squared()))
        });
        let Some(normal) = sum.try_normalize().filter(|_| sum.length() > LEAST_TURN * most) else {
            return false;
        };
        let (across, up) = normal.any_orthonormal_pair();
        self.places.clear();
        self.places.extend(corners.map(|corner| DVec2::new(corner.dot(across), corner.dot(up))));
        true
    }
}

/// Whether every corner turns to the left, once around in all. Corners on a straight edge, or on each other,
/// don't matter.
fn is_convex(places: &[DVec2]) -> bool {
    let following = places.iter().cycle().skip(1);
    let edges = places.iter().zip(following).map(|(place, next)| next - place);
    let edges: Vec<_> = edges.filter(|edge| *edge != DVec2::ZERO).collect();
    let mut turned = 0.0;
    for (edge, next) in edges.iter().zip(edges.iter().cycle().skip(1)) {
        let (across, along) = (edge.perp_dot(*next), edge.dot(*next));
        let dented = across < -LEAST_DENT * edge.length() * next.length();
        let back = along < 0.0 && across.abs() <= LEAST_DENT * edge.length() * next.length();
        if dented || back {
            return false;
        }
        turned += across.atan2(along);
    }
    turned < 3.0 * std::f64::consts::PI
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;
    use std::time::Instant;

    use super::*;
    use crate::scene::area;

    fn cut(corners: &[Vec3]) -> Vec<[usize; 3]> {
        let mut triangles = Vec::new();
        Cutter::default().cut(corners, |triangle| triangles.push(triangle)).unwrap();
        triangles
    }

    fn flat(corners: &[[f32; 2]]) -> Vec<Vec3> {
        corners.iter().map(|&[x, y]| Vec3::new(x, y, 0.0)).collect()
    }

    /// The sum of the areas, and whether all triangles face +z.
    fn area_of(corners: &[Vec3]) -> (f64, bool) {
        let triangles = cut(corners);
        let of = triangles.iter().map(|triangle| triangle.map(|corner| corners[corner]));
        let up = of.clone().all(|[a, b, c]| (b - a).cross(c - a).z >= 0.0);
        (of.map(|triangle| area(&triangle)).sum(), up)
    }

    #[test]
    fn convex_faces_are_fans() {
        let square = flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(cut(&square), [[0, 1, 2], [0, 2, 3]]);
        // With a corner in the middle of an edge, and one that comes twice.
        let more = flat(&[[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(cut(&more).len(), 4);
        assert_eq!(area_of(&more), (1.0, true));
        // Not flat: the halves of a roof.
        let mut roof = square;
        roof[2].z = 0.5;
        assert_eq!(cut(&roof), [[0, 1, 2], [0, 2, 3]]);
        let circle: Vec<_> = (0..500).map(|step| on_circle(step).extend(0.0)).collect();
        assert_eq!(cut(&circle)[497], [0, 498, 499]);
    }

    fn on_circle(step: u16) -> glam::Vec2 {
        glam::Vec2::from_angle(TAU * f32::from(step) / 500.0)
    }

    #[test]
    fn a_dent_stays_a_dent_from_whichever_corner() {
        let dart = flat(&[[-1.0, -1.0], [0.0, -0.5], [1.0, -1.0], [0.0, 1.0]]);
        // The letter L, of three squares.
        let letter = flat(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]]);
        for (face, expected) in [(dart, 1.5), (letter, 3.0)] {
            for first in 0..face.len() {
                let mut turned = face.clone();
                turned.rotate_left(first);
                assert_eq!(area_of(&turned), (expected, true), "from corner {first}");
                turned.reverse();
                assert_eq!(area_of(&turned), (expected, false), "from corner {first}, from behind");
            }
        }
    }

    #[test]
    fn a_wound_face_is_not_convex() {
        // A pentagram turns to the left at each of its corners, and twice around.
        let star: Vec<_> = (0..5).map(|point| on_circle(point * 200).extend(0.0)).collect();
        assert!(!is_convex(&star.iter().map(|corner| corner.truncate().as_dvec2()).collect::<Vec<_>>()));
        cut(&star);
    }

    #[test]
    fn faces_without_sense_do_no_harm() {
        for corners in [
            vec![],
            vec![Vec3::ONE],
            vec![Vec3::ONE; 2],
            vec![Vec3::ONE; 9],
            flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]),
            flat(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]),
            flat(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
            flat(&[[0.0, 0.0], [f32::MAX, 0.0], [f32::MIN_POSITIVE, 1.0], [0.0, f32::MAX]]),
        ] {
            for triangle in cut(&corners) {
                assert!(triangle.iter().all(|&corner| corner < corners.len()));
            }
        }
    }

    #[test]
    fn the_worst_face_does_not_hang() {
        // Corners at a few places again and again, whose edges cross each other by the million.
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f32::from(u16::try_from(state >> 30).unwrap())
        };
        let tangle: Vec<_> = (0..MAX_CORNERS).map(|_| Vec3::new(random(), random(), 0.0)).collect();
        let begun = Instant::now();
        cut(&tangle);
        assert!(begun.elapsed().as_secs() < 60, "{:?}", begun.elapsed());
        let longer: Vec<_> = tangle.iter().chain(&tangle[..1]).copied().collect();
        let problem = Cutter::default().cut(&longer, |_| ()).unwrap_err();
        assert_eq!(problem, "a face that is not convex has 2049 corners, more than 2048");
    }
}
