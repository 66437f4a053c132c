//! Where light comes from.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};

/// A light with its name in the scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Its name; for a surface that shines, the surface's.
    pub name: String,
    /// Where the light leaves.
    pub shape: LightShape,
}

/// Where and how light leaves. Power is in watts when lengths are in metres; any unit will do, as only shares matter.
#[derive(Clone, Debug, PartialEq)]
pub enum LightShape {
    /// Triangles that shine evenly (Lambert) on their front side, where the corners run counter-clockwise.
    Area {
        /// The corners, in scene units.
        triangles: Vec<[Vec3; 3]>,
        /// Power per area and solid angle, linear RGB.
        radiance: Vec3,
    },
    /// A point that shines evenly in a cone; all around with an angle of 180 degrees.
    Point {
        /// In scene units.
        position: Vec3,
        /// The cone's axis, of length 1.
        direction: Vec3,
        /// Between the cone's axis and its edge, in radians, more than 0 and up to π (all around).
        half_angle: f32,
        /// Power per solid angle, linear RGB.
        intensity: Vec3,
    },
}

impl Light {
    /// All power that leaves the light, linear RGB: π · area · radiance, or solid angle · intensity.
    #[must_use]
    pub fn flux(&self) -> DVec3 {
        match &self.shape {
            LightShape::Area { triangles, radiance } => {
                PI * triangles.iter().map(area).sum::<f64>() * radiance.as_dvec3()
            }
            LightShape::Point { half_angle, intensity, .. } => {
                TAU * cap_height(*half_angle) * intensity.as_dvec3()
            }
        }
    }
}

/// 1 - cos of an angle in radians, without loss for small ones.
pub(crate) fn cap_height(half_angle: f32) -> f64 {
    2.0 * (f64::from(half_angle) / 2.0).sin().powi(2)
}

/// Area of a triangle, in square scene units.
#[must_use]
pub fn area(triangle: &[Vec3; 3]) -> f64 {
    let [a, b, c] = triangle.map(Vec3::as_dvec3);
    (b - a).cross(c - a).length() / 2.0
}
