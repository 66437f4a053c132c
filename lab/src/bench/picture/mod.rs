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
//! | `photons` | photons traced on the CPU, with 8 diffuse landings at most |
//!
//! Rows take turns, one sample each, so that a machine that slows down slows all alike. Every answer is
//! checked: counts, radii, flux and light from tables against their definitions, the gather against it at 61
//! pixels, points by their number, the splat by its energy, and landings by their tally.

mod rows;

use std::time::{Duration, Instant};

use glam::UVec2;
use serde::{Deserialize, Serialize};

use self::rows::{Rows, Work};
use super::report::Device;
use super::settings::MapInfo;
use super::target::{Side, Target};
use crate::statistics::Statistics;
use varikernel::error::Result;
use varikernel::gl::{Gl, Sample, Timer};
use varikernel::scene::Scene;

/// A scene, and how much of it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PictureSuite {
    /// A scene that comes with the program.
    pub scene: String,
    /// Columns and rows.
    pub size: [u32; 2],
    /// Photons that are traced, and of those that may be seen, as many are drawn.
    pub photons: u32,
    /// Samples of each row at most, after one that is not counted.
    pub samples: usize,
}

impl Default for PictureSuite {
    /// A million photons in the glass box, 512 x 512 pixels.
    fn default() -> Self {
        Self { scene: "cornell-glass".to_owned(), size: [512, 512], photons: 1_000_000, samples: 50 }
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

/// Everything that the suite found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PictureReport {
    /// The program's version.
    pub program: String,
    /// Where it ran.
    pub device: Device,
    /// The settings.
    pub suite: PictureSuite,
    /// Photons that were drawn as points: those in the picture, as many as were traced at most.
    pub drawn: u64,
    /// Of those, what lies on the surface that its pixel shows.
    pub contributing: u64,
    /// n and MR of the radii, and the fixed radius, in pixels.
    pub radii: [u32; 3],
    /// The stages.
    pub rows: Vec<PictureRow>,
    /// The targets, judged.
    pub targets: Vec<Target>,
}

impl PictureSuite {
    /// Times the stages until `budget` is spent, each at least once; after each round `observe` gets what was
    /// found so far, and the share of the work that is done.
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
        let start = Instant::now();
        let scene = Scene::shipped(&self.scene)?;
        let mut rows = Rows::new(gl, &scene, UVec2::from_array(self.size), self.photons)?;
        let mut timer = Timer::new(gl)?;
        let mut samples: Vec<Vec<Sample>> = vec![Vec::new(); Work::ALL.len()];
        let mut right = Vec::new();
        for work in Work::ALL {
            right.push(rows.warm_up(&mut timer, work)?);
        }
        loop {
            for (index, work) in Work::ALL.into_iter().enumerate() {
                samples[index].push(rows.run(&mut timer, work)?);
            }
            let report = self.report(gl, &rows, &samples, &right);
            let spent = start.elapsed().as_secs_f64() / budget.as_secs_f64().max(1e-9);
            #[expect(clippy::cast_precision_loss, reason = "a share")]
            let done = spent.max(samples[0].len() as f64 / self.samples as f64).min(1.0);
            observe(&report, done)?;
            if done >= 1.0 {
                return Ok(report);
            }
        }
    }

    fn report(&self, gl: &Gl, rows: &Rows<'_>, samples: &[Vec<Sample>], right: &[bool]) -> PictureReport {
        let software = gl.info().software;
        let mut found: Vec<PictureRow> = Vec::new();
        for (index, work) in Work::ALL.into_iter().enumerate() {
            found.extend(row(work, &samples[index], software, right[index], rows));
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
        PictureReport {
            program: env!("CARGO_PKG_VERSION").to_owned(),
            device: Device::of(gl.info()),
            suite: self.clone(),
            drawn: rows.drawn,
            contributing: rows.contributing,
            radii: rows.radii(),
            targets: self.targets(&found),
            rows: found,
        }
    }

    fn targets(&self, rows: &[PictureRow]) -> Vec<Target> {
        let map = MapInfo { name: self.scene.clone(), size: self.size, origin: String::new() };
        let row = |work: Work| rows.iter().find(|row| row.name == work.name() && row.right);
        let density = row(Work::Density).and_then(|row| row.point_passes);
        let millions = f64::from(self.photons) / 1e6;
        let photons = row(Work::Photons).map(|row| row.statistics.median_ms / 1e3 / millions);
        let question = format!("{} photons", self.photons);
        vec![
            Target::new(
                ("density", "photons counted, against the same photons as points"),
                &map,
                question.clone(),
                density,
                (Side::AtMost, 6.0, "point-only passes"),
            ),
            Target::new(
                ("photons", "a million photons traced, with 8 landings"),
                &map,
                question,
                photons,
                (Side::AtMost, 2.0, "seconds"),
            ),
        ]
    }
}

fn row(work: Work, samples: &[Sample], software: bool, right: bool, rows: &Rows<'_>) -> Option<PictureRow> {
    let milliseconds = |time: Duration| time.as_secs_f64() * 1e3;
    let samples_ms: Vec<f64> = samples.iter().map(|sample| milliseconds(sample.query)).collect();
    let statistics = Statistics::of(&samples_ms)?;
    let suspects = samples.iter().enumerate().filter(|(_, sample)| sample.is_suspect(software));
    let fragments = rows.fragments(work);
    Some(PictureRow {
        name: work.name().to_owned(),
        wall_ms: samples.iter().map(|sample| milliseconds(sample.wall)).collect(),
        suspect: suspects.map(|(index, _)| index).collect(),
        point_passes: None,
        copies: None,
        fragments_per_photon: fragments.map(|all| all / rows.contributing_or_one()),
        ns_per_fragment: fragments.map(|all| statistics.median_ms * 1e6 / all.max(1.0)),
        right,
        samples_ms,
        statistics,
    })
}
