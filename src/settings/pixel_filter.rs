//! How a pixel weighs the light around its middle.

use std::f64::consts::TAU;

/// The weight of light by its distance from the middle of a pixel, along rows and columns alike.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum PixelFilter {
    /// All light of the pixel's square alike.
    #[default]
    Box,
    /// A bell of two pixels to each side (F. Harris, "On the use of windows for harmonic analysis with the
    /// discrete Fourier transform", 1978; four terms).
    BlackmanHarris,
    /// A bell of two pixels to each side that is a little negative at its ends, which keeps edges crisp (D.
    /// Mitchell, A. Netravali, "Reconstruction filters in computer graphics", 1988; B = C = 1/3).
    Mitchell,
}

impl PixelFilter {
    /// Pixels to each side of the middle that it reaches.
    #[must_use]
    pub fn reach(self) -> f64 {
        match self {
            Self::Box => 0.5,
            Self::BlackmanHarris | Self::Mitchell => 2.0,
        }
    }

    /// The weight at a distance from the middle in pixels, along one axis; 0 beyond its reach.
    #[must_use]
    pub fn weight(self, distance: f64) -> f64 {
        let x = distance.abs();
        if x > self.reach() {
            return 0.0;
        }
        match self {
            Self::Box => 1.0,
            Self::BlackmanHarris => {
                let cosine = |times: f64| (times * TAU * (x / 4.0 + 0.5)).cos();
                0.35875 - 0.48829 * cosine(1.0) + 0.14128 * cosine(2.0) - 0.01168 * cosine(3.0)
            }
            Self::Mitchell if x < 1.0 => (7.0 * x.powi(3) - 12.0 * x.powi(2) + 16.0 / 3.0) / 6.0,
            Self::Mitchell => (-7.0 / 3.0 * x.powi(3) + 12.0 * x.powi(2) - 20.0 * x + 32.0 / 3.0) / 6.0,
        }
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "where nothing is rounded")]
mod tests {
    use super::*;

    #[test]
    fn weights_are_those_of_the_papers_and_go_to_nothing_at_their_ends() {
        assert_eq!([0.0, 0.5, 0.51].map(|x| PixelFilter::Box.weight(x)), [1.0, 1.0, 0.0]);
        for (filter, middle, at_one) in
            [(PixelFilter::BlackmanHarris, 1.0, 0.21747), (PixelFilter::Mitchell, 8.0 / 9.0, 1.0 / 18.0)]
        {
            assert!((filter.weight(0.0) - middle).abs() < 1e-12, "{filter:?}");
            assert!((filter.weight(1.0) - at_one).abs() < 1e-12, "{filter:?} {}", filter.weight(1.0));
            assert!((filter.weight(1.0 - 1e-9) - filter.weight(1.0)).abs() < 1e-8);
            assert!(filter.weight(2.0).abs() < 1e-4 && filter.weight(2.1) == 0.0);
            assert_eq!(filter.weight(-0.7), filter.weight(0.7));
        }
        assert!(PixelFilter::Mitchell.weight(1.4) < 0.0);
    }
}
