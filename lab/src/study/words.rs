//! The conclusions of a study, in sentences.

use super::density::{DensityRow, Width};
use super::pictures::{EqualPhotons, EqualTime, Metric, Winner};
use super::shape::Shape;
use crate::confidence::{Confidence, RatioInterval};
use varikernel::settings::PictureSettings;

/// A measure, its name, and its place among the errors of a seed.
type Measure = (&'static str, fn(&DensityRow) -> Confidence, usize);
/// The measures by which estimates are compared.
const MEASURES: [Measure; 2] = [("RMSE", |row| row.rmse, 0), ("relative RMSE", |row| row.relative_rmse, 1)];

/// The best of some rows by a measure, and whether it is the last of them.
fn best<'a>(
    rows: impl DoubleEndedIterator<Item = &'a DensityRow> + Clone,
    measure: fn(&DensityRow) -> Confidence,
) -> Option<(&'a DensityRow, bool)> {
    let best = rows.clone().min_by(|a, b| measure(a).mean.total_cmp(&measure(b).mean))?;
    Some((best, best.width == rows.last()?.width))
}

/// The ratio of the errors of each seed.
fn ratio(one: &DensityRow, other: &DensityRow, place: usize) -> Option<RatioInterval> {
    let pairs: Vec<(f64, f64)> =
        one.of_seeds.iter().zip(&other.of_seeds).map(|(a, b)| (a[place], b[place])).collect();
    RatioInterval::of(&pairs)
}

/// For each shape: which n and which fixed radius are best, and which of both, by both measures.
pub(super) fn density(rows: &[DensityRow]) -> Vec<String> {
    let mut words = Vec::new();
    for shape in Shape::ALL {
        for (name, measure, place) in MEASURES {
            let of_shape = || rows.iter().filter(|row| row.shape == shape);
            let growing = best(of_shape().filter(|row| row.width.is_growing()), measure);
            let fixed = best(of_shape().filter(|row| row.width.is_fixed()), measure);
            let (Some((variable, widest_variable)), Some((fixed, widest_fixed))) = (growing, fixed) else {
                continue;
            };
            let Some(ratio) = ratio(variable, fixed, place) else { continue };
            let verdict = match Winner::by(&ratio) {
                Winner::Variable => "variable wins",
                Winner::Fixed => "fixed wins",
                Winner::Undecided => "level",
            };
            let told = |row: &DensityRow, at_end| {
                let end = if at_end { ", the widest tried" } else { "" };
                format!("{} ({}{end})", measure(row), width(row))
            };
            words.push(format!(
                "{}, {name}: {} of the best variable estimate, {} of the best fixed one: {verdict}.",
                shape.name(),
                told(variable, widest_variable),
                told(fixed, widest_fixed),
            ));
        }
    }
    words
}

/// For each shape: the error by the rule of even density, for which nothing is chosen, over those of the best
/// n and of the best fixed radius.
pub(super) fn even(rows: &[DensityRow]) -> Vec<String> {
    let (name, measure, place) = MEASURES[0];
    let of_shape = |shape| {
        let rows = || rows.iter().filter(move |row| row.shape == shape);
        let even = rows().find(|row| row.width == Width::Even)?;
        let (growing, _) = best(rows().filter(|row| row.width.is_growing()), measure)?;
        let (fixed, _) = best(rows().filter(|row| row.width.is_fixed()), measure)?;
        Some(format!(
            "{}, {name}: {} by the rule even, without any choice: {} of the best variable estimate ({}) and \
             {} of the best fixed one ({}).",
            shape.name(),
            measure(even),
            ratio(even, growing, place)?,
            width(growing),
            ratio(even, fixed, place)?,
            width(fixed),
        ))
    };
    Shape::ALL.into_iter().filter_map(of_shape).collect()
}

/// What c - 1 in place of c does to the mean of the uniform density, for the smallest and the largest n.
pub(super) fn stopping_rule(rows: &[DensityRow]) -> Vec<String> {
    let uniform = |corrected| {
        rows.iter().filter(move |row| row.shape == Shape::Uniform && row.corrected == corrected).filter_map(
            |row| match row.width {
                Width::Holding(n) => Some((n, row.mean_error)),
                Width::Fixed(_) | Width::Even => None,
            },
        )
    };
    let with_both = uniform(false).filter_map(|(n, plain)| {
        let (_, corrected) = uniform(true).find(|(other, _)| *other == n)?;
        Some((n, plain, corrected))
    });
    let all: Vec<_> = with_both.collect();
    let ends = [all.first(), all.last()];
    let mut words: Vec<String> = Vec::new();
    for (n, plain, corrected) in ends.into_iter().flatten() {
        let percent = |value: f64| format!("{:+.2} %", 100.0 * value);
        words.push(format!(
            "n = {n}: the count c puts {} into a uniform density, c - 1 puts {}.",
            percent(plain.mean),
            percent(corrected.mean)
        ));
    }
    words.dedup();
    words
}

/// A box, to show.
pub(super) fn width(row: &DensityRow) -> String {
    match (row.width, row.corrected) {
        (Width::Holding(n), false) => format!("n = {n}"),
        (Width::Holding(n), true) => format!("n = {n}, c - 1"),
        (Width::Fixed(radius), _) => format!("radius {radius}"),
        (Width::Even, _) => "even".to_owned(),
    }
}

