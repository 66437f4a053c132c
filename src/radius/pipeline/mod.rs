//! The stages in order: the one file that knows them all, and what a host engine calls.

mod size;

use glam::UVec2;
pub use size::MemoryRequired;
pub(crate) use size::check_fits;

use crate::error::{Error, Result};
use crate::gl::{Gl, ShaderSource, StateGuard, TextureFormat};
use crate::maps::Mask;
use crate::maps::exactness::{self, CountBounds, Plan};
use crate::maps::{Changed, Frame, Rectangle};
use crate::maps::{DensityMap, RadiusMap, describe};
use crate::radius::certificate::{self, Certificate, Certifier};
use crate::radius::driver_limits;
use crate::radius::search::{self, RadiusSearch};
use crate::radius::tables::{self, Tables};
use crate::settings::{Order, Search, Settings};

/// Density map in, radius map out, for one size and one set of settings.
///
/// Everything is allocated and compiled by [`RadiusPipeline::new`]; [`render`](Self::render) only draws. Each call
/// puts back the OpenGL state that it touches, also when it fails; the list is the crate's
/// [state contract](crate::gl::state_contract).
#[derive(Debug)]
pub struct RadiusPipeline {
    gl: Gl,
    settings: Settings,
    size: UVec2,
    density_format: TextureFormat,
    tables: Tables,
    search: RadiusSearch,
    certifier: Certifier,
    /// Searches of other orders, which [`set_order`](RadiusPipeline::set_order) left.
    resting: Vec<(Order, RadiusSearch)>,
    /// What the structure holds.
    built: Option<Built>,
    /// Whether the radii are those of what the structure held last, so that a frame's changes can be searched alone.
    searched: bool,
}

/// What a structure was built from.
#[derive(Clone, Copy, Debug)]
struct Built {
    map: glow::Texture,
    plan: Plan,
    /// Bounds of all photons in it.
    bounds: CountBounds,
    /// Whether photons were added to it, so that the map holds a part of them only.
    grown: bool,
}

impl Built {
    /// Nothing was built, since there is no photon.
    fn is_empty(&self) -> bool {
        self.bounds.total == 0
    }
}

impl RadiusPipeline {
    /// Allocates and compiles for maps of `size` in `density_format`.
    ///
    /// # Errors
    /// [`Error::Setting`] outside a setting's range, [`Error::TooLarge`], [`Error::Shader`] if the driver refuses a
    /// shader, [`Error::OutOfMemory`] ([`memory_required`](Self::memory_required) says how much is needed),
    /// [`Error::ContextLost`], [`Error::Gl`] if the driver fails otherwise.
    pub fn new(gl: &Gl, size: UVec2, density_format: TextureFormat, settings: Settings) -> Result<Self> {
        settings.validate()?;
        let passes = driver_limits::passes(gl.info(), &settings)?;
        check_fits(gl.info(), size)?;
        let _state = StateGuard::new(gl);
        let pipeline = Self {
            gl: gl.clone(),
            settings,
            size,
            density_format,
            tables: Tables::new(gl, size, density_format, &settings)?,
            search: RadiusSearch::new(gl, size, density_format, &settings, passes)?,
            certifier: Certifier::new(gl, density_format, &settings),
            resting: Vec::new(),
            built: None,
            searched: false,
        };
        gl.check("setting up a radius pipeline")?;
        Ok(pipeline)
    }

    /// Builds the structure and searches: all that a frame needs when nothing is known of the one before.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if the map's size or format is another than the pipeline's; [`Error::Inexact`] if the
    /// map's bounds do not prove the result exact and [`Settings::exactness`] asks for that; [`Error::Gl`] if the
    /// driver fails; [`Error::ContextLost`], from then on for every call.
    pub fn render(&mut self, density: &DensityMap) -> Result<&RadiusMap> {
        self.update(&Frame::new(density))
    }

    /// Builds and searches what differs from the frame before, for the pixels that need a radius.
    ///
    /// Of [`Frame::changed`], the pipeline believes what it can use: it starts anew when it has no frame before, or one of
    /// another map, or one whose counts were taken in otherwise. Only tables built by a scan and bracketed searches leave
    /// out what did not change; others do all of it, or the rectangle with a margin of MR.
    ///
    /// # Errors
    /// As [`render`](Self::render); [`Error::Mismatch`] also if the mask is missing, not expected, or of another size;
    /// [`Error::Setting`] for photons to be added without a summed-area table.
    pub fn update(&mut self, frame: &Frame<'_>) -> Result<&RadiusMap> {
        self.check_mask(frame)?;
        self.build_frame(frame)?;
        self.search_frame(frame)
    }

