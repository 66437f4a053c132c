//! Photons and a g-buffer in, irradiance out: density, radii and kernels in order (thesis 2.6). Hosts,
//! pictures, the window, the C interface and benchmarks all come through here.
//!
//! Photons may come all at once, or part after part, each with the power of all lights: the sum of k parts is
//! then k times the light. Each part is drawn with the radii of all photons so far, so that these shrink as
//! photons come, and the mean of the parts gets sharper. By arithmetic, on even ground: a kernel of part i
//! holds n / i of its photons, so that the part's variance is i / n of its square, and that of the mean of k
//! parts 1 / (2 n), whatever k; one splat of all photons has 1 / n, with kernels as narrow as the last.

use glam::UVec2;

use super::density::DensityStage;
use super::spread::Spreads;
use crate::error::Result;
use crate::gl::{Gl, StateGuard, Targets, TextureFormat, bytes_of};
use crate::maps::{
    DensityMap, FluxMap, Frame, IrradianceMap, KernelRadii, PhotonPoints, PowerMap, RadiusMap, SurfaceMaps,
};
use crate::radius::{RadiusPipeline, check_fits};
use crate::settings::{Estimate, IrradianceSettings, KernelRadius, Settings};

/// Photons and surfaces in, irradiance out, for one size.
///
/// Everything is allocated and compiled by [`new`](Self::new), and by [`change`](Self::change) what other
/// settings need; each call puts back the OpenGL state that it touches, also when it fails.
/// [`render`](Self::render) and [`add`](Self::add) do all of it; [`count`](Self::count),
/// [`search`](Self::search) and [`spread`](Self::spread) are its stages one by one.
#[derive(Debug)]
pub struct IrradiancePipeline {
    gl: Gl,
    settings: IrradianceSettings,
    density: DensityStage,
    /// For variable radii, with the settings that were asked for; kept while they are fixed.
    radii: Option<(Settings, RadiusPipeline)>,
    /// Whether the radii are those of all photons counted.
    searched: bool,
    /// Whether the light is that of all photons counted, by tables: it need not be gathered again.
    gathered: bool,
    spreads: Spreads,
}

impl IrradiancePipeline {
    /// Allocates and compiles for surfaces of `size`.
    ///
    /// # Errors
    /// [`Error::Setting`](crate::Error::Setting) outside of a setting's range,
    /// [`Error::TooLarge`](crate::Error::TooLarge), [`Error::Shader`](crate::Error::Shader) if the driver
    /// refuses a shader, [`Error::Gl`](crate::Error::Gl) when memory runs out.
    pub fn new(gl: &Gl, size: UVec2, settings: IrradianceSettings) -> Result<Self> {
        settings.validate()?;
        check_fits(gl.info(), size)?;
        Ok(Self {
            gl: gl.clone(),
            settings,
            density: DensityStage::of_kind(gl, size, needs_flux(&settings))?,
            radii: if settings.searches_radii() {
                Some((settings.radii, radius_pipeline(gl, size, settings.radii)?))
            } else {
                None
            },
            searched: false,
            gathered: false,
            spreads: Spreads::new(gl, size, &settings)?,
        })
    }

    /// Bytes of textures and buffers for surfaces of `size`, without a context: what [`new`](Self::new) and
    /// [`resize`](Self::resize) allocate. A driver may add to it; surfaces and photons are the host's.
    ///
    /// After [`change`](Self::change), and where the search is planned each frame, more is allocated; see
    /// [`MemoryRequired::other_orders`](crate::MemoryRequired::other_orders).
    ///
    /// # Errors
    /// [`Error::Setting`](crate::Error::Setting) outside of a setting's range.
    pub fn memory_required(size: UVec2, settings: &IrradianceSettings) -> Result<u64> {
        settings.validate()?;
        // Refuses an empty size as well.
        let radii = RadiusPipeline::memory_required(size, &settings.radii)?.at_creation;
        let radii = if settings.searches_radii() { radii } else { 0 };
        let density = bytes_of(&[DensityStage::shape(size, needs_flux(settings))]);
        Ok(radii + density + Spreads::bytes(size, settings))
    }

