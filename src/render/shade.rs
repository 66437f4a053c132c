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
    /// Of lights, seen and reflected once by a diffuse surface; also in mirrors and through glass. The fourth
    /// value is 1 where the pixel shows a diffuse surface, else 0.
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
        let _state = StateGuard::new(gl)?;
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
        self.set_light(&light.direct, &light.seen_through)?;
        self.draw(surfaces, irradiance, 1.0)?;
        self.read()
    }

    /// Takes in light as [`TracedLight`] holds it.
    pub(crate) fn set_light(
        &mut self,
        direct: &Image<[f32; 4]>,
        seen_through: &Image<[f32; 4]>,
    ) -> Result<()> {
        let _state = StateGuard::new(&self.gl)?;
        self.direct.upload(direct);
        self.seen_through.upload(seen_through);
        Ok(())
    }

    /// Draws the picture with `scale` times the irradiance.
    pub(crate) fn draw(
        &mut self,
        surfaces: &SurfaceMaps,
        irradiance: &IrradianceMap,
        scale: f32,
    ) -> Result<()> {
        let _state = StateGuard::new(&self.gl)?;
        Pass::new(LABEL, &self.program)
            .read("irradiance", irradiance.as_texture())
            .read("albedo", surfaces.albedo())
            .read("direct", &self.direct)
            .read("seen_through", &self.seen_through)
            .set("scale", scale)
            .fill(&mut self.target)?;
        self.gl.check("shading")
    }

    /// What was drawn, read back; waits for the GPU.
    pub(crate) fn read(&self) -> Result<Shaded> {
        let _state = StateGuard::new(&self.gl)?;
        let [beauty, indirect] = [0, 1].map(|plane: usize| self.target.textures()[plane].read(0));
        self.gl.check("reading a picture back")?;
        Ok(Shaded { beauty, indirect })
    }

    pub(crate) fn beauty(&self) -> &Texture {
        self.target.texture()
    }

    pub(crate) fn indirect(&self) -> &Texture {
        &self.target.textures()[1]
    }

    pub(crate) fn direct(&self) -> &Texture {
        &self.direct
    }
}

pub(crate) fn source() -> ShaderSource {
    ShaderSource::new(LABEL).targets([TextureFormat::Rgba32Float; 2]).file(glsl!("render/shade.frag"))
}
