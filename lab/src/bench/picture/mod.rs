//! The suite of a picture: the times of its stages, in point-only passes
//! ([`PointPass`](varikernel::measure::PointPass)).
//!
//! | row | what is timed |
//! |---|---|
//! | `copy` | a full-screen pass that reads and writes one texel: the other unit |
//! | `points` | every photon as a point, nothing read: the unit |
//! | `density` | the photons that contribute, counted, and their power added up |
//! | `radius` | the radius map of those counts: a table and a search |
//! | `splat-variable` | every photon drawn as its kernel, by the radius map |
//! | `splat-fixed` | the same with the fixed radius that is best in the glass box |
//! | `gather` | every pixel gathering with its radius |
//! | `flux` | the photons that contribute, counted, and their power added up in whole units |
//! | `tables` | light from tables, from that flux on, while the camera stands still |
//! | `tables-moved` | the same when the camera has moved |
//! | `whole` | both: photons on the GPU in, light from tables out, while the camera stands still |
//! | `photons` | photons traced on the CPU, with 8 diffuse landings at most |
//! | `stage-flux` ... `stage-smoothing` | the passes of `whole` by their labels, when the camera has moved |
//!
//! Rows take turns, one sample each, so that a machine that slows down slows all alike; those that take long
//! are taken once. Every answer is checked: counts, radii, flux and light from tables against their
//! definitions, the gather against it at 61 pixels, points by their number, the splat by its energy, and
//! landings by their tally. Splats of more than a million photons are left out: they would take minutes.

mod rows;
mod stages;
mod targets;

use std::time::{Duration, Instant};

use glam::UVec2;
use serde::{Deserialize, Serialize};

use self::rows::{Rows, Work};
use self::stages::Stages;
use super::report::Device;
use super::target::Target;
use crate::statistics::Statistics;
use varikernel::error::Result;
use varikernel::gl::{Gl, Sample, Timer};
use varikernel::scene::Scene;

/// More photons than this are not drawn as kernels.
const MOST_SPLATTED: u32 = 1_000_000;
/// Rows that take a larger part of a case's time are sampled once.
const LONG: f64 = 0.1;

/// A scene, and how much of it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PictureSuite {
    /// A scene that comes with the program.
    pub scene: String,
    /// Columns and rows of each picture.
    pub sizes: Vec<[u32; 2]>,
    /// Photons that are traced, and of those that may be seen, as many are drawn: each number at each size.
    pub photons: Vec<u32>,
    /// Samples of each row at most, after one that is not counted.
    pub samples: usize,
}

impl Default for PictureSuite {
    /// A million photons in the glass box, 512 x 512 pixels.
    fn default() -> Self {
        Self {
            scene: "cornell-glass".to_owned(),
            sizes: vec![[512, 512]],
            photons: vec![1_000_000],
            samples: 50,
        }
    }
}

/// A stage and its times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PictureRow {
    /// The stage.
    pub name: String,
    /// GL_TIME_ELAPSED of each sample; the clock's time of what runs on the CPU.
    pub samples_ms: Vec<f64>,
    /// The clock's time of each sample.
    pub wall_ms: Vec<f64>,
    /// All samples together.
    #[serde(flatten)]
    pub statistics: Statistics,
    /// Which samples' query and clock contradict each other ([`Sample::is_suspect`]), counted from 0.
    pub suspect: Vec<usize>,
    /// The median in point-only passes of this run; none on the CPU, or if the points are wrong.
    pub point_passes: Option<f64>,
    /// The median in copies of this run; none on the CPU, or if the copies are wrong.
    #[serde(default)]
    pub copies: Option<f64>,
    /// Fragments that a splat drew for each photon that contributes.
    pub fragments_per_photon: Option<f64>,
    /// The median over all fragments.
    pub ns_per_fragment: Option<f64>,
    /// Whether the answer is right.
    pub right: bool,
}

/// A row without a time, and why.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PictureLeftOut {
    /// The stage.
    pub name: String,
    /// Why not.
    pub reason: String,
}

/// One size with one number of photons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PictureCase {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Photons that were traced.
    pub photons: u32,
    /// Photons that were drawn as points: those in the picture, as many as were traced at most.
    pub drawn: u64,
    /// Of those, what lies on the surface that its pixel shows.
    pub contributing: u64,
    /// The stages.
    pub rows: Vec<PictureRow>,
    /// Stages that were not timed.
    pub left_out: Vec<PictureLeftOut>,
}

/// Everything that the suite found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PictureReport {
    /// The program's version.
    pub program: String,
    /// Where it ran.
    pub device: Device,
    /// The settings.
    pub suite: PictureSuite,
    /// n and MR of the radii, and the fixed radius, in pixels.
    pub radii: [u32; 3],
    /// Each size with each number of photons.
    pub cases: Vec<PictureCase>,
    /// The targets, judged.
    pub targets: Vec<Target>,
}

