//! The other way round: each pixel gathers with its own radius.
//!
//! - A pixel's irradiance is the weighted power of the pixels that its kernel covers, over their weighted areas: the count
//!   that was found decides, not n.
//! - Cost: about 4 (2 R + 1)² / π times 3 fetches a pixel, whatever the number of photons.
//! - Photons count as if they were in the middle of their pixels; energy is kept on the whole only, not for each photon.

use glam::UVec2;

use super::density::DensityStage;
use super::splat::{self, check, read_radius};
use crate::error::Result;
use crate::gl::{Gl, Pass, Program, ShaderSource, StateGuard, Target, TextureFormat, glsl};
use crate::maps::{ChosenRadius, IrradianceMap, SurfaceMaps};
use crate::settings::Kernel;

const LABEL: &str = "gather";

/// Gathers with one kernel into maps of one size.
#[derive(Debug)]
pub struct GatherStage {
    gl: Gl,
    program: Program,
    fixed: bool,
    irradiance: IrradianceMap,
}

impl GatherStage {
    /// Allocates and compiles for maps of `size`, and for kernels whose radii come from a map or are `fixed`; `correct` takes
    /// (c - 1) / c of what c photons give.
    ///
    /// # Errors
    /// [`Error::TooLarge`](crate::Error::TooLarge); [`Error::Shader`](crate::Error::Shader) if the driver refuses the shader;
    /// [`Error::Gl`](crate::Error::Gl) when memory runs out.
    pub fn new(gl: &Gl, size: UVec2, kernel: Kernel, fixed: bool, correct: bool) -> Result<Self> {
        let _state = StateGuard::new(gl);
        let program = Program::new(gl, &source(kernel, fixed, correct))?;
        let irradiance = IrradianceMap::of(Target::of(gl, &IrradianceMap::shape(size))?);
        Ok(Self { gl: gl.clone(), program, fixed, irradiance })
    }

    /// Gathers at every pixel from the power of each pixel's photons and their count, as `density` added them up.
    ///
    /// # Errors
    /// [`Error::Mismatch`](crate::Error::Mismatch) if a map has another size, or the radius is fixed and the stage's is not, or
    /// the other way round; [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn gather(
        &mut self,
        surfaces: &SurfaceMaps,
        density: &DensityStage,
        radius: ChosenRadius<'_>,
    ) -> Result<&IrradianceMap> {
        check(surfaces, self.irradiance.size(), radius, self.fixed)?;
        surfaces.check_size(density.map().size())?;
        let _state = StateGuard::new(&self.gl);
        let pass = surfaces.read_by(Pass::new(LABEL, &self.program)).read("power", density.power());
        read_radius(pass, radius).set("camera", surfaces.view().position()).fill(self.irradiance.target())?;
        self.gl.check("gathering photons")?;
        Ok(&self.irradiance)
    }
}

pub(crate) fn source(kernel: Kernel, fixed: bool, correct: bool) -> ShaderSource {
    splat::source(LABEL, kernel, fixed)
        .variant_if(correct, "count-correction")
        .targets([TextureFormat::Rgba32Float])
        .define_if(correct, "COUNT_CORRECTION")
        .file(glsl!("common/surfaces.glsl"))
        .file(glsl!("common/kernel.glsl"))
        .file(glsl!("common/chosen_radius.glsl"))
        .file(glsl!("light/gather.frag"))
}
