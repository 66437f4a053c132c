//! A way's errors over its times, and those of two ways at one time or one error.

use serde::{Deserialize, Serialize};

use super::regions::Region;
use super::{Picture, Point};
use crate::confidence::students_t;

/// A ratio, with the interval that holds the true one with a confidence of 95 %, by the seeds; nothing if they
/// are too few.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Factor {
    /// The ratio.
    pub ratio: f64,
    /// Its interval.
    pub interval: Option<[f64; 2]>,
}

impl std::fmt::Display for Factor {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{:.2}", self.ratio)?;
        self.interval.map_or(Ok(()), |[low, high]| write!(formatter, " ({low:.2} to {high:.2})"))
    }
}

/// A point of another way against the curve of the first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Of which pixels.
    pub region: Region,
    /// The point's error over that of the first way in the same time: above 1, the first is ahead. Nothing where
    /// the first has no point before or none after.
    pub equal_time: Option<Factor>,
    /// The point's time over that in which the first has the same error. Nothing where it never has.
    pub equal_error: Option<Factor>,
}

/// The logarithm of an error: its mean over seeds, and how sure that is.
#[derive(Clone, Copy, Debug)]
struct Logarithm {
    mean: f64,
    /// The square of the standard error, and its degrees of freedom; nothing of one seed.
    spread: Option<(f64, f64)>,
}

impl Logarithm {
    fn of(pictures: &[Picture], region: Region) -> Option<Self> {
        let errors: Vec<f64> = pictures.iter().map(|picture| picture.rmse(region)).collect::<Option<_>>()?;
        let logarithms: Vec<f64> = errors.iter().map(|error| error.ln()).collect();
        #[expect(clippy::cast_precision_loss, reason = "a few seeds")]
        let count = logarithms.len() as f64;
        let mean = logarithms.iter().sum::<f64>() / count;
        if !mean.is_finite() {
            return None;
        }
        let squares: f64 = logarithms.iter().map(|value| (value - mean).powi(2)).sum();
        let spread = (count > 1.0).then(|| (squares / (count - 1.0) / count, count - 1.0));
        Some(Self { mean, spread })
    }

    /// `share` of another and the rest of this, or with shares of 1 and -1 a difference.
    fn sum(parts: [(f64, Self); 2]) -> Self {
        let mean = parts.iter().map(|(share, of)| share * of.mean).sum();
        // Satterthwaite's degrees of freedom.
        let spreads: Option<Vec<(f64, f64)>> = parts
            .iter()
            .map(|(share, of)| of.spread.map(|(square, freedom)| (share * share * square, freedom)))
            .collect();
        let spread = spreads.map(|spreads| {
            let square: f64 = spreads.iter().map(|(square, _)| square).sum();
            let parts: f64 = spreads
                .iter()
                .map(|(part, freedom)| (part / square.max(f64::MIN_POSITIVE)).powi(2) / freedom)
                .sum();
            (square, if parts > 0.0 { 1.0 / parts } else { f64::INFINITY })
        });
        Self { mean, spread }
    }

    fn half_width(&self) -> Option<f64> {
        self.spread.map(
            |(square, freedom)| {
                if square > 0.0 { students_t(freedom.max(1.0)) * square.sqrt() } else { 0.0 }
            },
        )
    }
}

/// Compares a point with the curve of the first way, whose points are by increasing time.
pub(super) fn compare(point: &Point, first: &[Point], region: Region) -> Option<Comparison> {
    let own = Logarithm::of(&point.pictures, region)?;
    let mut curve = Vec::new();
    for other in first {
        curve.push((other.seconds.ln(), Logarithm::of(&other.pictures, region)?));
    }
    let time = point.seconds.ln();
    let equal_time = at_time(&curve, time).map(|other| {
        let ratio = Logarithm::sum([(1.0, own), (-1.0, other)]);
        let around = |half_width: f64| [ratio.mean - half_width, ratio.mean + half_width].map(f64::exp);
        Factor { ratio: ratio.mean.exp(), interval: ratio.half_width().map(around) }
    });
    let equal_error = at_error(&curve, own.mean).map(|(at, other)| {
        let ratio = |at: f64| (time - at).exp();
        let half_width = Logarithm::sum([(1.0, own), (-1.0, other)]).half_width();
        let interval = half_width.and_then(|half_width| {
            let [low, high] = [half_width, -half_width].map(|more| at_error(&curve, own.mean + more));
            // A larger error is reached sooner.
            Some([ratio(high?.0), ratio(low?.0)])
        });
        Factor { ratio: ratio(at), interval }
    });
    Some(Comparison { region, equal_time, equal_error })
}

