//! Which pixels need a radius: a texture of the host, or made from its depth or stencil buffer.

use glam::UVec2;

use super::host_depth::HostDepth;
use crate::error::Result;
use crate::gl::{
    FragmentTest, Gl, Pass, Program, ShaderSource, StateGuard, Target, Texture, TextureFormat, fill_where,
    glsl,
};
use crate::image::Image;

const TESTED: &str = "mask of tested pixels";

/// Which pixels need a radius: a GL_R8UI, GL_R16UI or GL_R32UI texture, 0 where none is needed (background,
/// no receiver, a radius that is still valid elsewhere).
///
/// Their radius is 0, which no other pixel has, and they are not limited.
#[derive(Debug)]
pub struct Mask {
    texture: Texture,
    /// Whether it is one texel that stands for all pixels of a map, each of which needs a radius.
    every_pixel: bool,
}

impl Mask {
    /// Makes a texture of `mask`.
    ///
    /// # Errors
    /// [`Error::TooLarge`](crate::Error::TooLarge); [`Error::OutOfMemory`](crate::Error::OutOfMemory).
    pub fn upload(gl: &Gl, mask: &Image<u8>) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let texture = Texture::new(gl, TextureFormat::R8Uint, mask.size(), 1)?.labelled("mask");
        texture.upload(mask);
        gl.check("uploading a mask")?;
        Ok(Self { texture, every_pixel: false })
    }

    /// Uses a texture that the host owns and keeps alive as long as this; its contents may change between
    /// frames.
    ///
    /// # Errors
    /// [`Error::Mismatch`](crate::Error::Mismatch) unless it is a GL_TEXTURE_2D of one of the formats above, with
    /// level 0 as its base and red where red belongs.
    pub fn borrow(gl: &Gl, texture: glow::Texture) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let formats = [TextureFormat::R8Uint, TextureFormat::R16Uint, TextureFormat::R32Uint];
        let texture = Texture::borrow_as(gl, texture, "mask", &formats)?;
        Ok(Self { texture, every_pixel: false })
    }

    /// One texel for all pixels, whatever the map's size: what is bound where a frame has no mask.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`](crate::Error::OutOfMemory).
    pub(crate) fn of_every_pixel(gl: &Gl) -> Result<Self> {
        let mask = Self::upload(gl, &Image::filled(UVec2::ONE, 1))?;
        Ok(Self { every_pixel: true, ..mask })
    }

    /// The bytes of [`of_every_pixel`](Self::of_every_pixel).
    pub(crate) const BYTES_OF_EVERY_PIXEL: u64 = 1;

    /// Whether it was made by [`of_every_pixel`](Self::of_every_pixel).
    pub(crate) fn is_every_pixel(&self) -> bool {
        self.every_pixel
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.texture.size()
    }

    pub(crate) fn texture(&self) -> &Texture {
        &self.texture
    }
}

/// Makes masks of a host's depth or stencil buffers, for hosts without a mask: one pass and one byte a pixel.
#[derive(Debug)]
pub struct MaskMaker {
    gl: Gl,
    program: Program,
    target: Target,
    /// The target's texture, borrowed as one of a host would be.
    mask: Mask,
}

impl MaskMaker {
    /// Allocates and compiles for masks of `size`.
    ///
    /// # Errors
    /// [`Error::TooLarge`](crate::Error::TooLarge); [`Error::Shader`](crate::Error::Shader) if the driver refuses
    /// the shader; [`Error::OutOfMemory`](crate::Error::OutOfMemory).
    pub fn new(gl: &Gl, size: UVec2) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let target =
            Target::single(gl, Texture::new(gl, TextureFormat::R8Uint, size, 1)?)?.labelled(&[TESTED]);
        let mask = Mask::borrow(gl, target.texture().name())?;
        Ok(Self { gl: gl.clone(), program: Program::new(gl, &Self::shader_source())?, target, mask })
    }

    /// Pixels that have something in front of the far plane: whose depth is less than 1, or more than 0 where
    /// it is reversed.
    ///
    /// # Errors
    /// [`Error::Mismatch`](crate::Error::Mismatch) unless it is a GL_TEXTURE_2D with depth, of the masks'
    /// size.
    pub fn from_depth(&mut self, depth: HostDepth) -> Result<&Mask> {
        self.make(depth.texture, FragmentTest::Depth { reversed: depth.reversed })
    }

    /// Pixels whose stencil value equals `reference` in the bits that are set in `bits`.
    ///
    /// # Errors
    /// [`Error::Mismatch`](crate::Error::Mismatch) unless `stencil` is a GL_TEXTURE_2D with stencil, of the
    /// masks' size.
    pub fn from_stencil(&mut self, stencil: glow::Texture, reference: u8, bits: u8) -> Result<&Mask> {
        self.make(stencil, FragmentTest::Stencil { reference, bits })
    }

    /// The shader.
    #[must_use]
    pub fn shader_source() -> ShaderSource {
        ShaderSource::new(TESTED).targets([TextureFormat::R8Uint]).file(glsl!("maps/mask.frag"))
    }

    fn make(&mut self, texture: glow::Texture, test: FragmentTest) -> Result<&Mask> {
        let pass = Pass::new(TESTED, &self.program);
        fill_where(pass, &self.gl, texture, test, &mut self.target)?;
        self.gl.check("making a mask")?;
        Ok(&self.mask)
    }
}
