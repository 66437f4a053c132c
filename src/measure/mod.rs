//! How right and how fast a result is.

mod difference;

pub use difference::{Difference, Place};