    /// Fills the intermediate structure: the first half of [`render`](Self::render), apart for timing.
    ///
    /// # Errors
    /// As [`render`](Self::render).
    pub fn build(&mut self, density: &DensityMap) -> Result<()> {
        self.searched = false;
        self.build_frame(&Frame::new(density))
    }

    /// Searches the structure that [`build`](Self::build) last filled, from the same map.
    ///
    /// # Errors
    /// As [`render`](Self::render), and [`Error::Mismatch`] if the structure was not built from this map.
    pub fn search(&mut self, density: &DensityMap) -> Result<&RadiusMap> {
        self.search_frame(&Frame::new(density))
    }

    /// The second half of [`update`](Self::update) alone, with all that is in the frame: another mask, for one.
    ///
    /// # Errors
    /// As [`search`](Self::search) and [`update`](Self::update).
    pub fn search_frame(&mut self, frame: &Frame<'_>) -> Result<&RadiusMap> {
        let built = self.check_built(frame)?;
        self.check_mask(frame)?;
        let changed = if self.searched { frame.changed } else { Changed::Everything };
        if changed == Changed::Nothing {
            return Ok(self.search.radii());
        }
        let frame = Frame { changed, ..*frame };
        let _state = StateGuard::new(&self.gl);
        self.searched = false;
        if built.is_empty() {
            self.search.find_nothing(&frame)?;
        } else {
            self.search.estimate(&frame, &self.tables)?;
        }
        self.gl.check("searching radii")?;
        self.searched = true;
        Ok(self.search.radii())
    }

