//! The stages in order: the one file that knows them all, and what a host engine calls.

use glam::UVec2;

use crate::certificate::{self, Certificate, Certifier};
use crate::driver_limits;
use crate::error::{Error, Result};
use crate::exactness::{self, Plan};
use crate::gl::{Gl, ShaderSource, StateGuard, TextureFormat};
use crate::maps::{DensityMap, RadiusMap, describe};
use crate::radius::{self, RadiusSearch};
use crate::settings::Settings;
use crate::structure::{self, Structure};

/// Density map in, radius map out, for one size and one set of settings.
///
/// Everything is allocated and compiled by [`RadiusPipeline::new`]; [`render`](Self::render) only draws. Each call
/// puts back the OpenGL state that it touches, also when it fails; the list is the crate's
/// [state contract](crate#the-hosts-opengl-state).
#[derive(Debug)]
pub struct RadiusPipeline {
    gl: Gl,
    settings: Settings,
    size: UVec2,
    density_format: TextureFormat,
    structure: Structure,
    search: RadiusSearch,
    certifier: Certifier,
    /// The map that the structure was built from.
    built: Option<glow::Texture>,
}

impl RadiusPipeline {
    /// Allocates and compiles for maps of `size` in `density_format`.
    ///
    /// # Errors
    /// [`Error::Setting`] outside a setting's range, [`Error::TooLarge`], [`Error::Shader`] if the driver refuses a
    /// shader, [`Error::Gl`] when memory runs out.
    pub fn new(gl: &Gl, size: UVec2, density_format: TextureFormat, settings: Settings) -> Result<Self> {
        settings.validate()?;
        let passes = driver_limits::passes(gl.info(), &settings)?;
        let limit = gl.info().max_texture_size;
        if size.max_element() > limit {
            return Err(Error::TooLarge { size, limit });
        }
        if size.min_element() == 0 {
            return Err(Error::Setting {
                name: "size",
                value: format!("{} x {}", size.x, size.y),
                reason: "a map has at least one pixel".to_owned(),
            });
        }
        let _state = StateGuard::new(gl);
        let pipeline = Self {
            gl: gl.clone(),
            settings,
            size,
            density_format,
            structure: Structure::new(gl, size, density_format, &settings)?,
            search: RadiusSearch::new(gl, size, density_format, &settings, passes)?,
            certifier: Certifier::new(gl, density_format, &settings),
            built: None,
        };
        gl.check("setting up a radius pipeline")?;
        Ok(pipeline)
    }

    /// Builds the structure and searches: all that a frame needs.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if the map's size or format is another than the pipeline's; [`Error::Inexact`] if the
    /// map's bounds do not prove the result exact and [`Settings::exactness`] asks for that; [`Error::Gl`] if the
    /// driver fails.
    pub fn render(&mut self, density: &DensityMap) -> Result<&RadiusMap> {
        self.build(density)?;
        self.search(density)
    }

    /// Fills the intermediate structure: the first half of [`render`](Self::render), apart for timing.
    ///
    /// # Errors
    /// As [`render`](Self::render).
    pub fn build(&mut self, density: &DensityMap) -> Result<()> {
        self.check(density)?;
        let plan = self.plan(density)?;
        let _state = StateGuard::new(&self.gl);
        self.built = None;
        self.structure.build(density, plan)?;
        self.gl.check("building the intermediate structure")?;
        self.built = Some(density.texture().name());
        Ok(())
    }

    /// Searches the structure that [`build`](Self::build) last filled, from the same map.
    ///
    /// # Errors
    /// As [`render`](Self::render), and [`Error::Mismatch`] if the structure was not built from this map.
    pub fn search(&mut self, density: &DensityMap) -> Result<&RadiusMap> {
        self.check_built(density)?;
        let _state = StateGuard::new(&self.gl);
        self.search.estimate(density, &self.structure)?;
        self.gl.check("searching radii")?;
        Ok(self.search.radii())
    }

    /// What the last [`search`](Self::search) found, to be read after it was timed; undefined before the first.
    #[must_use]
    pub fn radii(&self) -> &RadiusMap {
        self.search.radii()
    }

    /// Proves what the last [`search`](Self::search) found, from `density` alone: each radius, each limited pixel, and
    /// each entry of the table. Waits for the GPU; shaders are compiled by the first call. See
    /// [`certificate`].
    ///
    /// # Errors
    /// As [`search`](Self::search); [`Error::Setting`] unless the method is the summed-area table; [`Error::Inexact`]
    /// also where [`Settings::exactness`] waives it; [`Error::Gl`] while a query of the host counts samples.
    pub fn certify(&mut self, density: &DensityMap) -> Result<Certificate> {
        let plan = self.check_certifiable(density)?;
        let _state = StateGuard::new(&self.gl);
        self.certifier.certify(density, plan, &self.structure, self.search.radii())
    }

    /// As [`certify`](Self::certify), for radii that the host found by itself: a [`build`](Self::build) is all that has to
    /// be done before.
    ///
    /// # Errors
    /// As [`certify`](Self::certify), and [`Error::Mismatch`] if the sizes differ.
    pub fn certify_radii(&mut self, density: &DensityMap, radii: &RadiusMap) -> Result<Certificate> {
        let plan = self.check_certifiable(density)?;
        if radii.size() != self.size {
            return Err(Error::Mismatch {
                what: "radius map",
                expected: self.size.to_string(),
                got: radii.size().to_string(),
            });
        }
        let _state = StateGuard::new(&self.gl);
        self.certifier.certify(density, plan, &self.structure, radii)
    }

    /// How the counts of `density` would be taken in, and whether the result is exact.
    ///
    /// # Errors
    /// [`Error::Inexact`] as [`render`](Self::render).
    pub fn plan(&self, density: &DensityMap) -> Result<Plan> {
        exactness::plan(&self.settings, self.size, density.bounds())
    }

    /// The settings that the pipeline was made with.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    fn check_certifiable(&self, density: &DensityMap) -> Result<Plan> {
        Certificate::check_possible(&self.settings)?;
        self.check_built(density)?;
        Certificate::plan(&self.settings, density)
    }

    fn check_built(&self, density: &DensityMap) -> Result<()> {
        self.check(density)?;
        if self.built == Some(density.texture().name()) {
            return Ok(());
        }
        Err(Error::Mismatch {
            what: "density map of the search",
            expected: "the one that was built last".to_owned(),
            got: "another, or none was built".to_owned(),
        })
    }

    fn check(&self, density: &DensityMap) -> Result<()> {
        if density.size() != self.size || density.format() != self.density_format {
            return Err(Error::Mismatch {
                what: "density map",
                expected: describe(self.size, self.density_format),
                got: describe(density.size(), density.format()),
            });
        }
        if self.search.radii().is_written_to(density.texture().name()) {
            return Err(Error::Mismatch {
                what: "density map",
                expected: "a texture of the host".to_owned(),
                got: "the pipeline's own output".to_owned(),
            });
        }
        Ok(())
    }
}

/// The fragment shaders that a pipeline of these settings may compile, in the order of its passes; those of a certificate last.
#[must_use]
pub fn shader_sources(density_format: TextureFormat, settings: &Settings) -> Vec<ShaderSource> {
    let mut sources = structure::build_sources(density_format, settings);
    sources.extend(radius::search_sources(density_format, settings));
    sources.extend(certificate::sources(density_format, settings));
    sources
}
