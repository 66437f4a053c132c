//! The stages in order: the one file that knows them all, and what a host engine calls.

mod certify;
mod frame;
mod size;
mod warm_up;

use glam::UVec2;
pub use size::MemoryRequired;
pub(crate) use size::check_fits;

use crate::error::Result;
use crate::gl::{Gl, ShaderSource, StateGuard, TextureFormat};
use crate::maps::exactness::{self, CountBounds, Plan};
use crate::maps::{DensityMap, Mask, RadiusMap};
use crate::radius::certificate::{self, Certifier};
use crate::radius::driver_limits;
use crate::radius::frame_planner::{self, FramePlanner};
use crate::radius::planner::Decision;
use crate::radius::search::{self, RadiusSearch};
use crate::radius::tables::{self, Tables};
use crate::settings::{Order, Planning, Rule, Search, Settings};

/// Density map in, radius map out, for one size and one set of settings.
///
/// Everything is allocated and compiled by [`RadiusPipeline::new`]; [`render`](Self::render) only draws. Each
/// call puts back the OpenGL state that it touches, also when it fails; the list is the crate's [state
/// contract](crate::gl::state_contract). With [`Planning::EachFrame`], an order that is chosen for the first
/// time is compiled and allocated then.
#[derive(Debug)]
pub struct RadiusPipeline {
    gl: Gl,
    settings: Settings,
    size: UVec2,
    density_format: TextureFormat,
    tables: Tables,
    search: RadiusSearch,
    certifier: Certifier,
    /// What decides on each frame, where the settings ask for that.
    planner: Option<Box<FramePlanner>>,
    /// What is bound where a frame has no mask, if frames may have one.
    every_pixel: Option<Mask>,
    /// Searches of other orders, which [`set_order`](RadiusPipeline::set_order) left.
    resting: Vec<(Order, RadiusSearch)>,
    /// What the structure holds.
    built: Option<Built>,
    /// Whose radii, of what the structure held last, were found, so that a frame's changes can be searched
    /// alone.
    searched: Option<Pixels>,
}

/// The pixels of a frame that got a radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pixels {
    All,
    OfMask,
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
    /// [`Error::Setting`](crate::Error::Setting) outside a setting's range,
    /// [`Error::TooLarge`](crate::Error::TooLarge), [`Error::Shader`](crate::Error::Shader) if the driver
    /// refuses a shader, [`Error::OutOfMemory`](crate::Error::OutOfMemory)
    /// ([`memory_required`](Self::memory_required) says how much is needed),
    /// [`Error::ContextLost`](crate::Error::ContextLost), [`Error::Gl`](crate::Error::Gl) if the driver fails
    /// otherwise.
    pub fn new(gl: &Gl, size: UVec2, density_format: TextureFormat, settings: Settings) -> Result<Self> {
        let decision = planned(size, &settings);
        let settings = decision.as_ref().map_or(settings, |decision| decision.settings);
        settings.validate()?;
        let passes = driver_limits::passes(gl.info(), &settings)?;
        check_fits(gl.info(), size)?;
        let _state = StateGuard::new(gl)?;
        let pipeline = Self {
            gl: gl.clone(),
            settings,
            size,
            density_format,
            tables: Tables::new(gl, size, density_format, &settings)?,
            search: RadiusSearch::new(gl, size, density_format, &settings, passes)?,
            certifier: Certifier::new(gl, density_format, &settings),
            planner: match decision {
                Some(decision) => Some(Box::new(FramePlanner::new(gl, size, density_format, decision)?)),
                None => None,
            },
            every_pixel: if settings.masked { Some(Mask::of_every_pixel(gl)?) } else { None },
            resting: Vec::new(),
            built: None,
            searched: None,
        };
        gl.check("setting up a radius pipeline")?;
        Ok(pipeline)
    }

    /// Searches in another order from now on; the first time, its programs are compiled and its map
    /// allocated. With [`Planning::EachFrame`], the next frame is planned anew; with [`Rule::Even`], nothing
    /// is searched in an order.
    ///
    /// # Errors
    /// As [`new`](Self::new); the order stays as it was then.
    pub fn set_order(&mut self, order: Order) -> Result<()> {
        let old = self.settings.search.order;
        if order == old || self.settings.rule == Rule::Even {
            return Ok(());
        }
        let settings = Settings { search: Search { order, ..self.settings.search }, ..self.settings };
        let known = self.resting.iter().position(|(resting, _)| *resting == order);
        let new = if let Some(index) = known {
            self.resting.swap_remove(index).1
        } else {
            settings.validate()?;
            let passes = driver_limits::passes(self.gl.info(), &settings)?;
            let _state = StateGuard::new(&self.gl)?;
            let search = RadiusSearch::new(&self.gl, self.size, self.density_format, &settings, passes)?;
            self.gl.check("setting up a search")?;
            search
        };
        self.resting.push((old, std::mem::replace(&mut self.search, new)));
        self.settings = settings;
        // The map of this search is of an older frame.
        self.searched = None;
        Ok(())
    }

    /// What the last [`search`](Self::search) found, to be read after it was timed; undefined before the
    /// first.
    #[must_use]
    pub fn radii(&self) -> &RadiusMap {
        self.search.radii()
    }

    /// How the counts of `density` would be taken in, and whether the result is exact.
    ///
    /// # Errors
    /// [`Error::Inexact`](crate::Error::Inexact) as [`render`](Self::render).
    pub fn plan(&self, density: &DensityMap) -> Result<Plan> {
        exactness::plan(&self.settings, self.size, density.bounds())
    }

    /// The settings that the pipeline was made with, in the order of the last frame.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// What the planner decided on the last frame, and why; none unless the settings say
    /// [`Planning::EachFrame`].
    #[must_use]
    pub fn decision(&self) -> Option<&Decision> {
        self.planner.as_deref().map(FramePlanner::decision)
    }
}

/// What is decided before the first frame, where a planner is asked for.
fn planned(size: UVec2, settings: &Settings) -> Option<Decision> {
    match settings.planning {
        Planning::AsAsked => None,
        Planning::EachFrame => Some(frame_planner::first_decision(size, settings)),
    }
}

/// The fragment shaders that a pipeline of these settings may compile, in the order of its passes: those of a
/// frame in their order of the search, of a certificate, and of a census for [`Planning::EachFrame`].
#[must_use]
pub fn shader_sources(density_format: TextureFormat, settings: &Settings) -> Vec<ShaderSource> {
    let mut sources = tables::build_sources(density_format, settings);
    sources.extend(search::search_sources(density_format, settings));
    sources.extend(certificate::sources(density_format, settings));
    if settings.planning == Planning::EachFrame && settings.rule == Rule::Nearest {
        sources.push(frame_planner::census_source(density_format, settings));
    }
    sources
}
