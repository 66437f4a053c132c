//! Irradiance to picture: reflected by the surface, with direct light added (thesis 2.3.2, 2.4).

use glam::UVec2;

use crate::error::Result;
use crate::gl::{Gl, Pass, Program, ShaderSource, StateGuard, Target, Texture, TextureFormat, glsl};
use crate::image::Image;
use crate::maps::{IrradianceMap, SurfaceMaps};

const LABEL: &str = "shade";

/// Light that is found on the CPU: radiance towards the camera, linear RGB.
#[derive(Clone, Debug)]
pub(crate) struct TracedLight {
    /// Of lights, seen and reflected once by a diffuse surface; also in mirrors and through glass. The fourth value is 1
    /// where the pixel shows a diffuse surface, else 0.
    pub(crate) direct: Image<[f32; 4]>,
    /// Indirect light that is seen in mirrors and through glass.
    pub(crate) seen_through: Image<[f32; 4]>,
}

/// Radiance towards the camera, linear RGB and 1.
#[derive(Clone, Debug)]
pub(crate) struct Shaded {
    pub(crate) beauty: Image<[f32; 4]>,
    pub(crate) indirect: Image<[f32; 4]>,
}

/// The shader and what it reads and fills.
#[derive(Debug)]
pub(crate) struct ShadeStage {
    gl: Gl,
    program: Program,
    direct: Texture,
    seen_through: Texture,
    target: Target,
}

impl ShadeStage {
    pub(crate) fn new(gl: &Gl, size: UVec2) -> Result<Self> {
        let _state = StateGuard::new(gl);
        let plane = || Texture::new(gl, TextureFormat::Rgba32Float, size, 1);
        Ok(Self {
            gl: gl.clone(),
            program: Program::new(gl, &source())?,
            direct: plane()?.labelled("direct light"),
            seen_through: plane()?.labelled("light seen through glass"),
            target: Target::new(gl, vec![plane()?, plane()?])?.labelled(&["picture", "indirect light"]),
        })
    }

    /// The picture, read back.
    pub(crate) fn shade(
        &mut self,
        surfaces: &SurfaceMaps,
        irradiance: &IrradianceMap,
        light: &TracedLight,
    ) -> Result<Shaded> {
        let _state = StateGuard::new(&self.gl);
        self.direct.upload(&light.direct);
        self.seen_through.upload(&light.seen_through);
        Pass::new(LABEL, &self.program)
            .read("irradiance", irradiance.texture())
            .read("albedo", surfaces.albedo())
            .read("direct", &self.direct)
            .read("seen_through", &self.seen_through)
            .fill(&mut self.target)?;
        let [beauty, indirect] = [0, 1].map(|plane: usize| self.target.textures()[plane].read(0));
        self.gl.check("shading")?;
        Ok(Shaded { beauty, indirect })
    }
}

pub(crate) fn source() -> ShaderSource {
    ShaderSource::new(LABEL).file(glsl!("shade.frag"))
}
