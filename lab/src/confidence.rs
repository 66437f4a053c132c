//! The confidence interval of a mean of few samples: Student's t.

use std::fmt;

use statrs::distribution::{ContinuousCDF as _, StudentsT};

/// The share of intervals that hold the true mean, where samples are independent and normal.
pub const CONFIDENCE_LEVEL: f64 = 0.95;

/// A mean and how far the true one may be from it, with a confidence of 95 % (W. S. Gosset, "The Probable
/// Error of a Mean", 1908): t(0.975, count - 1) standard deviations of the sample over the root of their
/// number.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Confidence {
    /// How many samples.
    pub count: usize,
    /// The arithmetic mean.
    pub mean: f64,
    /// The true mean is less than this away; nothing if there is one sample.
    pub half_width: Option<f64>,
}

impl Confidence {
    /// Summarises independent samples; nothing if there are none.
    ///
    /// A sample that is not finite gives a mean and a half-width that are not finite either.
    #[must_use]
    pub fn of(samples: &[f64]) -> Option<Self> {
        let count = samples.len();
        if count == 0 {
            return None;
        }
        let number = as_number(count);
        let mean = samples.iter().sum::<f64>() / number;
        let half_width = (count > 1).then(|| {
            let variance = samples.iter().map(|sample| (sample - mean).powi(2)).sum::<f64>() / (number - 1.0);
            students_t(number - 1.0) * (variance / number).sqrt()
        });
        Some(Self { count, mean, half_width })
    }

    /// Half the width, 0 for one sample.
    #[must_use]
    pub fn margin(&self) -> f64 {
        self.half_width.unwrap_or(0.0)
    }
}

impl fmt::Display for Confidence {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = formatter.precision().unwrap_or(4);
        write!(formatter, "{:.digits$}", self.mean)?;
        self.half_width.map_or(Ok(()), |half_width| write!(formatter, " ± {half_width:.digits$}"))
    }
}

/// A ratio of errors or times, as the geometric mean of paired samples, and its interval with a confidence of
/// 95 %.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RatioInterval {
    /// How many pairs.
    pub count: usize,
    /// The geometric mean of the ratios.
    pub ratio: f64,
    /// The true ratio is between these two; nothing if there is one pair.
    pub interval: Option<[f64; 2]>,
}

impl RatioInterval {
    /// The ratio of first over second in each pair, both more than 0; nothing if there are no pairs.
    ///
    /// Logarithms are averaged, so that the ratio the other way round is the inverse. A pair with a 0 gives a
    /// ratio of 0, of infinity or NaN.
    #[must_use]
    pub fn of(pairs: &[(f64, f64)]) -> Option<Self> {
        let logarithms: Vec<f64> = pairs.iter().map(|(above, below)| (above / below).ln()).collect();
        let Confidence { count, mean, half_width } = Confidence::of(&logarithms)?;
        let interval = half_width.map(|half_width| [(mean - half_width).exp(), (mean + half_width).exp()]);
        Some(Self { count, ratio: mean.exp(), interval })
    }

    /// Whether the interval is below 1 as a whole: first is surely less than second.
    #[must_use]
    pub fn is_below_one(&self) -> bool {
        self.interval.is_some_and(|[_, high]| high < 1.0)
    }

    /// Whether the interval is above 1 as a whole: first is surely more than second.
    #[must_use]
    pub fn is_above_one(&self) -> bool {
        self.interval.is_some_and(|[low, _]| low > 1.0)
    }
}

impl fmt::Display for RatioInterval {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:.2}", self.ratio)?;
        self.interval.map_or(Ok(()), |[low, high]| write!(formatter, " ({low:.2} to {high:.2})"))
    }
}

/// What a share of 97.5 % of Student's distribution is below, for at least 1 degree of freedom.
pub(crate) fn students_t(freedom: f64) -> f64 {
    let distribution = StudentsT::new(0.0, 1.0, freedom)
        .unwrap_or_else(|error| unreachable!("a scale of 1 and freedom of at least 1: {error}"));
    distribution.inverse_cdf(f64::midpoint(1.0, CONFIDENCE_LEVEL))
}

#[expect(clippy::cast_precision_loss, reason = "far fewer than 2^52 samples")]
fn as_number(count: usize) -> f64 {
    count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn students_t_as_in_printed_tables() {
        for (freedom, printed) in
            [(1.0, 12.706), (2.0, 4.303), (3.0, 3.182), (4.0, 2.776), (9.0, 2.262), (30.0, 2.042)]
        {
            let found = students_t(freedom);
            assert!((found - printed).abs() < 0.0006, "{freedom}: {found}");
        }
        // tan(0.475 π), the closed form of one degree of freedom.
        assert!((students_t(1.0) - (0.475 * std::f64::consts::PI).tan()).abs() < 1e-6);
    }

    #[test]
    fn five_samples_by_hand() {
        // The squares of -2, -1, 0, 1, 2 add up to 10: a variance of 10 / 4, and a half-width of 2.776 √(2.5
        // / 5).
        let Confidence { count, mean, half_width } = Confidence::of(&[3.0, 1.0, 5.0, 2.0, 4.0]).unwrap();
        assert!(count == 5 && (mean - 3.0).abs() < 1e-15);
        assert!((half_width.unwrap() - 2.776_445 * 0.5_f64.sqrt()).abs() < 1e-5, "{half_width:?}");
        assert_eq!(Confidence::of(&[]), None);
        assert_eq!(Confidence::of(&[7.0]), Some(Confidence { count: 1, mean: 7.0, half_width: None }));
        assert_eq!(Confidence::of(&[7.0; 3]).unwrap().half_width, Some(0.0));
    }

    #[test]
    fn a_ratio_by_hand() {
        // Ratios of 1/2 and 1/8: the mean logarithm is ln(1/4), off by ln 2 each, so a half-width of 12.706
        // ln 2.
        let ratio = RatioInterval::of(&[(1.0, 2.0), (2.0, 16.0)]).unwrap();
        assert!((ratio.ratio - 0.25).abs() < 1e-12);
        let [low, high] = ratio.interval.unwrap();
        let half = 12.706_205 * 2.0_f64.ln();
        assert!((low.ln() - (0.25_f64.ln() - half)).abs() < 1e-4, "{low}");
        assert!((high.ln() - (0.25_f64.ln() + half)).abs() < 1e-4, "{high}");
        assert!(!ratio.is_below_one() && !ratio.is_above_one(), "two pairs so far apart do not decide");
        let sure = RatioInterval::of(&[(1.0, 2.0), (1.0, 2.0)]).unwrap();
        assert!(sure.is_below_one() && !sure.is_above_one());
        assert!(RatioInterval::of(&[(2.0, 1.0), (2.1, 1.0)]).unwrap().is_above_one());
        assert_eq!(RatioInterval::of(&[(1.0, 2.0)]).unwrap().interval, None);
    }
}
