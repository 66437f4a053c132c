//! Run time against error of radius maps: every way to find them, on the same maps, against the exact answer.

mod timed_map;

use glam::UVec2;
use serde::{Deserialize, Serialize};

use self::timed_map::{Bench, Machine};
use super::variant::{self, Variant, VariantName};
use crate::bench::{MapInfo, MapSource};
use crate::synth::Kind;
use varikernel::error::{Error, Result};
use varikernel::gl::Gl;
use varikernel::image::Image;
use varikernel::settings::{Search, Settings};

/// The maps of each size.
const KINDS: [Kind; 4] = [Kind::Uniform, Kind::Caustic, Kind::Step, Kind::Spike];
/// The seed of all maps.
const SEED: u64 = 1;

/// A question, on maps of which side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Question {
    /// Columns and rows.
    pub side: u32,
    /// n.
    pub min_photons: u32,
    /// MR.
    pub max_radius: u32,
}

impl std::fmt::Display for Question {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { side, min_photons, max_radius } = self;
        write!(formatter, "{side} x {side} pixels, n = {min_photons}, MR = {max_radius}")
    }
}

impl Question {
    /// The search, with scaled edges.
    #[must_use]
    pub fn search(self) -> Search {
        Search { min_photons: self.min_photons, max_radius: self.max_radius, ..Settings::default().search }
    }
}

/// Which questions, and how long each way is timed for each map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RadiusStudy {
    /// The questions; the first is the one that the others vary.
    pub questions: Vec<Question>,
    /// Time for samples of one way on one map, in milliseconds; at least one is taken.
    pub sample_ms: u64,
}

impl RadiusStudy {
    /// n, MR and side varied one at a time.
    #[must_use]
    pub fn usual() -> Self {
        let middle = Question { side: 256, min_photons: 25, max_radius: 32 };
        let mut questions = vec![middle];
        questions.extend([10, 250].map(|min_photons| Question { min_photons, ..middle }));
        questions.extend([8, 128].map(|max_radius| Question { max_radius, ..middle }));
        questions.extend([64, 512].map(|side| Question { side, ..middle }));
        Self { questions, sample_ms: 40 }
    }

    /// One question on small maps.
    #[must_use]
    pub fn quick() -> Self {
        Self { questions: vec![Question { side: 64, min_photons: 25, max_radius: 32 }], sample_ms: 5 }
    }

    /// Every side with every n and MR.
    #[must_use]
    pub fn full() -> Self {
        let mut questions = Self::usual().questions;
        for side in [64, 256, 512, 1024] {
            for min_photons in [10, 25, 250, 1000] {
                for max_radius in [8, 32, 128] {
                    let question = Question { side, min_photons, max_radius };
                    if !questions.contains(&question) {
                        questions.push(question);
                    }
                }
            }
        }
        Self { questions, sample_ms: 100 }
    }

    /// The maps of a question; `real` joins those of its size.
    #[must_use]
    pub fn maps(question: Question, real: (&str, &Image<u32>)) -> Vec<MapSource> {
        let size = UVec2::splat(question.side);
        let mut maps: Vec<_> = KINDS.map(|kind| MapSource::synthetic(kind, size, SEED)).into();
        if real.1.size() == size {
            maps.push(MapSource::given(real.0, real.1.clone()));
        }
        maps
    }
}

/// How far radii are from the exact ones, in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RadiusError {
    /// Part of the pixels whose radius is another.
    pub wrong_share: f64,
    /// Mean of the distances.
    pub mean: f64,
    /// Root of the mean of their squares.
    pub rms: f64,
    /// The largest.
    pub max: u32,
}

impl RadiusError {
    /// Compares each pixel.
    ///
    /// # Panics
    /// If the sizes differ.
    #[must_use]
    pub fn between(found: &Image<u32>, exact: &Image<u32>) -> Self {
        assert_eq!(found.size(), exact.size(), "maps of one size");
        let (mut wrong, mut sum, mut squares, mut max) = (0_u64, 0_u64, 0_u64, 0);
        for (found, exact) in found.values().iter().zip(exact.values()) {
            let distance = found.abs_diff(*exact);
            wrong += u64::from(distance != 0);
            sum += u64::from(distance);
            squares += u64::from(distance) * u64::from(distance);
            max = max.max(distance);
        }
        #[expect(clippy::cast_precision_loss, reason = "means are rounded anyway")]
        let mean = |sum: u64| sum as f64 / found.values().len() as f64;
        Self { wrong_share: mean(wrong), mean: mean(sum), rms: mean(squares).sqrt(), max }
    }
}

