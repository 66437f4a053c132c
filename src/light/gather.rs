//! The other way round: each pixel gathers with its own radius.
//!
//! - A pixel's irradiance is the weighted power of the pixels that its kernel covers, over their weighted
//!   areas: the count that was found decides, not n.
//! - Cost: about 4 (2 R + 1)² / π times 3 fetches a pixel, whatever the number of photons.
//! - Photons count as if they were in the middle of their pixels; energy is kept on the whole only, not for
//!   each photon.

use glam::UVec2;

use super::kernel_pass::{self, check, read_radius};
use crate::error::Result;
use crate::gl::{Gl, Pass, Program, ShaderSource, StateGuard, Target, Targets, TextureFormat, glsl};
use crate::maps::{IrradianceMap, KernelRadii, PowerMap, SurfaceMaps};
use crate::settings::{Estimate, IrradianceSettings, KernelRadius};

const LABEL: &str = "gather";

/// Gathers with one kernel into maps of one size.
#[derive(Debug)]
pub struct GatherStage {
    gl: Gl,
    program: Program,
    radius: KernelRadius,
    irradiance: IrradianceMap,
}

impl GatherStage {
    /// Allocates and compiles for maps of `size`, and for the kernel, the correction and the kind of radii of
    /// `settings`: from a map, or the same everywhere, whatever that radius is.
    ///
    /// # Errors
    /// [`Error::TooLarge`](crate::Error::TooLarge); [`Error::Shader`](crate::Error::Shader) if the driver
    /// refuses the shader; [`Error::Gl`](crate::Error::Gl) when memory runs out.
    pub fn new(gl: &Gl, size: UVec2, settings: &IrradianceSettings) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let program = Program::new(gl, &source(settings))?;
        let irradiance = IrradianceMap::of(Target::of(gl, &IrradianceMap::shape(size))?);
        Ok(Self { gl: gl.clone(), program, radius: settings.radius, irradiance })
    }

    /// Goes on with another target.
    pub(super) fn resize(&mut self, targets: &mut Targets) {
        self.irradiance = IrradianceMap::of(targets.take());
    }

    /// What was gathered last.
    #[must_use]
    pub fn irradiance(&self) -> &IrradianceMap {
        &self.irradiance
    }

    /// Gathers at every pixel from the power of each pixel's photons and their count.
    ///
    /// # Errors
    /// [`Error::Mismatch`](crate::Error::Mismatch) if a map has another size, or the radius is fixed and the
    /// stage's is not, or the other way round; [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn gather(
        &mut self,
        surfaces: &SurfaceMaps,
        power: &PowerMap,
        radius: KernelRadii<'_>,
    ) -> Result<&IrradianceMap> {
        check(surfaces, self.irradiance.size(), radius, self.radius)?;
        surfaces.check_size(power.size())?;
        let _state = StateGuard::new(&self.gl)?;
        let pass = surfaces.read_by(Pass::new(LABEL, &self.program)).read("power", power.as_texture());
        read_radius(pass, radius).set("camera", surfaces.view().position()).fill(self.irradiance.target())?;
        self.gl.check("gathering photons")?;
        Ok(&self.irradiance)
    }
}

/// The shader of these settings.
pub(super) fn source(settings: &IrradianceSettings) -> ShaderSource {
    let corrects = settings.estimate == Estimate::Gather { count_correction: true };
    kernel_pass::source(LABEL, settings)
        .variant_if(corrects, "count-correction")
        .targets([TextureFormat::Rgba32Float])
        .define_if(corrects, "COUNT_CORRECTION")
        .file(glsl!("common/surfaces.glsl"))
        .file(glsl!("common/kernel.glsl"))
        .file(glsl!("common/kernel_radius.glsl"))
        .file(glsl!("light/gather.frag"))
}
