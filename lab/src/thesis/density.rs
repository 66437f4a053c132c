//! How dense the thesis's unpublished input was, as inferred from its tables, and maps of that density.
//!
//! # The derivation
//! A forward search counts one box per radius until one holds enough: as many probes as the radius is long,
//! so the mean number of probes is the mean radius. A binary search from 1 to MR = 32 counts log2 32 = 5
//! boxes, whatever the map. Table A.6 times both on one table. If a search costs `fixed + probes * p`, then
//!
//! ```text
//! forward / binary = (fixed + mean radius * p) / (fixed + 5 p)
//! ```
//!
//! Two readings bound what is fixed. With nothing fixed, mean radius = 5 forward / binary
//! ([`Estimate::by_ratio`]). Table A.7 measures it: there the binary search takes 5, 6, 7 and 8 probes, a
//! straight line whose intercept is `fixed` at 512 x 512. Taken as the same share of a binary search at every
//! size, it gives [`Estimate::by_line`]. Both carry the rounding of three printed decimals
//! ([`Estimate::rounding`]).
//!
//! # How far to trust it
//! Only roughly: the two cards had the same maps, and at 64 x 64 they give radii that differ by more than 2.
//! A GPU waits for the slowest of a group of pixels, so forward time follows a mean of maxima; binary probes
//! lie far apart and miss the cache where forward ones do not. Both effects depend on the card. So
//! [`Inference::mean_radius`] is the geometric mean of the cards' ratios, and [`Inference::low`] to
//! [`Inference::high`] span all readings.
//!
//! Table A.8 is independent evidence. Brute force fetches Σ (2 r + 1)² texels for a pixel, so its time a
//! pixel follows the radii steeply. From 128 to 1024 it hardly changes on either card: what A.6 shows at 1024
//! is not a map with radii more than twice those at 512, which would have cost brute force ten times as much
//! a pixel. The likelier cause is a table that no longer fits the cache. [`Inference::by_brute_force`] is the
//! mean radius that A.8 gives when 512 is taken from A.6, and it widens the span.
//!
//! # The maps
//! [`matching_map`] draws a seeded map and solves for the number of photons, with the definition as judge,
//! until the mean radius is within [`TOLERANCE`] of the one wanted. The density grows from left to right, so
//! that most radii are small and few are large, as the thesis describes its own (5.1).

use glam::UVec2;

use super::quantity::{Card, Quantity};
use super::tables::printed_series;
use crate::summary::RadiusSummary;
use crate::synth::{self, Kind};
use varikernel::image::Image;
use varikernel::reference;
use varikernel::settings::{Edges, Order, Search};

/// n = 25 of the thesis's figures, MR = 32 of its benchmarks, and its edge rule.
pub const SEARCH: Search =
    Search { min_photons: 25, max_radius: 32, edges: Edges::Scale, order: Order::Forward };
/// Boxes that a binary search to MR = 32 counts.
const BINARY_PROBES: f64 = 5.0;
/// Half the last printed digit, in milliseconds.
const HALF_DIGIT: f64 = 0.0005;
/// The size at which A.7 was timed, and at which A.8 is tied to A.6.
const ANCHOR: u32 = 512;
/// How far the mean radius of a [`matching_map`] may be from the one wanted, relative.
pub const TOLERANCE: f64 = 0.01;
/// The distribution of [`matching_map`].
const KIND: Kind = Kind::Gradient;

/// The inference from one card for one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The card.
    pub card: Card,
    /// Mean forward probes if nothing is fixed.
    pub by_ratio: f64,
    /// Mean forward probes with the fixed share of A.7.
    pub by_line: f64,
    /// The relative error that rounding to three decimals allows.
    pub rounding: f64,
}

/// The inference from both cards for one size.
#[derive(Clone, Debug, PartialEq)]
pub struct Inference {
    /// Side of the map.
    pub size: u32,
    /// Each card alone.
    pub estimates: Vec<Estimate>,
    /// The best guess: geometric mean of both cards' ratios.
    pub mean_radius: f64,
    /// The smallest that a reading gives, rounding included.
    pub low: f64,
    /// The largest.
    pub high: f64,
    /// What the growth of brute force gives, both cards' geometric mean.
    pub by_brute_force: f64,
}

