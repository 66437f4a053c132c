//! The settings of a timing run.

use std::fmt;
use std::time::Duration;

use glam::UVec2;
use serde::{Deserialize, Serialize};

use super::suite::FastSuite;
use crate::rivals::Rival;
use varikernel::image::Image;
use varikernel::settings::{
    Edges, Laboratory, Method, Order, SatBuild, SatSamples, Search, Settings, Storage,
};

/// How often a case is repeated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Protocol {
    /// How many times the run goes over all cases of a map.
    pub sets: usize,
    /// The most samples that a case gives in one set; slow cases give as many as the budget allows.
    pub iterations: usize,
    /// Seconds that the run may take in all. A case that has begun is finished, so it may take a little more.
    pub budget_s: f64,
}

impl Protocol {
    /// 5 sets of up to 100 iterations.
    #[must_use]
    pub fn within(budget: Duration) -> Self {
        Self { sets: 5, iterations: 100, budget_s: budget.as_secs_f64() }
    }

    /// 5 sets of up to 10^3 iterations (thesis 5.1).
    #[must_use]
    pub fn thesis(budget: Duration) -> Self {
        Self { iterations: 1000, ..Self::within(budget) }
    }
}

/// What varies from case to case, and what stays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BenchSettings {
    /// Methods.
    pub methods: Vec<Method>,
    /// Builds of the summed-area table.
    pub sat_builds: Vec<SatBuild>,
    /// Samples a pass of a table that is built by doubling.
    pub sat_samples: Vec<SatSamples>,
    /// Numbers in which summed-area tables are kept; none stands for that of `base`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub storages: Vec<Storage>,
    /// Orders of the search.
    pub searches: Vec<Order>,
    /// n.
    pub min_photons: Vec<u32>,
    /// MR.
    pub max_radius: Vec<u32>,
    /// Edge rules.
    pub edges: Vec<Edges>,
    /// Rivals on the processor, timed beside the methods.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rivals: Vec<Rival>,
    /// A suite, which times a part of what is listed above and more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub suite: Option<FastSuite>,
    /// Everything else: storage, split, matching, faults. What is listed above is taken from there.
    pub base: Settings,
    /// How often.
    pub protocol: Protocol,
}

impl BenchSettings {
    /// The exact methods, the thesis's numbers of samples, both searches, n = 25, MR = 32, no rivals.
    #[must_use]
    pub fn new(protocol: Protocol) -> Self {
        let base = Settings::default();
        Self {
            methods: Method::ALL.into_iter().filter(|method| method.is_exact()).collect(),
            sat_builds: vec![SatBuild::Doubling, SatBuild::Scan],
            sat_samples: vec![SatSamples::Two, SatSamples::Four],
            storages: Vec::new(),
            searches: vec![Order::Forward, Order::Binary, Order::Bracketed],
            min_photons: vec![base.search.min_photons],
            max_radius: vec![base.search.max_radius],
            edges: vec![base.search.edges],
            rivals: Vec::new(),
            suite: None,
            base,
            protocol,
        }
    }

    /// Every pipeline that is timed, brute force first as in the thesis.
    pub(super) fn pipelines(&self) -> Vec<Settings> {
        let mut pipelines: Vec<Settings> = Vec::new();
        for &method in &self.methods {
            for search in self.questions() {
                for (storage, sat_build, sat_samples) in self.builds_of(method) {
                    let mut settings = Settings {
                        search,
                        method,
                        storage,
                        laboratory: Laboratory { sat_build, sat_samples, ..self.base.laboratory },
                        ..self.base
                    };
                    if method == Method::NaiveMipmap {
                        // It has a search of its own, to which the order does not apply.
                        settings.search.order = Settings::of(method).search.order;
                    }
                    let is_possible =
                        settings.search.order != Order::Bracketed || method == Method::SummedAreaTable;
                    if is_possible && !pipelines.contains(&settings) {
                        pipelines.push(settings);
                    }
                }
            }
        }
        pipelines
    }

    fn builds_of(&self, method: Method) -> Vec<(Storage, SatBuild, SatSamples)> {
        if method != Method::SummedAreaTable {
            return vec![(
                self.base.storage,
                self.base.laboratory.sat_build,
                self.base.laboratory.sat_samples,
            )];
        }
        let storages = if self.storages.is_empty() { &[self.base.storage][..] } else { &self.storages };
        let samples_of = |build: &SatBuild| match build {
            SatBuild::Doubling => self.sat_samples.clone(),
            SatBuild::Scan => vec![self.base.laboratory.sat_samples],
        };
        let mut builds = Vec::new();
        for &storage in storages {
            for &build in &self.sat_builds {
                // A scan adds integers.
                if storage.is_integer() || build == SatBuild::Doubling {
                    builds.extend(samples_of(&build).into_iter().map(|samples| (storage, build, samples)));
                }
            }
        }
        builds
    }

    /// Every n with every MR, edge rule and order.
    pub(super) fn questions(&self) -> Vec<Search> {
        let mut questions = Vec::new();
        for &min_photons in &self.min_photons {
            for &max_radius in &self.max_radius {
                for &edges in &self.edges {
                    for &order in &self.searches {
                        questions.push(Search { min_photons, max_radius, edges, order });
                    }
                }
            }
        }
        questions
    }

    /// The question that bounds all others, for the map's bounds.
    pub(super) fn widest(&self) -> Search {
        Search {
            min_photons: self.min_photons.iter().copied().max().unwrap_or(1),
            max_radius: self.max_radius.iter().copied().max().unwrap_or(1),
            ..self.base.search
        }
    }

    /// Whether the same is asked, whatever the budget.
    pub(super) fn asks_the_same(&self, other: &Self) -> bool {
        let timeless = |settings: &Self| {
            let protocol = Protocol { budget_s: 0.0, ..settings.protocol };
            Self { protocol, ..settings.clone() }
        };
        timeless(self) == timeless(other)
    }
}

/// A map's identity in a file of results.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MapInfo {
    /// Its name.
    pub name: String,
    /// Columns and rows.
    pub size: [u32; 2],
    /// What distinguishes it from others of that name and size: a seed, a number of photons.
    pub origin: String,
}

/// A map to time with, made when its turn comes, so that large ones need not be in memory together.
pub struct MapSource {
    /// Its identity.
    pub info: MapInfo,
    make: Box<dyn Fn() -> Image<u32>>,
}

impl MapSource {
    /// A map that `make` makes, the same at each call.
    pub fn new(info: MapInfo, make: impl Fn() -> Image<u32> + 'static) -> Self {
        Self { info, make: Box::new(make) }
    }

    /// A map that is there already.
    #[must_use]
    pub fn given(name: impl Into<String>, counts: Image<u32>) -> Self {
        let origin = format!("{} photons", crate::summary::total_photons(&counts));
        let info = MapInfo { name: name.into(), size: counts.size().to_array(), origin };
        Self::new(info, move || counts.clone())
    }

    /// A seeded map of its kind's usual density.
    #[must_use]
    pub fn synthetic(kind: crate::synth::Kind, size: UVec2, seed: u64) -> Self {
        let density = kind.usual_density();
        let info = MapInfo {
            name: format!("{kind:?}").to_lowercase(),
            size: size.to_array(),
            origin: format!("seed {seed}, {density} photons a pixel"),
        };
        Self::new(info, move || crate::synth::map(kind, size, density, seed))
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        UVec2::from_array(self.info.size)
    }

    /// The counts.
    #[must_use]
    pub fn make(&self) -> Image<u32> {
        (self.make)()
    }
}

impl fmt::Debug for MapSource {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_tuple("MapSource").field(&self.info).finish()
    }
}
