//! The thesis's graphs with our lines in them, as SVG.
//!
//! Black, white and the grid's grey are left to the page's style sheet where the picture is part of one; alone, the
//! picture is dark on white.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use crate::measure::thesis::evidence::OrderPoint;
use crate::measure::thesis::figures::Figure;
use crate::measure::thesis::quantity::{Card, Measurements};
use crate::measure::thesis::tables::printed_series;

const WIDTH: u32 = 600;
/// Without the legend.
const HEIGHT: u32 = 330;
/// Of a row of the legend.
const LEGEND_ROW: u32 = 20;
const FONT: &str = "sans-serif";
const GRID: RGBColor = RGBColor(0xcc, 0xcc, 0xcc);
/// One colour a quantity, apart in hue and lightness.
const COLOURS: [RGBColor; 4] = [
    RGBColor(0x1f, 0x77, 0xb4),
    RGBColor(0xd6, 0x5f, 0x0e),
    RGBColor(0x2c, 0x94, 0x4a),
    RGBColor(0xa8, 0x4f, 0xb8),
];

/// A line of a plot.
#[derive(Clone, Debug, PartialEq)]
struct Line {
    name: String,
    colour: RGBColor,
    style: Style,
    points: Vec<(f64, f64)>,
}

/// Whose line it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Style {
    /// Solid, discs.
    Here,
    /// Dashed, triangles.
    Gtx260,
    /// Dotted, crosses.
    Gtx480,
}

/// What a plot's axes say.
struct Axes {
    title: String,
    x: &'static str,
    y: &'static str,
    logarithmic: bool,
    x_labels: Vec<f64>,
}

/// `figure` with the printed lines of its cards and ours as far as they were timed.
#[must_use]
pub fn figure_svg(figure: &Figure, measurements: &Measurements) -> String {
    let points = |series: Vec<(u32, f64)>| series.into_iter().map(|(row, ms)| (f64::from(row), ms)).collect();
    let mut lines = Vec::new();
    for (&quantity, &colour) in figure.quantities.iter().zip(&COLOURS) {
        let mut add = |who: &dyn std::fmt::Display, style, points: Vec<(f64, f64)>| {
            if !points.is_empty() {
                lines.push(Line { name: format!("{quantity}, {who}"), colour, style, points });
            }
        };
        add(&"here", Style::Here, points(measurements.series(quantity)));
        for card in figure.cards {
            let style = if *card == Card::Gtx260 { Style::Gtx260 } else { Style::Gtx480 };
            add(card, style, points(printed_series(quantity, *card)));
        }
    }
    let by_radius = figure.quantities[0].row_name() == "Max radius";
    let axes = Axes {
        title: format!("5.{}  {}", figure.number, figure.title),
        x: if by_radius { "maximum radius (pixels)" } else { "side of the map (pixels)" },
        y: "time (ms)",
        logarithmic: figure.logarithmic,
        x_labels: labels(&lines),
    };
    draw(&axes, &lines)
}

/// Forward and binary search by the mean radius, and where they cross.
#[must_use]
pub fn orders_svg(orders: &[OrderPoint]) -> String {
    let mut orders = orders.to_vec();
    orders.sort_by(|a, b| a.mean_radius.total_cmp(&b.mean_radius));
    let line = |name: &str, colour, ms: fn(&OrderPoint) -> f64| Line {
        name: name.to_owned(),
        colour,
        style: Style::Here,
        points: orders.iter().map(|point| (point.mean_radius, ms(point))).collect(),
    };
    let lines = [
        line("forward", COLOURS[0], |point| point.forward_ms),
        line("binary", COLOURS[1], |point| point.binary_ms),
    ];
    let axes = Axes {
        title: "Forward against binary search as the density falls".to_owned(),
        x: "mean radius (pixels)",
        y: "time (ms)",
        logarithmic: true,
        x_labels: vec![1.0, 2.0, 4.0, 8.0, 16.0, 32.0],
    };
    draw(&axes, &lines)
}

/// Every place of x, once.
fn labels(lines: &[Line]) -> Vec<f64> {
    let mut labels: Vec<f64> =
        lines.iter().flat_map(|line| line.points.iter().map(|point| point.0)).collect();
    labels.sort_by(f64::total_cmp);
    labels.dedup();
    labels
}

fn draw(axes: &Axes, lines: &[Line]) -> String {
    let values = |of: fn(&(f64, f64)) -> f64| lines.iter().flat_map(move |line| line.points.iter().map(of));
    let span = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)))
    };
    let x = span(&mut values(|point| point.0));
    let y = span(&mut values(|point| point.1));
    let x = PowersOf { labels: axes.x_labels.clone(), range: x.0 / 1.15..x.1 * 1.15 };
    let mut svg = String::new();
    {
        let rows = u32::try_from(lines.len().div_ceil(2)).unwrap_or(u32::MAX);
        let size = (WIDTH, HEIGHT + LEGEND_ROW * rows + 10);
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        let drawn = if axes.logarithmic {
            let range = y.0 / 1.5..y.1 * 1.5;
            let labels = decades(&range);
            draw_lines(&area, axes, lines, x, PowersOf { labels, range })
        } else {
            draw_lines(&area, axes, lines, x, RangedCoordf64::from(0.0..y.1 * 1.15))
        };
        drawn.and_then(|()| area.present()).expect("a string takes all that is drawn");
    }
    svg
}

