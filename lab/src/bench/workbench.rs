//! A map on the device, the jobs that are timed on it, and the answers that they should give.

use std::time::{Duration, Instant};

use super::case::Stage;
use super::rival::{self, Rivals};
use super::scene::Scene;
use super::settings::{BenchSettings, MapSource};
use super::situation::Situation;
use super::work::Work;
use varikernel::error::{Error, Result};
use varikernel::gl::{Gl, Sample, Timer};
use varikernel::image::Difference;
use varikernel::image::Image;
use varikernel::maps::CountBounds;
use varikernel::maps::DensityMap;
use varikernel::measure::{Unit, UnitPass};
use varikernel::radius::Census;
use varikernel::radius::RadiusPipeline;
use varikernel::radius::planner::{self, Decision};
use varikernel::reference;
use varikernel::settings::{Order, Search, Settings, Storage};

/// A map on the device, and all that was made for it.
pub(super) struct Workbench {
    gl: Gl,
    counts: Image<u32>,
    density: DensityMap,
    units: Vec<(Unit, UnitPass)>,
    pipelines: Vec<RadiusPipeline>,
    /// What the planner chose for which settings.
    decisions: Vec<(Settings, Decision)>,
    scenes: Vec<(Situation, Scene)>,
    rivals: Rivals,
    /// The definition's radii.
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
        assert_eq!(counts.size(), size, "a map source of another size than it declares");
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
            decisions: Vec::new(),
            scenes: Vec::new(),
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
            Work::Pipeline(settings) => self.prepare_pipeline(settings)?,
            Work::Planned(settings) => {
                if !self.decisions.iter().any(|(known, _)| *known == settings) {
                    let census = Census::of(&self.counts);
                    let decision = planner::decide(&settings, size, Some(&census), self.density.bounds());
                    self.decisions.push((settings, decision));
                }
                self.prepare_pipeline(self.decision(settings).settings)?;
            }
            Work::Situation(situation, settings) => {
                self.prepare_pipeline(settings)?;
                if !self.scenes.iter().any(|(known, _)| *known == situation) {
                    let scene = Scene::new(&self.gl, situation, settings.search, &self.counts)?;
                    self.scenes.push((situation, scene));
                }
            }
            Work::Rival(rival, search) => self.rivals.prepare(rival, search, size)?,
        }
        Ok(())
    }

    fn prepare_pipeline(&mut self, settings: Settings) -> Result<()> {
        if !self.pipelines.iter().any(|known| *known.settings() == settings) {
            let size = self.counts.size();
            let pipeline = RadiusPipeline::new(&self.gl, size, self.density.format(), settings)?;
            pipeline.plan(&self.density)?;
            self.pipelines.push(pipeline);
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
        match work {
            Work::Situation(situation, settings) => {
                let pipeline = find(&mut self.pipelines, settings);
                find_scene(&mut self.scenes, situation).begin_set(pipeline)?;
            }
            _ if stage == Stage::Search => self.run_once(work, Stage::Build)?,
            _ => (),
        }
        self.begin_sample(work)?;
        self.run_once(work, stage)?;
        loop {
            self.begin_sample(work)?;
            let ((), sample) = timer.time(|| self.run_once(work, stage))?;
            set.push(sample);
            if set.len() >= limit || start.elapsed() + sample.wall > time {
                return Ok(set);
            }
        }
    }

    /// What comes before each sample, not timed.
    fn begin_sample(&mut self, work: Work) -> Result<()> {
        let Work::Situation(situation, settings) = work else { return Ok(()) };
        let pipeline = find(&mut self.pipelines, settings);
        find_scene(&mut self.scenes, situation).begin_sample(pipeline, &self.density)
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
                    _ => pipeline.render(&self.density).map(drop),
                }
            }
            Work::Planned(settings) => self.run_once(Work::Pipeline(self.decision(settings).settings), stage),
            Work::Situation(situation, settings) => {
                find_scene(&mut self.scenes, situation).run(find(&mut self.pipelines, settings))
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
            Work::Planned(settings) => {
                self.wrong_pixels(stage, Work::Pipeline(self.decision(settings).settings))
            }
            Work::Situation(situation, settings) => {
                find_scene(&mut self.scenes, situation).wrong_pixels(find(&mut self.pipelines, settings))
            }
            Work::Rival(rival, search) => {
                let answer = self.answer(search).clone();
                self.rivals.wrong_pixels(rival, search, &answer)
            }
        }
    }

    /// The mean of the definition's radii, where a search of the map itself was timed.
    pub(super) fn mean_radius(&mut self, stage: Stage, work: Work) -> Option<f64> {
        let search = match work {
            Work::Pipeline(settings) | Work::Planned(settings) if stage != Stage::Build => settings.search,
            Work::Rival(_, search) => search,
            _ => return None,
        };
        let radii = self.answer(search);
        let size = radii.size().as_dvec2();
        Some(radii.values().iter().map(|&radius| f64::from(radius)).sum::<f64>() / size.element_product())
    }

    /// What the planner decided, and why.
    pub(super) fn planned(&self, work: Work) -> Option<String> {
        let Work::Planned(settings) = work else { return None };
        let Decision { settings, reason } = self.decision(settings);
        Some(format!("{}: {reason}", settings.search.order.name()))
    }

    fn decision(&self, settings: Settings) -> &Decision {
        &self.decisions.iter().find(|(known, _)| *known == settings).expect("prepared").1
    }

    /// The definition's radii, which no order changes.
    fn answer(&mut self, search: Search) -> &Image<u32> {
        let search = Search { order: Order::Binary, ..search };
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

fn find_scene(scenes: &mut [(Situation, Scene)], situation: Situation) -> &mut Scene {
    &mut scenes.iter_mut().find(|(known, _)| *known == situation).expect("prepared").1
}
