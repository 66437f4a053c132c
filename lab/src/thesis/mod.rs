//! The thesis, to compare a run with: its tables, its figures, its claims.
//!
//! - [`tables`], [`figures`]: what was printed, and which columns each figure draws.
//! - [`quantity`]: what was timed, the key that printed and measured values share.
//! - [`counted`], [`example`]: what needs no clock; fetches, stack depths, and the map of Figures 3.2 to 3.4.
//! - [`density`]: how dense the unpublished input was, as far as the tables tell, and maps of that density.
//! - [`listings`]: what the faults of the listings spoil, and where a table in f32 breaks.
//! - [`claims`]: every statement that can be checked, and how it is judged from the [`evidence`];
//!   [`judgement`] is the answer.

pub mod claims;
pub mod counted;
pub mod density;
pub mod evidence;
pub mod example;
pub mod figures;
mod judge_counted;
mod judge_future;
mod judge_printed;
mod judge_timed;
pub mod judgement;
pub mod listings;
pub mod quantity;
pub mod tables;
