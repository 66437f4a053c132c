//! How far an estimate of density is from the truth: bias and noise apart.
//!
//! The estimate of a pixel is what its box holds over the box's area inside the map. Over independent seeds,
//! *bias* is what the mean estimate is off, *noise* is how estimates vary around their mean, and the mean
//! squared error is the sum of their squares. A box that grows until it holds n photons stops at a dense
//! moment: its count over its area is too large on the average. Where the area ends exactly at the n-th
//! photon, n - 1 in place of n is right (as in the nearest-neighbour estimate: D. O. Loftsgaarden, C. P.
//! Quesenberry, 1965); boxes grow by whole pixels and hold c >= n, so the study measures what c - 1 in place
//! of c does.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::shape::{Shape, sample};
use crate::confidence::Confidence;
use crate::rivals::{Cores, Scanline};
use varikernel::image::Image;
use varikernel::reference::{self, Inside, Table};
use varikernel::settings::{Search, Settings};

/// The share of the truth's root mean square below which an error counts as if the pixel were that dense.
const DARK: f64 = 0.1;

/// What is estimated, and how often.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DensityStudy {
    /// Columns and rows of the maps.
    pub side: u32,
    /// Photons a pixel, on the average.
    pub photons_per_pixel: f64,
    /// n of growing boxes.
    pub min_photons: Vec<u32>,
    /// MR of growing boxes and of even ones.
    pub max_radius: u32,
    /// Radii of boxes that are the same everywhere.
    pub fixed: Vec<u32>,
    /// Independent maps of each shape, at least 2.
    pub seeds: u32,
}

impl DensityStudy {
    /// Two photons a pixel, 48 seeds.
    #[must_use]
    pub fn usual() -> Self {
        Self {
            side: 128,
            photons_per_pixel: 2.0,
            min_photons: vec![5, 10, 25, 50, 100, 200, 400, 800, 1600, 3200],
            max_radius: 32,
            fixed: vec![1, 2, 3, 4, 6, 8, 12, 16, 20],
            seeds: 48,
        }
    }

    /// Small maps, few seeds.
    #[must_use]
    pub fn quick() -> Self {
        Self { side: 48, min_photons: vec![10, 50, 200], fixed: vec![1, 3, 8], seeds: 6, ..Self::usual() }
    }
}

/// The width of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Width {
    /// The smallest that holds n photons.
    Holding(u32),
    /// The same everywhere, in pixels.
    Fixed(u32),
    /// The widest over which the density is even but for noise
    /// ([`Rule::Even`](varikernel::settings::Rule::Even)); nothing is chosen.
    Even,
}

impl Width {
    /// Whether it grows until it holds n photons.
    #[must_use]
    pub fn is_growing(self) -> bool {
        matches!(self, Self::Holding(_))
    }

    /// Whether it is the same everywhere.
    #[must_use]
    pub fn is_fixed(self) -> bool {
        matches!(self, Self::Fixed(_))
    }
}

/// One estimate of one shape. All errors are in parts of the map's mean density.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DensityRow {
    /// The truth.
    pub shape: Shape,
    /// The box.
    pub width: Width,
    /// Whether c - 1 stands for c.
    pub corrected: bool,
    /// How many maps.
    pub seeds: u32,
    /// The mean radius, in pixels.
    pub mean_radius: f64,
    /// Mean of estimate minus truth: what is too much or too little in all, with its interval over seeds.
    pub mean_error: Confidence,
    /// Root of the mean squared bias, the part of it that is chance taken off.
    pub bias: f64,
    /// Root of the mean variance over seeds.
    pub noise: f64,
    /// Root of the mean squared error, with its interval over seeds.
    pub rmse: Confidence,
    /// The same with each pixel's squared error over its squared truth plus ε, the square of a tenth of the
    /// truth's root mean square: dim pixels count as much as bright ones.
    pub relative_rmse: Confidence,
    /// The two errors of each seed, in their order, to be paired with those of another estimate.
    pub of_seeds: Vec<[f64; 2]>,
}

/// Every estimate of every shape, the same bits whatever the number of threads. `observe` gets the part that
/// is done.
///
/// # Errors
/// Whatever `observe` fails with.
///
/// # Panics
/// With fewer than two seeds.
pub fn run<E>(
    study: &DensityStudy,
    observe: &mut dyn FnMut(f64) -> Result<(), E>,
) -> Result<Vec<DensityRow>, E> {
    assert!(study.seeds >= 2, "a variance takes two seeds");
    let mut rows = Vec::new();
    for (done, shape) in Shape::ALL.into_iter().enumerate() {
        #[expect(clippy::cast_precision_loss, reason = "a share")]
        observe(done as f64 / Shape::ALL.len() as f64)?;
        let truth = shape.expected(study.side, study.photons_per_pixel);
        let maps: Vec<Image<u32>> =
            (0..study.seeds).into_par_iter().map(|seed| sample(&truth, u64::from(seed) + 1)).collect();
        let growing = study.min_photons.iter().map(|&n| Width::Holding(n));
        let fixed = study.fixed.iter().map(|&radius| Width::Fixed(radius));
        let widths: Vec<_> = growing.chain(fixed).chain([Width::Even]).collect();
        let of_widths: Vec<Vec<DensityRow>> = widths
            .into_par_iter()
            .map(|width| {
                let corrections: &[bool] = match width {
                    Width::Holding(_) => &[false, true],
                    // It does not stop at a photon, so that there is nothing to correct.
                    Width::Fixed(_) | Width::Even => &[false],
                };
                let found: Vec<Boxes> =
                    maps.iter().map(|map| Boxes::of(map, width, study.max_radius)).collect();
                let row = |&corrected: &bool| row(study, shape, width, corrected, &truth, &found);
                corrections.iter().map(row).collect()
            })
            .collect();
        rows.extend(of_widths.into_iter().flatten());
    }
    Ok(rows)
}

