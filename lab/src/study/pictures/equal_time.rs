//! Variable against fixed radii in the same time: more photons, or better kernels?

use serde::{Deserialize, Serialize};

use super::equal_photons::distinct;
use super::metric::Sweep;
use super::{Family, Metric, PictureRow, Way, Winner};
use crate::confidence::{Confidence, RatioInterval};
use crate::statistics::Statistics;
use varikernel::settings::{Kernel, PictureSettings};

/// Budgets that are compared, evenly spaced in the logarithm, where both curves are defined.
const BUDGETS: u32 = 5;

/// One number of photons: how long a picture takes, and how wrong it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// Photons that left the lights.
    pub photons: u32,
    /// What was drawn: with the least mean error for them, where a number was chosen.
    pub way: Way,
    /// Median seconds of a whole picture over the seeds: photons, counts, radii and light.
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
    /// The n with the least error at that time, and the error: a geometric mean over the seeds.
    pub variable: (Way, f64),
    /// The fixed radius, the same.
    pub fixed: (Way, f64),
    /// Variable error over fixed error, paired by seed.
    pub ratio: RatioInterval,
    /// Who is better.
    pub winner: Winner,
}

/// Error over time for every way.
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
    /// Splats with the default n, by increasing time, as the others.
    pub default: Vec<CurvePoint>,
    /// Gathers with that n.
    pub gather: Vec<CurvePoint>,
    /// Light from tables.
    pub tables: Vec<CurvePoint>,
    /// Times that variable and fixed radii both reach. Each width has a curve of its own over its numbers of
    /// photons, errors interpolated by their logarithm over that of the time, and the lowest at that time
    /// counts: a narrow kernel with more photons may beat what is best for either number. None where both
    /// share no time.
    pub budgets: Vec<Budget>,
}

/// Compares, for each scene and kernel among `rows`, and each metric. All widths have rows of the same seeds,
/// as [`run`](super::run) gives them: seeds are paired in their order.
#[must_use]
pub fn equal_time(rows: &[PictureRow]) -> Vec<EqualTime> {
    let mut found = Vec::new();
    for (scene, kernel) in distinct(rows, |row| (row.scene.as_str(), row.kernel)) {
        let of_scene: Vec<&PictureRow> =
            rows.iter().filter(|row| (row.scene.as_str(), row.kernel) == (scene, kernel)).collect();
        for metric in Metric::ALL {
            let families = [Family::Variable, Family::Fixed];
            let [variable, fixed] = families.map(|family| curve(&of_scene, metric, family));
            let [variables, fixeds] = families.map(|family| curves(&of_scene, metric, family));
            let one = |way| along_photons(&of_scene, |sweep, photons| point(sweep, metric, photons, way));
            let min_photons = PictureSettings::default().min_photons;
            found.push(EqualTime {
                scene: scene.to_owned(),
                kernel,
                metric,
                variable,
                fixed,
                default: one(Way::Variable { min_photons }),
                gather: one(Way::Gather { min_photons }),
                tables: one(Way::Tables),
                budgets: budgets(&variables, &fixeds),
            });
        }
    }
    found
}

/// The best way of a family for each number of photons.
fn curve(rows: &[&PictureRow], metric: Metric, family: Family) -> Vec<CurvePoint> {
    along_photons(rows, |sweep, photons| {
        let chosen = sweep.best(metric, family)?;
        point(sweep, metric, photons, chosen.way)
    })
}

/// Each way of a family over its numbers of photons.
fn curves(rows: &[&PictureRow], metric: Metric, family: Family) -> Vec<Vec<CurvePoint>> {
    let mut ways: Vec<Way> = rows.iter().map(|row| row.way).filter(|way| way.family() == family).collect();
    ways.sort_unstable();
    ways.dedup();
    let of_way = |way| along_photons(rows, |sweep, photons| point(sweep, metric, photons, way));
    ways.into_iter().map(of_way).collect()
}

/// A point for each number of photons, by increasing time.
fn along_photons(
    rows: &[&PictureRow],
    point: impl Fn(&Sweep<'_>, u32) -> Option<CurvePoint>,
) -> Vec<CurvePoint> {
    let mut counts: Vec<u32> = rows.iter().map(|row| row.photons).collect();
    counts.sort_unstable();
    counts.dedup();
    let of = |photons| point(&Sweep::new(rows.iter().copied().filter(|row| row.photons == photons)), photons);
    let mut curve: Vec<CurvePoint> = counts.into_iter().filter_map(of).collect();
    curve.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    curve
}

/// A way with one number of photons, if it was tried.
fn point(sweep: &Sweep<'_>, metric: Metric, photons: u32, way: Way) -> Option<CurvePoint> {
    if !sweep.is_whole(way) {
        return None;
    }
    let seconds: Vec<f64> = sweep.of(way).iter().map(|row| 1e3 * row.seconds()).collect();
    let seeds = sweep.errors(way, metric);
    Some(CurvePoint {
        photons,
        way,
        seconds: Statistics::of(&seconds)?.median_ms / 1e3,
        error: Confidence::of(&seeds)?,
        seeds,
    })
}

fn budgets(variables: &[Vec<CurvePoint>], fixeds: &[Vec<CurvePoint>]) -> Vec<Budget> {
    let ends = |curves: &[Vec<CurvePoint>]| {
        let seconds = || curves.iter().flatten().map(|point| point.seconds);
        Some((seconds().reduce(f64::min)?, seconds().reduce(f64::max)?))
    };
    let (Some(variable_ends), Some(fixed_ends)) = (ends(variables), ends(fixeds)) else {
        return Vec::new();
    };
    let (begin, end) = (variable_ends.0.max(fixed_ends.0), variable_ends.1.min(fixed_ends.1));
    if begin >= end {
        return Vec::new();
    }
    let budget = |step: u32| {
        let share = f64::from(step) / f64::from(BUDGETS - 1);
        // The last one is the end itself, without a rounded power.
        let seconds = if step + 1 == BUDGETS { end } else { begin * (end / begin).powf(share) };
        let (variable, fixed) = (lowest_at(variables, seconds)?, lowest_at(fixeds, seconds)?);
        let pairs: Vec<(f64, f64)> = variable.seeds.into_iter().zip(fixed.seeds).collect();
        let ratio = RatioInterval::of(&pairs)?;
        Some(Budget {
            seconds,
            variable: (variable.way, variable.error),
            fixed: (fixed.way, fixed.error),
            ratio,
            winner: Winner::by(&ratio),
        })
    };
    (0..BUDGETS).filter_map(budget).collect()
}

/// A way at some time.
struct AtTime {
    way: Way,
    error: f64,
    seeds: Vec<f64>,
}

/// The way with the least error at a time; nothing where no curve is defined.
fn lowest_at(curves: &[Vec<CurvePoint>], seconds: f64) -> Option<AtTime> {
    let at = |curve: &Vec<CurvePoint>| {
        let count = curve.iter().map(|point| point.seeds.len()).min()?;
        let seeds: Vec<f64> = (0..count).map(|seed| error_at(curve, seed, seconds)).collect::<Option<_>>()?;
        Some(AtTime { way: curve[0].way, error: geometric_mean(&seeds)?, seeds })
    };
    curves.iter().filter_map(at).min_by(|a, b| a.error.total_cmp(&b.error))
}

/// A seed's error at a time between two points, on the straight line of the logarithms; nothing outside of
/// the curve.
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
