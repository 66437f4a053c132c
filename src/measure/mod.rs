//! How right and how fast a result is.

#[cfg(feature = "bench")]
pub mod bench;
mod difference;
#[cfg(feature = "render")]
mod picture;
#[cfg(feature = "report")]
pub mod report;
#[cfg(feature = "report")]
pub mod reproduce;
#[cfg(feature = "bench")]
pub mod rivals;
mod statistics;
#[cfg(all(feature = "report", feature = "render"))]
pub mod stress;
mod summary;
#[cfg(feature = "report")]
pub mod thesis;
mod unit_pass;

pub use difference::{Difference, Place};
#[cfg(feature = "render")]
pub use picture::PictureError;
pub use statistics::Statistics;
pub use summary::{RadiusSummary, total_photons};
pub use unit_pass::{Unit, UnitPass};