    /// From now on for surfaces of `size`, without photons: programs stay, textures are made anew. The same
    /// size is free, and changes nothing.
    ///
    /// # Errors
    /// Those of [`RadiusPipeline::resize`]; but for a lost context, the pipeline then goes on at its old
    /// size, with what it held.
    pub fn resize(&mut self, size: UVec2) -> Result<()> {
        if size == self.size() {
            return self.gl.current().map(drop);
        }
        check_fits(self.gl.info(), size)?;
        let _state = StateGuard::new(&self.gl)?;
        let mut shapes = vec![DensityStage::shape(size, self.density.has_flux())];
        shapes.extend(self.spreads.shapes(size));
        let mut targets = Targets::new(&self.gl, &shapes)?;
        self.gl.check("resizing an irradiance pipeline")?;
        if let Some((_, radii)) = &mut self.radii {
            radii.resize(size)?;
        }
        self.density.resize(&mut targets);
        self.spreads.resize(size, &mut targets);
        targets.finish();
        self.searched = false;
        self.gathered = false;
        Ok(())
    }

    /// Goes on with other settings and the photons that were counted, without light: it has to be
    /// [`spread`](Self::spread) anew. The same settings change nothing. Between tables and the others photons
    /// are counted otherwise: then there are none, and they have to be [counted](Self::count) anew.
    ///
    /// What was compiled stays for later: a search of the same question, and the last kernel of a splat and
    /// of a gather, of variable and of fixed radii. So it takes more memory than a new pipeline.
    ///
    /// # Errors
    /// As [`new`](Self::new); the settings are those of before then.
    pub fn change(&mut self, settings: IrradianceSettings) -> Result<()> {
        settings.validate()?;
        if settings == self.settings {
            return Ok(());
        }
        let size = self.size();
        let wants_radii = settings.searches_radii();
        let has_flux = needs_flux(&settings);
        let density = if has_flux == self.density.has_flux() {
            None
        } else {
            Some(DensityStage::of_kind(&self.gl, size, has_flux)?)
        };
        let is_known = self.radii.as_ref().is_some_and(|(asked, _)| *asked == settings.radii);
        let searches = if wants_radii && !is_known {
            Some((settings.radii, radius_pipeline(&self.gl, size, settings.radii)?))
        } else {
            None
        };
        self.spreads.change(&self.gl, size, &settings)?;
        if searches.is_some() {
            self.radii = searches;
            self.searched = false;
        }
        if let Some(density) = density {
            self.density = density;
            self.searched = false;
        }
        // What the stage held when it was used last is of other settings or photons.
        self.clear_light()?;
        self.settings = settings;
        Ok(())
    }

    /// The light of these photons, which carry the power of all lights together.
    ///
    /// # Errors
    /// As [`add`](Self::add).
    pub fn render(&mut self, surfaces: &SurfaceMaps, photons: &PhotonPoints) -> Result<&IrradianceMap> {
        self.clear()?;
        self.add(surfaces, photons)
    }

    /// Adds the light of these photons to what is there, with the radii of all photons so far.
    ///
    /// # Errors
    /// [`Error::Mismatch`](crate::Error::Mismatch) if the surfaces have another size;
    /// [`Error::Inexact`](crate::Error::Inexact) where a pixel has more photons than can be counted, see
    /// [`DensityStage::add`], and as [`RadiusPipeline::render`]; [`Error::Gl`](crate::Error::Gl) if the
    /// driver fails.
    pub fn add(&mut self, surfaces: &SurfaceMaps, photons: &PhotonPoints) -> Result<&IrradianceMap> {
        self.count(surfaces, photons)?;
        self.spread(surfaces, photons)
    }

    /// Counts photons in, beside those that are there.
    ///
    /// # Errors
    /// As [`DensityStage::add`].
    pub fn count(&mut self, surfaces: &SurfaceMaps, photons: &PhotonPoints) -> Result<&DensityMap> {
        if photons.count() > 0 {
            self.searched = false;
            self.gathered = false;
        }
        self.density.add(surfaces, photons)
    }

    /// Finds the radii of all photons so far; none if radii are fixed.
    ///
    /// # Errors
    /// As [`RadiusPipeline::update`].
    pub fn search(&mut self) -> Result<Option<&RadiusMap>> {
        let Some((_, radii)) = self.radii.as_mut().filter(|_| self.settings.searches_radii()) else {
            return Ok(None);
        };
        self.searched = false;
        let radii = radii.update(&Frame::new(self.density.map()))?;
        self.searched = true;
        Ok(Some(radii))
    }

