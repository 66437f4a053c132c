//! Where a ray meets a triangle or a sphere, in f64.

use glam::{DVec2, DVec3};

use crate::view::Ray;

/// How far outside a triangle still counts as inside, in barycentric coordinates.
///
/// Neighbours then overlap by less than f32 resolves, instead of leaving a gap by rounding.
const OVERLAP: f64 = 1e-12;

/// A triangle as its first corner and the two edges from there.
#[derive(Clone, Copy, Debug)]
pub struct TriangleEdges {
    /// First corner, in scene units.
    pub corner: DVec3,
    /// From the first corner to the second.
    pub edge1: DVec3,
    /// From the first corner to the third.
    pub edge2: DVec3,
}

impl TriangleEdges {
    /// Distance along the ray, more than zero, and the shares of the second and third corner
    /// (T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997).
    ///
    /// Both sides count. A ray in the triangle's plane misses it.
    #[must_use]
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<(f64, DVec2)> {
        let across = ray.direction.cross(self.edge2);
        let determinant = self.edge1.dot(across);
        if determinant == 0.0 {
            return None;
        }
        let inverse = 1.0 / determinant;
        let from_corner = ray.origin - self.corner;
        let second = inverse * from_corner.dot(across);
        if !(-OVERLAP..=1.0 + OVERLAP).contains(&second) {
            return None;
        }
        let up = from_corner.cross(self.edge1);
        let third = inverse * ray.direction.dot(up);
        if third < -OVERLAP || second + third > 1.0 + OVERLAP {
            return None;
        }
        let distance = inverse * self.edge2.dot(up);
        // Also refuses what is not a number.
        (distance > 0.0).then_some((distance, DVec2::new(second, third)))
    }

    /// The shares of the second and third corner at a place in the triangle's plane.
    #[must_use]
    pub fn shares(&self, position: DVec3) -> DVec2 {
        let across = self.edge1.cross(self.edge2);
        let from_corner = position - self.corner;
        let second = from_corner.cross(self.edge2).dot(across) / across.length_squared();
        let third = self.edge1.cross(from_corner).dot(across) / across.length_squared();
        DVec2::new(second, third)
    }
}

/// Distance along the ray, more than zero, to the first place on the sphere.
///
/// The smaller root is found without subtracting near equals (W. Press and others, "Numerical Recipes", 5.6),
/// and the discriminant from the ray's closest point (E. Haines and others, "Ray Tracing Gems", 7).
#[must_use]
#[inline]
pub fn intersect_sphere(ray: &Ray, centre: DVec3, radius: f64) -> Option<f64> {
    let to_centre = centre - ray.origin;
    let along = to_centre.dot(ray.direction);
    let closest = to_centre - along * ray.direction;
    let discriminant = radius * radius - closest.length_squared();
    if discriminant < 0.0 {
        return None;
    }
    let half_chord = discriminant.sqrt();
    let outside = to_centre.length_squared() - radius * radius;
    let larger = along + half_chord.copysign(along);
    let smaller = outside / larger;
    let (near, far) = if larger < smaller { (larger, smaller) } else { (smaller, larger) };
    [near, far].into_iter().find(|&distance| distance > 0.0)
}