/// The curve at a time within it, straight in logarithms between its points.
fn at_time(curve: &[(f64, Logarithm)], time: f64) -> Option<Logarithm> {
    let exact = curve.iter().find(|(at, _)| at.total_cmp(&time).is_eq());
    exact.map(|&(_, error)| error).or_else(|| {
        let pair = curve.windows(2).find(|pair| pair[0].0 <= time && time <= pair[1].0)?;
        let share = (time - pair[0].0) / (pair[1].0 - pair[0].0);
        Some(Logarithm::sum([(1.0 - share, pair[0].1), (share, pair[1].1)]))
    })
}

/// When the curve first comes down to an error, and what it is there.
fn at_error(curve: &[(f64, Logarithm)], error: f64) -> Option<(f64, Logarithm)> {
    let exact = curve.iter().find(|(_, at)| at.mean.total_cmp(&error).is_eq());
    exact.copied().or_else(|| {
        let pair = curve.windows(2).find(|pair| pair[0].1.mean >= error && error >= pair[1].1.mean)?;
        let share = (pair[0].1.mean - error) / (pair[0].1.mean - pair[1].1.mean);
        let at = pair[0].0 + share * (pair[1].0 - pair[0].0);
        Some((at, Logarithm::sum([(1.0 - share, pair[0].1), (share, pair[1].1)])))
    })
}

#[cfg(test)]
mod tests {
    use super::super::error::RegionError;
    use super::*;

    fn point(seconds: f64, errors: &[f64]) -> Point {
        let picture = |(&rmse, seed): (&f64, i32)| Picture {
            seed: seed.to_string(),
            seconds,
            errors: vec![RegionError { region: Region::Whole, pixels: 9, rmse, median: rmse, bias: 0.0 }],
        };
        Point { options: String::new(), seconds, pictures: errors.iter().zip(0..).map(picture).collect() }
    }

    fn whole(point: &Point, first: &[Point]) -> Comparison {
        compare(point, first, Region::Whole).unwrap()
    }

    #[test]
    fn equal_time_and_equal_error_by_hand() {
        // Error falls with the root of time: 0.4 at 1 s, 0.1 at 16 s, 0.2 at 4 s.
        let first = [point(1.0, &[0.4]), point(16.0, &[0.1])];
        let found = whole(&point(4.0, &[0.3]), &first);
        assert!((found.equal_time.unwrap().ratio - 1.5).abs() < 1e-12);
        // 0.3 is reached after 16/9 s.
        assert!((found.equal_error.unwrap().ratio - 4.0 * 9.0 / 16.0).abs() < 1e-12);
        assert_eq!(found.equal_time.unwrap().interval, None, "one seed has no interval");
    }

    #[test]
    fn beyond_the_first_ways_curve_nothing_is_made_up() {
        let first = [point(1.0, &[0.4]), point(16.0, &[0.1])];
        let early = whole(&point(0.5, &[0.2]), &first);
        assert!(early.equal_time.is_none() && early.equal_error.is_some());
        let late = whole(&point(99.0, &[0.05]), &first);
        assert!(late.equal_time.is_none() && late.equal_error.is_none());
        let alone = whole(&point(1.0, &[0.8]), &first[..1]);
        assert!((alone.equal_time.unwrap().ratio - 2.0).abs() < 1e-12 && alone.equal_error.is_none());
        assert_eq!(compare(&point(1.0, &[0.0]), &first, Region::Whole), None, "no logarithm of 0");
        assert_eq!(compare(&point(1.0, &[0.1]), &first, Region::Edges), None, "there is no such region");
    }

    #[test]
    fn intervals_are_those_of_welch() {
        let (a, b) = ([0.1_f64, 0.2, 0.4], [0.3_f64, 0.3, 0.6, 0.9]);
        let found = whole(&point(2.0, &b), &[point(2.0, &a)]).equal_time.unwrap();
        let logarithms = |errors: &[f64]| errors.iter().map(|error| error.ln()).collect::<Vec<_>>();
        let test = crate::welch::Welch::test(&logarithms(&b), &logarithms(&a)).unwrap();
        let half_width = students_t(test.freedom) * test.error;
        let [low, high] = found.interval.unwrap();
        assert!((found.ratio.ln() - test.difference).abs() < 1e-12);
        assert!((low.ln() - (test.difference - half_width)).abs() < 1e-9);
        assert!((high.ln() - (test.difference + half_width)).abs() < 1e-9);
    }
}