    /// Spreads these photons, which were counted before, with the radii of all photons so far, and adds their
    /// light to what is there; a gather finds the light of all photons instead. Radii are searched if they
    /// were not since photons came. Light from tables stays where no photon came and the camera stands still.
    ///
    /// # Errors
    /// As [`add`](Self::add).
    pub fn spread(&mut self, surfaces: &SurfaceMaps, photons: &PhotonPoints) -> Result<&IrradianceMap> {
        if self.gathered {
            surfaces.check_size(self.size())?;
            self.gl.current()?;
            return Ok(self.spreads.irradiance());
        }
        if !self.searched {
            self.search()?;
        }
        let radius = match (self.settings.radius, &self.radii) {
            (KernelRadius::Fixed(radius), _) => KernelRadii::Fixed(radius),
            (KernelRadius::Variable, Some((_, radii))) => KernelRadii::Map(radii.radii()),
            // Tables ask for none.
            (KernelRadius::Variable, None) => KernelRadii::Fixed(0),
        };
        let irradiance = self.spreads.add(surfaces, photons, &self.density, radius)?;
        self.gathered = self.settings.estimate == Estimate::Tables;
        Ok(irradiance)
    }

    /// Forgets all photons and their light: when the camera or what it sees has moved.
    ///
    /// # Errors
    /// [`Error::HostState`](crate::Error::HostState), [`Error::WrongContext`](crate::Error::WrongContext).
    pub fn clear(&mut self) -> Result<()> {
        self.clear_photons()?;
        self.clear_light()?;
        self.forget_camera();
        Ok(())
    }

    /// Has what light from tables needs of the camera and the surfaces alone made anew by the next light:
    /// without this, or [`clear`](Self::clear), these are taken to stand still.
    pub fn forget_camera(&mut self) {
        self.spreads.forget_camera();
        self.gathered = false;
    }

    /// Forgets the photons that were counted.
    ///
    /// # Errors
    /// As [`clear`](Self::clear).
    pub fn clear_photons(&mut self) -> Result<()> {
        self.density.clear()?;
        self.searched = false;
        self.gathered = false;
        Ok(())
    }

    /// Forgets the light, and keeps the photons that were counted.
    ///
    /// # Errors
    /// As [`clear`](Self::clear).
    pub fn clear_light(&mut self) -> Result<()> {
        self.spreads.clear()?;
        self.gathered = false;
        Ok(())
    }

    /// Searches radii again for the next light, though they are known.
    pub fn clear_radii(&mut self) {
        self.searched = false;
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.density.map().size()
    }

    /// Photons of each pixel.
    #[must_use]
    pub fn density(&self) -> &DensityMap {
        self.density.map()
    }

    /// Power of each pixel's photons; for light from tables it is in [`flux`](Self::flux).
    #[must_use]
    pub fn power(&self) -> Option<&PowerMap> {
        self.density.power()
    }

    /// Power of each pixel's photons in whole units, for light from tables.
    #[must_use]
    pub fn flux(&self) -> Option<&FluxMap> {
        self.density.flux()
    }

    /// The radii of the last photons' kernels, if they are variable, or those that light from tables was
    /// gathered from; undefined before the first light.
    #[must_use]
    pub fn radii(&self) -> Option<&RadiusMap> {
        let radii = self.radii.as_ref().filter(|_| self.settings.searches_radii());
        radii.map(|(_, radii)| radii.radii()).or_else(|| self.spreads.widths())
    }

    /// The light so far.
    #[must_use]
    pub fn irradiance(&self) -> &IrradianceMap {
        self.spreads.irradiance()
    }

    /// The stage that counts photons.
    #[must_use]
    pub fn density_stage(&self) -> &DensityStage {
        &self.density
    }

    /// The settings of the next photons.
    #[must_use]
    pub fn settings(&self) -> &IrradianceSettings {
        &self.settings
    }
}

/// Whether photons are counted in whole units of power.
fn needs_flux(settings: &IrradianceSettings) -> bool {
    settings.estimate == Estimate::Tables
}

fn radius_pipeline(gl: &Gl, size: UVec2, settings: Settings) -> Result<RadiusPipeline> {
    RadiusPipeline::new(gl, size, TextureFormat::R32Float, settings)
}
