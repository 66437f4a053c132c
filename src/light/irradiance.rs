//! Photons and a g-buffer in, irradiance out: density, radii and splat in order (thesis 2.6).
//!
//! Photons may come all at once, or part after part, each with the power of all lights: the sum of k parts is then k times
//! the light. Each part is drawn with the radii of all photons so far, so that these shrink as photons come, and the mean
//! of the parts gets sharper. By arithmetic, on even ground: a kernel of part i holds n / i of its photons, so that the part's
//! variance is i / n of its square, and that of the mean of k parts 1 / (2 n), whatever k; one splat of all photons has 1 / n, with
//! kernels as narrow as the last.

use glam::UVec2;

use super::density::{self, DensityStage};
use super::gather;
use super::splat::{self, SplatStage};
use crate::error::Result;
use crate::gl::{Gl, ShaderSource, StateGuard, Targets, TextureFormat, bytes_of};
use crate::maps::Frame;
use crate::maps::{ChosenRadius, DensityMap, IrradianceMap, PhotonPoints, RadiusMap, SurfaceMaps};
use crate::radius::{RadiusPipeline, check_fits};
use crate::settings::{IrradianceSettings, Kernel, RadiusChoice};

/// Photons and surfaces in, irradiance out, for one size and one set of settings.
///
/// Everything is allocated and compiled by [`new`](Self::new); each call puts back the OpenGL state that it touches, also when
/// it fails. The stages are usable apart: [`DensityStage`], [`RadiusPipeline`], [`SplatStage`].
#[derive(Debug)]
pub struct IrradiancePipeline {
    gl: Gl,
    settings: IrradianceSettings,
    density: DensityStage,
    /// For variable radii.
    radii: Option<RadiusPipeline>,
    splat: SplatStage,
}

impl IrradiancePipeline {
    /// Allocates and compiles for surfaces of `size`.
    ///
    /// # Errors
    /// [`Error::Setting`](crate::Error::Setting) outside of a setting's range, [`Error::TooLarge`](crate::Error::TooLarge),
    /// [`Error::Shader`](crate::Error::Shader) if the driver refuses a shader, [`Error::Gl`](crate::Error::Gl) when memory runs
    /// out.
    pub fn new(gl: &Gl, size: UVec2, settings: IrradianceSettings) -> Result<Self> {
        settings.validate()?;
        check_fits(gl.info(), size)?;
        let fixed = matches!(settings.radius, RadiusChoice::Fixed(_));
        let radii = || RadiusPipeline::new(gl, size, TextureFormat::R32Float, settings.search);
        Ok(Self {
            gl: gl.clone(),
            settings,
            density: DensityStage::new(gl, size)?,
            radii: if fixed { None } else { Some(radii()?) },
            splat: SplatStage::new(gl, size, settings.kernel, fixed)?,
        })
    }

    /// Bytes of textures and buffers for surfaces of `size`, without a context: what [`new`](Self::new) and
    /// [`resize`](Self::resize) allocate. A driver may add to it; surfaces and photons are the host's.
    ///
    /// # Errors
    /// [`Error::Setting`](crate::Error::Setting) outside of a setting's range.
    pub fn memory_required(size: UVec2, settings: &IrradianceSettings) -> Result<u64> {
        settings.validate()?;
        // Refuses an empty size as well.
        let radii = RadiusPipeline::memory_required(size, &settings.search)?.at_creation;
        let radii = if settings.radius == RadiusChoice::Variable { radii } else { 0 };
        Ok(radii + bytes_of(&[DensityStage::shape(size)]) + SplatStage::bytes(size))
    }