impl Inference {
    /// How far the cards are apart: the larger ratio over the smaller.
    #[must_use]
    pub fn disagreement(&self) -> f64 {
        let ratios = || self.estimates.iter().map(|estimate| estimate.by_ratio);
        ratios().fold(0.0, f64::max) / ratios().fold(f64::INFINITY, f64::min)
    }
}

/// The inference for each size of Table A.6.
#[must_use]
pub fn infer() -> Vec<Inference> {
    let sizes: Vec<u32> = printed_series(Quantity::SatSearch(Order::Forward), Card::Gtx260)
        .into_iter()
        .map(|(size, _)| size)
        .collect();
    let estimates = |size: u32| Card::ALL.map(|card| estimate(card, size)).to_vec();
    let ratio = |estimates: &[Estimate]| geometric_mean(estimates.iter().map(|estimate| estimate.by_ratio));
    let anchor = ratio(&estimates(ANCHOR));
    sizes
        .into_iter()
        .map(|size| {
            let estimates = estimates(size);
            let by_brute_force =
                geometric_mean(Card::ALL.into_iter().map(|card| by_brute_force(card, size, anchor)));
            let readings: Vec<(f64, f64)> = estimates
                .iter()
                .flat_map(|of| [(of.by_ratio, of.rounding), (of.by_line, of.rounding)])
                .chain([(by_brute_force, 0.0)])
                .collect();
            Inference {
                size,
                mean_radius: ratio(&estimates),
                low: readings.iter().map(|(radius, error)| radius * (1.0 - error)).fold(f64::MAX, f64::min),
                high: readings.iter().map(|(radius, error)| radius * (1.0 + error)).fold(0.0, f64::max),
                estimates,
                by_brute_force,
            }
        })
        .collect()
}

fn estimate(card: Card, size: u32) -> Estimate {
    let forward = printed(Quantity::SatSearch(Order::Forward), card, size);
    let binary = printed(Quantity::SatSearch(Order::Binary), card, size);
    let ratio = forward / binary;
    let share = fixed_share(card);
    Estimate {
        card,
        by_ratio: BINARY_PROBES * ratio,
        by_line: BINARY_PROBES * (ratio - share) / (1.0 - share),
        rounding: HALF_DIGIT / forward + HALF_DIGIT / binary,
    }
}

/// The share of a binary search at MR = 32 that does not grow with the probes: the intercept of A.7.
fn fixed_share(card: Card) -> f64 {
    let points: Vec<(f64, f64)> = printed_series(Quantity::SatSearchByMaxRadius, card)
        .into_iter()
        .map(|(max_radius, ms)| (f64::from(max_radius).log2(), ms))
        .collect();
    let (slope, intercept) = line(&points);
    intercept / (intercept + slope * BINARY_PROBES)
}

/// The least-squares line through `points`: slope and intercept.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "a handful of points")]
pub fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let count = points.len() as f64;
    let mean_x = points.iter().map(|point| point.0).sum::<f64>() / count;
    let mean_y = points.iter().map(|point| point.1).sum::<f64>() / count;
    let covariance: f64 = points.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let variance: f64 = points.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
    let slope = covariance / variance;
    (slope, mean_y - slope * mean_x)
}

/// The radius whose work is that of `anchor` times what A.8 says a pixel of `size` costs beside one of
/// [`ANCHOR`].
fn by_brute_force(card: Card, size: u32, anchor: f64) -> f64 {
    let a_pixel = |size: u32| printed(Quantity::BruteForce, card, size) / f64::from(size).powi(2);
    let wanted = work(anchor) * a_pixel(size) / a_pixel(ANCHOR);
    bisect(1.0, f64::from(SEARCH.max_radius), |radius| work(radius) >= wanted)
}

/// Σ (2 r + 1)² for r from 1 to `radius`, in its closed form, which fractions fit too.
fn work(radius: f64) -> f64 {
    (radius + 1.0) * (2.0 * radius + 1.0) * (2.0 * radius + 3.0) / 3.0 - 1.0
}

