//! Densities whose truth is known: how many photons each pixel expects.

use glam::{DVec2, UVec2};
use rand::SeedableRng as _;
use rand_distr::{Distribution as _, Poisson};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use varikernel::image::Image;

/// How bright the bright part of a step, a disc or a line is against the rest.
const CONTRAST: f64 = 8.0;
/// Radius of the disc, in sides of the map.
const DISC: f64 = 0.25;
/// Columns of the line.
const LINE: u32 = 3;

/// A density over a square map, by what an estimate can get wrong about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// The same everywhere: noise alone.
    Uniform,
    /// From none at the left to twice the mean at the right: straight, which symmetric kernels do not blur.
    Ramp,
    /// Dim at the left, eight times as bright at the right: a shadow's edge.
    Step,
    /// A disc of half the map's width, eight times as bright as what is around it: a caustic's spot.
    Disc,
    /// Three columns in the middle, eight times as bright as the rest: a caustic's line.
    Line,
}

impl Shape {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Uniform, Self::Ramp, Self::Step, Self::Disc, Self::Line];

    /// Its name in tables and files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Ramp => "ramp",
            Self::Step => "step",
            Self::Disc => "disc",
            Self::Line => "line",
        }
    }

    /// The photons that each pixel of a map of `side` columns and rows expects, `mean` on the average.
    ///
    /// A pixel is bright or dim as its middle is: the truth is this map, not the curve through it.
    #[must_use]
    pub fn expected(self, side: u32, mean: f64) -> Image<f64> {
        let middle = f64::from(side) / 2.0;
        let weights = Image::from_fn(UVec2::splat(side), |x, y| {
            let is_bright = match self {
                Self::Uniform => return 1.0,
                Self::Ramp => return f64::from(x) + 0.5,
                Self::Step => f64::from(x) + 0.5 > middle,
                Self::Disc => {
                    let away = UVec2::new(x, y).as_dvec2() + 0.5 - DVec2::splat(middle);
                    away.length() < DISC * f64::from(side)
                }
                Self::Line => (side / 2 - LINE / 2..side / 2 - LINE / 2 + LINE).contains(&x),
            };
            if is_bright { CONTRAST } else { 1.0 }
        });
        let sum: f64 = weights.values().iter().sum();
        let scale = mean * f64::from(side) * f64::from(side) / sum;
        weights.map(|weight| scale * weight)
    }
}

/// Photons as they fall by chance: each pixel's count is a Poisson variable, independent of all others.
///
/// # Panics
/// If a pixel expects a number that is negative, not finite or past 10^9.
#[must_use]
pub fn sample(expected: &Image<f64>, seed: u64) -> Image<u32> {
    let mut random = Pcg64::seed_from_u64(seed);
    let counts = expected.values().iter().map(|&expected| {
        assert!((0.0..=1e9).contains(&expected), "{expected} photons expected");
        if expected == 0.0 {
            return 0;
        }
        let poisson = Poisson::new(expected).expect("a positive number");
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count far below 2^32")]
        let count = poisson.sample(&mut random) as u32;
        count
    });
    Image::from_values(expected.size(), counts.collect())
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "equal pixels are computed alike")]
mod tests {
    use super::*;

    #[test]
    fn densities_by_hand() {
        let row = |shape: Shape| shape.expected(8, 4.5).values()[..8].to_vec();
        assert_eq!(row(Shape::Uniform), [4.5; 8]);
        // Middles at 0.5 to 7.5, 4 on the average.
        assert_eq!(row(Shape::Ramp)[..2], [0.5625, 1.6875]);
        // Half the pixels at 1, half at 8: 4.5 on the average.
        assert_eq!(row(Shape::Step), [1.0, 1.0, 1.0, 1.0, 8.0, 8.0, 8.0, 8.0]);
        // Columns 3, 4 and 5 of 8: (5 + 24) / 8 on the average.
        let line = row(Shape::Line);
        assert_eq!(line.iter().filter(|&&value| value == line[4]).count(), 3);
        assert!((line[4] / line[0] - 8.0).abs() < 1e-12 && line[2] == line[0] && line[6] == line[0]);
        // A radius of 2 pixels around (4, 4): the four middle ones and two beside each side of them.
        let disc = Shape::Disc.expected(8, 4.5);
        let bright = disc.values().iter().filter(|&&value| value == disc.at(4, 4)).count();
        assert_eq!(bright, 12);
        for shape in Shape::ALL {
            let sum: f64 = shape.expected(8, 4.5).values().iter().sum();
            assert!((sum / 64.0 - 4.5).abs() < 1e-12, "{}", shape.name());
        }
    }

    #[test]
    fn counts_have_the_mean_and_the_variance_of_poisson_and_their_seed() {
        let expected = Image::filled(UVec2::splat(100), 3.0);
        let counts = sample(&expected, 7);
        let values = || counts.values().iter().map(|&count| f64::from(count));
        let mean = values().sum::<f64>() / 1e4;
        let variance = values().map(|value| (value - mean).powi(2)).sum::<f64>() / 1e4;
        // The mean of 10^4 counts has a deviation of √3 / 100, the variance one of √(3 + 2 · 9) / 100.
        assert!((mean - 3.0).abs() < 4.0 * 0.01732, "{mean}");
        assert!((variance - 3.0).abs() < 4.0 * 0.0458, "{variance}");
        assert_eq!(sample(&expected, 7), counts);
        assert_ne!(sample(&expected, 8), counts);
        assert_eq!(sample(&Image::filled(UVec2::ONE, 0.0), 1).values(), [0]);
    }
}