    /// From now on for surfaces of `size`, without photons: programs stay, textures are made anew. The same size is free, and
    /// changes nothing.
    ///
    /// # Errors
    /// Those of [`RadiusPipeline::resize`]; but for a lost context, the pipeline then goes on at its old size, with what it held.
    pub fn resize(&mut self, size: UVec2) -> Result<()> {
        if size == self.density.map().size() {
            return self.gl.current().map(drop);
        }
        check_fits(self.gl.info(), size)?;
        let state = StateGuard::new(&self.gl);
        let mut shapes = vec![DensityStage::shape(size)];
        shapes.extend(SplatStage::shapes(size));
        let mut targets = Targets::new(&self.gl, &shapes)?;
        self.gl.check("resizing an irradiance pipeline")?;
        drop(state);
        if let Some(radii) = &mut self.radii {
            radii.resize(size)?;
        }
        self.density.resize(&mut targets);
        self.splat.resize(&mut targets);
        targets.finish();
        Ok(())
    }

    /// The light of these photons, which carry the power of all lights together.
    ///
    /// # Errors
    /// As [`add`](Self::add).
    pub fn render(&mut self, surfaces: &SurfaceMaps, photons: &PhotonPoints) -> Result<&IrradianceMap> {
        self.clear();
        self.add(surfaces, photons)
    }

    /// Adds the light of these photons to what is there, with the radii of all photons so far.
    ///
    /// # Errors
    /// [`Error::Mismatch`](crate::Error::Mismatch) if the surfaces have another size;
    /// [`Error::Inexact`](crate::Error::Inexact) where a pixel has more photons than can be counted, see
    /// [`DensityStage::add`], and as [`RadiusPipeline::render`]; [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn add(&mut self, surfaces: &SurfaceMaps, photons: &PhotonPoints) -> Result<&IrradianceMap> {
        let density = self.density.add(surfaces, photons)?;
        let radius = match (&mut self.radii, self.settings.radius) {
            (Some(radii), _) => ChosenRadius::Map(radii.update(&Frame::new(density))?),
            (None, RadiusChoice::Fixed(radius)) => ChosenRadius::Fixed(radius),
            (None, RadiusChoice::Variable) => unreachable!("made with a search"),
        };
        self.splat.add(surfaces, photons, radius)
    }

    /// Forgets all photons and their light: when the camera or what it sees has moved.
    pub fn clear(&mut self) {
        self.density.clear();
        self.splat.clear();
    }

    /// Photons of each pixel.
    #[must_use]
    pub fn density(&self) -> &DensityMap {
        self.density.map()
    }

    /// The radii of the last photons' kernels, if they are variable; undefined before the first.
    #[must_use]
    pub fn radii(&self) -> Option<&RadiusMap> {
        self.radii.as_ref().map(RadiusPipeline::radii)
    }

    /// The light so far.
    #[must_use]
    pub fn irradiance(&self) -> &IrradianceMap {
        self.splat.irradiance()
    }

    /// The stage that counts photons.
    #[must_use]
    pub fn density_stage(&self) -> &DensityStage {
        &self.density
    }

    /// The settings that the pipeline was made with.
    #[must_use]
    pub fn settings(&self) -> &IrradianceSettings {
        &self.settings
    }
}

/// Every shader that photons become irradiance by, beside those of the radius map: density, splats and gathers of all kernels.
#[must_use]
pub fn shader_sources() -> Vec<ShaderSource> {
    let kernels = Kernel::ALL.into_iter().flat_map(|kernel| [(kernel, false), (kernel, true)]);
    let spreads = kernels.flat_map(|(kernel, fixed)| spread_sources(kernel, fixed));
    std::iter::once(density_source()).chain(spreads).collect()
}

/// The shader that counts photons.
#[must_use]
pub fn density_source() -> ShaderSource {
    density::source()
}

/// The shaders of splats and gathers by one kernel, whose radii are variable or fixed.
#[must_use]
pub fn spread_sources(kernel: Kernel, fixed: bool) -> Vec<ShaderSource> {
    let gathers = [false, true].map(|correct| gather::source(kernel, fixed, correct));
    splat::sources(kernel, fixed).into_iter().chain(gathers).collect()
}
