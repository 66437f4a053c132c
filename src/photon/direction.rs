//! Directions around an axis: within a cone, by Lambert's law.

use std::f64::consts::TAU;

use glam::DVec3;

use super::random::Stream;

/// Directions around an axis, up to an angle whose 1 - cos is the height, which tells small angles as well as
/// large ones.
pub(super) struct Cone {
    pub(super) axis: DVec3,
    pub(super) height: f64,
}

impl Cone {
    pub(super) fn new(axis: DVec3, height: f64) -> Self {
        Self { axis: axis.normalize(), height }
    }

    pub(super) fn direction(&self, [u, v]: [f64; 2]) -> DVec3 {
        let height = u * self.height;
        around(self.axis, 1.0 - height, (height * (2.0 - height)).max(0.0).sqrt(), v)
    }

    pub(super) fn solid_angle(&self) -> f64 {
        TAU * self.height
    }

    /// Whether a direction of length 1 is in it; at its edge, also where rounding puts it a little beyond.
    pub(super) fn holds(&self, direction: DVec3) -> bool {
        (direction - self.axis).length_squared() / 2.0 <= self.height * (1.0 + 1e-9)
    }
}

/// A direction around `normal` by Lambert's law: as likely as the cosine of its angle to the normal.
pub(super) fn cosine_around(normal: DVec3, random: &mut Stream) -> DVec3 {
    let cos = (1.0 - random.number()).sqrt();
    around(normal, cos, (1.0 - cos * cos).max(0.0).sqrt(), random.number())
}

/// The direction at an angle of the given cosine and sine from `axis`, `turn` of the way around it.
fn around(axis: DVec3, cos: f64, sin: f64, turn: f64) -> DVec3 {
    let (side, other) = axis.any_orthonormal_pair();
    let (sin_turn, cos_turn) = (TAU * turn).sin_cos();
    sin * (cos_turn * side + sin_turn * other) + cos * axis
}
