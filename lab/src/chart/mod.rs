//! Plots as SVG: lines, points and intervals over named axes.
//!
//! Black, white and the grid's grey are left to the page's style sheet where the picture is part of one;
//! alone, the picture is dark on white. A value that a logarithmic axis has no place for, 0, stands on a line
//! of its own at the axis's end, which says so.

mod layout;

pub(crate) use layout::Scale;

use plotters::prelude::*;

use layout::Layout;

/// Without the legend.
const HEIGHT: u32 = 330;
const WIDTH: u32 = 600;
/// Of a row of the legend.
const LEGEND_ROW: u32 = 20;
const FONT: &str = "sans-serif";
const GRID: RGBColor = RGBColor(0xcc, 0xcc, 0xcc);
/// Apart in hue and lightness.
pub(crate) const COLOURS: [RGBColor; 6] = [
    RGBColor(0x1f, 0x77, 0xb4),
    RGBColor(0xd6, 0x5f, 0x0e),
    RGBColor(0x2c, 0x94, 0x4a),
    RGBColor(0xa8, 0x4f, 0xb8),
    RGBColor(0x8c, 0x6d, 0x31),
    RGBColor(0x5f, 0x6b, 0x7a),
];

/// Some points of one kind, joined or not.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Series {
    /// Its name in the legend; series of one name share an entry.
    pub(crate) name: String,
    pub(crate) colour: RGBColor,
    pub(crate) style: Style,
    pub(crate) points: Vec<Point>,
}

/// A place, with half the length of its interval of confidence along y if it has one, and words beside it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Point {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) half_width: f64,
    pub(crate) label: String,
}

impl Point {
    pub(crate) fn at(x: f64, y: f64) -> Self {
        Self { x, y, ..Self::default() }
    }
}

/// What is drawn at the points and between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Style {
    /// A solid line with discs.
    Solid,
    /// A dashed line with triangles.
    Dashed,
    /// A dotted line with crosses.
    Dotted,
    /// Discs alone.
    Discs,
    /// Rings alone.
    Rings,
}

/// An axis: what it measures with its unit, and how.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Axis {
    pub(crate) name: String,
    pub(crate) scale: Scale,
}

/// A plot.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Chart {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) series: Vec<Series>,
}

impl Chart {
    /// The picture; without any point, a note that there is none.
    pub(crate) fn svg(&self) -> String {
        let mut svg = String::new();
        {
            let entries = self.entries();
            let rows = u32::try_from(entries.len().div_ceil(2)).unwrap_or(u32::MAX);
            let area = SVGBackend::with_string(&mut svg, (WIDTH, HEIGHT + LEGEND_ROW * rows + 10))
                .into_drawing_area();
            let drawn = self.draw(&area, &entries).and_then(|()| area.present());
            drawn.expect("a string takes all that is drawn");
        }
        svg
    }

    /// The first series of each name.
    fn entries(&self) -> Vec<&Series> {
        let mut entries: Vec<&Series> = Vec::new();
        for series in &self.series {
            if !entries.iter().any(|entry| entry.name == series.name) {
                entries.push(series);
            }
        }
        entries
    }