/// One way on one map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RadiusRow {
    /// The map.
    pub map: MapInfo,
    /// All its photons.
    pub photons: u64,
    /// The question.
    pub question: Question,
    /// The way.
    pub variant: VariantName,
    /// Whether the library guarantees that every radius is exact.
    pub promised: bool,
    /// The mean of the exact radii, in pixels.
    pub mean_radius: f64,
    /// Against the exact radii.
    pub error: RadiusError,
    /// Textures beside the density map: the structure, what builds it, brackets and the radii, in bytes.
    pub memory_bytes: u64,
    /// Median time of a frame, build and search.
    pub ms: f64,
    /// The same in passes that read and write each texel once.
    pub copies: f64,
    /// Samples in the median.
    pub samples: usize,
}

/// A way that was not run on a map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// The map's name.
    pub map: String,
    /// The question.
    pub question: Question,
    /// The way.
    pub variant: VariantName,
    /// Why.
    pub reason: String,
}

/// The results of a question.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Answers {
    /// A row for each way and map.
    pub rows: Vec<RadiusRow>,
    /// What was not run.
    pub left_out: Vec<LeftOut>,
}

/// Runs every way on every map of a question that `earlier` does not have. `observe` gets what is there so
/// far, the way that is next, and the part that is done.
///
/// # Errors
/// [`Error::Gl`] if the driver fails while it is timed, and whatever `observe` fails with. A way that can't
/// be set up is left out, with the reason.
pub fn answer(
    gl: &Gl,
    question: Question,
    maps: &[MapSource],
    sample_ms: u64,
    earlier: Answers,
    observe: &mut dyn FnMut(&Answers, &str, f64) -> Result<()>,
) -> Result<Answers> {
    let search = question.search();
    let mut answers = earlier;
    let variants = variant::all(search);
    let missing: Vec<&Variant> =
        variants.iter().filter(|variant| answers.of(&variant.name) < maps.len()).collect();
    if missing.is_empty() {
        return Ok(answers);
    }
    let mut benches = Vec::new();
    for map in maps {
        benches.push(Bench::new(gl, map, search)?);
    }
    let first = answers.rows.len();
    for (done, variant) in missing.iter().enumerate() {
        #[expect(clippy::cast_precision_loss, reason = "a share")]
        observe(&answers, &variant.name.to_string(), done as f64 / missing.len() as f64)?;
        let mut machine = None;
        for bench in &mut benches {
            bench.take_copy()?;
            match Machine::prepared(&mut machine, gl, &bench.density, variant) {
                Ok(machine) => match bench.run(machine, question, &variant.name, sample_ms) {
                    Ok(row) => answers.rows.push(row),
                    Err(error @ (Error::Gl { .. } | Error::ContextLost | Error::OutOfMemory { .. })) => {
                        return Err(error);
                    }
                    Err(error) => answers.leave_out(bench, question, variant, &error),
                },
                Err(error) => answers.leave_out(bench, question, variant, &error),
            }
        }
    }
    // By all copies that were taken, not only those before a row.
    for bench in &benches {
        for row in answers.rows[first..].iter_mut().filter(|row| row.map == bench.map) {
            row.copies = row.ms / bench.copy_ms();
        }
    }
    Ok(answers)
}

impl Answers {
    /// Maps for which a way has a row, or a reason for none.
    fn of(&self, variant: &VariantName) -> usize {
        self.rows.iter().filter(|row| row.variant == *variant).count()
            + self.left_out.iter().filter(|left_out| left_out.variant == *variant).count()
    }

    fn leave_out(&mut self, bench: &Bench, question: Question, variant: &Variant, error: &Error) {
        self.left_out.push(LeftOut {
            map: bench.map.name.clone(),
            question,
            variant: variant.name.clone(),
            reason: error.to_string().lines().next().unwrap_or_default().to_owned(),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_by_hand() {
        let size = UVec2::new(4, 1);
        let exact = Image::from_values(size, vec![1, 2, 3, 4]);
        let found = Image::from_values(size, vec![1, 4, 3, 1]);
        let error = RadiusError::between(&found, &exact);
        // Distances 0, 2, 0, 3.
        assert_eq!((error.wrong_share, error.mean, error.max), (0.5, 1.25, 3));
        assert!((error.rms - 3.25_f64.sqrt()).abs() < 1e-15);
        assert_eq!(RadiusError::between(&exact, &exact), RadiusError::default());
    }

    #[test]
    fn questions_vary_one_thing_at_a_time_or_all() {
        let Question { side, min_photons, max_radius } = RadiusStudy::usual().questions[0];
        for question in &RadiusStudy::usual().questions[1..] {
            let same = [
                question.side == side,
                question.min_photons == min_photons,
                question.max_radius == max_radius,
            ];
            assert_eq!(same.iter().filter(|same| !**same).count(), 1, "{question:?}");
        }
        assert_eq!(RadiusStudy::full().questions.len(), 4 * 4 * 3);
    }
}
