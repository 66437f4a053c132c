//! Plans each frame by the photons of the frames before: [`planner`] for hosts that run.
//!
//! After a frame, the photons of each 64 x 64 pixels are counted in its table (4 fetches a tile) and fetched
//! when the GPU is done with them: no frame waits, so that the first is planned without a census, and each
//! later one by that of a frame or a few before it.

use glam::UVec2;

use super::census::{self, CENSUS_SIDE, Census};
use super::planner::{self, Decision};
use super::tables::{self, Tables};
use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, Readback, ShaderSource, StateGuard, Target, TargetShape, TextureFormat, TextureShape,
    bytes_of, glsl,
};
use crate::maps::{CountBounds, DensityMap};
use crate::settings::{Order, Settings};

const CENSUS: &str = "census";

/// The census of maps of one size, and what was decided by it.
#[derive(Debug)]
pub(super) struct FramePlanner {
    gl: Gl,
    map_size: UVec2,
    decision: Decision,
    program: Program,
    counts: Target,
    census: Option<Census>,
    readback: Readback,
}

impl FramePlanner {
    /// Allocates and compiles, for the frames after the one that `decision` is for.
    pub(super) fn new(
        gl: &Gl,
        map_size: UVec2,
        density_format: TextureFormat,
        decision: Decision,
    ) -> Result<Self> {
        let (counts, readback) = targets(gl, map_size)?;
        Ok(Self {
            gl: gl.clone(),
            map_size,
            program: Program::new(gl, &census_source(density_format, &decision.settings))?,
            counts,
            census: None,
            readback,
            decision,
        })
    }

    /// What a planner for maps of `map_size` allocates: a texture and a buffer of its size.
    pub(super) fn bytes(map_size: UVec2) -> u64 {
        2 * bytes_of(&[shape(map_size)])
    }

    /// What [`resize`](Self::resize) takes.
    pub(super) fn targets_at(&self, map_size: UVec2) -> Result<(Target, Readback)> {
        targets(&self.gl, map_size)
    }

    /// From now on for maps of `map_size`, of which nothing is known.
    pub(super) fn resize(&mut self, map_size: UVec2, (counts, readback): (Target, Readback)) {
        (self.map_size, self.census) = (map_size, None);
        (self.counts, self.readback) = (counts, readback);
    }

    /// Takes in the census of an earlier frame, if it has come, and decides on the next one.
    pub(super) fn decide(&mut self, settings: &Settings, bounds: CountBounds) -> Result<Order> {
        if self.readback.is_pending() {
            let _state = StateGuard::new(&self.gl)?;
            if let Some(photons) = self.readback.poll() {
                self.census = Some(Census::counted(self.map_size, photons));
            }
        }
        self.decision = planner::decide(settings, self.map_size, self.census.as_ref(), bounds);
        Ok(self.decision.settings.search.order)
    }

    /// Counts the photons of a frame's tiles and asks for them.
    pub(super) fn count(&mut self, tables: &Tables, density: &DensityMap) -> Result<()> {
        // Of a map without photons nothing is built that could be counted.
        if self.readback.is_pending() || density.bounds().total == 0 {
            return Ok(());
        }
        let _state = StateGuard::new(&self.gl)?;
        let pass = Pass::new(CENSUS, &self.program).set("map_size", self.map_size.as_ivec2());
        tables.read_by(pass, density).fill(&mut self.counts)?;
        self.readback.begin(&self.counts)?;
        self.gl.check("taking a census")
    }

    /// What was decided last.
    pub(super) fn decision(&self) -> &Decision {
        &self.decision
    }
}

/// What is decided before anything is known of the photons.
pub(super) fn first_decision(map_size: UVec2, settings: &Settings) -> Decision {
    planner::decide(settings, map_size, None, CountBounds::total_at_most(0))
}

fn targets(gl: &Gl, map_size: UVec2) -> Result<(Target, Readback)> {
    let shape = shape(map_size);
    Ok((Target::of(gl, &shape)?, Readback::new(gl, CENSUS, bytes_of(&[shape]))?))
}

/// A count for each tile.
fn shape(map_size: UVec2) -> TargetShape {
    vec![TextureShape::new(CENSUS, TextureFormat::R32Uint, census::tiles(map_size))]
}

/// The shader that counts.
pub(super) fn census_source(density: TextureFormat, settings: &Settings) -> ShaderSource {
    let source =
        ShaderSource::new(CENSUS).targets([TextureFormat::R32Uint]).define("CENSUS_SIDE", CENSUS_SIDE);
    tables::counter(source, density, settings).file(glsl!("radius/census.frag"))
}
