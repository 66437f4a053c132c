//! The thesis's tables and claims, timed and judged on this machine, in one go.
//!
//! What needs neither clock nor OpenGL is counted first; then come the timing runs, each part a run of
//! [`bench`](mod@crate::bench) with a share of the budget, and last what the changes of chapter 6 gain.
//! Everything is kept in a [`RunFile`], which is saved as it grows and can be gone on with.

mod gains;
mod parts;

use std::path::Path;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::bench::{self, Protocol};
use crate::thesis::claims::{self, Group, Judged};
use crate::thesis::evidence::{Evidence, Gain, LargerSmaller};
use varikernel::error::{Error, Result};
use varikernel::gl::Gl;
use varikernel::image::{Image, write_atomically};
use varikernel::maps::CountBounds;
use varikernel::maps::DensityMap;
use varikernel::radius::RadiusPipeline;
use varikernel::reference;
use varikernel::settings::{Method, Settings};

pub use parts::{OtherMap, Part, measurements, orders, other_maps};

/// The share of the budget that goes to gains; the parts divide the rest.
const GAINS_SHARE: f64 = 0.1;

/// Everything that a reproduction measured: `run.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunFile {
    /// The parts that were begun, in their order.
    pub parts: Vec<NamedReport>,
    /// What changes gain.
    pub gains: Vec<Gain>,
}

/// A part's name and what it measured so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NamedReport {
    /// The name of the [`Part`].
    pub name: String,
    /// Seconds that it took.
    pub seconds: f64,
    /// Its timing run.
    pub report: bench::Report,
}

impl RunFile {
    /// The report of a part, if it was begun.
    #[must_use]
    pub fn part(&self, name: &str) -> Option<&NamedReport> {
        self.parts.iter().find(|part| part.name == name)
    }

    /// Writes the file, the old one kept until the new one is whole.
    ///
    /// # Errors
    /// [`Error::File`] if it can't be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        write_atomically(path, |file| serde_json::to_writer(file, self).map_err(std::io::Error::from))
    }

    /// Reads a file that [`save`](Self::save) wrote.
    ///
    /// # Errors
    /// [`Error::File`] if there is none, or it is something else.
    pub fn load(path: &Path) -> Result<Self> {
        let remedy = "give the folder of an earlier run, or leave out --resume";
        let text = std::fs::read(path)
            .map_err(|error| Error::file(path, format!("can't be read: {error}"), remedy))?;
        serde_json::from_slice(&text)
            .map_err(|error| Error::file(path, format!("is not the file of a run: {error}"), remedy))
    }

    fn replace(&mut self, name: &str, seconds: f64, report: &bench::Report) {
        let named = NamedReport { name: name.to_owned(), seconds, report: report.clone() };
        match self.parts.iter_mut().find(|part| part.name == name) {
            Some(part) => *part = named,
            None => self.parts.push(named),
        }
    }
}

/// Where a reproduction is.
#[derive(Clone, Debug)]
pub struct Progress<'a> {
    /// The part, in a few words.
    pub part: &'a str,
    /// What is timed now.
    pub case: &'a str,
    /// Share of the work that is done, 0 to 1.
    pub done: f64,
    /// What is left of the budget.
    pub budget_left: Duration,
}

