//! The plots of a study.

use super::density::{DensityRow, Width};
use super::pareto::Overall;
use super::pictures::{CurvePoint, EqualTime, Metric};
use super::radii::Question;
use super::shape::Shape;
use crate::chart::{Axis, COLOURS, Chart, Point, Scale, Series, Style};
use varikernel::settings::PictureSettings;

/// The methods that share a colour, by the beginning of their names.
const FAMILIES: [(&str, &str); 6] = [
    ("sat scan", "table by a scan"),
    ("sat doubling", "table by doubling"),
    ("pyramid", "pyramid"),
    ("brute-force", "brute force"),
    ("averaged-mipmap", "averaged mipmap"),
    ("", "naive mipmap, half density, grids"),
];

fn axis(name: &str, scale: Scale) -> Axis {
    Axis { name: name.to_owned(), scale }
}

/// Run time against error, the front labelled.
pub(super) fn radii(overall: &[Overall], question: Question) -> String {
    let mut series = Vec::new();
    let mut left: Vec<&Overall> = overall.iter().collect();
    for ((prefix, name), colour) in FAMILIES.into_iter().zip(COLOURS) {
        let (of_family, others): (Vec<_>, Vec<_>) =
            left.into_iter().partition(|one| one.variant.to_string().starts_with(prefix));
        left = others;
        for (style, on_front) in [(Style::Rings, false), (Style::Discs, true)] {
            let points: Vec<Point> = of_family
                .iter()
                .filter(|one| one.on_front == on_front)
                .map(|one| {
                    let label = if on_front { one.variant.to_string() } else { String::new() };
                    Point { label, ..Point::at(one.copies, one.mean_error) }
                })
                .collect();
            if !points.is_empty() {
                series.push(Series { name: name.to_owned(), colour, style, points });
            }
        }
    }
    Chart {
        title: question.to_string(),
        x: axis("time of a frame (copies)", Scale::Logarithmic),
        y: axis("mean error of the radius (pixels)", Scale::Logarithmic),
        series,
    }
    .svg()
}

/// Ways that are followed through the questions.
const FOLLOWED: [(&str, &str); 6] = [
    ("sat scan u32 bracketed", "table by a scan, bracketed"),
    ("sat scan u32 binary", "table by a scan, binary"),
    ("sat doubling-4 f32 binary", "thesis: 4 samples, binary"),
    ("sat doubling-4 f32 forward", "thesis: 4 samples, forward"),
    ("brute-force u32 forward", "brute force, forward"),
    ("pyramid u32 forward", "pyramid, forward"),
];

/// The part of a question that a plot varies.
type Vary = fn(&mut Question) -> &mut u32;

/// How times grow with n, MR and side, one varied at a time around the first question.
pub(super) fn by_question(overall: &[(Question, Vec<Overall>)]) -> Vec<String> {
    let Some((middle, _)) = overall.first() else { return Vec::new() };
    let kinds: [(&str, &str, Vary); 3] = [
        ("Time by n", "n (photons)", |question| &mut question.min_photons),
        ("Time by MR", "MR (pixels)", |question| &mut question.max_radius),
        ("Time by size", "side of the map (pixels)", |question| &mut question.side),
    ];
    let plot = |(title, x, vary): (&str, &str, Vary)| {
        let line = |((name, shown), colour)| {
            let mut points: Vec<Point> = Vec::new();
            for (question, overall) in overall {
                let (mut question, mut same) = (*question, *middle);
                let value = *vary(&mut question);
                *vary(&mut same) = value;
                let found = overall.iter().find(|one| one.variant.to_string() == name);
                if let Some(found) = found.filter(|_| question == same) {
                    points.push(Point::at(f64::from(value), found.copies));
                }
            }
            points.sort_by(|a, b| a.x.total_cmp(&b.x));
            Series { name: String::from(shown), colour, style: Style::Solid, points }
        };
        let series: Vec<Series> = FOLLOWED.into_iter().zip(COLOURS).map(line).collect();
        let mut values: Vec<f64> =
            series.iter().flat_map(|series| series.points.iter().map(|point| point.x)).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        let has_more = values.len() > 1;
        let chart = Chart {
            title: title.to_owned(),
            x: axis(x, Scale::LogarithmicAt(values)),
            y: axis("time of a frame (copies)", Scale::Logarithmic),
            series,
        };
        has_more.then(|| chart.svg())
    };
    kinds.into_iter().filter_map(plot).collect()
}

