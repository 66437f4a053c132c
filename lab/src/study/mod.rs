//! Run time against error: what each way to a radius map costs and how wrong it is, how far estimates of
//! density are from the truth, and what both mean for pictures.
//!
//! Three parts, each of which can be read alone:
//!
//! - [`radii`]: every method, build, storage and search against the exact radii, with approximations that are
//!   no default anywhere; [`pareto`] has what to choose for which budget.
//! - [`density`]: bias and noise of estimates on densities whose truth is known.
//! - [`pictures`]: light from tables, variable radii and gathers against the best fixed radii on the shipped
//!   scenes, for equal photons and equal time, with targets, and their bias apart from noise.
//!
//! Errors are the same to the last bit at each run with the same settings; times are not.

pub mod density;
mod files;
mod page;
mod page_pictures;
pub mod pareto;
pub mod pictures;
mod plots;
pub mod radii;
pub mod shape;
mod variant;
mod words;

pub use variant::VariantName;

use std::time::Instant;

use serde::{Deserialize, Serialize};

use self::density::{DensityRow, DensityStudy};
use self::pareto::Overall;
use self::pictures::{BiasRow, EqualPhotons, EqualTime, PictureRow, PictureStudy, SceneReference};
use self::radii::{Answers, Question, RadiusStudy};
use crate::bench::{Device, Target};
use varikernel::error::Result;
use varikernel::gl::Gl;
use varikernel::image::Image;

/// What is studied.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudySettings {
    /// Radius maps.
    pub radii: RadiusStudy,
    /// Estimates of density.
    pub density: DensityStudy,
    /// Pictures of scenes.
    pub pictures: PictureStudy,
}

impl StudySettings {
    /// What two processor cores do within two hours, most of it pictures.
    #[must_use]
    pub fn usual() -> Self {
        Self { radii: RadiusStudy::usual(), density: DensityStudy::usual(), pictures: PictureStudy::usual() }
    }

    /// A look at every part, within a minute.
    #[must_use]
    pub fn quick() -> Self {
        Self { radii: RadiusStudy::quick(), density: DensityStudy::quick(), pictures: PictureStudy::quick() }
    }

    /// Every size with every n and MR: hours on a software renderer.
    #[must_use]
    pub fn full() -> Self {
        Self { radii: RadiusStudy::full(), ..Self::usual() }
    }
}

/// Everything that a study found so far: `study.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Study {
    /// The version of the program.
    pub program: String,
    /// The commit that it was built from.
    pub commit: String,
    /// Where it ran.
    pub device: Device,
    /// The settings.
    pub settings: StudySettings,
    /// Radius maps, question by question.
    pub radii: Vec<(Question, Answers)>,
    /// Estimates of density; empty until all are there.
    pub density: Vec<DensityRow>,
    /// Pictures, row by row.
    pub pictures: Vec<PictureRow>,
    /// What the pictures were compared with; empty until all are there.
    pub references: Vec<SceneReference>,
    /// How biased the ways to a picture are; empty until all are there.
    pub biases: Vec<BiasRow>,
    /// Seconds that all of it took, over all runs.
    pub seconds: f64,
}

impl Study {
    /// Nothing found yet.
    #[must_use]
    pub fn begin(gl: &Gl, settings: &StudySettings) -> Self {
        Self {
            program: env!("CARGO_PKG_VERSION").to_owned(),
            commit: crate::COMMIT.to_owned(),
            device: Device::of(gl.info()),
            settings: settings.clone(),
            radii: Vec::new(),
            density: Vec::new(),
            pictures: Vec::new(),
            references: Vec::new(),
            biases: Vec::new(),
            seconds: 0.0,
        }
    }

    /// The conclusions from the rows: the front of each question, comparisons, and sentences.
    #[must_use]
    pub fn summary(&self) -> Summary {
        let of_question = |(question, answers): &(Question, Answers)| {
            (*question, pareto::overall(&answers.rows, *question))
        };
        let radii: Vec<_> = self.radii.iter().map(of_question).collect();
        let equal_photons = pictures::equal_photons(&self.pictures);
        let equal_time = pictures::equal_time(&self.pictures);
        Summary {
            advice: radii.first().map(|(_, overall)| pareto::advice(overall)).unwrap_or_default(),
            density: [
                words::stopping_rule(&self.density),
                words::density(&self.density),
                words::even(&self.density),
            ]
            .concat(),
            pictures: words::pictures(&equal_photons, &equal_time),
            targets: pictures::targets(&equal_photons, self.settings.pictures.size),
            radii,
            equal_photons,
            equal_time,
        }
    }
}

