//! The proof of what a pipeline found.

use super::RadiusPipeline;
use crate::error::{Error, Result};
use crate::gl::StateGuard;
use crate::maps::exactness::Plan;
use crate::maps::{DensityMap, Frame, RadiusMap, Rectangle};
use crate::radius::certificate::Certificate;

impl RadiusPipeline {
    /// Proves what the last [`search`](Self::search) found, from `density` alone: each radius, each limited
    /// pixel, and each entry of the table. Waits for the GPU; shaders are compiled by the first call. See
    /// [`certificate`](crate::radius::certificate).
    ///
    /// # Errors
    /// As [`search`](Self::search); [`Error::Mismatch`] also for a pipeline with masks and for photons that
    /// were added; [`Error::Setting`] unless the method is the summed-area table; [`Error::Inexact`] also
    /// where [`Laboratory::exactness`](crate::settings::Laboratory::exactness) waives it;
    /// [`Error::QueryRunning`] while a query of the host counts samples.
    pub fn certify(&mut self, density: &DensityMap) -> Result<Certificate> {
        let plan = self.prepare_certificate(density)?;
        let _state = StateGuard::new(&self.gl)?;
        self.certifier.certify(density, plan, &self.tables, self.search.radii())
    }

    /// As [`certify`](Self::certify), for radii that the host found by itself: a [`build`](Self::build) is
    /// all that has to be done before.
    ///
    /// # Errors
    /// As [`certify`](Self::certify), and [`Error::Mismatch`] if the sizes differ.
    pub fn certify_radii(&mut self, density: &DensityMap, radii: &RadiusMap) -> Result<Certificate> {
        let plan = self.prepare_certificate(density)?;
        if radii.size() != self.size {
            return Err(Error::size("radius map", self.size, radii.size()));
        }
        let _state = StateGuard::new(&self.gl)?;
        self.certifier.certify(density, plan, &self.tables, radii)
    }

    /// Prepares a certificate: checks that it is possible, and builds a table that was left out for lack of
    /// photons.
    fn prepare_certificate(&mut self, density: &DensityMap) -> Result<Plan> {
        Certificate::check_possible(&self.settings)?;
        if self.settings.masked {
            return Err(Error::Mismatch {
                what: "pipeline of a certificate",
                expected: "one without masks".to_owned(),
                got: "one whose settings say `masked`".to_owned(),
            });
        }
        let frame = Frame::new(density);
        let built = self.check_built(&frame)?;
        if built.grown {
            return Err(Error::Mismatch {
                what: "density map of a certificate",
                expected: "that of all photons".to_owned(),
                got: "that of photons that were added".to_owned(),
            });
        }
        let plan = Certificate::plan(&self.settings, density)?;
        if built.is_empty() {
            let _state = StateGuard::new(&self.gl)?;
            self.tables.build(density, plan, Rectangle::whole(self.size))?;
        }
        Ok(plan)
    }
}
