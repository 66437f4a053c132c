//! Photons: from the lights into the scene, landing after landing (thesis 2.4, 2.6.1), on the CPU; and as
//! vertices.

#[cfg(feature = "scene")]
mod aim;
#[cfg(feature = "scene")]
mod direction;
#[cfg(feature = "scene")]
mod emission;
#[cfg(feature = "scene")]
mod file_format;
#[cfg(feature = "scene")]
mod landing;
#[cfg(feature = "scene")]
mod landings;
#[cfg(feature = "scene")]
mod output;
#[cfg(feature = "scene")]
mod path;
mod point;
#[cfg(feature = "scene")]
mod random;
#[cfg(feature = "scene")]
mod records;
#[cfg(feature = "scene")]
mod roulette;
#[cfg(feature = "scene")]
mod scatter;
#[cfg(feature = "scene")]
mod trace_settings;
#[cfg(feature = "scene")]
mod tracer;

#[cfg(feature = "scene")]
pub use emission::{Emission, EmittedPhoton, FirstHit};
#[cfg(feature = "scene")]
pub use file_format::PhotonFormat;
#[cfg(feature = "scene")]
pub use landing::Photon;
#[cfg(feature = "scene")]
pub use landings::{Ends, Landings, Tally};
#[cfg(feature = "scene")]
pub use output::write;
#[cfg(feature = "scene")]
pub use path::MAX_SPECULAR;
pub use point::PhotonPoint;
#[cfg(feature = "scene")]
pub use roulette::{MAX_BOUNCES, ROULETTE_AFTER};
#[cfg(feature = "scene")]
pub(crate) use scatter::mirrored;
#[cfg(feature = "scene")]
pub use scatter::{reflect, reflected_by_pane, refract};
#[cfg(feature = "scene")]
pub use trace_settings::TraceSettings;
#[cfg(feature = "scene")]
pub use tracer::{trace, trace_from, trace_from_hits, trace_in_batches};
