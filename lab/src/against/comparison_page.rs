//! The page of a comparison: `against.html`, self-contained, in light or dark.

use askama::Template as _;

use super::curve::Factor;
use super::{Against, Point, Region, SceneFound, WayFound};
use crate::chart::{Axis, COLOURS, Chart, Point as Place, Scale, Series, Style};
use crate::confidence::Confidence;

/// The page.
#[derive(askama::Template)]
#[template(path = "against.html")]
struct Page<'a> {
    against: &'a Against,
    command: &'a str,
    scenes: Vec<SceneView>,
}

/// A scene, as text.
struct SceneView {
    title: String,
    about: String,
    plots: Vec<String>,
    regions: Vec<&'static str>,
    rows: Vec<Row>,
    /// For each region but the whole, errors in equal time.
    apart: Vec<Row>,
}

/// A point, as text.
struct Row {
    way: String,
    options: String,
    cells: Vec<String>,
}

impl Against {
    /// The whole page; `command` is what made it.
    ///
    /// # Panics
    /// Never: a string takes all that is written.
    #[must_use]
    pub fn html(&self, command: &str) -> String {
        let scenes = self.scenes.iter().map(SceneView::of).collect();
        let page = Page { against: self, command, scenes };
        page.render().expect("a string takes all that is written")
    }

    /// A row for each point: scene, way, options, seconds, RMSE, median relative error, error in equal time.
    #[must_use]
    pub fn rows(&self) -> Vec<[String; 7]> {
        let mut rows = Vec::new();
        for scene in &self.scenes {
            for way in &scene.ways {
                for (index, point) in way.points.iter().enumerate() {
                    let [rmse, median] = errors(point, Region::Whole);
                    let equal_time = factors(way, index, Region::Whole)[0].clone();
                    let seconds = seconds(point);
                    let [scene, way] = [&scene.scene, &way.way].map(Clone::clone);
                    rows.push([scene, way, point.options.clone(), seconds, rmse, median, equal_time]);
                }
            }
        }
        rows
    }
}

impl SceneView {
    fn of(scene: &SceneFound) -> Self {
        let found: Vec<Region> = Region::ALL
            .into_iter()
            .filter(|&region| scene.ways[0].points[0].pictures[0].rmse(region).is_some())
            .collect();
        let (mut rows, mut apart) = (Vec::new(), Vec::new());
        for way in &scene.ways {
            for (index, point) in way.points.iter().enumerate() {
                let row = |cells| Row { way: way.way.clone(), options: point.options.clone(), cells };
                let [rmse, median] = errors(point, Region::Whole);
                let [equal_time, equal_error] = factors(way, index, Region::Whole);
                let seeds = point.pictures.len().to_string();
                rows.push(row(vec![seeds, seconds(point), rmse, median, equal_time, equal_error]));
                let of_region = |&region: &Region| {
                    let [rmse, _] = errors(point, region);
                    let [equal_time, _] = factors(way, index, region);
                    if equal_time.is_empty() { rmse } else { format!("{rmse}; x {equal_time}") }
                };
                apart.push(row(found[1..].iter().map(of_region).collect()));
            }
        }
        let [width, height] = scene.size;
        let noise = match scene.noise.first() {
            Some((_, noise)) => format!("whose own RMSE is {noise:.4}"),
            None => "which does not know its own error".to_owned(),
        };
        let mean = if scene.references == 1 { "one picture" } else { "the mean of several pictures" };
        Self {
            title: scene.scene.clone(),
            about: format!("{width} x {height} pixels, against {mean}, {noise}."),
            plots: found.iter().map(|&region| plot(scene, region)).collect(),
            regions: found[1..].iter().map(|region| region.name()).collect(),
            rows,
            apart: if found.len() > 1 { apart } else { Vec::new() },
        }
    }
}

fn seconds(point: &Point) -> String {
    if point.seconds < 10.0 { format!("{:.2}", point.seconds) } else { format!("{:.0}", point.seconds) }
}

/// RMSE and median relative error of a region, in percent.
fn errors(point: &Point, region: Region) -> [String; 2] {
    let errors =
        || point.pictures.iter().filter_map(|one| one.errors.iter().find(|error| error.region == region));
    let percent = |samples: Vec<f64>| {
        let samples: Vec<f64> = samples.into_iter().map(|sample| 100.0 * sample).collect();
        Confidence::of(&samples).map_or_else(String::new, |mean| format!("{mean:.2}"))
    };
    [
        percent(errors().map(|error| error.rmse).collect()),
        percent(errors().map(|error| error.median).collect()),
    ]
}

/// In equal time and at equal error, against the first way.
fn factors(way: &WayFound, point: usize, region: Region) -> [String; 2] {
    let of_point = way.comparisons.get(point).into_iter().flatten();
    let found = of_point.into_iter().find(|comparison| comparison.region == region);
    let shown = |factor: Option<Factor>| factor.map_or_else(|| "-".to_owned(), |factor| factor.to_string());
    match found {
        Some(comparison) => [shown(comparison.equal_time), shown(comparison.equal_error)],
        None => [String::new(), String::new()],
    }
}

fn plot(scene: &SceneFound, region: Region) -> String {
    let styles = [Style::Solid, Style::Dashed, Style::Dotted];
    let line = |(index, way): (usize, &WayFound)| {
        let place = |point: &Point| {
            let errors: Option<Vec<f64>> =
                point.pictures.iter().map(|picture| picture.rmse(region)).collect();
            let mean = Confidence::of(&errors?)?;
            Some(Place { half_width: 100.0 * mean.margin(), ..Place::at(point.seconds, 100.0 * mean.mean) })
        };
        Series {
            name: way.way.clone(),
            colour: COLOURS[index % COLOURS.len()],
            style: styles[index / COLOURS.len() % styles.len()],
            points: way.points.iter().filter_map(place).collect(),
        }
    };
    Chart {
        title: format!("{}: {}", scene.scene, region.name()),
        x: Axis { name: "time (s)".to_owned(), scale: Scale::Logarithmic },
        y: Axis { name: "RMSE (% of the mean)".to_owned(), scale: Scale::Logarithmic },
        series: scene.ways.iter().enumerate().map(line).collect(),
    }
    .svg()
}
