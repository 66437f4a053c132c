//! The stages of a picture one by one, to be timed: each does what it does within [`Renderer::picture`].

use super::{Account, Renderer};
use crate::error::Result;
use crate::image::Image;
use crate::light::{GatherStage, SplatStage};
use crate::maps::Frame;
use crate::maps::{ChosenRadius, IrradianceMap, PhotonPoints, SurfaceMaps};
use crate::radius::RadiusPipeline;
use crate::settings::{Estimate, PictureSettings, RadiusChoice};

/// A renderer with the shaders for a kernel, ready to draw.
#[derive(Debug)]
pub struct Stages {
    renderer: Renderer,
    radii: RadiusPipeline,
    /// For radii from a map, and for fixed ones.
    splats: [SplatStage; 2],
    gather: GatherStage,
}

impl Renderer {
    /// Compiles and allocates what the kernel, n and MR of `settings` ask for; the gather's radii are variable.
    ///
    /// # Errors
    /// As [`Renderer::picture`].
    pub fn into_stages(mut self, settings: &PictureSettings) -> Result<Stages> {
        settings.validate()?;
        let correct = settings.estimate == Estimate::Gather { count_correction: true };
        let mut radii = self.radius_pipeline(settings)?;
        radii.update(&Frame::new(self.density.map()))?;
        let splat = |fixed| SplatStage::new(&self.gl, self.size, settings.kernel, fixed);
        Ok(Stages {
            radii,
            splats: [splat(false)?, splat(true)?],
            gather: GatherStage::new(&self.gl, self.size, settings.kernel, false, correct)?,
            renderer: self,
        })
    }
}

impl Stages {
    /// The photons that are drawn.
    #[must_use]
    pub fn photons(&self) -> &PhotonPoints {
        &self.renderer.traced.points
    }

    /// What each pixel shows.
    #[must_use]
    pub fn surfaces(&self) -> &SurfaceMaps {
        &self.renderer.surfaces
    }

    /// Counts all photons anew.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn count(&mut self) -> Result<()> {
        self.renderer.density.clear();
        self.renderer.density.add(&self.renderer.surfaces, &self.renderer.traced.points).map(|_| ())
    }

    /// How many photons each pixel has.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn read_counts(&self) -> Result<Image<f32>> {
        self.renderer.density.read_counts()
    }

    /// Finds all radii anew.
    ///
    /// # Errors
    /// As [`RadiusPipeline::update`].
    pub fn search(&mut self) -> Result<()> {
        self.radii.update(&Frame::new(self.renderer.density.map())).map(|_| ())
    }

    /// The radii.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn read_radii(&self) -> Result<Image<u32>> {
        self.radii.radii().read()
    }

    /// Draws each photon as its kernel.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn splat(&mut self, radius: RadiusChoice) -> Result<&IrradianceMap> {
        let Renderer { surfaces, traced, .. } = &self.renderer;
        let [variable, fixed] = &mut self.splats;
        match radius {
            RadiusChoice::Variable => {
                variable.splat(surfaces, &traced.points, ChosenRadius::Map(self.radii.radii()))
            }
            RadiusChoice::Fixed(radius) => fixed.splat(surfaces, &traced.points, ChosenRadius::Fixed(radius)),
        }
    }

    /// Lets each pixel gather with its radius.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn gather(&mut self) -> Result<&IrradianceMap> {
        let Renderer { surfaces, density, .. } = &self.renderer;
        self.gather.gather(surfaces, density, ChosenRadius::Map(self.radii.radii()))
    }

    /// The account of the last counts and of irradiance that a splat or gather gave.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn account(&self, irradiance: &Image<[f32; 4]>) -> Result<Account> {
        let surfaces = &self.renderer.surfaces;
        let limited = Image::filled(surfaces.size(), 0);
        self.renderer.account(&surfaces.read_position()?, &surfaces.read_normal()?, irradiance, &limited)
    }
}