impl PictureSuite {
    /// Times the stages of each case until its share of `budget` is spent, each at least once; after each
    /// round `observe` gets what was found so far, and the share of the work that is done.
    ///
    /// # Errors
    /// Those of [`Renderer`](varikernel::render::Renderer) and `observe`, and
    /// [`Error::File`](varikernel::Error::File) for an unknown scene.
    pub fn run(
        &self,
        gl: &Gl,
        budget: Duration,
        observe: &mut dyn FnMut(&PictureReport, f64) -> Result<()>,
    ) -> Result<PictureReport> {
        let scene = Scene::shipped(&self.scene)?;
        let mut report = PictureReport {
            program: env!("CARGO_PKG_VERSION").to_owned(),
            device: Device::of(gl.info()),
            suite: self.clone(),
            radii: rows::radii(),
            cases: Vec::new(),
            targets: Vec::new(),
        };
        let cases: Vec<([u32; 2], u32)> = self
            .sizes
            .iter()
            .flat_map(|&size| self.photons.iter().map(move |&photons| (size, photons)))
            .collect();
        #[expect(clippy::cast_precision_loss, reason = "a few cases")]
        let count = cases.len() as f64;
        for (number, (size, photons)) in (0_u32..).zip(cases) {
            let rows = Rows::new(gl, &scene, UVec2::from_array(size), photons)?;
            let mut case = CaseRun::new(gl, rows)?;
            loop {
                let done = case.round(self, budget.as_secs_f64() / count)?;
                report.cases.truncate(number as usize);
                report.cases.push(case.told(size, photons, gl.info().software));
                report.targets = targets::of(self, &report.cases);
                observe(&report, (f64::from(number) + done) / count)?;
                if done >= 1.0 {
                    break;
                }
            }
        }
        Ok(report)
    }
}

/// A case while it runs.
struct CaseRun<'a> {
    rows: Rows<'a>,
    timer: Timer,
    stages: Stages,
    works: Vec<Work>,
    samples: Vec<Vec<Sample>>,
    right: Vec<bool>,
    start: Instant,
}

impl<'a> CaseRun<'a> {
    /// Checks every row.
    fn new(gl: &Gl, mut rows: Rows<'a>) -> Result<Self> {
        let start = Instant::now();
        let mut timer = Timer::new(gl)?;
        let is_timed = |work: &Work| !work.is_splat() || rows.photons() <= MOST_SPLATTED;
        let works: Vec<Work> = Work::ALL.into_iter().filter(is_timed).collect();
        let right = works.iter().map(|&work| rows.warm_up(&mut timer, work)).collect::<Result<Vec<_>>>()?;
        let samples = vec![Vec::new(); works.len()];
        Ok(Self { rows, timer, stages: Stages::new(gl)?, works, samples, right, start })
    }

    /// A sample of each row, but for those that would take too much of the `seconds`. The share that is done.
    fn round(&mut self, suite: &PictureSuite, seconds: f64) -> Result<f64> {
        for ((&work, samples), &is_right) in self.works.iter().zip(&mut self.samples).zip(&self.right) {
            let first = samples.first().map_or(0.0, |sample| sample.wall.as_secs_f64());
            if samples.is_empty() || first <= LONG * seconds {
                samples.push(self.rows.run(&mut self.timer, work)?);
            }
            if work == Work::Whole && is_right {
                self.stages.time(|| self.rows.whole_when_moved())?;
            }
        }
        let spent = self.start.elapsed().as_secs_f64() / seconds.max(1e-9);
        #[expect(clippy::cast_precision_loss, reason = "a share")]
        let taken = self.samples[0].len() as f64 / suite.samples.max(1) as f64;
        Ok(spent.max(taken).min(1.0))
    }

    fn told(&self, size: [u32; 2], photons: u32, software: bool) -> PictureCase {
        let mut found: Vec<PictureRow> = Vec::new();
        for ((&work, samples), &right) in self.works.iter().zip(&self.samples).zip(&self.right) {
            found.extend(row(work.name(), samples, software, right).map(|mut row| {
                let fragments = self.rows.fragments(work);
                row.fragments_per_photon = fragments.map(|all| all / self.rows.contributing_or_one());
                row.ns_per_fragment = fragments.map(|all| row.statistics.median_ms * 1e6 / all.max(1.0));
                row
            }));
        }
        for (name, samples) in stages::NAMES.into_iter().zip(&self.stages.samples) {
            // A pass that belongs to no stage makes all of them too short.
            found.extend(row(name, samples, software, self.stages.unknown.is_empty()));
        }
        // A wrong unit gives no ratios.
        let unit = |work: Work| {
            let row = found.iter().find(|row| row.name == work.name() && row.right)?;
            Some(row.statistics.median_ms).filter(|&median| median > 0.0)
        };
        let (copy, points) = (unit(Work::Copy), unit(Work::Points));
        for row in found.iter_mut().filter(|row| row.name != Work::Photons.name()) {
            row.copies = copy.map(|unit| row.statistics.median_ms / unit);
            row.point_passes = points.map(|unit| row.statistics.median_ms / unit);
        }
        let left_out = Work::ALL.into_iter().filter(|work| !self.works.contains(work)).map(|work| {
            let reason = format!(
                "a kernel for each of more than {MOST_SPLATTED} photons; time goes with their number for a \
                 fixed radius, and hardly falls with it for n"
            );
            PictureLeftOut { name: work.name().to_owned(), reason }
        });
        PictureCase {
            size,
            photons,
            drawn: self.rows.drawn,
            contributing: self.rows.contributing,
            rows: found,
            left_out: left_out.collect(),
        }
    }
}

/// Nothing without a sample.
fn row(name: &str, samples: &[Sample], software: bool, right: bool) -> Option<PictureRow> {
    let milliseconds = |time: Duration| time.as_secs_f64() * 1e3;
    let samples_ms: Vec<f64> = samples.iter().map(|sample| milliseconds(sample.query)).collect();
    let statistics = Statistics::of(&samples_ms)?;
    let suspects = samples.iter().enumerate().filter(|(_, sample)| sample.is_suspect(software));
    Some(PictureRow {
        name: name.to_owned(),
        wall_ms: samples.iter().map(|sample| milliseconds(sample.wall)).collect(),
        suspect: suspects.map(|(index, _)| index).collect(),
        point_passes: None,
        copies: None,
        fragments_per_photon: None,
        ns_per_fragment: None,
        right,
        samples_ms,
        statistics,
    })
}
