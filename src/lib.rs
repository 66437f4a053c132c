//! placeholder

pub mod error;
pub mod image;

pub use error::{Error, Result};
pub use image::Image;
