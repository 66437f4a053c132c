//! Photons per pixel.

use glam::UVec2;

use super::describe;
use super::exactness::CountBounds;
use crate::error::{Error, Result};
use crate::gl::{Gl, StateGuard, Texture, TextureFormat};
use crate::image::Image;

/// Photons per pixel: a GL_R32UI or GL_R8UI texture, or a GL_R32F one as additive blending of points fills
/// it.
///
/// Values are whole and not negative; in GL_R32F they are exact up to 2^24 a pixel, where adding 1 stops to
/// count. Of a fraction the whole part counts; NaN counts as anything.
#[derive(Debug)]
pub struct DensityMap {
    texture: Texture,
    bounds: CountBounds,
}

impl DensityMap {
    /// Makes a texture of `counts`.
    ///
    /// # Errors
    /// [`Error::TooLarge`]; [`Error::OutOfMemory`].
    pub fn upload(gl: &Gl, counts: &Image<u32>, bounds: CountBounds) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let texture = Texture::new(gl, TextureFormat::R32Uint, counts.size(), 1)?.labelled("density map");
        texture.upload(counts);
        gl.check("uploading a density map")?;
        Ok(Self { texture, bounds })
    }

    /// Replaces the counts of a map that [`upload`](Self::upload) made, in the same texture.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if the size or the map's format is another; [`Error::Gl`] if the driver fails.
    pub fn replace(&mut self, counts: &Image<u32>, bounds: CountBounds) -> Result<()> {
        if (counts.size(), TextureFormat::R32Uint) != (self.size(), self.format()) {
            return Err(Error::Mismatch {
                what: "counts",
                expected: describe(self.size(), self.format()),
                got: describe(counts.size(), TextureFormat::R32Uint),
            });
        }
        let gl = self.texture.gl();
        let _state = StateGuard::new(gl)?;
        self.texture.upload(counts);
        gl.check("replacing a density map")?;
        self.bounds = bounds;
        Ok(())
    }

    /// Uses a texture that the host owns and keeps alive as long as this; its contents may change between
    /// frames, but after a new glTexImage2D it has to be borrowed again.
    ///
    /// `bounds` is what the host knows of its counts; with [`CountBounds::UNKNOWN`] a result is refused
    /// unless n and MR alone prove it exact.
    ///
    /// # Errors
    /// [`Error::Mismatch`] unless it is a GL_TEXTURE_2D in GL_R32UI, GL_R32F or GL_R8UI, with
    /// level 0 as its base and red where red belongs.
    pub fn borrow(gl: &Gl, texture: glow::Texture, bounds: CountBounds) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        Ok(Self { texture: Texture::borrow_map(gl, texture, "host's density map")?, bounds })
    }

    /// The counts that a stage adds up in a texture of its own, none yet.
    pub(crate) fn of_stage(texture: &Texture) -> Self {
        Self { texture: texture.alias(), bounds: CountBounds::total_at_most(0) }
    }

    pub(crate) fn set_bounds(&mut self, bounds: CountBounds) {
        self.bounds = bounds;
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.texture.size()
    }

    /// The texture of counts.
    #[must_use]
    pub fn texture(&self) -> glow::Texture {
        self.texture.name()
    }

    /// The format of the texture.
    #[must_use]
    pub fn format(&self) -> TextureFormat {
        self.texture.format()
    }

    /// What is known of the counts.
    #[must_use]
    pub fn bounds(&self) -> CountBounds {
        self.bounds
    }

    pub(crate) fn as_texture(&self) -> &Texture {
        &self.texture
    }
}
