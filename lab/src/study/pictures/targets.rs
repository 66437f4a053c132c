//! What light from tables should reach, and whether it does.

use super::{EqualPhotons, Metric};
use crate::bench::{MapInfo, Side, Target};

/// What is judged: inside of faces, and over all pixels.
const METRICS: [(Metric, f64); 4] = [
    (Metric::Rmse, 0.75),
    (Metric::RelativeMse, 0.5),
    (Metric::RmseOfAll, 0.75),
    (Metric::RelativeMseOfAll, 0.5),
];
/// How much worse a single scene may be.
const WORST: f64 = 1.05;
const UNIT: &str = "times its error";
/// The map of a mean over all of them.
const ALL: &str = "all scenes";

/// Which of two ways the error of tables is over.
type Over = fn(&EqualPhotons) -> Option<f64>;

/// Judges the comparisons of one study: geometric means over its numbers of photons, and over its scenes.
/// Nothing where there are no tables.
#[must_use]
pub fn targets(compared: &[EqualPhotons], size: [u32; 2]) -> Vec<Target> {
    let over_fixed: Over = |one| Some(one.tables?.ratio.ratio);
    let over_default: Over = |one| Some(one.tables_over_default?.ratio);
    if !compared.iter().any(|one| over_fixed(one).is_some()) {
        return Vec::new();
    }
    let mut scenes: Vec<&str> = compared.iter().map(|one| one.scene.as_str()).collect();
    scenes.dedup();
    let judge = |kind: (&str, &str), scene: &str, metric: Metric, over: Over, bound: f64| {
        let of = compared.iter().filter(|one| one.metric == metric && (scene == ALL || one.scene == scene));
        let map = MapInfo { name: scene.to_owned(), size, origin: String::new() };
        let bound = (Side::AtMost, bound, UNIT);
        Target::new(kind, &map, metric.name().to_owned(), geometric_mean(of.map(over)), bound)
    };
    let mean = (
        "tables-over-best-fixed",
        "light from tables against the best fixed radius, which is chosen with the answer in hand, over all \
         scenes and numbers of photons",
    );
    let mut targets: Vec<Target> =
        METRICS.map(|(metric, bound)| judge(mean, ALL, metric, over_fixed, bound)).into();
    let by_scene = [
        (("tables-over-best-fixed-scene", "the same in each scene, over its numbers of photons"), over_fixed),
        (("tables-over-default-scene", "light from tables against splats with the default n"), over_default),
    ];
    for (kind, over) in by_scene {
        for (metric, _) in METRICS {
            targets.extend(scenes.iter().map(|scene| judge(kind, scene, metric, over, WORST)));
        }
    }
    targets
}

/// Nothing if one is missing, or there are none.
fn geometric_mean(ratios: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let logarithms = ratios.map(|ratio| Some(ratio?.ln())).collect::<Option<Vec<f64>>>()?;
    #[expect(clippy::cast_precision_loss, reason = "a few ratios")]
    let count = logarithms.len() as f64;
    (!logarithms.is_empty()).then(|| (logarithms.iter().sum::<f64>() / count).exp())
}
