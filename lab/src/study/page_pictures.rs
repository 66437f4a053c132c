//! The part of a study's page that is about pictures.

use std::fmt::Write as _;

use super::pictures::{BiasRow, Chosen, Comparison, EqualPhotons, EqualTime, Metric, Way};
use super::{Study, Summary, plots};
use crate::bench::Target;
use crate::confidence::{Confidence, RatioInterval};

/// From this share of a tile's light on, a bias is shown as a strong one.
const STRONG: f32 = 0.1;

/// Text and plots.
pub(super) struct PicturesView {
    pub(super) words: Vec<String>,
    pub(super) plots: Vec<String>,
    pub(super) targets: Vec<TargetView>,
    pub(super) rows: Vec<[String; 9]>,
    pub(super) biases: Vec<SceneView>,
}

/// A target and its verdict.
pub(super) struct TargetView {
    pub(super) class: &'static str,
    pub(super) cells: [String; 5],
}

/// The ways of one scene.
pub(super) struct SceneView {
    pub(super) scene: String,
    pub(super) ways: Vec<BiasView>,
}

/// Where a way is biased, and by how much in the mean.
pub(super) struct BiasView {
    pub(super) way: String,
    pub(super) cells: [String; 5],
    /// Columns and rows of tiles.
    pub(super) tiles: [u32; 2],
    /// Much too dark, too dark, too bright, much too bright: paths of squares.
    pub(super) paths: [String; 4],
}

impl PicturesView {
    pub(super) fn of(study: &Study, summary: &Summary) -> Self {
        let is_plotted =
            |curves: &&EqualTime| matches!(curves.metric, Metric::Rmse | Metric::RelativeMse | Metric::Flip);
        let mut biases: Vec<SceneView> = Vec::new();
        for row in &study.biases {
            if biases.last().is_none_or(|last| last.scene != row.scene) {
                biases.push(SceneView { scene: row.scene.clone(), ways: Vec::new() });
            }
            if let Some(last) = biases.last_mut() {
                last.ways.push(BiasView::of(row));
            }
        }
        Self {
            words: summary.pictures.clone(),
            plots: summary.equal_time.iter().filter(is_plotted).map(plots::pictures).collect(),
            targets: summary.targets.iter().map(TargetView::of).collect(),
            rows: summary.equal_photons.iter().map(row).collect(),
            biases,
        }
    }
}

impl TargetView {
    fn of(target: &Target) -> Self {
        let (class, verdict) = match target.measured {
            None => ("untested", "not measured"),
            Some(_) if target.holds => ("confirmed", "holds"),
            Some(_) => ("refuted", "missed"),
        };
        let measured = target.measured.map_or_else(String::new, |measured| format!("{measured:.3}"));
        let bound = format!("{} {}", target.side, target.bound);
        let against = if target.name.contains("default") { "default n" } else { "best fixed radius" };
        let what = format!("{}, against the {against}", target.map);
        Self { class, cells: [what, target.question.clone(), measured, bound, verdict.to_owned()] }
    }
}

impl BiasView {
    fn of(row: &BiasRow) -> Self {
        let percent = |value: f64| format!("{:.1} %", 100.0 * value);
        let mean = |of: &Confidence| format!("{:+.2} ± {:.2} %", 100.0 * of.mean, 100.0 * of.margin());
        let share = |tiles: u32| percent(f64::from(tiles) / f64::from(row.tested.max(1)));
        Self {
            way: row.way.to_string(),
            cells: [
                share(row.biased),
                share(row.surely_biased),
                percent(row.size),
                mean(&row.inside),
                mean(&row.edges),
            ],
            tiles: row.tiles,
            paths: paths(row.tiles, &row.map),
        }
    }
}

/// Runs of tiles of one kind as paths, the lowest row of the picture at the bottom.
fn paths([columns, rows]: [u32; 2], map: &[f32]) -> [String; 4] {
    let kind = |share: f32| match share {
        share if share <= -STRONG => Some(0),
        share if share < 0.0 => Some(1),
        share if share >= STRONG => Some(3),
        share if share > 0.0 => Some(2),
        _ => None,
    };
    let mut paths: [String; 4] = std::array::from_fn(|_| String::new());
    for (row, tiles) in map.chunks(columns.max(1) as usize).enumerate() {
        let mut column = 0;
        for run in tiles.chunk_by(|a, b| kind(*a) == kind(*b)) {
            if let Some(path) = kind(run[0]).map(|kind: usize| &mut paths[kind]) {
                let (top, width) = ((rows as usize).saturating_sub(row + 1), run.len());
                write!(path, "M{column} {top}h{width}v1h-{width}z").expect("writing to a string");
            }
            column += run.len();
        }
    }
    paths
}

fn row(row: &EqualPhotons) -> [String; 9] {
    let width = |chosen: &Chosen| {
        let end = if chosen.at_end { " (last tried)" } else { "" };
        match chosen.way {
            Way::Fixed { radius } => format!("radius {radius}{end}: {}", chosen.error),
            way => format!("n = {}{end}: {}", way.min_photons().unwrap_or(0), chosen.error),
        }
    };
    let ratio = |of: Option<Comparison>| shown(of.map(|of| of.ratio));
    [
        row.scene.clone(),
        row.photons.to_string(),
        row.metric.name().to_owned(),
        width(&row.fixed),
        width(&row.best.chosen),
        row.best.ratio.to_string(),
        ratio(row.default),
        ratio(row.gather),
        ratio(row.tables),
    ]
}

fn shown(ratio: Option<RatioInterval>) -> String {
    ratio.map_or_else(String::new, |ratio| ratio.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two rows of three tiles: the second row of the picture is drawn above the first.
    #[test]
    fn tiles_are_drawn_by_their_bias() {
        let map = [0.05, 0.05, 0.0, -0.3, 0.2, -0.01];
        assert_eq!(paths([3, 2], &map), ["M0 0h1v1h-1z", "M2 0h1v1h-1z", "M0 1h2v1h-2z", "M1 0h1v1h-1z"]);
    }
}
