//! The radius of every k-th pixel of every k-th row, by halving: exact where it is found, and nothing
//! between.
//!
//! Cost: ⌈log2 MR⌉ boxes for one pixel in k². What lies between is somebody else's guess: radii with zero
//! edges differ by no more than the distance of their pixels, with scaled edges by any amount.

use glam::UVec2;

use super::{Continued, of_pixels, search_source};
use crate::error::Result;
use crate::gl::{Gl, Program, ShaderSource, Target, Texture, TextureFormat};
use crate::maps::DensityMap;
use crate::maps::Frame;
use crate::radius::tables::Tables;
use crate::settings::{Order, Search, Settings};

/// The search and the radii of the grid: place (i, j) is pixel k (i, j) + ⌊k / 2⌋, or the map's last one.
#[derive(Debug)]
pub(crate) struct GridSearch {
    program: Program,
    settings: Settings,
    radii: Target,
}

impl GridSearch {
    /// For maps of `size`, with a place every `step` pixels.
    pub(crate) fn new(
        gl: &Gl,
        size: UVec2,
        density: TextureFormat,
        settings: &Settings,
        step: u32,
    ) -> Result<Self> {
        let grid = Texture::new(gl, TextureFormat::R32Uint, (size + step - 1) / step, 1)?;
        Ok(Self {
            program: Program::new(gl, &source(density, settings, step))?,
            settings: in_halves(settings),
            radii: Target::single(gl, grid)?.labelled(&["radii of a grid"]),
        })
    }

    pub(crate) fn estimate(&mut self, density: &DensityMap, tables: &Tables) -> Result<()> {
        let frame = Frame::new(density);
        of_pixels(&self.settings, &self.program, &frame, tables).fill(&mut self.radii)
    }

    pub(crate) fn radii(&self) -> &Texture {
        self.radii.texture()
    }
}

fn in_halves(settings: &Settings) -> Settings {
    Settings { search: Search { order: Order::Binary, ..settings.search }, ..*settings }
}

/// The search of one pixel in `step`².
pub(crate) fn source(density: TextureFormat, settings: &Settings, step: u32) -> ShaderSource {
    search_source(density, &in_halves(settings), Continued::No)
        .variant(format!("every-{step}"))
        .define("GRID_STEP", step)
}