fn bisect(mut low: f64, mut high: f64, reached: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if reached(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

fn printed(quantity: Quantity, card: Card, row: u32) -> f64 {
    let series = printed_series(quantity, card);
    let cell = series.into_iter().find(|&(of, _)| of == row);
    cell.unwrap_or_else(|| panic!("{quantity} is printed for {row}")).1
}

fn geometric_mean(values: impl Iterator<Item = f64>) -> f64 {
    let logarithms: Vec<f64> = values.map(f64::ln).collect();
    #[expect(clippy::cast_precision_loss, reason = "a handful of values")]
    let count = logarithms.len() as f64;
    (logarithms.iter().sum::<f64>() / count).exp()
}

/// A map whose mean radius under [`SEARCH`] is the one wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct MatchingMap {
    /// The map.
    pub map: Image<u32>,
    /// Photons a pixel, on average, as [`synth::map`] takes it.
    pub density: f64,
    /// The mean radius that it has.
    pub mean_radius: f64,
    /// Whether that is within [`TOLERANCE`] of the one wanted.
    pub within_tolerance: bool,
}

/// Draws a map of `size` whose mean radius, and so whose mean number of forward probes, is `mean_radius`.
///
/// More photons from one seed are the same photons and some more, so the mean radius never grows with the
/// density, and halving finds it.
#[must_use]
pub fn matching_map(size: UVec2, mean_radius: f64, seed: u64) -> MatchingMap {
    let drawn = |density: f64| {
        let map = synth::map(KIND, size, density, seed);
        let mean = RadiusSummary::of(&reference::radius_by_table(&map, SEARCH)).mean;
        let within_tolerance = (mean - mean_radius).abs() <= TOLERANCE * mean_radius;
        MatchingMap { map, density, mean_radius: mean, within_tolerance }
    };
    // From nothing within MR to enough in nearly every pixel, in powers of two.
    let (mut thin, mut dense) = (-10.0_f64, 8.0_f64);
    let mut best = drawn(f64::midpoint(thin, dense).exp2());
    for _ in 0..40 {
        if best.within_tolerance {
            break;
        }
        let exponent = best.density.log2();
        if best.mean_radius > mean_radius {
            thin = exponent;
        } else {
            dense = exponent;
        }
        best = drawn(f64::midpoint(thin, dense).exp2());
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_by_hand() {
        // 5 * 0.550 / 0.909 and 5 * 0.294 / 0.275.
        let at_512 = &infer()[3];
        assert_eq!(at_512.size, 512);
        assert!((at_512.estimates[0].by_ratio - 3.0253).abs() < 1e-3);
        assert!((at_512.estimates[1].by_ratio - 5.3455).abs() < 1e-3);
        assert!((at_512.mean_radius - 4.0214).abs() < 1e-3);
        assert!((at_512.by_brute_force - at_512.mean_radius).abs() < 1e-6, "512 is the anchor");
    }

    #[test]
    fn every_best_guess_lies_in_its_span_and_the_cards_disagree() {
        for inference in infer() {
            assert!(inference.low < inference.mean_radius && inference.mean_radius < inference.high);
            assert!(inference.low >= 1.0 && inference.high < 32.0, "{inference:?}");
        }
        assert!(infer()[0].disagreement() > 2.0);
    }

    #[test]
    fn a_planted_line_and_the_closed_form() {
        let (slope, intercept) = line(&[(5.0, 13.0), (6.0, 15.0), (8.0, 19.0)]);
        assert!((slope - 2.0).abs() < 1e-12 && (intercept - 3.0).abs() < 1e-12);
        assert!((work(1.0) - 9.0).abs() < 1e-12 && (work(3.0) - 83.0).abs() < 1e-12);
    }

    #[test]
    fn maps_have_the_mean_radius_that_was_inferred() {
        for inference in &infer()[..2] {
            let made = matching_map(UVec2::splat(inference.size), inference.mean_radius, 7);
            assert!(made.within_tolerance, "{} for {}", made.mean_radius, inference.mean_radius);
            // Counted anew, from the definition itself.
            if inference.size == 64 {
                let mean = RadiusSummary::of(&reference::radius(&made.map, SEARCH)).mean;
                assert!((mean - inference.mean_radius).abs() <= TOLERANCE * inference.mean_radius);
            }
        }
    }
}