/// Error of an estimate by the mean radius of its boxes: growing ones with and without correction, fixed
/// ones, and even ones.
pub(super) fn density(rows: &[DensityRow], shape: Shape) -> String {
    let line = |name: &str, colour, style, is_of: fn(&DensityRow) -> bool| {
        let mut points: Vec<Point> = rows
            .iter()
            .filter(|row| row.shape == shape && is_of(row))
            .map(|row| Point { half_width: row.rmse.margin(), ..Point::at(row.mean_radius, row.rmse.mean) })
            .collect();
        points.sort_by(|a, b| a.x.total_cmp(&b.x));
        Series { name: name.to_owned(), colour, style, points }
    };
    Chart {
        title: format!("Estimates of a density: {}", shape.name()),
        x: axis("mean radius (pixels)", Scale::Logarithmic),
        y: axis("RMSE (parts of the mean density)", Scale::Logarithmic),
        series: vec![
            line("variable, count c", COLOURS[0], Style::Solid, |row| {
                row.width.is_growing() && !row.corrected
            }),
            line("variable, c - 1", COLOURS[2], Style::Dashed, |row| row.corrected),
            line("fixed radius", COLOURS[1], Style::Dotted, |row| row.width.is_fixed()),
            line("even", COLOURS[3], Style::Solid, |row| row.width == Width::Even),
        ],
    }
    .svg()
}

/// What the stopping rule adds to the mean by n, with and without correction, on the uniform density.
pub(super) fn stopping_rule(rows: &[DensityRow]) -> String {
    let line = |name: &str, colour, style, corrected: bool| Series {
        name: name.to_owned(),
        colour,
        style,
        points: rows
            .iter()
            .filter(|row| row.shape == Shape::Uniform && row.corrected == corrected)
            .filter_map(|row| match row.width {
                Width::Holding(n) => Some(Point {
                    half_width: row.mean_error.margin(),
                    ..Point::at(f64::from(n), row.mean_error.mean)
                }),
                Width::Fixed(_) | Width::Even => None,
            })
            .collect(),
    };
    Chart {
        title: "Too much or too little in all, uniform density".to_owned(),
        x: axis("n (photons)", Scale::Logarithmic),
        y: axis("mean error (parts of the mean density)", Scale::Linear),
        series: vec![
            line("count c", COLOURS[0], Style::Solid, false),
            line("c - 1", COLOURS[2], Style::Dashed, true),
        ],
    }
    .svg()
}

/// Error of pictures over their time, for more and more photons: each way is a curve.
pub(super) fn pictures(curves: &EqualTime) -> String {
    let line = |name: &str, colour, style, points: &[CurvePoint]| Series {
        name: name.to_owned(),
        colour,
        style,
        points: points
            .iter()
            .map(|point| Point {
                half_width: point.error.margin(),
                ..Point::at(point.seconds, point.error.mean)
            })
            .collect(),
    };
    let n = PictureSettings::default().min_photons;
    let unit = match curves.metric {
        Metric::Rmse | Metric::RmseOfAll => " (radiance)",
        _ => " (of 1)",
    };
    Chart {
        title: format!("{}: {}", curves.scene, curves.metric.name()),
        x: axis("time of a picture without direct light (s)", Scale::Logarithmic),
        y: axis(&format!("{}{unit}", curves.metric.name()), Scale::Logarithmic),
        series: vec![
            line("light from tables", COLOURS[2], Style::Solid, &curves.tables),
            line("splat, the best fixed radius", COLOURS[1], Style::Dashed, &curves.fixed),
            line("splat, the best n", COLOURS[0], Style::Solid, &curves.variable),
            line(&format!("splat, n = {n}"), COLOURS[3], Style::Dotted, &curves.default),
            line(&format!("gather, n = {n}"), COLOURS[5], Style::Dashed, &curves.gather),
        ],
    }
    .svg()
}

#[cfg(test)]
mod tests {
    use super::super::variant;
    use super::*;
    use varikernel::settings::Settings;

    #[test]
    fn what_is_followed_and_coloured_exists() {
        let names: Vec<String> =
            variant::all(Settings::default().search).iter().map(|one| one.name.to_string()).collect();
        for (name, _) in FOLLOWED {
            assert!(names.iter().any(|known| known == name), "{name}");
        }
        for (prefix, _) in FAMILIES {
            assert!(names.iter().any(|name| name.starts_with(prefix)), "{prefix}");
        }
    }
}
