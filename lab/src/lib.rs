//! What measures `varikernel`: run time, error and promises about numbers, against the thesis and against
//! baselines (rivals) on the processor.
//!
//! It uses the library as any host does; the few passes that need its inside are in [`varikernel::measure`].
//!
//! | module | what it answers |
//! |---|---|
//! | [`bench`](mod@bench) | how long does each stage of each method take, in copies? |
//! | [`rivals`] | how long does plain code on the processor take for the same radii? |
//! | [`study`] | how does run time trade against error, for every way to a radius map, and for pictures? |
//! | [`against`] | how far are pictures of other renderers, and ours, from a reference after the same time? |
//! | [`flicker`] | how much does light change from frame to frame by noise alone? |
//! | [`stress`] | do the promises about exact numbers hold on this device? |
//! | [`thesis`] | what did the thesis print, and does each of its claims hold? |
//! | [`reproduce`] | both together, in one run that can be resumed |
//! | [`report`] | the page of that run |
//! | [`synth`] | seeded test maps |

pub mod against;
pub mod bench;
mod chart;
mod confidence;
mod fingerprint;
pub mod flicker;
mod halves;
mod picture;
pub mod report;
pub mod reproduce;
pub mod rivals;
mod statistics;
pub mod stress;
pub mod study;
mod summary;
pub mod synth;
pub mod thesis;
mod welch;

pub use confidence::{CONFIDENCE_LEVEL, Confidence, RatioInterval};
pub use halves::ReferenceHalves;
pub use picture::{LightError, PictureError, caustic_and_walls};
pub use statistics::Statistics;
pub use summary::{RadiusSummary, total_photons};
pub use welch::Welch;

/// Diffuse landings after which photons of benchmarks and studies are followed no further: committed results
/// have this many.
const BOUNCES: u32 = 8;

/// The commit that this was built from, where git had one.
pub const COMMIT: &str = env!("VARIKERNEL_COMMIT");
