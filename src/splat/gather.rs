//! The other way round: each pixel gathers with its own radius.
//!
//! - A pixel's irradiance is the weighted power of the pixels that its kernel covers, over their weighted areas: the count
//!   that was found decides, not n.
//! - Cost: about 4 (2 R + 1)² / π times 3 fetches a pixel, whatever the number of photons.
//! - Photons count as if they were in the middle of their pixels; energy is kept on the whole only, not for each photon.

use glam::UVec2;

use super::read_radius;
use crate::error::Result;
use crate::gl::{Gl, Pass, Program, ShaderSource, StateGuard, Texture, glsl};
use crate::maps::{ChosenRadius, IrradianceMap, SurfaceMaps};
use crate::settings::Kernel;

const LABEL: &str = "gather";

/// The shader of one kernel, and what it fills.
#[derive(Debug)]
pub(crate) struct GatherStage {
    gl: Gl,
    program: Program,
    irradiance: IrradianceMap,
}

impl GatherStage {
    /// For kernels whose radii come from a map or are fixed; `correct` takes (c - 1) / c of what c photons give.
    pub(crate) fn new(gl: &Gl, size: UVec2, kernel: Kernel, fixed: bool, correct: bool) -> Result<Self> {
        let _state = StateGuard::new(gl);
        let program = Program::new(gl, &source(kernel, fixed, correct))?;
        Ok(Self { gl: gl.clone(), program, irradiance: IrradianceMap::new(gl, size)? })
    }

    /// Gathers at every pixel from the power of each pixel's photons and their count.
    pub(crate) fn gather(
        &mut self,
        surfaces: &SurfaceMaps,
        power: &Texture,
        radius: ChosenRadius<'_>,
    ) -> Result<&IrradianceMap> {
        let _state = StateGuard::new(&self.gl);
        let pass = surfaces.read_by(Pass::new(LABEL, &self.program)).read("power", power);
        read_radius(pass, radius).set("camera", surfaces.view().position()).fill(self.irradiance.target())?;
        self.gl.check("gathering photons")?;
        Ok(&self.irradiance)
    }
}

pub(crate) fn source(kernel: Kernel, fixed: bool, correct: bool) -> ShaderSource {
    super::source(LABEL, kernel, fixed)
        .define_if(correct, "COUNT_CORRECTION")
        .file(glsl!("common/surfaces.glsl"))
        .file(glsl!("common/kernel.glsl"))
        .file(glsl!("common/chosen_radius.glsl"))
        .file(glsl!("gather.frag"))
}
