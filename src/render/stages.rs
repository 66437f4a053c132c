//! The stages of a picture one by one, to be timed: those of [`Renderer::picture`], on the same pipeline.

use super::{Account, Renderer};
use crate::error::Result;
use crate::image::Image;
use crate::light::IrradiancePipeline;
use crate::maps::{IrradianceMap, PhotonPoints};
use crate::settings::PictureSettings;

impl Renderer {
    /// The photons that are drawn.
    #[must_use]
    pub fn photons(&self) -> &PhotonPoints {
        &self.traced.points
    }

    /// What counts, searches and spreads them.
    #[must_use]
    pub fn pipeline(&self) -> &IrradiancePipeline {
        &self.pipeline
    }

    /// Counts all photons anew.
    ///
    /// # Errors
    /// As [`IrradiancePipeline::count`].
    pub fn count(&mut self) -> Result<()> {
        self.pipeline.clear_photons()?;
        self.pipeline.count(&self.surfaces, &self.traced.points).map(drop)
    }

    /// Makes ready for the radius, kernel and estimate of `settings`: compiles what is not there yet, and forgets the
    /// light.
    ///
    /// # Errors
    /// As [`IrradiancePipeline::change`].
    pub fn change(&mut self, settings: &PictureSettings) -> Result<()> {
        self.pipeline.change(settings.irradiance())?;
        self.count_unless_known()
    }

    /// Finds all radii anew, if they are variable.
    ///
    /// # Errors
    /// As [`IrradiancePipeline::search`].
    pub fn search(&mut self) -> Result<()> {
        self.pipeline.search().map(drop)
    }

    /// Has what light from tables needs of the camera alone made anew by the next light.
    pub fn forget_camera(&mut self) {
        self.pipeline.forget_camera();
    }

    /// Spreads or gathers all photons anew, with the radii that are there; they are searched if photons were counted
    /// since.
    ///
    /// # Errors
    /// As [`IrradiancePipeline::spread`].
    pub fn spread(&mut self) -> Result<&IrradianceMap> {
        self.pipeline.clear_light()?;
        self.pipeline.spread(&self.surfaces, &self.traced.points)
    }

    /// The account of the last counts and of irradiance that they gave.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn account(&self, irradiance: &Image<[f32; 4]>) -> Result<Account> {
        let limited = Image::filled(self.surfaces.size(), 0);
        self.account_of(&self.surfaces.read_position()?, &self.surfaces.read_normal()?, irradiance, &limited)
    }
}
