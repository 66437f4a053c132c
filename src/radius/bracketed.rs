//! The bracketed search: bounds for the radii of blocks of pixels, of ever smaller blocks, then the pixels.
//!
//! For a block of side b, let the *outer* box of radius r be the union of its pixels' boxes, and the *inner* box what
//! they have in common. Let L be the smallest radius whose outer box holds enough: no pixel's radius is smaller. The
//! inner box of radius L + b - 1 is the outer box of L, so no pixel's radius is larger than that. One search for L
//! thus leaves b candidates for every pixel of the block, and those of a block inside a larger one start from what is
//! left there. Where an edge is in reach and the count is scaled, the inside area differs from pixel to pixel: L is
//! tested with the least, and the upper bound is searched with the most. Both tests are monotone in r, as is the
//! pixel's own between them, so that the result is the definition's.
//!
//! - Cost: of 4 fetches each, log2 MR boxes for one pixel in 1024, 5 for one in 64, 3 for one in 4, and 1 for each; the
//!   density and MR hardly matter. Where edges are scaled, a few more near the edges.
//! - Memory: 4 bytes for each block, 0.27 of the map together.
//! - Tried, and no gain: see the table in the module above.

use glam::UVec2;

use super::{of_pixels, search_defines};
use crate::error::Result;
use crate::gl::{Gl, Pass, Program, ShaderSource, Target, Texture, TextureFormat, glsl};
use crate::maps::{DensityMap, RadiusMap};
use crate::settings::Settings;
use crate::structure::{self, Structure};

const BRACKET: &str = "radius bracket";

/// Sides of the blocks, from large to small; `radius.frag` knows the last.
const SIDES: [u32; 3] = [32, 8, 2];

/// The levels of blocks; the pixels follow.
#[derive(Debug)]
pub(super) struct Bracketed {
    widest: Program,
    narrower: Program,
    /// Brackets for each of `SIDES`.
    levels: Vec<(u32, Target)>,
    pixels: Program,
    last_radius: u32,
    settings: Settings,
}

impl Bracketed {
    pub(super) fn new(gl: &Gl, size: UVec2, density: TextureFormat, settings: &Settings) -> Result<Self> {
        let level = |side: u32| {
            let texture = Texture::new(gl, TextureFormat::R32Uint, (size + side - 1) / side, 1)?;
            Ok((side, Target::single(gl, texture)?))
        };
        Ok(Self {
            widest: Program::new(gl, &bracket_source(density, settings, Wider::No))?,
            narrower: Program::new(gl, &bracket_source(density, settings, Wider::Yes))?,
            levels: SIDES.into_iter().map(level).collect::<Result<_>>()?,
            pixels: Program::new(gl, &super::search_source(density, settings, super::Continued::No))?,
            // One more than MR stands for "not even MR", which only the mask wants to know.
            last_radius: settings.search.max_radius + u32::from(settings.limited_mask),
            settings: *settings,
        })
    }

    pub(super) fn estimate(
        &mut self,
        density: &DensityMap,
        structure: &Structure,
        radii: &mut RadiusMap,
    ) -> Result<()> {
        for index in 0..self.levels.len() {
            let (wider, rest) = self.levels.split_at_mut(index);
            let (side, target) = &mut rest[0];
            let pass = |program| {
                let pass = Pass::new(BRACKET, program)
                    .set("map_size", density.size().as_ivec2())
                    .set("min_photons", self.settings.search.min_photons)
                    .set("side", side.cast_signed());
                structure.read_by(pass, density)
            };
            match wider.last() {
                None => {
                    pass(&self.widest).set("last_radius", self.last_radius.cast_signed()).fill(target)?;
                }
                Some((wider_side, wider)) => pass(&self.narrower)
                    .read("wider", wider.texture())
                    .set("wider_side", wider_side.cast_signed())
                    .fill(target)?,
            }
        }
        let (_, finest) = &self.levels[self.levels.len() - 1];
        of_pixels(&self.settings, &self.pixels, density, structure)
            .read("brackets", finest.texture())
            .fill(radii.target())
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Wider {
    No,
    Yes,
}

/// The shaders of the blocks.
pub(super) fn bracket_sources(density: TextureFormat, settings: &Settings) -> [ShaderSource; 2] {
    [Wider::No, Wider::Yes].map(|wider| bracket_source(density, settings, wider))
}

fn bracket_source(density: TextureFormat, settings: &Settings, wider: Wider) -> ShaderSource {
    let source = search_defines(ShaderSource::new(BRACKET), settings)
        .define_if(wider == Wider::Yes, "INSIDE_WIDER")
        .file(glsl!("common/enough.glsl"));
    structure::counter(source, density, settings).file(glsl!("bracket.frag"))
}
