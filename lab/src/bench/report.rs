//! The results of a timing run, and its files.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::case::{Case, Stage};
use super::settings::{BenchSettings, MapInfo};
use super::target::Target;
use crate::statistics::Statistics;
use varikernel::error::{Error, Result};
use varikernel::gl::{DeviceInfo, Sample};
use varikernel::settings::Method;

/// The device and the machine around it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Device {
    /// GL_RENDERER.
    pub renderer: String,
    /// GL_VENDOR.
    pub vendor: String,
    /// GL_VERSION.
    pub version: String,
    /// The part of GL_VERSION that names the driver.
    pub driver: String,
    /// Whether the renderer runs on the processor.
    pub software: bool,
    /// The processor, as far as the system names it.
    pub processor: String,
    /// Threads that the processor runs at once for this program.
    pub threads: usize,
}

impl Device {
    /// What the context and the system report.
    #[must_use]
    pub fn of(info: &DeviceInfo) -> Self {
        // "4.5 (Core Profile) Mesa 22.3.6", "3.3.0 NVIDIA 535.54".
        let after_number = info.version.split_once(' ').map_or("", |(_, rest)| rest);
        let driver = after_number.trim_start_matches("(Core Profile) ").to_owned();
        let cpuinfo = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let processor = cpuinfo
            .lines()
            .find_map(|line| line.strip_prefix("model name")?.split_once(": "))
            .map_or(std::env::consts::ARCH, |(_, name)| name.trim());
        Self {
            renderer: info.renderer.clone(),
            vendor: info.vendor.clone(),
            version: info.version.clone(),
            driver,
            software: info.software,
            processor: processor.to_owned(),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
        }
    }
}

/// A case and its times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// What was timed.
    #[serde(flatten)]
    pub case: Case,
    /// GL_TIME_ELAPSED of each sample, in the order in which they were taken.
    pub samples_ms: Vec<f64>,
    /// The clock's time of each sample.
    pub wall_ms: Vec<f64>,
    /// All samples together.
    #[serde(flatten)]
    pub statistics: Statistics,
    /// The same for each set; their counts part the samples.
    pub sets: Vec<Statistics>,
    /// The median in copies of this map in this run; absent for a wrong answer, and where no copy was timed.
    pub copies: Option<f64>,
    /// Which samples' query and clock contradict each other ([`Sample::is_suspect`]), counted from 0.
    pub suspect: Vec<usize>,
    /// Pixels whose radius is not that of the definition; for a unit, texels that are not as expected.
    pub wrong_pixels: u64,
    /// The mean of the definition's radii, which decides what a search costs; absent where none was asked
    /// for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_radius: Option<f64>,
    /// What the planner chose and why, for a frame of its choice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub planned: Option<String>,
}

impl Run {
    /// A case with its first set, nothing if that is empty.
    #[must_use]
    pub fn new(case: Case, set: &[Sample], software: bool) -> Option<Self> {
        let statistics = Statistics::of(&query_ms(set))?;
        let mut run = Self {
            case,
            samples_ms: Vec::new(),
            wall_ms: Vec::new(),
            statistics,
            sets: Vec::new(),
            copies: None,
            suspect: Vec::new(),
            wrong_pixels: 0,
            mean_radius: None,
            planned: None,
        };
        run.add_set(set, software);
        Some(run)
    }

    /// Adds a set of samples; an empty one adds nothing.
    pub fn add_set(&mut self, set: &[Sample], software: bool) {
        let Some(statistics) = Statistics::of(&query_ms(set)) else { return };
        self.sets.push(statistics);
        for sample in set {
            if sample.is_suspect(software) {
                self.suspect.push(self.samples_ms.len());
            }
            self.samples_ms.push(milliseconds(sample.query));
            self.wall_ms.push(milliseconds(sample.wall));
        }
        self.statistics = Statistics::of(&self.samples_ms).unwrap_or(self.statistics);
    }

    /// Whether a method that must be right was wrong, so that its time means nothing.
    ///
    /// Approximate methods are allowed pixels that differ.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        self.wrong_pixels > 0 && self.case.method.is_none_or(Method::is_exact)
    }
}

