//! How right and how fast a result is.

mod difference;
mod summary;

pub use difference::{Difference, Place};
pub use summary::{RadiusSummary, total_photons};
