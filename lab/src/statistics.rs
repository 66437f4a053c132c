//! Many samples in a few numbers.

/// Median, quartiles, mean and range of some times in milliseconds.
///
/// A quartile is the value at the place p (n - 1) of the sorted samples, counted from 0 and interpolated
/// between neighbours: Hyndman and Fan's definition 7, the usual one of NumPy and R.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Statistics {
    /// How many samples.
    pub count: usize,
    /// The smallest.
    pub min_ms: f64,
    /// A quarter of the samples is below.
    pub quartile_1_ms: f64,
    /// Half of the samples is below.
    pub median_ms: f64,
    /// Three quarters of the samples are below.
    pub quartile_3_ms: f64,
    /// The largest.
    pub max_ms: f64,
    /// The arithmetic mean, which the thesis gives.
    pub mean_ms: f64,
}

impl Statistics {
    /// Summarises `samples`; nothing if there are none.
    #[must_use]
    pub fn of(samples: &[f64]) -> Option<Self> {
        let mut sorted = samples.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (&min_ms, &max_ms) = (sorted.first()?, sorted.last()?);
        #[expect(clippy::cast_precision_loss, reason = "far fewer than 2^52 samples")]
        let mean_ms = samples.iter().sum::<f64>() / samples.len() as f64;
        Some(Self {
            count: samples.len(),
            min_ms,
            quartile_1_ms: quantile(&sorted, 1),
            median_ms: quantile(&sorted, 2),
            quartile_3_ms: quantile(&sorted, 3),
            max_ms,
            mean_ms,
        })
    }

    /// The distance between the quartiles, which outliers do not move.
    #[must_use]
    pub fn spread_ms(&self) -> f64 {
        self.quartile_3_ms - self.quartile_1_ms
    }
}

/// The value that `quarters` of four are below.
fn quantile(sorted: &[f64], quarters: usize) -> f64 {
    // The place is `quarters (n - 1) / 4`, whole part and rest apart, so that whole places are exact.
    let place = quarters * (sorted.len() - 1);
    let (below, rest) = (place / 4, place % 4);
    let above = (below + 1).min(sorted.len() - 1);
    #[expect(clippy::cast_precision_loss, reason = "0 to 3")]
    let share = rest as f64 / 4.0;
    sorted[below] + share * (sorted[above] - sorted[below])
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the answers are exact in binary")]
mod tests {
    use super::*;

    #[test]
    fn five_samples_by_hand() {
        let statistics = Statistics::of(&[9.0, 1.0, 3.0, 2.0, 5.0]).unwrap();
        assert_eq!(
            statistics,
            Statistics {
                count: 5,
                min_ms: 1.0,
                quartile_1_ms: 2.0,
                median_ms: 3.0,
                quartile_3_ms: 5.0,
                max_ms: 9.0,
                mean_ms: 4.0
            }
        );
        assert_eq!(statistics.spread_ms(), 3.0);
    }

    #[test]
    fn four_samples_are_interpolated() {
        // Places 0.75, 1.5 and 2.25 of 1, 2, 4, 8.
        let Statistics { quartile_1_ms, median_ms, quartile_3_ms, mean_ms, .. } =
            Statistics::of(&[8.0, 4.0, 2.0, 1.0]).unwrap();
        assert_eq!((quartile_1_ms, median_ms, quartile_3_ms, mean_ms), (1.75, 3.0, 5.0, 3.75));
    }

    #[test]
    fn one_sample_is_all_and_none_is_nothing() {
        let one = Statistics::of(&[7.0]).unwrap();
        assert_eq!((one.min_ms, one.quartile_1_ms, one.median_ms, one.max_ms), (7.0, 7.0, 7.0, 7.0));
        assert_eq!(one.spread_ms(), 0.0);
        assert_eq!(Statistics::of(&[]), None);
    }
}
