//! Which rows a timing run has.

use super::case::{Case, Stage};
use super::rival;
use super::settings::{BenchSettings, MapInfo};
use super::work::Work;
use varikernel::measure::Unit;
use varikernel::settings::Method;

/// Every case of a map, units first and rivals last. A brute-force search is its whole frame, so only the
/// frame is a case.
pub(super) fn cases(settings: &BenchSettings, map: &MapInfo) -> Vec<(Case, Work)> {
    if let Some(suite) = &settings.suite {
        return suite.cases(settings, map);
    }
    let mut cases: Vec<(Case, Work)> =
        [Unit::Copy, Unit::Probe].map(|unit| (Case::unit(unit, map), Work::Unit(unit))).into();
    for stage in [Stage::Build, Stage::Search, Stage::Frame] {
        for pipeline in settings.pipelines() {
            if pipeline.method == Method::BruteForce && stage != Stage::Frame {
                continue;
            }
            let case = Case::of(stage, &pipeline, settings.base.storage, map);
            // The same build under another question, or the same search in a table built otherwise.
            if !cases.iter().any(|(known, _)| *known == case) {
                cases.push((case, Work::Pipeline(pipeline)));
            }
        }
    }
    cases.extend(rival::cases(settings, map));
    cases
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::bench::Protocol;
    use varikernel::settings::{Edges, Storage};

    #[test]
    fn each_case_is_there_once() {
        let map = MapInfo { name: "m".to_owned(), size: [4, 4], origin: String::new() };
        let mut settings = BenchSettings::new(Protocol::within(Duration::from_secs(1)));
        let count = |settings: &BenchSettings, stage| {
            cases(settings, &map).iter().filter(|(case, _)| case.stage == stage).count()
        };
        // Pyramid and three tables are built; pyramid and table are searched; brute force is a frame as well.
        // Two orders, and a third for the table.
        assert_eq!([Stage::Build, Stage::Search, Stage::Frame].map(|s| count(&settings, s)), [4, 5, 13]);
        settings.edges = vec![Edges::Zero, Edges::Scale];
        assert_eq!([Stage::Build, Stage::Search, Stage::Frame].map(|s| count(&settings, s)), [4, 10, 26]);
        // Tables in other numbers, but no scan in f32: two more builds, three more searches, six more frames.
        let usual = settings.clone();
        settings.edges = vec![Edges::Zero];
        settings.storages = vec![Storage::U32, Storage::F32];
        assert_eq!([Stage::Build, Stage::Search, Stage::Frame].map(|s| count(&settings, s)), [6, 8, 19]);
        settings = usual;
        // The naive mipmap has one search of its own.
        settings.methods = vec![Method::NaiveMipmap];
        assert_eq!([Stage::Build, Stage::Search, Stage::Frame].map(|s| count(&settings, s)), [1, 2, 2]);
    }
}
