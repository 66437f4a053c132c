//! The thesis, to compare a run with: its tables, its figures, its claims.
//!
//! - [`tables`], [`figures`]: what was printed, and which columns each figure draws.
//! - [`quantity`]: what was timed, the key that printed and measured values share.
//! - [`counted`], [`example`]: costs that need no clock: fetches, stack depths, and the map of Figures 3.2 to
//!   3.4.
//! - [`density`]: how dense the unpublished input was, as inferred from the tables, and maps of that density.
//! - [`listings`]: which radii the faults of the listings make wrong, and where a table in f32 breaks.
//! - [`claims`]: every statement that can be checked, and how it is judged from the [`evidence`].

pub mod claims;
pub mod counted;
pub mod density;
pub mod evidence;
pub mod example;
pub mod figures;
mod judge_counted;
mod judge_printed;
mod judge_timed;
pub mod listings;
pub mod quantity;
pub mod tables;