/// What the box of each pixel holds, its area inside the map, and the mean of all radii.
struct Boxes {
    counts: Vec<(f64, f64)>,
    mean_radius: f64,
}

impl Boxes {
    #[expect(clippy::cast_precision_loss, reason = "counts and areas are far below 2^53")]
    fn of(map: &Image<u32>, width: Width, max_radius: u32) -> Self {
        let radii = match width {
            Width::Fixed(radius) => Image::filled(map.size(), radius),
            Width::Even => reference::even(map, Search { max_radius, ..Settings::default().search }).radius,
            Width::Holding(min_photons) => {
                let search = Search { min_photons, max_radius, ..Settings::default().search };
                Scanline::new(map.size(), search, Cores::One).run(map).radius.clone()
            }
        };
        let table = Table::new(map);
        let mut counts = Vec::new();
        for y in 0..map.size().y {
            for x in 0..map.size().x {
                let inside = Inside::of_box(map.size(), x, y, radii.at(x, y));
                counts.push((table.count(inside) as f64, inside.area() as f64));
            }
        }
        let sum: u64 = radii.values().iter().map(|&radius| u64::from(radius)).sum();
        Self { mean_radius: sum as f64 / counts.len() as f64, counts }
    }

    /// Photons a pixel.
    fn estimates(&self, corrected: bool) -> impl Iterator<Item = f64> {
        let taken = if corrected { 1.0 } else { 0.0 };
        self.counts.iter().map(move |(count, area)| (count - taken).max(0.0) / area)
    }
}

fn row(
    study: &DensityStudy,
    shape: Shape,
    width: Width,
    corrected: bool,
    truth: &Image<f64>,
    found: &[Boxes],
) -> DensityRow {
    let maps: Vec<Vec<f64>> = found.iter().map(|boxes| boxes.estimates(corrected).collect()).collect();
    let Errors { means, rmses, relative_rmses, bias, noise } = Errors::of(&maps, truth.values());
    let unit = study.photons_per_pixel;
    let confidence = |values: Vec<f64>| Confidence::of(&values).expect("at least two seeds");
    let in_unit = |values: &[f64]| values.iter().map(|value| value / unit).collect::<Vec<f64>>();
    let rmses = in_unit(&rmses);
    DensityRow {
        shape,
        width,
        corrected,
        seeds: study.seeds,
        mean_radius: mean(found.iter().map(|boxes| boxes.mean_radius)),
        mean_error: confidence(in_unit(&means)),
        bias: bias / unit,
        noise: noise / unit,
        of_seeds: rmses.iter().zip(&relative_rmses).map(|(&rmse, &relative)| [rmse, relative]).collect(),
        rmse: confidence(rmses),
        relative_rmse: confidence(relative_rmses),
    }
}

/// Errors of some maps of one truth.
#[derive(Debug, PartialEq)]
struct Errors {
    /// For each map, the mean of estimate minus truth.
    means: Vec<f64>,
    /// For each map, the root of the mean squared error.
    rmses: Vec<f64>,
    /// The same, in parts of each pixel's truth.
    relative_rmses: Vec<f64>,
    bias: f64,
    noise: f64,
}

