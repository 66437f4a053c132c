//! What light arrives at each pixel's surface.

use glam::UVec2;

use crate::error::Result;
use crate::gl::{StateGuard, Target, TargetShape, Texture, TextureFormat, TextureShape};
use crate::image::Image;

/// Indirect irradiance: power per area in scene units, linear RGB, in GL_RGBA32F.
///
/// The fourth value is the number of kernels drawn over the pixel for a splat, of photons found for a gather,
/// and for light from tables the radius in pixels that it was gathered from.
#[derive(Debug)]
pub struct IrradianceMap {
    target: Target,
}

impl IrradianceMap {
    /// The plane of a map.
    pub(crate) fn shape(size: UVec2) -> TargetShape {
        vec![TextureShape::new("irradiance", TextureFormat::Rgba32Float, size)]
    }

    /// The map that a target of such a shape is.
    pub(crate) fn of(target: Target) -> Self {
        Self { target }
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.target.size()
    }

    /// The texture, to bind in the host's own shaders as a `sampler2D`.
    #[must_use]
    pub fn texture(&self) -> glow::Texture {
        self.target.texture().name()
    }

    /// Reads it back; waits for the GPU.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn read(&self) -> Result<Image<[f32; 4]>> {
        let gl = self.target.texture().gl();
        let _state = StateGuard::new(gl)?;
        let image = self.target.texture().read(0);
        gl.check("reading an irradiance map back")?;
        Ok(image)
    }

    pub(crate) fn target(&mut self) -> &mut Target {
        &mut self.target
    }

    pub(crate) fn as_texture(&self) -> &Texture {
        self.target.texture()
    }
}