/// The conclusions from the rows of a study.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// What to choose for which budget, for the first question.
    pub advice: Vec<String>,
    /// What was found of estimates of density.
    pub density: Vec<String>,
    /// What was found of pictures.
    pub pictures: Vec<String>,
    /// What light from tables should reach, judged.
    pub targets: Vec<Target>,
    /// Each question's ways over all of its maps, and which are on the front.
    pub radii: Vec<(Question, Vec<Overall>)>,
    /// Every way against fixed radii from the same photons.
    pub equal_photons: Vec<EqualPhotons>,
    /// The same in the same time.
    pub equal_time: Vec<EqualTime>,
}

/// Where a study is.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// What is being done, to show.
    pub what: String,
    /// Share of the work that is done, 0 to 1, as far as is known.
    pub done: f64,
}

/// Parts of the time that radius maps, estimates and pictures take at the usual settings.
const SHARES: [f64; 3] = [0.06, 0.01, 0.93];

/// Finds everything, going on with `earlier` if there is one; `real` is a map of real photons with its name.
///
/// `observe` is called often, with all that is known by then: to save it and to show the progress.
///
/// # Errors
/// [`Error::Gl`](varikernel::Error::Gl) if the driver fails; whatever `observe` fails with.
pub fn run(
    gl: &Gl,
    settings: &StudySettings,
    real: (&str, &Image<u32>),
    earlier: Option<Study>,
    observe: &mut dyn FnMut(&Study, &Progress) -> Result<()>,
) -> Result<Study> {
    let start = Instant::now();
    let mut study = earlier.unwrap_or_else(|| Study::begin(gl, settings));
    let before = study.seconds;
    let questions = &settings.radii.questions;
    for (index, &question) in questions.iter().enumerate() {
        let known = study.radii.iter().position(|(known, _)| *known == question);
        let place = known.unwrap_or_else(|| {
            study.radii.push((question, Answers::default()));
            study.radii.len() - 1
        });
        let maps = RadiusStudy::maps(question, real);
        let earlier = study.radii[place].1.clone();
        let sample_ms = settings.radii.sample_ms;
        study.radii[place].1 =
            radii::answer(gl, question, &maps, sample_ms, earlier, &mut |answers, way, part| {
                study.radii[place].1.clone_from(answers);
                study.seconds = before + start.elapsed().as_secs_f64();
                #[expect(clippy::cast_precision_loss, reason = "a share")]
                let done = (index as f64 + part) / questions.len() as f64;
                let what = format!("radii of {question}: {way}");
                observe(&study, &Progress { what, done: SHARES[0] * done })
            })?;
    }
    if study.density.is_empty() {
        study.density = density::run(&settings.density, &mut |done| {
            observe(&study, &Progress { what: "density".to_owned(), done: SHARES[0] + SHARES[1] * done })
        })?;
    }
    if study.references.is_empty() {
        let earlier = study.pictures.clone();
        let found = pictures::run(gl, &settings.pictures, earlier.clone(), &mut |rows, progress| {
            // What an interrupted run had drawn is kept until its turn comes.
            study.pictures = rows.to_vec();
            study.pictures.extend(earlier.iter().filter(|row| !rows.contains(row)).cloned());
            study.seconds = before + start.elapsed().as_secs_f64();
            let done = SHARES[0] + SHARES[1] + SHARES[2] * progress.done;
            observe(&study, &Progress { what: format!("pictures: {}", progress.stage), done })
        })?;
        (study.pictures, study.references, study.biases) = (found.rows, found.references, found.biases);
    }
    study.seconds = before + start.elapsed().as_secs_f64();
    observe(&study, &Progress { what: "done".to_owned(), done: 1.0 })?;
    Ok(study)
}
