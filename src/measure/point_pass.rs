//! The unit of time for draws of photons: every photon as a point, nothing read, one added to GL_R32F.

use glam::Vec4;

use crate::error::Result;
use crate::gl::{Gl, Pass, Program, ShaderSource, StateGuard, Target, Texture, TextureFormat, glsl};
use crate::image::Image;
use crate::maps::PhotonPoints;
use crate::view::View;

const LABEL: &str = "points";

/// Its shader and its target.
#[derive(Debug)]
pub struct PointPass {
    gl: Gl,
    view: View,
    program: Program,
    target: Target,
}

impl PointPass {
    /// Compiles and allocates, for the pixels of a view.
    ///
    /// # Errors
    /// [`Error::TooLarge`](crate::Error::TooLarge), [`Error::Shader`](crate::Error::Shader), or
    /// [`Error::OutOfMemory`](crate::Error::OutOfMemory).
    pub fn new(gl: &Gl, view: &View) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let program = Program::new(gl, &Self::source())?;
        let target = Target::single(gl, Texture::new(gl, TextureFormat::R32Float, view.size(), 1)?)?
            .labelled(&["points"]);
        Ok(Self { gl: gl.clone(), view: *view, program, target })
    }

    /// Its shader.
    #[must_use]
    pub fn source() -> ShaderSource {
        ShaderSource::new(LABEL)
            .targets([TextureFormat::R32Float])
            .vertex_file(glsl!("measure/points.vert"))
            .file(glsl!("measure/points.frag"))
    }

    /// Draws all photons once.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn run(&mut self, photons: &PhotonPoints) -> Result<()> {
        let _state = StateGuard::new(&self.gl)?;
        self.target.clear_floats(&[Vec4::ZERO]);
        for chunk in photons.chunks() {
            Pass::new(LABEL, &self.program)
                .set("to_clip", self.view.to_clip())
                .add_points(chunk, &mut self.target)?;
        }
        self.gl.check("drawing points")
    }

    /// Reads back how many photons the last [`run`](Self::run) drew at each pixel.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn read(&self) -> Result<Image<f32>> {
        let _state = StateGuard::new(&self.gl)?;
        let image = self.target.texture().read(0);
        self.gl.check("reading points back")?;
        Ok(image)
    }
}
