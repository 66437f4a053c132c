//! The thesis's graphs with our lines in them, as SVG.

use crate::chart::{Axis, COLOURS, Chart, Point, Scale, Series, Style};
use crate::thesis::evidence::OrderPoint;
use crate::thesis::figures::Figure;
use crate::thesis::quantity::{Card, Measurements};
use crate::thesis::tables::printed_series;

/// `figure` with the printed lines of its cards and ours as far as they were timed.
#[must_use]
pub fn figure_svg(figure: &Figure, measurements: &Measurements) -> String {
    let points =
        |series: Vec<(u32, f64)>| series.into_iter().map(|(row, ms)| Point::at(f64::from(row), ms)).collect();
    let mut series = Vec::new();
    for (&quantity, &colour) in figure.quantities.iter().zip(&COLOURS) {
        let mut add = |who: &dyn std::fmt::Display, style, points: Vec<Point>| {
            if !points.is_empty() {
                series.push(Series { name: format!("{quantity}, {who}"), colour, style, points });
            }
        };
        add(&"here", Style::Solid, points(measurements.series(quantity)));
        for card in figure.cards {
            let style = if *card == Card::Gtx260 { Style::Dashed } else { Style::Dotted };
            add(card, style, points(printed_series(quantity, *card)));
        }
    }
    let by_radius = figure.quantities[0].row_name() == "Max radius";
    let x = if by_radius { "maximum radius (pixels)" } else { "side of the map (pixels)" };
    let x = Axis { name: x.to_owned(), scale: Scale::LogarithmicAt(every_x(&series)) };
    let scale = if figure.logarithmic { Scale::Logarithmic } else { Scale::Linear };
    let y = Axis { name: "time (ms)".to_owned(), scale };
    Chart { title: format!("5.{}  {}", figure.number, figure.title), x, y, series }.svg()
}

/// Forward and binary search by the mean radius, and where they cross.
#[must_use]
pub fn orders_svg(orders: &[OrderPoint]) -> String {
    let mut orders = orders.to_vec();
    orders.sort_by(|a, b| a.mean_radius.total_cmp(&b.mean_radius));
    let line = |name: &str, colour, ms: fn(&OrderPoint) -> f64| Series {
        name: name.to_owned(),
        colour,
        style: Style::Solid,
        points: orders.iter().map(|point| Point::at(point.mean_radius, ms(point))).collect(),
    };
    let series = vec![
        line("forward", COLOURS[0], |point| point.forward_ms),
        line("binary", COLOURS[1], |point| point.binary_ms),
    ];
    let labels = vec![1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
    Chart {
        title: "Forward against binary search as the density falls".to_owned(),
        x: Axis { name: "mean radius (pixels)".to_owned(), scale: Scale::LogarithmicAt(labels) },
        y: Axis { name: "time (ms)".to_owned(), scale: Scale::Logarithmic },
        series,
    }
    .svg()
}

/// Every place of x, once.
fn every_x(series: &[Series]) -> Vec<f64> {
    let mut all: Vec<f64> =
        series.iter().flat_map(|series| series.points.iter().map(|point| point.x)).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thesis::figures;

    #[test]
    fn every_figure_is_drawn_with_units_and_a_legend() {
        for figure in &figures::ALL {
            let svg = figure_svg(figure, &Measurements::default());
            assert!(svg.contains("time (ms)") && svg.contains("(pixels)"), "5.{}", figure.number);
            let cards = svg.matches("GTX 480").count() + svg.matches("GTX 260").count();
            assert!(cards >= figure.quantities.len() * figure.cards.len());
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "5.{}", figure.number);
        }
    }
}
