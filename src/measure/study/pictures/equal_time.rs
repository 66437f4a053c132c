//! Variable against fixed radii in the same time: more photons, or better kernels?

use serde::{Deserialize, Serialize};

use super::compare::distinct;
use super::metric::Sweep;
use super::{Metric, PictureRow, Width, Winner};
use crate::measure::{Confidence, RatioInterval};
use crate::settings::Kernel;

/// Budgets that are looked at, evenly spaced in the logarithm, where both curves go.
const BUDGETS: u32 = 5;

/// One number of photons: how long a picture takes, and how wrong it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// Photons that left the lights.
    pub photons: u32,
    /// The n or fixed radius with the least mean error for them.
    pub width: Width,
    /// Mean seconds of a whole picture over the seeds: photons, radii and kernels.
    pub seconds: f64,
    /// Mean error over the seeds.
    pub error: Confidence,
    /// The error of each seed, in their order.
    pub seeds: Vec<f64>,
}

/// Both errors at one time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Budget {
    /// Seconds of a picture.
    pub seconds: f64,
    /// Error of variable radii, a geometric mean over the seeds.
    pub variable: f64,
    /// Error of the fixed radius, the same.
    pub fixed: f64,
    /// Variable error over fixed error, paired by seed.
    pub ratio: RatioInterval,
    /// Who is better.
    pub winner: Winner,
}

/// Error over time for both.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EqualTime {
    /// The scene's name.
    pub scene: String,
    /// The falloff of both.
    pub kernel: Kernel,
    /// What is compared.
    pub metric: Metric,
    /// Variable radii with the best n for each number of photons, by increasing time.
    pub variable: Vec<CurvePoint>,
    /// The best fixed radius for each number of photons, by increasing time.
    pub fixed: Vec<CurvePoint>,
    /// Times that both curves reach, errors interpolated by their logarithm over that of the time; none where the curves share no
    /// time.
    pub budgets: Vec<Budget>,
}

/// Compares, for each scene and kernel among `rows`, and each metric. All widths have rows of the same seeds, as
/// [`run`](super::run) gives them: seeds are paired in their order.
#[must_use]
pub fn equal_time(rows: &[PictureRow]) -> Vec<EqualTime> {
    let mut found = Vec::new();
    for (scene, kernel) in distinct(rows, |row| (row.scene.as_str(), row.kernel)) {
        let of_scene: Vec<&PictureRow> =
            rows.iter().filter(|row| (row.scene.as_str(), row.kernel) == (scene, kernel)).collect();
        for metric in Metric::ALL {
            let [variable, fixed] = [false, true].map(|is_fixed| curve(&of_scene, metric, is_fixed));
            let budgets = budgets(&variable, &fixed);
            found.push(EqualTime { scene: scene.to_owned(), kernel, metric, variable, fixed, budgets });
        }
    }
    found
}

fn curve(rows: &[&PictureRow], metric: Metric, is_fixed: bool) -> Vec<CurvePoint> {
    let mut counts: Vec<u32> = rows.iter().map(|row| row.photons).collect();
    counts.sort_unstable();
    counts.dedup();
    let point = |photons| {
        let sweep = Sweep::new(rows.iter().copied().filter(|row| row.photons == photons));
        let chosen = sweep.best(metric, is_fixed)?;
        let seconds: Vec<f64> = sweep.of(chosen.width).iter().map(|row| row.seconds()).collect();
        Some(CurvePoint {
            photons,
            width: chosen.width,
            seconds: Confidence::of(&seconds)?.mean,
            error: chosen.error,
            seeds: sweep.errors(chosen.width, metric),
        })
    };
    let mut curve: Vec<CurvePoint> = counts.into_iter().filter_map(point).collect();
    curve.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    curve
}

fn budgets(variable: &[CurvePoint], fixed: &[CurvePoint]) -> Vec<Budget> {
    let ends = |curve: &[CurvePoint]| Some((curve.first()?.seconds, curve.last()?.seconds));
    let (Some(variable_ends), Some(fixed_ends)) = (ends(variable), ends(fixed)) else {
        return Vec::new();
    };
    let (begin, end) = (variable_ends.0.max(fixed_ends.0), variable_ends.1.min(fixed_ends.1));
    if begin >= end {
        return Vec::new();
    }
    let seeds = variable.iter().chain(fixed).map(|point| point.seeds.len()).min().unwrap_or(0);
    let budget = |step: u32| {
        let share = f64::from(step) / f64::from(BUDGETS - 1);
        // The last one is the end itself, without a rounded power.
        let seconds = if step + 1 == BUDGETS { end } else { begin * (end / begin).powf(share) };
        let errors = |curve: &[CurvePoint]| {
            (0..seeds).map(|seed| error_at(curve, seed, seconds)).collect::<Option<Vec<f64>>>()
        };
        let (variable, fixed) = (errors(variable)?, errors(fixed)?);
        let pairs: Vec<(f64, f64)> = variable.iter().copied().zip(fixed.iter().copied()).collect();
        let ratio = RatioInterval::of(&pairs)?;
        let winner = Winner::by(&ratio);
        Some(Budget {
            seconds,
            variable: geometric_mean(&variable)?,
            fixed: geometric_mean(&fixed)?,
            ratio,
            winner,
        })
    };
    (0..BUDGETS).filter_map(budget).collect()
}

/// A seed's error at a time between two points, on the straight line of the logarithms; nothing outside of the curve.
fn error_at(curve: &[CurvePoint], seed: usize, seconds: f64) -> Option<f64> {
    let after = curve.iter().position(|point| point.seconds >= seconds)?;
    let end = &curve[after];
    if end.seconds <= seconds {
        return Some(end.seeds[seed]);
    }
    let begin = &curve[after.checked_sub(1)?];
    let share = (seconds / begin.seconds).ln() / (end.seconds / begin.seconds).ln();
    let (from, to) = (begin.seeds[seed].ln(), end.seeds[seed].ln());
    Some((from + share * (to - from)).exp())
}

fn geometric_mean(values: &[f64]) -> Option<f64> {
    let logarithms: Vec<f64> = values.iter().map(|value| value.ln()).collect();
    Some(Confidence::of(&logarithms)?.mean.exp())
}
