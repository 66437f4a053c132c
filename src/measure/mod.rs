//! What measuring needs of the inside: passes that serve as units of time, and approximations to compare with
//! the exact radii.
//!
//! None of it makes a radius map or a picture better. The package `varikernel-lab` is built on it, and hosts
//! may compare their own times with the same units.

mod approximation;
#[cfg(feature = "scene")]
mod point_pass;
mod unit_pass;

pub use approximation::{Approximation, GRID_STEPS, sources as approximation_sources};
#[cfg(feature = "scene")]
pub use point_pass::PointPass;
pub use unit_pass::{Unit, UnitPass};
