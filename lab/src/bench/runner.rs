//! The timing run itself.

use std::time::{Duration, Instant};

use super::all_cases::cases;
use super::case::Case;
use super::fast;
use super::report::{Device, LeftOut, Report, Run};
use super::settings::{BenchSettings, MapSource};
use super::work::Work;
use super::workbench::Workbench;
use crate::fingerprint::fingerprint;
use varikernel::error::{Error, Result};
use varikernel::gl::{Gl, TextureFormat, Timer};
use varikernel::measure::Unit;
use varikernel::radius;

/// How far a run is.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Sets that were taken, or passed over for lack of time.
    pub sets_done: usize,
    /// Sets in all.
    pub sets: usize,
    /// The case that was timed last.
    pub case: String,
    /// What is left of the budget.
    pub budget_left: Duration,
}

/// Times every case of `maps`, and adds to `earlier` if there is one.
///
/// `observe` is called after each set, with everything that is known by then: to save it, and to show the
/// progress.
///
/// # Errors
/// [`Error::Gl`] if the driver fails while it is timed, and whatever `observe` fails with. A case that cannot
/// be set up is no error: it is left out, with the reason.
///
/// # Panics
/// If a [`MapSource`] makes a map of another size than it declares.
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
    let sets: usize = maps.iter().map(|map| cases(settings, &map.info).len() * settings.protocol.sets).sum();
    let mut runner =
        Runner { gl, settings, report, timer: Timer::new(gl)?, start, budget, sets, sets_done: 0, observe };
    for (index, map) in maps.iter().enumerate() {
        // A map's share grows with its cases and its side: a sample's time grows with the map's pixels, and
        // small maps need no more samples than large ones.
        let weight = |map: &MapSource| {
            let cases = u32::try_from(cases(settings, &map.info).len()).unwrap_or(u32::MAX);
            f64::from(cases) * map.size().as_dvec2().element_product().sqrt()
        };
        let share = weight(map) / maps[index..].iter().map(weight).sum::<f64>();
        let left = budget.saturating_sub(start.elapsed());
        runner.time_map(map, start.elapsed() + left.mul_f64(share))?;
    }
    runner.report.update_targets();
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
        targets: Vec::new(),
    }
}

/// Of every shader that is timed.
fn shader_hash(settings: &BenchSettings) -> String {
    let pipelines = if settings.suite.is_some() { fast::pipelines(settings) } else { settings.pipelines() };
    let timed = pipelines.iter().flat_map(|of| radius::shader_sources(TextureFormat::R32Uint, of));
    let sources = Unit::ALL.map(Unit::source).into_iter().chain(timed);
    fingerprint(sources.flat_map(|source| source.fragment().into_bytes()))
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
    /// Seconds that its last sample took.
    cost: f64,
    left_out: bool,
}

impl Runner<'_> {
    /// Goes over all cases of a map, set by set; `deadline` counts from the start of the run.
    fn time_map(&mut self, map: &MapSource, deadline: Duration) -> Result<()> {
        let turns = cases(self.settings, &map.info).into_iter();
        let mut turns: Vec<Turn> =
            turns.map(|(case, work)| Turn { case, work, credit: 0.0, cost: 0.0, left_out: false }).collect();
        if self.start.elapsed() >= self.budget {
            for turn in &mut turns {
                self.leave_out(turn, &budget_reason(self.budget));
                self.sets_done += self.settings.protocol.sets;
            }
            return self.observed(&turns[0].case.to_string());
        }
        let mut bench = match Workbench::new(self.gl, self.settings, map) {
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
                let left = deadline.saturating_sub(self.start.elapsed());
                let quantum = left / u32::try_from(visits_left).unwrap_or(u32::MAX);
                self.visit(&mut bench, &mut turns[index], quantum.as_secs_f64())?;
                self.sets_done += 1;
                self.observed(&turns[index].case.to_string())?;
            }
        }
        Ok(())
    }

    /// Takes a set of samples of a case, if it has not enough sets and its credit reaches for a sample.
    fn visit(&mut self, bench: &mut Workbench, turn: &mut Turn, quantum: f64) -> Result<()> {
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
        let (stage, work) = (turn.case.stage, turn.work);
        let time = Duration::from_secs_f64(turn.credit.max(0.0));
        let set = bench.take_set(&mut self.timer, (stage, work), limit, time)?;
        let wrong_pixels = bench.wrong_pixels(stage, work)?;
        let (mean_radius, planned) = (bench.mean_radius(stage, work), bench.planned(work));
        turn.cost = set.last().map_or(0.0, |sample| sample.wall.as_secs_f64());
        // Drivers compile at the first draw, which no case should pay for with its samples.
        let first_set: Duration = set.iter().chain(set.last()).map(|sample| sample.wall).sum();
        let used = if sets == 0 { start.elapsed().min(first_set) } else { start.elapsed() };
        turn.credit -= used.as_secs_f64();

        let software = self.gl.info().software;
        match self.report.runs.iter_mut().find(|run| run.case == turn.case) {
            Some(run) => run.add_set(&set, software),
            None => self.report.runs.extend(Run::new(turn.case.clone(), &set, software)),
        }
        if let Some(run) = self.report.runs.iter_mut().find(|run| run.case == turn.case) {
            run.wrong_pixels = run.wrong_pixels.max(wrong_pixels);
            (run.mean_radius, run.planned) = (mean_radius, planned);
        }
        self.report.update_copies();
        self.report.update_targets();
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
    format!("the budget of {:.1} s was spent before its turn", budget.as_secs_f64())
}

/// An error in a table, without its help, which is for other output.
fn first_line(error: &Error) -> String {
    error.to_string().lines().next().unwrap_or_default().to_owned()
}
