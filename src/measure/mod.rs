//! How right and how fast a result is.

mod difference;
#[cfg(feature = "report")]
pub mod report;
mod summary;
#[cfg(feature = "report")]
pub mod thesis;

pub use difference::{Difference, Place};
pub use summary::{RadiusSummary, total_photons};