fn draw_lines<'a, Y: Ranged<ValueType = f64> + ValueFormatter<f64>>(
    area: &DrawingArea<SVGBackend<'a>, plotters::coord::Shift>,
    axes: &Axes,
    lines: &[Line],
    x: PowersOf,
    y: Y,
) -> Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>> {
    area.fill(&WHITE)?;
    // The legend has its own strip, so that it hides no line.
    let (plot, legend) = area.split_vertically(HEIGHT);
    let mut chart = ChartBuilder::on(&plot)
        .caption(&axes.title, (FONT, 17))
        .margin(10)
        .x_label_area_size(42)
        .y_label_area_size(64)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .x_desc(axes.x)
        .y_desc(axes.y)
        .axis_desc_style((FONT, 14))
        .label_style((FONT, 13))
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .x_label_formatter(&|value| number(*value))
        .y_label_formatter(&|value| number(*value))
        .draw()?;
    for line in lines {
        let points = || line.points.iter().copied();
        match line.style {
            Style::Here => {
                chart.draw_series(LineSeries::new(points(), line.colour.stroke_width(3)))?;
                chart.draw_series(points().map(|at| Circle::new(at, 4, line.colour.filled())))?;
            }
            Style::Gtx260 => {
                chart.draw_series(DashedLineSeries::new(points(), 8, 5, line.colour.stroke_width(1)))?;
                chart.draw_series(points().map(|at| TriangleMarker::new(at, 5, line.colour.filled())))?;
            }
            Style::Gtx480 => {
                chart.draw_series(DashedLineSeries::new(points(), 2, 4, line.colour.stroke_width(1)))?;
                chart.draw_series(points().map(|at| Cross::new(at, 4, line.colour.stroke_width(2))))?;
            }
        }
    }
    for (index, line) in lines.iter().enumerate() {
        draw_legend(&legend, index, line)?;
    }
    Ok(())
}

/// Entry `index` of two columns.
fn draw_legend<'a>(
    area: &DrawingArea<SVGBackend<'a>, plotters::coord::Shift>,
    index: usize,
    line: &Line,
) -> Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>> {
    let column = i32::try_from(index % 2).unwrap_or(0);
    let row = i32::try_from(index / 2).unwrap_or(0);
    let (left, middle) = (60 + column * 270, 10 + row * 20);
    let at = (left + 14, middle);
    match line.style {
        Style::Here => {
            area.draw(&PathElement::new([(left, middle), (left + 28, middle)], line.colour.stroke_width(3)))?;
            area.draw(&Circle::new(at, 4, line.colour.filled()))?;
        }
        Style::Gtx260 => {
            for start in [left, left + 20] {
                area.draw(&PathElement::new([(start, middle), (start + 8, middle)], line.colour))?;
            }
            area.draw(&TriangleMarker::new(at, 5, line.colour.filled()))?;
        }
        Style::Gtx480 => {
            for start in [left, left + 5, left + 21, left + 26] {
                area.draw(&PathElement::new([(start, middle), (start + 2, middle)], line.colour))?;
            }
            area.draw(&Cross::new(at, 4, line.colour.stroke_width(2)))?;
        }
    }
    area.draw(&Text::new(line.name.clone(), (left + 36, middle - 7), (FONT, 14)))
}

/// 1, 2, 5 times the powers of ten in `range`; only the powers where that would be crowded.
fn decades(range: &Range<f64>) -> Vec<f64> {
    let wide = range.end / range.start > 200.0;
    #[expect(clippy::cast_possible_truncation, reason = "times are far from the limits of i32")]
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
    // Ten digits hide what binary fractions add.
    let text = format!("{value:.10}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A logarithmic axis with labels of our choice.
struct PowersOf {
    labels: Vec<f64>,
    range: Range<f64>,
}

impl Ranged for PowersOf {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    #[expect(clippy::cast_possible_truncation, reason = "a place in a picture")]
    fn map(&self, value: &f64, (low, high): (i32, i32)) -> i32 {
        let share = (value / self.range.start).ln() / (self.range.end / self.range.start).ln();
        low + (f64::from(high - low) * share).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.labels.iter().copied().filter(|value| self.range.contains(value)).collect()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::thesis::figures;

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

    #[test]
    fn labels_are_round() {
        assert_eq!(decades(&(0.03..3.0)), [0.05, 0.1, 0.2, 0.5, 1.0, 2.0]);
        assert_eq!(decades(&(0.5..5000.0)), [1.0, 10.0, 100.0, 1000.0]);
        assert_eq!([0.05, 1.0, 1024.0].map(number), ["0.05", "1", "1024"]);
    }
}
