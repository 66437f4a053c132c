//! Power of the photons of each pixel.

use glam::UVec2;

use crate::error::Result;
use crate::gl::{StateGuard, Texture};
use crate::image::Image;

/// Power of each pixel's photons, linear RGB, and their count, in GL_RGBA32F.
#[derive(Debug)]
pub struct PowerMap {
    texture: Texture,
}

impl PowerMap {
    /// The power that a stage adds up in a texture of its own.
    pub(crate) fn of_stage(texture: &Texture) -> Self {
        Self { texture: texture.alias() }
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.texture.size()
    }

    /// The texture, to bind in the host's own shaders as a `sampler2D`.
    #[must_use]
    pub fn texture(&self) -> glow::Texture {
        self.texture.name()
    }

    /// Reads it back; waits for the GPU.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn read(&self) -> Result<Image<[f32; 4]>> {
        let gl = self.texture.gl();
        let _state = StateGuard::new(gl)?;
        let power = self.texture.read(0);
        gl.check("reading a power map back")?;
        Ok(power)
    }

    pub(crate) fn as_texture(&self) -> &Texture {
        &self.texture
    }
}
