//! Which tiles have a pixel that needs a radius: a mask, reduced twice by 8 x 8.

use glam::UVec2;

use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, Target, TargetShape, Targets, Texture, TextureFormat, TextureShape, glsl,
};
use crate::maps::Mask;

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
    pub(super) fn new(gl: &Gl, targets: &mut Targets) -> Result<Self> {
        Ok(Self { program: Program::new(gl, &source())?, blocks: targets.take(), tiles: targets.take() })
    }

    pub(super) fn resize(&mut self, targets: &mut Targets) {
        (self.blocks, self.tiles) = (targets.take(), targets.take());
    }

    /// 1 for each tile of 64 x 64 that has a pixel of the mask, else 0; one texel for all if the mask has
    /// one.
    pub(super) fn reduce<'a>(&'a mut self, mask: &'a Mask) -> Result<&'a Texture> {
        if mask.is_every_pixel() {
            return Ok(mask.texture());
        }
        reduce(&self.program, mask.texture(), &mut self.blocks)?;
        reduce(&self.program, self.blocks.texture(), &mut self.tiles)?;
        Ok(self.tiles.texture())
    }
}

pub(super) fn shapes(size: UVec2) -> Vec<TargetShape> {
    let reduced = |size: UVec2| (size + SIDE - 1) / SIDE;
    let shape = |size| vec![TextureShape::new("tiles of a mask", TextureFormat::R8Uint, size)];
    vec![shape(reduced(size)), shape(reduced(reduced(size)))]
}

fn reduce(program: &Program, mask: &Texture, target: &mut Target) -> Result<()> {
    Pass::new(MASK, program).read("mask", mask).set("mask_size", mask.size().as_ivec2()).fill(target)
}

pub(super) fn source() -> ShaderSource {
    ShaderSource::new(MASK).targets([TextureFormat::R8Uint]).file(glsl!("radius/search/mask_tiles.frag"))
}
