//! A host's depth buffer to the places that its pixels show.
//!
//! - Cost: one pass, one fetch a pixel. Memory: 16 bytes a pixel.
//! - Rounding: a depth of 24 bits or f32 places a surface at distance z to about 2^-24 z² / near along the
//!   line of sight, a 32-bit reversed one to about 2^-24 z. Photons are looked for within half a pixel of the
//!   surface, so that near / far may be 10^-4 or less; a depth of 16 bits is too coarse.

use super::host_depth::HostDepth;
use crate::error::Result;
use crate::gl::{Gl, Pass, Program, ShaderSource, StateGuard, Target, Texture, TextureFormat, glsl};
use crate::view::View;

const LABEL: &str = "positions from depth";

/// Makes positions for [`HostSurfaces`](crate::HostSurfaces) out of depth.
#[derive(Debug)]
pub struct PositionMaker {
    gl: Gl,
    program: Program,
    depth: Texture,
    reversed: bool,
    zero_to_one: bool,
    target: Target,
}

impl PositionMaker {
    /// Uses a depth buffer that the host owns and keeps alive as long as this; its contents may change
    /// between frames. Allocates and compiles for its size.
    ///
    /// # Errors
    /// [`Error::Mismatch`](crate::Error::Mismatch) unless the texture is a GL_TEXTURE_2D with depth;
    /// [`Error::Shader`](crate::Error::Shader) if the driver refuses the shader;
    /// [`Error::Gl`](crate::Error::Gl) when memory runs out.
    pub fn borrow(gl: &Gl, depth: HostDepth) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let HostDepth { texture, reversed, zero_to_one } = depth;
        let depth = Texture::borrow_depth(gl, texture)?;
        let texture = Texture::new(gl, TextureFormat::Rgba32Float, depth.size(), 1)?;
        Ok(Self {
            gl: gl.clone(),
            program: Program::new(gl, &Self::shader_source())?,
            depth,
            reversed,
            zero_to_one,
            target: Target::single(gl, texture)?.labelled(&["positions"]),
        })
    }

    /// The places that the depth buffer shows, drawn with the matrices of `view`: GL_RGBA32F, the depth along
    /// the view in the fourth value, all 0 where the depth is that of the far plane.
    ///
    /// # Errors
    /// [`Error::Mismatch`](crate::Error::Mismatch) unless the view has the size of the depth buffer;
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn render(&mut self, view: &View) -> Result<glow::Texture> {
        view.check_size(self.target.size())?;
        let _state = StateGuard::new(&self.gl)?;
        let from_clip = view.to_clip().as_dmat4().inverse().as_mat4();
        let (scale, shift) = if self.zero_to_one { (1.0, 0.0) } else { (2.0, 1.0) };
        Pass::new(LABEL, &self.program)
            .read("depth", &self.depth)
            .set("from_clip", from_clip)
            .set("camera", view.position())
            .set("view_direction", view.direction())
            .set("farthest", if self.reversed { 0.0 } else { 1.0 })
            .set("depth_scale", scale)
            .set("depth_shift", shift)
            .fill(&mut self.target)?;
        self.gl.check("finding positions")?;
        Ok(self.texture())
    }

    /// The texture that [`render`](Self::render) fills.
    #[must_use]
    pub fn texture(&self) -> glow::Texture {
        self.target.texture().name()
    }

    /// The shader.
    #[must_use]
    pub fn shader_source() -> ShaderSource {
        ShaderSource::new(LABEL).targets([TextureFormat::Rgba32Float]).file(glsl!("maps/position.frag"))
    }
}