    fn draw<'a>(&self, area: &Area<'a>, entries: &[&Series]) -> Drawn<'a> {
        area.fill(&WHITE)?;
        // The legend has its own strip, so that it hides no line.
        let (plot, legend) = area.split_vertically(HEIGHT);
        let points = || self.series.iter().flat_map(|series| &series.points);
        if points().next().is_none() {
            plot.draw(&Text::new(self.title.clone(), (10, 10), (FONT, 17)))?;
            return plot.draw(&Text::new("nothing was measured", (10, 40), (FONT, 14)));
        }
        let along_x = Layout::of(&self.x.scale, points().map(|point| point.x), 1.15);
        let ends =
            points().flat_map(|point| [point.y - point.half_width, point.y, point.y + point.half_width]);
        // An interval that reaches past 0 is cut, not the reason for a wider axis.
        let ends = ends.filter(|end| *end > 0.0 || self.y.scale == Scale::Linear);
        let zeros = points().map(|point| point.y).filter(|y| *y == 0.0);
        let along_y = Layout::of(&self.y.scale, ends.chain(zeros), 1.5);
        let mut chart = ChartBuilder::on(&plot)
            .caption(&self.title, (FONT, 17))
            .margin(10)
            .x_label_area_size(42)
            .y_label_area_size(64)
            .build_cartesian_2d(along_x.clone(), along_y.clone())?;
        chart
            .configure_mesh()
            .x_desc(&self.x.name)
            .y_desc(&self.y.name)
            .axis_desc_style((FONT, 14))
            .label_style((FONT, 13))
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .x_label_formatter(&|value| along_x.label(*value))
            .y_label_formatter(&|value| along_y.label(*value))
            .draw()?;
        for series in &self.series {
            let at = || series.points.iter().map(|point| (along_x.shown(point.x), along_y.shown(point.y)));
            let colour = series.colour;
            for point in series.points.iter().filter(|point| point.half_width > 0.0) {
                let [low, high] = [-1.0, 1.0].map(|side| point.y + side * point.half_width);
                let ends = [low, high].map(|y| (along_x.shown(point.x), along_y.shown(y)));
                chart.draw_series([PathElement::new(ends, colour.stroke_width(1))])?;
            }
            match series.style {
                Style::Solid => {
                    chart.draw_series(LineSeries::new(at(), colour.stroke_width(3)))?;
                }
                Style::Dashed => {
                    chart.draw_series(DashedLineSeries::new(at(), 8, 5, colour.stroke_width(1)))?;
                }
                Style::Dotted => {
                    chart.draw_series(DashedLineSeries::new(at(), 2, 4, colour.stroke_width(1)))?;
                }
                Style::Discs | Style::Rings => (),
            }
            match series.style {
                Style::Solid | Style::Discs => {
                    chart.draw_series(at().map(|at| Circle::new(at, 4, colour.filled())))?;
                }
                Style::Dashed => {
                    chart.draw_series(at().map(|at| TriangleMarker::new(at, 5, colour.filled())))?;
                }
                Style::Dotted => {
                    chart.draw_series(at().map(|at| Cross::new(at, 4, colour.stroke_width(2))))?;
                }
                Style::Rings => {
                    chart.draw_series(at().map(|at| Circle::new(at, 4, colour.stroke_width(1))))?;
                }
            }
            let labelled = series.points.iter().zip(at()).filter(|(point, _)| !point.label.is_empty());
            // Neighbours' labels keep apart if they take turns above and below.
            chart.draw_series(labelled.enumerate().map(|(index, (point, at))| {
                let place = if index % 2 == 0 { (7, -14) } else { (7, 4) };
                EmptyElement::at(at) + Text::new(point.label.clone(), place, (FONT, 12))
            }))?;
        }
        for (index, series) in entries.iter().enumerate() {
            draw_entry(&legend, index, series)?;
        }
        Ok(())
    }
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Drawn<'a> = Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>>;

/// Entry `index` of two columns.
fn draw_entry<'a>(area: &Area<'a>, index: usize, series: &Series) -> Drawn<'a> {
    let column = i32::try_from(index % 2).unwrap_or(0);
    let row = i32::try_from(index / 2).unwrap_or(0);
    let (left, middle) = (60 + column * 270, 10 + row * 20);
    let at = (left + 14, middle);
    let colour = series.colour;
    match series.style {
        Style::Solid => {
            area.draw(&PathElement::new([(left, middle), (left + 28, middle)], colour.stroke_width(3)))?;
            area.draw(&Circle::new(at, 4, colour.filled()))?;
        }
        Style::Dashed => {
            for start in [left, left + 20] {
                area.draw(&PathElement::new([(start, middle), (start + 8, middle)], colour))?;
            }
            area.draw(&TriangleMarker::new(at, 5, colour.filled()))?;
        }
        Style::Dotted => {
            for start in [left, left + 5, left + 21, left + 26] {
                area.draw(&PathElement::new([(start, middle), (start + 2, middle)], colour))?;
            }
            area.draw(&Cross::new(at, 4, colour.stroke_width(2)))?;
        }
        Style::Discs => area.draw(&Circle::new(at, 4, colour.filled()))?,
        Style::Rings => area.draw(&Circle::new(at, 4, colour.stroke_width(1)))?,
    }
    area.draw(&Text::new(series.name.clone(), (left + 36, middle - 7), (FONT, 14)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plot_names_its_axes_and_each_name_once() {
        let series = |points: Vec<Point>| Series {
            name: "some".to_owned(),
            colour: COLOURS[0],
            style: Style::Solid,
            points,
        };
        let axis = |name: &str| Axis { name: name.to_owned(), scale: Scale::Logarithmic };
        let mut chart = Chart {
            title: "title".to_owned(),
            x: axis("time (copies)"),
            y: axis("error (pixels)"),
            series: vec![series(vec![Point::at(1.0, 2.0), Point { half_width: 5.0, ..Point::at(2.0, 4.0) }])],
        };
        chart.series.push(Series {
            style: Style::Rings,
            ..series(vec![Point { label: "here".to_owned(), ..Point::at(3.0, 0.0) }])
        });
        let svg = chart.svg();
        for text in ["title", "time (copies)", "error (pixels)", "here", "some"] {
            assert_eq!(svg.matches(&format!("\n{text}\n")).count(), 1, "{text} in {svg}");
        }
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        chart.series.clear();
        assert!(chart.svg().contains("nothing was measured"));
    }
}
