//! Where values stand along an axis, and which are labelled.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;

/// How values are laid out.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Scale {
    /// From 0 on, or from the least value if that is negative.
    Linear,
    /// Logarithmic, with labels at round numbers.
    Logarithmic,
    /// Logarithmic, with labels at these values.
    LogarithmicAt(Vec<f64>),
}

/// Values laid out along an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layout {
    logarithmic: bool,
    labels: Vec<f64>,
    range: Range<f64>,
    /// Where 0 stands on a logarithmic axis, if a value is 0.
    zero: Option<f64>,
}

/// Values beyond, which only a damaged file of results holds, are drawn at the end of an axis; so are those
/// below one part of it, so that every axis is finite.
const LARGEST: f64 = 1e100;

impl Layout {
    /// An axis for `values` that goes past them by a factor of `margin`.
    pub(super) fn of(scale: &Scale, values: impl Iterator<Item = f64>, margin: f64) -> Self {
        let values: Vec<f64> = values.map(|value| value.clamp(-LARGEST, LARGEST)).collect();
        let most = values.iter().copied().fold(0.0, f64::max);
        if *scale == Scale::Linear {
            let least = values.iter().copied().fold(0.0, f64::min);
            let most = if most > least { most } else { least + 1.0 };
            // A tenth on each side that has values.
            let beyond = 0.1 * (most - least);
            let range = (if least < 0.0 { least - beyond } else { 0.0 })..most + beyond;
            return Self { logarithmic: false, labels: Vec::new(), range, zero: None };
        }
        let least = values.iter().copied().filter(|value| *value > 0.0).fold(f64::INFINITY, f64::min);
        let (least, most) = if least.is_finite() { (least, most) } else { (1.0, 1.0) };
        let (least, most) = (least.max(1.0 / LARGEST), most.max(1.0 / LARGEST));
        let mut range = least / margin..most * margin;
        let zero = values.contains(&0.0).then(|| {
            // A twelfth of the axis below all others.
            range.start / (range.end / range.start).powf(1.0 / 12.0).max(margin)
        });
        if let Some(zero) = zero {
            range.start = zero / margin.sqrt();
        }
        let mut labels = match scale {
            Scale::LogarithmicAt(labels) => labels.clone(),
            _ => decades(&(least / margin..range.end)),
        };
        labels.extend(zero);
        Self { logarithmic: true, labels, range, zero }
    }

    /// The value that stands where this one belongs: 0 has a place of its own.
    pub(super) fn shown(&self, value: f64) -> f64 {
        match self.zero {
            Some(zero) if value <= 0.0 => zero,
            _ if self.logarithmic => value.max(self.range.start),
            _ => value,
        }
    }

    pub(super) fn label(&self, value: f64) -> String {
        if self.zero == Some(value) { "0".to_owned() } else { number(value) }
    }
}

impl Ranged for Layout {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    #[expect(clippy::cast_possible_truncation, reason = "a place in a picture")]
    fn map(&self, value: &f64, (low, high): (i32, i32)) -> i32 {
        let Range { start, end } = self.range;
        let share = if self.logarithmic {
            (value / start).ln() / (end / start).ln()
        } else {
            (value - start) / (end - start)
        };
        // Far outside of the picture, but still finite.
        (f64::from(low) + f64::from(high - low) * share.clamp(-100.0, 100.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if self.logarithmic {
            return self.labels.iter().copied().filter(|value| self.range.contains(value)).collect();
        }
        RangedCoordf64::from(self.range.clone()).key_points(hint)
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

/// 1, 2, 5 times the powers of ten in `range`; only the powers where that would be crowded.
fn decades(range: &Range<f64>) -> Vec<f64> {
    let wide = range.end / range.start > 200.0;
    #[expect(clippy::cast_possible_truncation, reason = "values are far from the limits of i32")]
    let (low, high) = (range.start.log10().floor() as i32, range.end.log10().ceil() as i32);
    (low..=high)
        .flat_map(|power| {
            if wide { vec![1.0] } else { vec![1.0, 2.0, 5.0] }
                .into_iter()
                .map(move |of| of * 10_f64.powi(power))
        })
        .filter(|value| range.contains(value))
        .collect()
}

fn number(value: f64) -> String {
    // Ten digits hide the rounding of binary fractions.
    let text = format!("{value:.10}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_nobody_measured_have_an_axis_with_an_end() {
        let values = [5e-324, 1e308, -1e308, 0.0, 1.0];
        for scale in [Scale::Linear, Scale::Logarithmic] {
            let layout = Layout::of(&scale, values.into_iter(), 1.5);
            assert!(layout.range.start.is_finite() && layout.range.end.is_finite(), "{layout:?}");
            assert!(layout.labels.len() < 1000, "{} labels", layout.labels.len());
            for value in values {
                let place = layout.map(&layout.shown(value), (0, 500));
                assert!((-500_000..500_000).contains(&place), "{value} is at {place}");
            }
        }
    }

    #[test]
    fn labels_are_round() {
        assert_eq!(decades(&(0.03..3.0)), [0.05, 0.1, 0.2, 0.5, 1.0, 2.0]);
        assert_eq!(decades(&(0.5..5000.0)), [1.0, 10.0, 100.0, 1000.0]);
        assert_eq!([0.05, 1.0, 1024.0].map(number), ["0.05", "1", "1024"]);
    }

    #[test]
    fn zero_has_a_place_below_all_others_on_a_logarithmic_axis() {
        let place = Layout::of(&Scale::Logarithmic, [0.0, 1.0, 10.0].into_iter(), 1.5);
        let zero = place.zero.unwrap();
        assert!(zero < 1.0 / 1.5 && place.range.contains(&zero));
        assert_eq!(place.label(zero), "0");
        assert_eq!((place.shown(0.0), place.shown(-1.0), place.shown(2.0)), (zero, zero, 2.0));
        assert_eq!(Layout::of(&Scale::Logarithmic, [1.0, 10.0].into_iter(), 1.5).zero, None);
    }

    #[test]
    fn values_are_laid_out_by_their_logarithm_or_as_they_are() {
        let place = Layout { logarithmic: true, labels: vec![], range: 1.0..100.0, zero: None };
        assert_eq!([1.0, 10.0, 100.0].map(|value| place.map(&value, (0, 200))), [0, 100, 200]);
        let place = Layout { logarithmic: false, ..place };
        assert_eq!([1.0, 50.5, 100.0].map(|value| place.map(&value, (0, 200))), [0, 100, 200]);
        let place = Layout::of(&Scale::Linear, [-1.0, 1.0].into_iter(), 1.5);
        assert!(place.range.contains(&-1.0) && place.range.contains(&1.0));
    }
}
