//! Maps that are adverse to sums.
//!
//! Unlike `synth`, which draws photon by photon, these draw pixel by pixel: they hold up to 7e10 photons.

use glam::UVec2;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use varikernel::image::Image;

/// Photons in the one bright pixel of [`Shape::Spike`].
const SPIKE: u32 = 1_000_000_000;
/// Side of a square of [`Shape::Checkerboard`], in pixels.
const SQUARE: u32 = 8;
/// The share of the right half's density that the left half of [`Shape::HalfInShadow`] gets.
const SHADOW: f64 = 1.0 / 64.0;

/// How photons lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// Everywhere alike.
    Uniform,
    /// The left half gets 1 for 64 in the right one.
    HalfInShadow,
    /// Everywhere alike, and 10^9 in the first pixel of all sums.
    Spike,
    /// Squares of 8 x 8 pixels, empty ones and ones with twice the density.
    Checkerboard,
    /// All in the middle row.
    OneRow,
    /// All in the corner from which tables sum, an eighth of each side: all sums are large, and most boxes
    /// empty.
    Corner,
}

impl Shape {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Uniform, Self::HalfInShadow, Self::Spike, Self::Checkerboard, Self::OneRow, Self::Corner];

    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::HalfInShadow => "half-in-shadow",
            Self::Spike => "spike",
            Self::Checkerboard => "checkerboard",
            Self::OneRow => "one-row",
            Self::Corner => "corner",
        }
    }

    /// A map of `side` x `side` with `density` photons a pixel on average, beside a spike; the same for the
    /// same seed.
    ///
    /// A pixel whose mean is m gets a whole number between 0 and 2 m, each as likely, rounded up or down by
    /// chance.
    ///
    /// # Panics
    /// If `side` is zero.
    #[must_use]
    pub fn map(self, side: u32, density: f64, seed: u64) -> Image<u32> {
        let mut random = Pcg64::seed_from_u64(seed);
        let corner = side.div_ceil(8);
        let brighter = f64::from(side) / f64::from(corner);
        let mean = |x: u32, y: u32| match self {
            Self::Uniform | Self::Spike => density,
            Self::HalfInShadow if x < side / 2 => density * 2.0 * SHADOW / (1.0 + SHADOW),
            Self::HalfInShadow => density * 2.0 / (1.0 + SHADOW),
            Self::Checkerboard if (x / SQUARE + y / SQUARE).is_multiple_of(2) => 2.0 * density,
            Self::OneRow if y == side / 2 => density * f64::from(side),
            Self::Corner if x.max(y) < corner => density * brighter * brighter,
            Self::Checkerboard | Self::OneRow | Self::Corner => 0.0,
        };
        let mut map = Image::from_fn(UVec2::splat(side), |x, y| {
            let (amount, rounding): (f64, f64) = (random.random(), random.random());
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
            let count = (2.0 * amount * mean(x, y) + rounding) as u32;
            if mean(x, y) > 0.0 { count } else { 0 }
        });
        if self == Self::Spike {
            map.set(0, 0, SPIKE);
        }
        map
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn total(map: &Image<u32>) -> f64 {
        map.values().iter().map(|&count| f64::from(count)).sum()
    }

    #[test]
    fn photons_lie_as_the_shape_says_and_are_as_many_as_the_density_says() {
        for shape in Shape::ALL {
            for density in [0.25, 100.0] {
                let map = shape.map(128, density, 1);
                let spike = if shape == Shape::Spike { f64::from(SPIKE) } else { 0.0 };
                let found = (total(&map) - spike) / (128.0 * 128.0 * density);
                // One row has 128 pixels, each off by 0.58 of its mean: 0.05 in all.
                assert!((found - 1.0).abs() < 0.2, "{shape:?} {density}: {found}");
                assert_eq!(map, shape.map(128, density, 1));
                assert_ne!(map, shape.map(128, density, 2));
            }
        }
        let map = Shape::HalfInShadow.map(64, 1000.0, 1);
        let of = |columns: std::ops::Range<u32>| -> f64 {
            columns.map(|x| (0..64).map(|y| f64::from(map.at(x, y))).sum::<f64>()).sum()
        };
        assert!((of(32..64) / of(0..32) / 64.0 - 1.0).abs() < 0.1);
        let map = Shape::Corner.map(64, 1.0, 1);
        assert!(map.at(7, 7) <= 129 && map.at(8, 0) == 0 && map.at(0, 8) == 0);
        let map = Shape::OneRow.map(64, 1.0, 1);
        assert!((0..64).all(|x| map.at(x, 31) == 0) && total(&map) > 0.0);
        let map = Shape::Checkerboard.map(64, 10.0, 1);
        assert!(map.at(8, 0) == 0 && (0..8).any(|x| map.at(x, 0) > 0));
    }
}
