//! Pictures of many layers in one EXR file, and plain colours as PNG.

use std::path::Path;

use glam::UVec2;

use super::attribute::Attribute;
use super::exr::{self, Samples};
use super::{Image, png, write_atomically};
use crate::error::Result;

/// Layers of one size, to be written as one flat EXR file: channels of the layer `normal` are `normal.R` and
/// so on, those of the unnamed layer plain `R`, `G` and `B`, which is what viewers show first.
#[derive(Clone, Debug)]
pub struct LayerFile {
    size: UVec2,
    channels: Vec<(String, Samples<'static>)>,
}

impl LayerFile {
    /// No layers yet.
    #[must_use]
    pub fn new(size: UVec2) -> Self {
        Self { size, channels: Vec::new() }
    }

    /// Adds a layer of three channels, called as `letters` says; the layer without a name is the picture
    /// itself.
    ///
    /// # Panics
    /// If its size is another.
    #[must_use]
    pub fn colours(mut self, layer: &str, letters: [char; 3], image: &Image<[f32; 3]>) -> Self {
        assert_eq!(image.size(), self.size, "layers of one size");
        let prefix = if layer.is_empty() { String::new() } else { format!("{layer}.") };
        for (index, letter) in letters.into_iter().enumerate() {
            let samples = image.values().iter().map(|value| value[index]).collect();
            self.channels.push((format!("{prefix}{letter}"), Samples::F32(samples)));
        }
        self
    }

    /// Adds a layer of one channel.
    ///
    /// # Panics
    /// If its size is another.
    #[must_use]
    pub fn values(mut self, layer: &str, image: &Image<f32>) -> Self {
        assert_eq!(image.size(), self.size, "layers of one size");
        self.channels.push((format!("{layer}.Y"), Samples::F32(image.values().to_vec())));
        self
    }

    /// Writes all layers with `attributes`. The same input gives the same bytes.
    ///
    /// # Errors
    /// As [`write_atomically`].
    ///
    /// # Panics
    /// If two channels or attributes have one name.
    pub fn write(&self, path: &Path, attributes: &[Attribute]) -> Result<()> {
        write_atomically(path, |file| exr::write_channels(file, self.size, &self.channels, attributes))
    }
}

/// Writes 8-bit RGB as PNG.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_colours(path: &Path, picture: &Image<[u8; 3]>) -> Result<()> {
    write_atomically(path, |file| png::write_colours(file, picture))
}
