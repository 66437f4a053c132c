//! How right and how fast a result is.

#[cfg(feature = "bench")]
pub mod bench;
#[cfg(feature = "report")]
mod chart;
#[cfg(feature = "bench")]
mod confidence;
mod difference;
#[cfg(feature = "bench")]
mod fingerprint;
#[cfg(feature = "scene")]
mod picture;
#[cfg(feature = "scene")]
mod point_pass;
#[cfg(feature = "report")]
pub mod report;
#[cfg(feature = "report")]
pub mod reproduce;
#[cfg(feature = "bench")]
pub mod rivals;
mod statistics;
#[cfg(feature = "report")]
pub mod stress;
#[cfg(feature = "report")]
pub mod study;
mod summary;
#[cfg(feature = "report")]
pub mod thesis;
mod unit_pass;

#[cfg(feature = "bench")]
pub use confidence::{CONFIDENCE_LEVEL, Confidence, RatioInterval};
pub use difference::{Difference, Place};
#[cfg(feature = "scene")]
pub use picture::{LightError, PictureError};
#[cfg(feature = "scene")]
pub use point_pass::PointPass;
pub use statistics::Statistics;
pub use summary::{RadiusSummary, total_photons};
pub use unit_pass::{Unit, UnitPass};