/// Who wins how often, for equal photons and in equal time.
pub(super) fn pictures(equal_photons: &[EqualPhotons], equal_time: &[EqualTime]) -> Vec<String> {
    if equal_photons.is_empty() {
        return Vec::new();
    }
    let n = PictureSettings::default().min_photons;
    let mut words = Vec::new();
    for metric in Metric::ALL {
        let of_metric = || equal_photons.iter().filter(|one| one.metric == metric);
        let best = count(of_metric().map(|one| one.best.winner));
        let default = count(of_metric().filter_map(|one| Some(one.default?.winner)));
        let of_time = equal_time.iter().filter(|one| one.metric == metric);
        let budgets = count(of_time.filter_map(|one| Some(one.budgets.last()?.winner)));
        words.push(format!(
            "Pictures, {}: for equal photons, variable radii beat the best fixed one {} with the best n and \
             {} with n = {n}; in the longest time that both reach, {}.",
            metric.name(),
            best,
            default,
            budgets,
        ));
        let over = |ratio: fn(&EqualPhotons) -> Option<f64>| geometric_mean(of_metric().filter_map(ratio));
        let over_fixed = over(|one| Some(one.tables?.ratio.ratio));
        let over_default = over(|one| Some(one.tables_over_default?.ratio));
        if let (Some(over_fixed), Some(over_default)) = (over_fixed, over_default) {
            words.push(format!(
                "Light from tables, {}: {over_fixed:.2} of the error of the best fixed radius and \
                 {over_default:.2} of that with n = {n}, geometric means over scenes and photons; it beats the \
                 best fixed radius {}.",
                metric.name(),
                count(of_metric().filter_map(|one| Some(one.tables?.winner))),
            ));
        }
    }
    words
}

fn geometric_mean(ratios: impl Iterator<Item = f64>) -> Option<f64> {
    let logarithms: Vec<f64> = ratios.map(f64::ln).collect();
    Some(Confidence::of(&logarithms)?.mean.exp())
}

/// "in 3 of 15 cases (4 undecided)".
fn count(winners: impl Iterator<Item = Winner>) -> String {
    let (mut variable, mut undecided, mut all) = (0, 0, 0);
    for winner in winners {
        variable += u32::from(winner == Winner::Variable);
        undecided += u32::from(winner == Winner::Undecided);
        all += 1;
    }
    match undecided {
        0 => format!("in {variable} of {all} cases"),
        some => format!("in {variable} of {all} cases ({some} undecided)"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(mean: f64, half_width: f64) -> Confidence {
        Confidence { count: 4, mean, half_width: Some(half_width) }
    }

    #[test]
    fn winners_are_counted() {
        let winners = [Winner::Variable, Winner::Fixed, Winner::Variable];
        assert_eq!(count(winners.into_iter()), "in 2 of 3 cases");
        assert_eq!(count([Winner::Undecided, Winner::Fixed].into_iter()), "in 0 of 2 cases (1 undecided)");
        assert_eq!(pictures(&[], &[]), [""; 0]);
    }

    fn row(width: Width, corrected: bool, rmse: f64, mean_error: f64) -> DensityRow {
        DensityRow {
            shape: Shape::Uniform,
            width,
            corrected,
            seeds: 4,
            mean_radius: 1.0,
            mean_error: around(mean_error, 0.001),
            bias: 0.0,
            noise: rmse,
            rmse: around(rmse, 0.01),
            relative_rmse: around(2.0 * rmse, 0.3),
            of_seeds: vec![[rmse - 0.001, 2.0 * rmse - 0.3], [rmse + 0.001, 2.0 * rmse + 0.3]],
        }
    }

    #[test]
    fn the_best_of_both_kinds_are_named() {
        let mut rows = vec![
            row(Width::Holding(10), false, 0.3, 0.02),
            row(Width::Holding(10), true, 0.2, -0.001),
            row(Width::Fixed(2), false, 0.4, 0.0),
            row(Width::Fixed(3), false, 0.1, 0.0),
            row(Width::Fixed(4), false, 0.9, 0.0),
        ];
        assert_eq!(
            density(&rows),
            [
                "uniform, RMSE: 0.2000 ± 0.0100 (n = 10, c - 1, the widest tried) of the best variable \
                 estimate, 0.1000 ± 0.0100 (radius 3) of the best fixed one: fixed wins.",
                "uniform, relative RMSE: 0.4000 ± 0.3000 (n = 10, c - 1, the widest tried) of the best \
                 variable estimate, 0.2000 ± 0.3000 (radius 3) of the best fixed one: level."
            ]
        );
        assert_eq!(
            stopping_rule(&rows),
            ["n = 10: the count c puts +2.00 % into a uniform density, c - 1 puts -0.10 %."]
        );
        rows[3] = row(Width::Fixed(3), false, 0.2, 0.0);
        assert!(density(&rows)[0].ends_with("level."));
        rows[3] = row(Width::Fixed(3), false, 0.5, 0.0);
        assert!(density(&rows)[0].ends_with("variable wins."));
        assert_eq!(density(&[]), [""; 0]);
    }

    #[test]
    fn the_rule_without_a_choice_stands_beside_both() {
        let mut rows = vec![
            row(Width::Holding(10), false, 0.3, 0.02),
            row(Width::Holding(25), false, 0.4, 0.02),
            row(Width::Fixed(2), false, 0.1, 0.0),
            row(Width::Fixed(3), false, 0.9, 0.0),
        ];
        assert_eq!(even(&rows), [""; 0]);
        rows.push(row(Width::Even, false, 0.2, 0.0));
        let [told] = &even(&rows)[..] else { panic!("a sentence for the one shape") };
        assert!(
            told.starts_with("uniform, RMSE: 0.2000 ± 0.0100 by the rule even, without any choice: 0.67 (")
        );
        assert!(told.contains(" of the best variable estimate (n = 10) and 2.00 ("), "{told}");
        assert!(told.ends_with(" of the best fixed one (radius 2)."), "{told}");
        // Neither kind's best is the even one.
        assert_eq!(density(&rows).len(), 2);
    }
}
