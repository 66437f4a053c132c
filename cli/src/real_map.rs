//! The map of real photons that comes with the program.

use std::path::Path;

use anyhow::Result;
use varikernel::Image;
use varikernel::image::{CORNELL_GLASS_EXR, ReadOptions, read_counts_of};

/// What it is called in reports.
pub(super) const NAME: &str = "Cornell glass";

/// The map, read like any other file.
pub(super) fn read() -> Result<Image<u32>> {
    Ok(read_counts_of(Path::new("cornell_glass_512.exr"), CORNELL_GLASS_EXR, &ReadOptions::default())?)
}
