//! A pipeline that plans each frame by the photons of the frames before: [`planner`](crate::radius::planner) for running hosts.

use glam::UVec2;

use crate::error::Result;
use crate::gl::{
    DeviceInfo, Gl, Pass, Program, Readback, ShaderSource, StateGuard, Target, TargetShape, TextureFormat,
    TextureShape, bytes_of, glsl,
};
use crate::maps::CountBounds;
use crate::maps::RadiusMap;
use crate::maps::{Changed, Frame};
use crate::radius::census::{self, CENSUS_SIDE, Census};
use crate::radius::planner::{self, Choice};
use crate::radius::tables;
use crate::radius::{MemoryRequired, RadiusPipeline};
use crate::settings::Settings;

const CENSUS: &str = "census";

/// A [`RadiusPipeline`] whose search is chosen anew as the photons change.
///
/// After a frame, the photons of each 64 x 64 pixels are counted in its table (4 fetches a tile) and fetched when the GPU
/// is done with them: no frame waits, so that the first is planned without a census, and each later one by that of a
/// frame or a few before it.
#[derive(Debug)]
pub struct AdaptivePipeline {
    gl: Gl,
    pipeline: RadiusPipeline,
    map_size: UVec2,
    choice: Choice,
    program: Program,
    counts: Target,
    census: Option<Census>,
    readback: Readback,
}

impl AdaptivePipeline {
    /// Allocates and compiles for maps of `size` in `density_format`; of `settings`, the question and all that does not
    /// decide speed are kept, method and build are the planner's.
    ///
    /// # Errors
    /// Those of [`RadiusPipeline::new`].
    pub fn new(gl: &Gl, size: UVec2, density_format: TextureFormat, settings: Settings) -> Result<Self> {
        let choice = first_choice(size, &settings);
        let pipeline = RadiusPipeline::new(gl, size, density_format, choice.settings)?;
        let _state = StateGuard::new(gl);
        let shape = census_shape(size);
        let adaptive = Self {
            gl: gl.clone(),
            pipeline,
            map_size: size,
            program: Program::new(gl, &census_source(density_format, &choice.settings))?,
            counts: Target::of(gl, &shape)?,
            census: None,
            readback: Readback::new(gl, CENSUS, bytes_of(&[shape]))?,
            choice,
        };
        gl.check("setting up an adaptive pipeline")?;
        Ok(adaptive)
    }

    /// The memory of an adaptive pipeline for maps of `size`, as [`RadiusPipeline::memory_required`] says it: which orders of
    /// the search are used depends on the photons, so that the other orders may be allocated or not. Nothing is
    /// ever certified.
    ///
    /// # Errors
    /// Those of [`RadiusPipeline::memory_required`].
    pub fn memory_required(size: UVec2, settings: &Settings) -> Result<MemoryRequired> {
        let pipeline = RadiusPipeline::memory_required(size, &first_choice(size, settings).settings)?;
        Ok(with_census(size, pipeline))
    }

    /// As [`memory_required`](Self::memory_required), on a renderer that is known.
    ///
    /// # Errors
    /// Those of [`RadiusPipeline::memory_required_on`].
    pub fn memory_required_on(
        device: &DeviceInfo,
        size: UVec2,
        settings: &Settings,
    ) -> Result<MemoryRequired> {
        let settings = first_choice(size, settings).settings;
        Ok(with_census(size, RadiusPipeline::memory_required_on(device, size, &settings)?))
    }

    /// From now on for maps of `size`; see [`RadiusPipeline::resize`]. The next frame is planned without a census.
    ///
    /// # Errors
    /// Those of [`RadiusPipeline::resize`].
    pub fn resize(&mut self, size: UVec2) -> Result<()> {
        if size == self.map_size {
            return self.gl.current().map(drop);
        }
        let shape = census_shape(size.max(UVec2::ONE));
        let _state = StateGuard::new(&self.gl);
        let counts = Target::of(&self.gl, &shape)?;
        let readback = Readback::new(&self.gl, CENSUS, bytes_of(&[shape]))?;
        self.pipeline.resize(size)?;
        (self.counts, self.readback) = (counts, readback);
        (self.map_size, self.census) = (size, None);
        Ok(())
    }

    /// Builds and searches what differs from the frame before; see [`RadiusPipeline::update`].
    ///
    /// # Errors
    /// Those of [`RadiusPipeline::update`].
    pub fn update(&mut self, frame: &Frame<'_>) -> Result<&RadiusMap> {
        if frame.changed == Changed::Nothing {
            return self.pipeline.update(frame);
        }
        self.plan(frame)?;
        self.pipeline.update(frame)?;
        self.count(frame)?;
        Ok(self.pipeline.radii())
    }

    /// What the last frame was planned to do, and why.
    #[must_use]
    pub fn choice(&self) -> &Choice {
        &self.choice
    }

    /// The shader that a pipeline of these settings compiles in addition to those of
    /// [`shader_sources`](crate::radius::shader_sources).
    #[must_use]
    pub fn shader_source(density_format: TextureFormat, settings: &Settings) -> ShaderSource {
        census_source(density_format, settings)
    }

    /// Takes in the census of an earlier frame, if it has come, and plans this one.
    fn plan(&mut self, frame: &Frame<'_>) -> Result<()> {
        if self.readback.is_pending() {
            let _state = StateGuard::new(&self.gl);
            if let Some(photons) = self.readback.poll() {
                self.census = Some(Census::counted(self.map_size, photons));
            }
        }
        let (settings, bounds) = (self.pipeline.settings(), self.pipeline.bounds_with(frame));
        self.choice = planner::choose(settings, self.map_size, self.census.as_ref(), bounds);
        self.pipeline.set_order(self.choice.settings.search.order)
    }

    /// Counts the photons of this frame's tiles and asks for them.
    fn count(&mut self, frame: &Frame<'_>) -> Result<()> {
        // Of a map without photons nothing is built that could be counted.
        if self.readback.is_pending() || frame.density.bounds().total == 0 {
            return Ok(());
        }
        let _state = StateGuard::new(&self.gl);
        let pass = Pass::new(CENSUS, &self.program).set("map_size", self.map_size.as_ivec2());
        self.pipeline.tables().read_by(pass, frame.density).fill(&mut self.counts)?;
        self.readback.begin(&self.counts)?;
        self.gl.check("taking a census")
    }
}

fn first_choice(size: UVec2, settings: &Settings) -> Choice {
    planner::choose(settings, size, None, CountBounds::total_at_most(0))
}

/// A count for each tile.
fn census_shape(size: UVec2) -> TargetShape {
    vec![TextureShape::new(CENSUS, TextureFormat::R32Uint, census::tiles(size))]
}

/// The census is a texture and a buffer of its size.
fn with_census(size: UVec2, pipeline: MemoryRequired) -> MemoryRequired {
    let census = 2 * bytes_of(&[census_shape(size)]);
    MemoryRequired { at_creation: pipeline.at_creation + census, certificate: 0, ..pipeline }
}

fn census_source(density: TextureFormat, settings: &Settings) -> ShaderSource {
    let source =
        ShaderSource::new(CENSUS).targets([TextureFormat::R32Uint]).define("CENSUS_SIDE", CENSUS_SIDE);
    tables::counter(source, density, settings).file(glsl!("radius/census.frag"))
}
