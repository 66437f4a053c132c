//! The timing run itself.

use std::time::{Duration, Instant};

use super::case::{self, Case, Stage, Work};
use super::report::{Device, LeftOut, Report, Run};
use super::settings::{BenchSettings, MapSource};
use crate::error::{Error, Result};
use crate::exactness::CountBounds;
use crate::gl::{Gl, Sample, TextureFormat, Timer};
use crate::image::Image;
use crate::maps::DensityMap;
use crate::measure::{Difference, Unit, UnitPass};
use crate::pipeline::{self, RadiusPipeline};
use crate::reference;
use crate::settings::{Search, Settings};

/// How far a run is.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Sets that were taken, or passed over for lack of time.
    pub sets_done: usize,
    /// Sets in all.
    pub sets: usize,
    /// The case whose turn it was.
    pub case: String,
    /// What is left of the budget.
    pub budget_left: Duration,
}

/// Times every case of `maps`, and adds to `earlier` if there is one.
///
/// `observe` is called after each set, with everything that is known by then: to save it, and to show the progress.
///
/// # Errors
/// [`Error::Gl`] if the driver fails while it is timed, and whatever `observe` fails with. A case that cannot be set
/// up is no error: it is left out, with the reason.
///
/// # Panics
/// If a [`MapSource`] makes a map of another size than it says.
pub fn run(
    gl: &Gl,
    settings: &BenchSettings,
    maps: &[MapSource],
    earlier: Option<Report>,
    observe: &mut dyn FnMut(&Report, &Progress) -> Result<()>,
) -> Result<Report> {
    let start = Instant::now();
    let budget = Duration::from_secs_f64(settings.protocol.budget_s);
    let mut report = earlier.unwrap_or_else(|| empty_report(gl, settings, maps));
    report.settings.protocol = settings.protocol;
    report.left_out.clear();
    let sets: usize =
        maps.iter().map(|map| case::cases(settings, &map.info).len() * settings.protocol.sets).sum();
    let mut runner =
        Runner { gl, settings, report, timer: Timer::new(gl)?, start, budget, sets, sets_done: 0, observe };
    for (index, map) in maps.iter().enumerate() {
        // A map's share grows with its side: its samples cost as much as it has pixels, and small maps need no
        // more of them than large ones.
        let weight = |map: &MapSource| map.size().as_dvec2().element_product().sqrt();
        let share = weight(map) / maps[index..].iter().map(weight).sum::<f64>();
        let left = budget.saturating_sub(start.elapsed());
        runner.time_map(map, start.elapsed() + left.mul_f64(share))?;
    }
    Ok(runner.report)
}

/// What a run of these settings is, before anything is timed.
#[must_use]
pub fn empty_report(gl: &Gl, settings: &BenchSettings, maps: &[MapSource]) -> Report {
    Report {
        program: env!("CARGO_PKG_VERSION").to_owned(),
        shaders: shader_hash(settings),
        device: Device::of(gl.info()),
        settings: settings.clone(),
        maps: maps.iter().map(|map| map.info.clone()).collect(),
        runs: Vec::new(),
        left_out: Vec::new(),
    }
}

/// FNV-1a, 64 bits, of every shader.
fn shader_hash(settings: &BenchSettings) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for pipeline in settings.pipelines() {
        for source in pipeline::shader_sources(TextureFormat::R32Uint, &pipeline) {
            for byte in source.fragment().bytes() {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        }
    }
    format!("{hash:016x}")
}

struct Runner<'a> {
    gl: &'a Gl,
    settings: &'a BenchSettings,
    report: Report,
    timer: Timer,
    start: Instant,
    budget: Duration,
    sets: usize,
    sets_done: usize,
    observe: &'a mut dyn FnMut(&Report, &Progress) -> Result<()>,
}

/// A case in its turn.
struct Turn {
    case: Case,
    work: Work,
    /// Time that it was given and has not used, in seconds; negative if it has used more.
    credit: f64,
    /// Seconds that its last set took, per sample.
    cost: f64,
    left_out: bool,
}

