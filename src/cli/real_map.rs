//! The map of real photons that comes with the program.

use std::fs;

use anyhow::{Context as _, Result};
use varikernel::Image;
use varikernel::image::{ReadOptions, read_counts};

const CORNELL: &[u8] = include_bytes!("../../assets/maps/cornell_glass_512.exr");

/// What it is called in reports.
pub(super) const NAME: &str = "Cornell glass";

/// The map, read like any other file.
pub(super) fn read() -> Result<Image<u32>> {
    let folder = tempfile::tempdir().context("can't make a temporary folder")?;
    let file = folder.path().join("cornell_glass_512.exr");
    fs::write(&file, CORNELL).context("can't write a temporary file")?;
    Ok(read_counts(&file, &ReadOptions::default())?)
}