/// Times everything within `budget`, going on with `earlier`.
///
/// `observe` is called after each set of samples, with all that is known by then: to save it and to show the
/// progress. `full` takes the thesis's iterations for every cell instead of as many as the budget allows.
///
/// # Errors
/// [`Error::File`] if `earlier`, read from `path`, was measured on another device or by another version;
/// [`Error::Gl`] if the driver fails; whatever `observe` fails with.
pub fn time(
    gl: &Gl,
    (real_map, real_name): (&Image<u32>, &str),
    budget: Duration,
    full: bool,
    (earlier, path): (RunFile, &Path),
    observe: &mut dyn FnMut(&RunFile, &Progress<'_>) -> Result<()>,
) -> Result<RunFile> {
    let start = Instant::now();
    let mut run = earlier;
    let all = parts::all(real_map, real_name);
    for part in &all {
        if let Some(begun) = run.part(part.name) {
            let now = bench::empty_report(gl, &part.settings(Protocol::within(budget)), &part.maps);
            begun.report.check_resumable(path, &now)?;
        }
    }
    let timed = budget.mul_f64(1.0 - GAINS_SHARE);
    for (index, part) in all.iter().enumerate() {
        let share = part.share / all[index..].iter().map(|part| part.share).sum::<f64>();
        let part_budget = timed.saturating_sub(start.elapsed()).mul_f64(share);
        let protocol = if full { Protocol::thesis(part_budget) } else { Protocol::within(part_budget) };
        let earlier = run.part(part.name).map(|part| part.report.clone());
        let (before, begun) = (run.part(part.name).map_or(0.0, |part| part.seconds), Instant::now());
        bench::run(gl, &part.settings(protocol), &part.maps, earlier, &mut |report, progress| {
            run.replace(part.name, before + begun.elapsed().as_secs_f64(), report);
            let done: f64 = all[..index].iter().map(|part| part.share).sum();
            #[expect(clippy::cast_precision_loss, reason = "a progress bar")]
            let in_part = progress.sets_done as f64 / progress.sets.max(1) as f64;
            let total: f64 = all.iter().map(|part| part.share).sum();
            observe(
                &run,
                &Progress {
                    part: part.name,
                    case: &progress.case,
                    done: (1.0 - GAINS_SHARE) * (done + part.share * in_part) / total,
                    budget_left: budget.saturating_sub(start.elapsed()),
                },
            )
        })?;
    }
    let left = budget.saturating_sub(start.elapsed()).max(budget.mul_f64(GAINS_SHARE / 2.0));
    run.gains = gains::time(gl, real_map, real_name, left)?;
    observe(
        &run,
        &Progress {
            part: "gains",
            case: "chapter 6",
            done: 1.0,
            budget_left: budget.saturating_sub(start.elapsed()),
        },
    )?;
    Ok(run)
}

/// What neither clock nor a long run is needed for: counts, and the averaged mipmap's radii from the device.
///
/// # Errors
/// [`Error::Gl`] if the driver fails.
pub fn counted(gl: &Gl, (real_map, real_name): (&Image<u32>, &str)) -> Result<Evidence> {
    let search = claims::usual_search();
    let mut evidence = Evidence::counted(real_map, real_name, search)?;
    let settings = Settings { search, method: Method::AveragedMipmap, ..Settings::default() };
    let density = DensityMap::upload(gl, real_map, CountBounds::of(real_map, search))?;
    let mut pipeline = RadiusPipeline::new(gl, real_map.size(), density.format(), settings)?;
    let averaged = pipeline.render(&density)?.read()?;
    let exact = reference::radius_by_table(real_map, search).radius;
    evidence.averaged = Some(LargerSmaller::between(&averaged, &exact)?);
    Ok(evidence)
}

/// Adds what was timed to what was counted.
#[must_use]
pub fn with_timings(counted: Evidence, run: &RunFile) -> Evidence {
    Evidence { measurements: measurements(run), orders: orders(run), gains: run.gains.clone(), ..counted }
}

/// All claims with their answers and the time that their evidence took.
#[must_use]
pub fn judge(evidence: &Evidence, run: &RunFile, counted_seconds: f64) -> Vec<Judged> {
    let mut judged = claims::judge_all(evidence);
    for one in &mut judged {
        let parts = parts::of_claim(&one.claim.id);
        let seconds: f64 = parts.iter().filter_map(|name| run.part(name)).map(|part| part.seconds).sum();
        one.seconds = match one.claim.group {
            // All of them come from one count.
            Group::Counted | Group::Listing => Some(counted_seconds),
            _ => (seconds > 0.0).then_some(seconds),
        };
    }
    judged
}
