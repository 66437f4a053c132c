//! Which tiles have a pixel that needs a radius: a mask, reduced twice by 8 x 8.

use glam::UVec2;

use crate::error::Result;
use crate::gl::{Gl, Pass, Program, ShaderSource, Target, Texture, TextureFormat, glsl};
use crate::mask::Mask;

const MASK: &str = "radius mask";

/// Texels of the side that one becomes.
const SIDE: u32 = 8;

/// The reduced masks of a map of one size.
#[derive(Debug)]
pub(super) struct MaskTiles {
    program: Program,
    blocks: Target,
    tiles: Target,
}

impl MaskTiles {
    pub(super) fn new(gl: &Gl, size: UVec2) -> Result<Self> {
        let target = |size| -> Result<Target> {
            let tiles = Texture::new(gl, TextureFormat::R8Uint, size, 1)?;
            Ok(Target::single(gl, tiles)?.labelled(&["tiles of a mask"]))
        };
        let blocks = (size + SIDE - 1) / SIDE;
        Ok(Self {
            program: Program::new(gl, &source())?,
            blocks: target(blocks)?,
            tiles: target((blocks + SIDE - 1) / SIDE)?,
        })
    }

    /// 1 for each tile of 64 x 64 that has a pixel of the mask, else 0.
    pub(super) fn reduce(&mut self, mask: &Mask) -> Result<&Texture> {
        reduce(&self.program, mask.texture(), &mut self.blocks)?;
        reduce(&self.program, self.blocks.texture(), &mut self.tiles)?;
        Ok(self.tiles.texture())
    }
}

fn reduce(program: &Program, mask: &Texture, target: &mut Target) -> Result<()> {
    Pass::new(MASK, program).read("mask", mask).set("mask_size", mask.size().as_ivec2()).fill(target)
}

pub(super) fn source() -> ShaderSource {
    ShaderSource::new(MASK).file(glsl!("mask/any.frag"))
}
