//! A half line, in f64.

use glam::DVec3;

/// A half line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// In scene units.
    pub origin: DVec3,
    /// Of length 1.
    pub direction: DVec3,
}
