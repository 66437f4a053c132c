//! One row of a timing run.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::settings::MapInfo;
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

/// What identifies a row among all others of a run; what has no effect on a stage is absent.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Case {
    /// What is timed.
    pub stage: Stage,
    /// The method and, where it counts, how its structure is built: `brute-force`, `naive-mipmap`,
    /// `averaged-mipmap`, `pyramid`, `sat` (search), `sat-doubling-4` or `sat-scan` (build and frame),
    /// `copy`, `probe`; [`AUTO`]; or the name of a [`Rival`](crate::rivals::Rival) or a
    /// [`Situation`](super::Situation). A table that is kept in another number than the run's base says so:
    /// `sat-scan-u16`.
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
