//! A radius map in a few numbers.

use varikernel::image::Image;
use varikernel::reference::Radii;

/// Distribution of the radii, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct RadiusSummary {
    /// The smallest radius.
    pub min: u32,
    /// The mean radius.
    pub mean: f64,
    /// The median radius; for an even number of pixels, the mean of the middle two.
    pub median: f64,
    /// The largest radius.
    pub max: u32,
    /// The share of pixels, 0 to 1, that found too few photons within MR.
    pub limited_share: f64,
}

impl RadiusSummary {
    /// Summarises all pixels.
    #[must_use]
    pub fn of(radii: &Radii) -> Self {
        let mut sorted = radii.radius.values().to_vec();
        sorted.sort_unstable();
        let middle = sorted.len() / 2;
        let median = if sorted.len() % 2 == 1 {
            f64::from(sorted[middle])
        } else {
            f64::midpoint(f64::from(sorted[middle - 1]), f64::from(sorted[middle]))
        };
        Self {
            min: sorted[0],
            mean: mean(sorted.iter().map(|&radius| u64::from(radius)), sorted.len()),
            median,
            max: sorted[sorted.len() - 1],
            limited_share: mean(
                radii.limited.values().iter().map(|&limited| u64::from(limited)),
                sorted.len(),
            ),
        }
    }
}

/// All photons of a density map.
#[must_use]
pub fn total_photons(density: &Image<u32>) -> u64 {
    density.values().iter().map(|&count| u64::from(count)).sum()
}

#[expect(clippy::cast_precision_loss, reason = "a mean is rounded anyway")]
fn mean(values: impl Iterator<Item = u64>, count: usize) -> f64 {
    values.sum::<u64>() as f64 / count as f64
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    fn radii(radius: Vec<u32>, limited: Vec<u8>) -> Radii {
        let size = UVec2::new(u32::try_from(radius.len()).unwrap(), 1);
        Radii { radius: Image::from_values(size, radius), limited: Image::from_values(size, limited) }
    }

    #[test]
    fn even_and_odd_numbers_of_pixels_by_hand() {
        let even = RadiusSummary::of(&radii(vec![8, 1, 2, 1], vec![1, 0, 0, 0]));
        assert_eq!(even, RadiusSummary { min: 1, mean: 3.0, median: 1.5, max: 8, limited_share: 0.25 });
        let odd = RadiusSummary::of(&radii(vec![7, 3, 5], vec![0, 0, 0]));
        assert_eq!(odd, RadiusSummary { min: 3, mean: 5.0, median: 5.0, max: 7, limited_share: 0.0 });
    }
}
