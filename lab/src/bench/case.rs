//! What one row of a timing run is about.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::rival;
use super::settings::{BenchSettings, MapInfo};
use super::situation::Situation;
use crate::rivals::Rival;
use varikernel::measure::Unit;
use varikernel::settings::{Edges, Method, Order, SatBuild, SatSamples, Search, Settings, Storage};

/// What is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stage {
    /// One texel read and written: the unit.
    Copy,
    /// Four texels read and added.
    Probe,
    /// The intermediate structure, which depends on neither n, MR nor the search.
    Build,
    /// The search in a structure that is there, which does not depend on how a table was built.
    Search,
    /// Both: what a frame needs.
    Frame,
    /// The proof of radii that are there.
    Certify,
}

impl Stage {
    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Copy => "copy",
            Self::Probe => "probe",
            Self::Build => "build",
            Self::Search => "search",
            Self::Frame => "frame",
            Self::Certify => "certify",
        }
    }
}

/// The variant of frames that the [`planner`](varikernel::radius::planner) chooses.
pub const AUTO: &str = "auto";

/// What tells a row from all others of a run; what has no effect on a stage is absent.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Case {
    /// What is timed.
    pub stage: Stage,
    /// The method and, where it counts, how its structure is built: `brute-force`, `naive-mipmap`,
    /// `averaged-mipmap`, `pyramid`, `sat` (search), `sat-doubling-4` or `sat-scan` (build and frame), `copy`, `probe`;
    /// [`AUTO`]; or the name of a [`Rival`] or a [`Situation`]. A table that is kept in another number than the run's
    /// base says so: `sat-scan-u16`.
    pub variant: String,
    /// The map's name.
    pub map: String,
    /// The map's columns and rows.
    pub size: [u32; 2],
    /// The method; none for a unit, a rival, and where the planner chooses.
    pub method: Option<Method>,
    /// Samples a pass in which the summed-area table is built, if it is built by doubling.
    pub sat_samples: Option<SatSamples>,
    /// The order of the search.
    pub search: Option<Order>,
    /// n.
    pub min_photons: Option<u32>,
    /// MR.
    pub max_radius: Option<u32>,
    /// The edge rule.
    pub edges: Option<Edges>,
}

impl Case {
    pub(super) fn unit(unit: Unit, map: &MapInfo) -> Self {
        let stage = match unit {
            Unit::Copy => Stage::Copy,
            Unit::Probe => Stage::Probe,
        };
        Self {
            stage,
            variant: stage.name().to_owned(),
            map: map.name.clone(),
            size: map.size,
            method: None,
            sat_samples: None,
            search: None,
            min_photons: None,
            max_radius: None,
            edges: None,
        }
    }

    /// A frame of whatever the planner chooses for the map.
    pub(super) fn planned(search: Search, map: &MapInfo) -> Self {
        Self {
            stage: Stage::Frame,
            variant: AUTO.to_owned(),
            map: map.name.clone(),
            size: map.size,
            method: None,
            sat_samples: None,
            search: None,
            min_photons: Some(search.min_photons),
            max_radius: Some(search.max_radius),
            edges: Some(search.edges),
        }
    }

    pub(super) fn of(stage: Stage, settings: &Settings, base: Storage, map: &MapInfo) -> Self {
        let Settings { search, method, .. } = *settings;
        let is_table = method == Method::SummedAreaTable;
        let builds = is_table && stage != Stage::Search;
        let sat_samples = (builds && settings.laboratory.sat_build == SatBuild::Doubling)
            .then_some(settings.laboratory.sat_samples);
        let mut variant = match sat_samples {
            Some(samples) => format!("sat-doubling-{}", samples.count()),
            None if builds => "sat-scan".to_owned(),
            None => method.name().to_owned(),
        };
        if settings.storage != base {
            variant = format!("{variant}-{}", settings.storage.name());
        }
        let searches = stage != Stage::Build;
        Self {
            stage,
            variant,
            map: map.name.clone(),
            size: map.size,
            method: Some(method),
            sat_samples,
            search: (searches && method != Method::NaiveMipmap).then_some(search.order),
            min_photons: searches.then_some(search.min_photons),
            max_radius: searches.then_some(search.max_radius),
            edges: searches.then_some(search.edges),
        }
    }
}

impl fmt::Display for Case {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        write!(formatter, "{}", self.stage.name())?;
        if self.variant != self.stage.name() {
            write!(formatter, " {}", self.variant)?;
        }
        if let Some(order) = self.search {
            write!(formatter, " {}", order.name())?;
        }
        if let (Some(n), Some(radius), Some(edges)) = (self.min_photons, self.max_radius, self.edges) {
            write!(formatter, " n {n} MR {radius} edges {}", edges.name())?;
        }
        write!(formatter, ", {} {width} x {height}", self.map)
    }
}

/// What a case runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Work {
    Unit(Unit),
    Pipeline(Settings),
    /// The frame of what the planner makes of the settings.
    Planned(Settings),
    Situation(Situation, Settings),
    Rival(Rival, Search),
}

/// Every case of a map, units first and rivals last. A brute-force search is its whole frame, so only the frame is a case.
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

    #[test]
    fn each_case_is_there_once() {
        let map = MapInfo { name: "m".to_owned(), size: [4, 4], origin: String::new() };
        let mut settings = BenchSettings::new(Protocol::within(Duration::from_secs(1)));
        let count = |settings: &BenchSettings, stage| {
            cases(settings, &map).iter().filter(|(case, _)| case.stage == stage).count()
        };
        // Pyramid and three tables are built; pyramid and table are searched; brute force is a frame as well. Two
        // orders, and a third for the table.
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