    /// The first half of [`update`](Self::update).
    fn build_frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        self.check(frame)?;
        let density = frame.density;
        let map = density.texture();
        let before = self.built.filter(|built| !built.is_empty());
        let bounds = self.bounds_with(frame);
        let plan = exactness::plan(&self.settings, self.size, bounds)?;
        let whole = Rectangle::whole(self.size);
        let (changed, adds) = match (frame.changed, before) {
            (Changed::Nothing, _) if self.built.is_some_and(|built| built.map == map) => return Ok(()),
            (Changed::Added, Some(_)) => (Some(whole), true),
            (Changed::Rectangle { first, size }, Some(built))
                if (built.map, built.plan, built.grown) == (map, plan, false) =>
            {
                (Rectangle::inside(self.size, first, size), false)
            }
            // Nothing that is there is of use.
            _ => {
                self.searched = false;
                (Some(whole), false)
            }
        };
        if adds && plan.count_limit != u32::MAX {
            return Err(Error::Inexact {
                reason: "so many photons were added that a box may hold more than the sums do, and counts that came in \
                         parts cannot be clamped to n"
                    .to_owned(),
                remedy: "give the map of all photons anew (Changed::Everything)".to_owned(),
            });
        }
        let _state = StateGuard::new(&self.gl);
        self.built = None;
        match changed {
            // No box can hold a photon, so that none will be counted.
            _ if bounds.total == 0 => (),
            Some(_) if adds => self.tables.add(density, plan)?,
            Some(changed) => self.tables.build(density, plan, changed)?,
            None => (),
        }
        self.gl.check("building the intermediate structure")?;
        self.built = Some(Built { map, plan, bounds, grown: adds });
        Ok(())
    }

    /// Bounds of all photons that the structure will hold after a frame: its own, and those that it adds to.
    pub(crate) fn bounds_with(&self, frame: &Frame<'_>) -> CountBounds {
        let bounds = frame.density.bounds();
        let before = self.built.filter(|built| frame.changed == Changed::Added && !built.is_empty());
        before.map_or(bounds, |built| built.bounds.with(bounds))
    }

    /// Searches in another order from now on; the first time, its programs are compiled and its map allocated.
    ///
    /// # Errors
    /// As [`new`](Self::new); the order stays as it was then.
    pub fn set_order(&mut self, order: Order) -> Result<()> {
        let old = self.settings.search.order;
        if order == old {
            return Ok(());
        }
        let settings = Settings { search: Search { order, ..self.settings.search }, ..self.settings };
        let known = self.resting.iter().position(|(resting, _)| *resting == order);
        let new = if let Some(index) = known {
            self.resting.swap_remove(index).1
        } else {
            settings.validate()?;
            let passes = driver_limits::passes(self.gl.info(), &settings)?;
            let _state = StateGuard::new(&self.gl);
            let search = RadiusSearch::new(&self.gl, self.size, self.density_format, &settings, passes)?;
            self.gl.check("setting up a search")?;
            search
        };
        self.resting.push((old, std::mem::replace(&mut self.search, new)));
        self.settings = settings;
        // The map of this search is of an older frame.
        self.searched = false;
        Ok(())
    }

    /// What counters read.
    pub(crate) fn tables(&self) -> &Tables {
        &self.tables
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
    /// As [`search`](Self::search); [`Error::Mismatch`] also for a pipeline with masks and for photons that were added;
    /// [`Error::Setting`] unless the method is the summed-area table; [`Error::Inexact`] also where [`Settings::exactness`] waives it; [`Error::QueryRunning`]
    /// while a query of the host counts samples.
    pub fn certify(&mut self, density: &DensityMap) -> Result<Certificate> {
        let plan = self.prepare_certificate(density)?;
        let _state = StateGuard::new(&self.gl);
        self.certifier.certify(density, plan, &self.tables, self.search.radii())
    }

    /// As [`certify`](Self::certify), for radii that the host found by itself: a [`build`](Self::build) is all that has to
    /// be done before.
    ///
    /// # Errors
    /// As [`certify`](Self::certify), and [`Error::Mismatch`] if the sizes differ.
    pub fn certify_radii(&mut self, density: &DensityMap, radii: &RadiusMap) -> Result<Certificate> {
        let plan = self.prepare_certificate(density)?;
        if radii.size() != self.size {
            return Err(Error::size("radius map", self.size, radii.size()));
        }
        let _state = StateGuard::new(&self.gl);
        self.certifier.certify(density, plan, &self.tables, radii)
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

    /// Prepares a certificate: checks that it is possible, and builds a table that was left out for lack of photons.
    fn prepare_certificate(&mut self, density: &DensityMap) -> Result<Plan> {
        Certificate::check_possible(&self.settings)?;
        let frame = Frame::new(density);
        self.check_mask(&frame)?;
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
            let _state = StateGuard::new(&self.gl);
            self.tables.build(density, plan, Rectangle::whole(self.size))?;
        }
        Ok(plan)
    }

    fn check_built(&self, frame: &Frame<'_>) -> Result<Built> {
        self.check(frame)?;
        self.built.filter(|built| built.map == frame.density.texture()).ok_or_else(|| Error::Mismatch {
            what: "density map of the search",
            expected: "the one that was built last".to_owned(),
            got: "another, or none was built".to_owned(),
        })
    }

    fn check(&self, frame: &Frame<'_>) -> Result<()> {
        self.gl.current()?;
        let density = frame.density;
        if density.size() == self.size && density.format() == self.density_format {
            return Ok(());
        }
        Err(Error::Mismatch {
            what: "density map",
            expected: describe(self.size, self.density_format),
            got: describe(density.size(), density.format()),
        })
    }

    /// Checks what a search reads beside the map.
    fn check_mask(&self, frame: &Frame<'_>) -> Result<()> {
        let mismatch = |what, expected: String, got: String| Err(Error::Mismatch { what, expected, got });
        if frame.mask.is_some() != self.settings.masked {
            let in_words = |is: bool| if is { "one" } else { "none" }.to_owned();
            return mismatch("mask", in_words(self.settings.masked), in_words(frame.mask.is_some()));
        }
        if let Some(mask) = frame.mask.filter(|mask| mask.size() != self.size) {
            return Err(Error::size("mask", self.size, mask.size()));
        }
        let inputs = [Some(frame.density.as_texture()), frame.mask.map(Mask::texture)];
        if inputs.into_iter().flatten().any(|input| self.search.radii().is_written_to(input.name())) {
            return mismatch(
                "density map or mask",
                "a texture of the host".to_owned(),
                "the pipeline's own output".to_owned(),
            );
        }
        Ok(())
    }
}

/// The fragment shaders that a pipeline of these settings may compile, in the order of its passes; those of a certificate last.
#[must_use]
pub fn shader_sources(density_format: TextureFormat, settings: &Settings) -> Vec<ShaderSource> {
    let mut sources = tables::build_sources(density_format, settings);
    sources.extend(search::search_sources(density_format, settings));
    sources.extend(certificate::sources(density_format, settings));
    sources
}