fn query_ms(set: &[Sample]) -> Vec<f64> {
    set.iter().map(|sample| milliseconds(sample.query)).collect()
}

fn milliseconds(time: std::time::Duration) -> f64 {
    // One rounding, so that files hold as few digits as the nanoseconds have.
    #[expect(clippy::cast_precision_loss, reason = "exact up to 104 days")]
    let nanoseconds = time.as_nanos() as f64;
    nanoseconds / 1e6
}

/// A case without a time, and why.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LeftOut {
    /// What was not timed.
    #[serde(flatten)]
    pub case: Case,
    /// Why not.
    pub reason: String,
}

/// Everything that a timing run found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The program's version.
    pub program: String,
    /// A number that changes with any shader that was timed (FNV-1a of all their texts).
    pub shaders: String,
    /// Where it ran.
    pub device: Device,
    /// The settings.
    pub settings: BenchSettings,
    /// The maps.
    pub maps: Vec<MapInfo>,
    /// What was timed, in the order of the first set.
    pub runs: Vec<Run>,
    /// What was not timed.
    pub left_out: Vec<LeftOut>,
    /// The suite's targets, judged; none without a suite.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub targets: Vec<Target>,
}

impl Report {
    /// The run of `case`.
    #[must_use]
    pub fn run(&self, case: &Case) -> Option<&Run> {
        self.runs.iter().find(|run| run.case == *case)
    }

    /// The copy of a map.
    #[must_use]
    pub fn copy_of(&self, map: &str, size: [u32; 2]) -> Option<&Run> {
        self.runs
            .iter()
            .find(|run| run.case.stage == Stage::Copy && run.case.map == map && run.case.size == size)
    }

    /// Runs of one stage of a map, fastest first; wrong answers and [situations](super::Situation) are not
    /// among them.
    #[must_use]
    pub fn ranking(&self, stage: Stage, map: &str, size: [u32; 2]) -> Vec<&Run> {
        let mut runs: Vec<&Run> = self.runs.iter().collect();
        runs.retain(|run| {
            let of_map = run.case.stage == stage && run.case.map == map && run.case.size == size;
            of_map && !run.is_wrong() && run.case.situation().is_none()
        });
        runs.sort_by(|a, b| a.statistics.median_ms.total_cmp(&b.statistics.median_ms));
        runs
    }

    /// Recomputes each run's time in copies.
    pub fn update_copies(&mut self) {
        let copies: Vec<Option<f64>> = self
            .runs
            .iter()
            .map(|run| {
                let copy = self.copy_of(&run.case.map, run.case.size)?;
                let comparable = !run.is_wrong() && !copy.is_wrong() && copy.statistics.median_ms > 0.0;
                comparable.then(|| run.statistics.median_ms / copy.statistics.median_ms)
            })
            .collect();
        for (run, copies) in self.runs.iter_mut().zip(copies) {
            run.copies = copies;
        }
    }

    /// Checks that `now` would measure as this report was measured.
    ///
    /// # Errors
    /// [`Error::File`] with what differs.
    pub fn check_resumable(&self, path: &Path, now: &Self) -> Result<()> {
        let difference = if self.device != now.device {
            format!(
                "it was measured on {} ({}, {} threads), and this is {} ({}, {} threads)",
                self.device.renderer,
                self.device.driver,
                self.device.threads,
                now.device.renderer,
                now.device.driver,
                now.device.threads
            )
        } else if self.program != now.program {
            format!("it was measured by version {}, and this is {}", self.program, now.program)
        } else if self.maps != now.maps {
            "it was measured with other maps or sizes".to_owned()
        } else if !self.settings.asks_the_same(&now.settings) {
            "it was measured with other settings".to_owned()
        } else if self.shaders != now.shaders {
            "it was measured with other shaders".to_owned()
        } else {
            return Ok(());
        };
        Err(Error::file(
            path,
            format!("can't be resumed: {difference}"),
            "measure into a new file, or repeat the options that this one was begun with",
        ))
    }
}
