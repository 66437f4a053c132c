//! A map on the device, the jobs that are timed on it, and the answers that they should give.

use std::time::{Duration, Instant};

use super::case::{Stage, Work};
use super::rival::{self, Rivals};
use super::settings::{BenchSettings, MapSource};
use crate::error::{Error, Result};
use crate::exactness::CountBounds;
use crate::gl::{Gl, Sample, Timer};
use crate::image::Image;
use crate::maps::DensityMap;
use crate::measure::{Difference, Unit, UnitPass};
use crate::pipeline::RadiusPipeline;
use crate::reference;
use crate::settings::{Search, Settings, Storage};

/// A map on the device, and all that was made for it.
pub(super) struct Workbench {
    gl: Gl,
    counts: Image<u32>,
    density: DensityMap,
    units: Vec<(Unit, UnitPass)>,
    pipelines: Vec<RadiusPipeline>,
    rivals: Rivals,
    answers: Vec<(Search, Image<u32>)>,
}

impl Workbench {
    pub(super) fn new(gl: &Gl, settings: &BenchSettings, map: &MapSource) -> Result<Self> {
        // Before the map is made: one that no texture can hold may not fit the memory either.
        let (size, limit) = (map.size(), gl.info().max_texture_size);
        if size.max_element() > limit {
            return Err(Error::TooLarge { size, limit });
        }
        let counts = map.make();
        assert_eq!(counts.size(), size, "a map source of another size than it says");
        let bounds = if settings.storages.contains(&Storage::U16) {
            CountBounds::of_boxes(&counts, settings.widest())
        } else {
            CountBounds::of(&counts, settings.widest())
        };
        let density = DensityMap::upload(gl, &counts, bounds)?;
        Ok(Self {
            gl: gl.clone(),
            counts,
            density,
            units: Vec::new(),
            pipelines: Vec::new(),
            rivals: Rivals::default(),
            answers: Vec::new(),
        })
    }

    /// Allocates and compiles what the work needs; none of it is timed.
    pub(super) fn prepare(&mut self, work: Work) -> Result<()> {
        let size = self.counts.size();
        match work {
            Work::Unit(unit) => {
                if !self.units.iter().any(|(known, _)| *known == unit) {
                    self.units.push((unit, UnitPass::new(&self.gl, unit, size)?));
                }
            }
            Work::Pipeline(settings) => {
                if !self.pipelines.iter().any(|known| *known.settings() == settings) {
                    let pipeline = RadiusPipeline::new(&self.gl, size, self.density.format(), settings)?;
                    pipeline.plan(&self.density)?;
                    self.pipelines.push(pipeline);
                }
            }
            Work::Rival(rival, search) => self.rivals.prepare(rival, search, size)?,
        }
        Ok(())
    }

    /// One untimed run, then samples until `time` is used or there are `limit`; at least one.
    pub(super) fn take_set(
        &mut self,
        timer: &mut Timer,
        (stage, work): (Stage, Work),
        limit: usize,
        time: Duration,
    ) -> Result<Vec<Sample>> {
        if let Work::Rival(..) = work {
            return rival::take_set(|| self.run_once(work, stage), limit, time);
        }
        let start = Instant::now();
        let mut set = Vec::new();
        if stage == Stage::Search {
            self.run_once(work, Stage::Build)?;
        }
        self.run_once(work, stage)?;
        loop {
            let ((), sample) = timer.time(|| self.run_once(work, stage))?;
            set.push(sample);
            if set.len() >= limit || start.elapsed() + sample.wall > time {
                return Ok(set);
            }
        }
    }

    fn run_once(&mut self, work: Work, stage: Stage) -> Result<()> {
        match work {
            Work::Unit(unit) => {
                let (_, pass) = self.units.iter_mut().find(|(known, _)| *known == unit).expect("prepared");
                pass.run(&self.density)
            }
            Work::Pipeline(settings) => {
                let pipeline = find(&mut self.pipelines, settings);
                match stage {
                    Stage::Build => pipeline.build(&self.density),
                    Stage::Search => pipeline.search(&self.density).map(drop),
                    Stage::Copy | Stage::Probe | Stage::Frame => pipeline.render(&self.density).map(drop),
                }
            }
            Work::Rival(rival, search) => {
                self.rivals.run(rival, search, &self.counts);
                Ok(())
            }
        }
    }

    /// How many pixels of what was timed last are not as the definition has them.
    pub(super) fn wrong_pixels(&mut self, stage: Stage, work: Work) -> Result<u64> {
        match work {
            Work::Unit(unit) => {
                let (_, pass) = self.units.iter().find(|(known, _)| *known == unit).expect("prepared");
                Ok(Difference::between(&pass.read()?, &unit.expected(&self.counts))?.wrong_pixels)
            }
            Work::Pipeline(settings) => {
                let pipeline = find(&mut self.pipelines, settings);
                let found = match stage {
                    // What was built is right if a search in it is.
                    Stage::Build => pipeline.search(&self.density)?.read()?,
                    _ => pipeline.radii().read()?,
                };
                Ok(Difference::between(&found, self.answer(settings.search))?.wrong_pixels)
            }
            Work::Rival(rival, search) => {
                let answer = self.answer(search).clone();
                self.rivals.wrong_pixels(rival, search, &answer)
            }
        }
    }

    /// The definition's radii.
    fn answer(&mut self, search: Search) -> &Image<u32> {
        let index = self.answers.iter().position(|(known, _)| *known == search).unwrap_or_else(|| {
            let radius = reference::radius_by_table(&self.counts, search).radius;
            self.answers.push((search, radius));
            self.answers.len() - 1
        });
        &self.answers[index].1
    }
}

fn find(pipelines: &mut [RadiusPipeline], settings: Settings) -> &mut RadiusPipeline {
    pipelines.iter_mut().find(|known| *known.settings() == settings).expect("prepared")
}