impl Runner<'_> {
    /// Goes over all cases of a map, set by set; `deadline` counts from the start of the run.
    fn time_map(&mut self, map: &MapSource, deadline: Duration) -> Result<()> {
        let turns = case::cases(self.settings, &map.info).into_iter();
        let mut turns: Vec<Turn> =
            turns.map(|(case, work)| Turn { case, work, credit: 0.0, cost: 0.0, left_out: false }).collect();
        if self.start.elapsed() >= self.budget {
            for turn in &mut turns {
                self.leave_out(turn, &budget_reason(self.budget));
                self.sets_done += self.settings.protocol.sets;
            }
            return self.observed(&turns[0].case.to_string());
        }
        let mut bench = match Bench::new(self.gl, self.settings, map) {
            Ok(bench) => bench,
            Err(error) => {
                for turn in &mut turns {
                    self.leave_out(turn, &first_line(&error));
                    self.sets_done += self.settings.protocol.sets;
                }
                return self.observed(&turns[0].case.to_string());
            }
        };
        for set in 0..self.settings.protocol.sets {
            for index in 0..turns.len() {
                let visits_left = (self.settings.protocol.sets - set) * turns.len() - index;
                let left = deadline.saturating_sub(self.start.elapsed()).as_secs_f64();
                self.visit(&mut bench, &mut turns[index], left / visits_left as f64)?;
                self.sets_done += 1;
                self.observed(&turns[index].case.to_string())?;
            }
        }
        Ok(())
    }

    /// Takes a set of samples of a case, if it has not enough sets and its credit reaches for a sample.
    fn visit(&mut self, bench: &mut Bench, turn: &mut Turn, quantum: f64) -> Result<()> {
        let sets = self.report.run(&turn.case).map_or(0, |run| run.sets.len());
        if turn.left_out || sets >= self.settings.protocol.sets {
            return Ok(());
        }
        turn.credit += quantum;
        if sets == 0 {
            // The first set is never passed over, unless there is no time at all.
            if self.start.elapsed() >= self.budget {
                self.leave_out(turn, &budget_reason(self.budget));
                return Ok(());
            }
            if let Err(error) = bench.prepare(turn.work) {
                self.leave_out(turn, &first_line(&error));
                return Ok(());
            }
        } else if turn.credit < 2.0 * turn.cost || self.start.elapsed() >= self.budget {
            // A warm-up and a sample is the least that a set costs.
            return Ok(());
        } else {
            bench.prepare(turn.work)?;
        }
        let start = Instant::now();
        let limit = self.settings.protocol.iterations;
        let set = bench.take_set(&mut self.timer, turn, limit)?;
        let wrong_pixels = bench.wrong_pixels(turn)?;
        turn.credit -= start.elapsed().as_secs_f64();

        let software = self.gl.info().software;
        match self.report.runs.iter_mut().find(|run| run.case == turn.case) {
            Some(run) => run.add_set(&set, software),
            None => self.report.runs.extend(Run::new(turn.case.clone(), &set, software)),
        }
        if let Some(run) = self.report.runs.iter_mut().find(|run| run.case == turn.case) {
            run.wrong_pixels = run.wrong_pixels.max(wrong_pixels);
        }
        self.report.update_copies();
        Ok(())
    }

    fn leave_out(&mut self, turn: &mut Turn, reason: &str) {
        turn.left_out = true;
        // A case of an earlier run has its times already.
        if self.report.run(&turn.case).is_none() {
            self.report.left_out.push(LeftOut { case: turn.case.clone(), reason: reason.to_owned() });
        }
    }

    fn observed(&mut self, case: &str) -> Result<()> {
        let progress = Progress {
            sets_done: self.sets_done,
            sets: self.sets,
            case: case.to_owned(),
            budget_left: self.budget.saturating_sub(self.start.elapsed()),
        };
        (self.observe)(&self.report, &progress)
    }
}

fn budget_reason(budget: Duration) -> String {
    format!("the budget of {} s was spent before its turn", budget.as_secs_f64())
}

/// An error in a table: its help is for another place.
fn first_line(error: &Error) -> String {
    error.to_string().lines().next().unwrap_or_default().to_owned()
}

/// A map on the device, and all that was made for it.
struct Bench {
    gl: Gl,
    counts: Image<u32>,
    density: DensityMap,
    units: Vec<(Unit, UnitPass)>,
    pipelines: Vec<RadiusPipeline>,
    answers: Vec<(Search, Image<u32>)>,
}

impl Bench {
    fn new(gl: &Gl, settings: &BenchSettings, map: &MapSource) -> Result<Self> {
        // Before the map is made: one that no texture can hold may not fit the memory either.
        let (size, limit) = (map.size(), gl.info().max_texture_size);
        if size.max_element() > limit {
            return Err(Error::TooLarge { size, limit });
        }
        let counts = map.make();
        assert_eq!(counts.size(), size, "a map source of another size than it says");
        let density = DensityMap::upload(gl, &counts, CountBounds::of(&counts, settings.widest()))?;
        Ok(Self {
            gl: gl.clone(),
            counts,
            density,
            units: Vec::new(),
            pipelines: Vec::new(),
            answers: Vec::new(),
        })
    }

    /// Allocates and compiles what the work needs; none of it is timed.
    fn prepare(&mut self, work: Work) -> Result<()> {
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
        }
        Ok(())
    }

    /// One untimed run, then samples until the credit is used or there are `limit`; at least one.
    fn take_set(&mut self, timer: &mut Timer, turn: &mut Turn, limit: usize) -> Result<Vec<Sample>> {
        let start = Instant::now();
        let mut set = Vec::new();
        if turn.case.stage == Stage::Search {
            self.run_once(turn.work, Stage::Build)?;
        }
        self.run_once(turn.work, turn.case.stage)?;
        loop {
            let (work, stage) = (turn.work, turn.case.stage);
            let ((), sample) = timer.time(|| self.run_once(work, stage))?;
            set.push(sample);
            turn.cost = sample.wall.as_secs_f64();
            if set.len() >= limit || start.elapsed().as_secs_f64() + turn.cost > turn.credit {
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
        }
    }

    /// How many pixels of what was timed last are not as the definition has them.
    fn wrong_pixels(&mut self, turn: &Turn) -> Result<u64> {
        match turn.work {
            Work::Unit(unit) => {
                let (_, pass) = self.units.iter().find(|(known, _)| *known == unit).expect("prepared");
                Ok(Difference::between(&pass.read()?, &unit.expected(&self.counts))?.wrong_pixels)
            }
            Work::Pipeline(settings) => {
                let pipeline = find(&mut self.pipelines, settings);
                let found = match turn.case.stage {
                    // What was built is right if a search in it is.
                    Stage::Build => pipeline.search(&self.density)?.read()?,
                    _ => pipeline.radii().read()?,
                };
                Ok(Difference::between(&found, self.answer(settings.search))?.wrong_pixels)
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