impl Errors {
    fn of(maps: &[Vec<f64>], truth: &[f64]) -> Self {
        let errors =
            |map: &[f64]| -> Vec<f64> { map.iter().zip(truth).map(|(found, truth)| found - truth).collect() };
        let errors: Vec<Vec<f64>> = maps.iter().map(|map| errors(map)).collect();
        #[expect(clippy::cast_precision_loss, reason = "a few maps")]
        let count = maps.len() as f64;
        let (mut squared_bias, mut variance) = (0.0, 0.0);
        for pixel in 0..truth.len() {
            let mean = mean(errors.iter().map(|map| map[pixel]));
            let of_pixel = errors.iter().map(|map| (map[pixel] - mean).powi(2)).sum::<f64>() / (count - 1.0);
            // The mean of some maps is itself off by chance, by a part of the variance.
            squared_bias += mean * mean - of_pixel / count;
            variance += of_pixel;
        }
        #[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53 pixels")]
        let pixels = truth.len() as f64;
        let epsilon = DARK * DARK * mean(truth.iter().map(|truth| truth * truth));
        let relative = |map: &Vec<f64>| {
            mean(map.iter().zip(truth).map(|(error, truth)| error * error / (truth * truth + epsilon))).sqrt()
        };
        Self {
            means: errors.iter().map(|map| mean(map.iter().copied())).collect(),
            rmses: errors.iter().map(|map| mean(map.iter().map(|error| error * error)).sqrt()).collect(),
            relative_rmses: errors.iter().map(relative).collect(),
            bias: (squared_bias / pixels).max(0.0).sqrt(),
            noise: (variance / pixels).sqrt(),
        }
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53 values")]
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the answers are exact in binary")]
mod tests {
    use std::convert::Infallible;

    use super::*;

    #[test]
    fn bias_and_noise_by_hand() {
        // Two pixels, two maps. The first is 1 too large and 3 too large: a mean of 2, a variance of 2. The
        // second is 1 too small twice.
        let truth = [10.0, 5.0];
        let errors = Errors::of(&[vec![11.0, 4.0], vec![13.0, 4.0]], &truth);
        assert_eq!(errors.means, [0.0, 1.0]);
        assert_eq!(errors.rmses, [1.0, 5.0_f64.sqrt()]);
        // The mean of 100 and 25 is 62.5, of which ε is a hundredth.
        let relative = |[first, second]: [f64; 2]| {
            f64::midpoint(first * first / 100.625, second * second / 25.625).sqrt()
        };
        assert!((errors.relative_rmses[0] - relative([1.0, 1.0])).abs() < 1e-15);
        assert!((errors.relative_rmses[1] - relative([3.0, 1.0])).abs() < 1e-15);
        // (2² - 2 / 2 + 1) / 2 and (2 + 0) / 2.
        assert_eq!((errors.bias, errors.noise), (2.0_f64.sqrt(), 1.0));
    }

    #[test]
    fn an_estimate_is_what_a_box_holds_over_its_area_inside() {
        let map = Image::from_values(glam::UVec2::new(3, 1), vec![4, 0, 2]);
        let boxes = Boxes::of(&map, Width::Fixed(1), 9);
        let estimates = |corrected| boxes.estimates(corrected).collect::<Vec<_>>();
        assert_eq!(estimates(false), [2.0, 2.0, 1.0]);
        assert_eq!(estimates(true), [1.5, 5.0 / 3.0, 0.5]);
        // Scaled edges: 4 of 3 x 1 in 9 x 1 pixels count as 4 · 9 / 2 where n = 7 is compared.
        assert_eq!(Boxes::of(&map, Width::Holding(7), 9).mean_radius, 1.0);
    }

    #[test]
    fn a_growing_box_is_too_dense_and_one_photon_less_is_right() {
        let study = DensityStudy { min_photons: vec![25], fixed: vec![4], ..DensityStudy::quick() };
        let rows = run::<Infallible>(&study, &mut |_| Ok(())).unwrap();
        assert_eq!(rows.len(), 4 * Shape::ALL.len());
        let of = |shape, width, corrected| {
            let found =
                rows.iter().find(|row| (row.shape, row.width, row.corrected) == (shape, width, corrected));
            found.unwrap()
        };
        let growing = of(Shape::Uniform, Width::Holding(25), false).mean_error;
        let corrected = of(Shape::Uniform, Width::Holding(25), true).mean_error;
        let fixed = of(Shape::Uniform, Width::Fixed(4), false).mean_error;
        assert!(growing.mean - growing.margin() > 0.0, "{growing:?}");
        assert!(corrected.mean.abs() < growing.mean, "{corrected:?}");
        assert!(fixed.mean.abs() < fixed.margin(), "{fixed:?}");
        // A step is blurred, a plain is not; a wide box is less noisy than a narrow one.
        assert!(
            of(Shape::Step, Width::Fixed(4), false).bias
                > 5.0 * of(Shape::Uniform, Width::Fixed(4), false).bias
        );
        // What is even takes the widest boxes, and edges stay where a fixed box blurs them.
        let even = |shape| of(shape, Width::Even, false);
        let narrow = of(Shape::Uniform, Width::Fixed(4), false);
        assert!(even(Shape::Uniform).mean_radius > 25.0 && even(Shape::Uniform).noise < 0.5 * narrow.noise);
        let (kept, blurred) = (even(Shape::Step), of(Shape::Step, Width::Fixed(4), false));
        assert!(
            kept.bias < 0.75 * blurred.bias && kept.rmse.mean < blurred.rmse.mean,
            "{kept:?}, {blurred:?}"
        );
        for row in &rows {
            let squares = row.bias.powi(2) + row.noise.powi(2);
            // By chance, a few pixels of one map stay narrow, so that seeds differ.
            let far = if row.width == Width::Even { 0.2 } else { 0.1 };
            assert!((squares.sqrt() / row.rmse.mean - 1.0).abs() < far, "{row:?}");
        }
        assert_eq!(run::<Infallible>(&study, &mut |_| Ok(())).unwrap(), rows);
    }
}
