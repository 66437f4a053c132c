//! The suite of the fast path: what a table built by a scan, a bracketed search and all that is skipped cost,
//! on maps that differ in where their photons are.
//!
//! | map | photons a pixel |
//! |---|---|
//! | `uniform-sparse` | 0.05, anywhere |
//! | `uniform-dense` | 10, anywhere |
//! | `caustic`, `step` | 10 on the average, as `varikernel synth` makes them |
//! | `mostly-empty` | 1 in the lower left quarter, anywhere in it, and none elsewhere |
//!
//! On every map: the units; the three orders in one table at MR 32 and 256, the bracketed one also at 512 and
//! with zero edges; frames of the thesis's four combinations, of the scan in each order, and of the planner's
//! choice. On the caustic alone: the three builds, also in other sizes, and the
//! [situations](super::Situation). n = 25, tables in u32.
//!
//! The [targets](Target) are ratios of medians of the same run.

mod rows;
mod targets;

use glam::UVec2;

use self::rows::{ORDERS, Rows};
use super::case::Case;
use super::rival;
use super::settings::{BenchSettings, MapInfo, MapSource, Protocol};
use super::situation::Situation;
use super::suite::FastSuite;
use super::work::Work;
use crate::rivals::Rival;
use crate::synth::{self, Kind};
use varikernel::image::Image;
use varikernel::measure::Unit;
use varikernel::settings::{Edges, Method, Order, SatSamples, Settings};

/// MR of every search and frame.
const MAX_RADII: [u32; 2] = [32, 256];
/// MR of bracketed searches, whose time should not depend on it.
const MORE_RADII: [u32; 3] = [32, 256, 512];
/// MR of situations.
const SITUATION_RADIUS: u32 = 32;
/// The map of builds and situations.
const CAUSTIC: &str = "caustic";
const SPARSE: &str = "uniform-sparse";
const MOSTLY_EMPTY: &str = "mostly-empty";
/// The seed of all maps.
const SEED: u64 = 1;

impl BenchSettings {
    /// The suite, without rivals.
    #[must_use]
    pub fn fast(suite: FastSuite, protocol: Protocol) -> Self {
        Self {
            methods: vec![Method::SummedAreaTable],
            sat_samples: vec![SatSamples::Two, SatSamples::Four],
            searches: ORDERS.to_vec(),
            max_radius: MORE_RADII.to_vec(),
            edges: vec![Edges::Scale, Edges::Zero],
            suite: Some(suite),
            ..Self::new(protocol)
        }
    }
}

impl FastSuite {
    /// The maps, small ones first.
    #[must_use]
    pub fn maps(&self) -> Vec<MapSource> {
        let mut maps: Vec<MapSource> = self.sizes.iter().flat_map(|&size| maps_of(size)).collect();
        let others = self.build_sizes.iter().filter(|size| !self.sizes.contains(size));
        maps.extend(others.map(|&size| synthetic(CAUSTIC, Kind::Caustic, size, 10.0)));
        maps.sort_by_key(|map| map.size().element_product());
        maps
    }

    /// Every case of a map, units first and rivals last.
    pub(super) fn cases(&self, settings: &BenchSettings, map: &MapInfo) -> Vec<(Case, Work)> {
        let rows = Rows { map, base: settings.base };
        let mut cases: Vec<(Case, Work)> = Unit::ALL.map(|unit| rows.unit(unit)).into();
        if map.name == CAUSTIC {
            cases.extend(rows.builds());
        }
        if !self.sizes.contains(&map.size) {
            return cases;
        }
        for radius in MAX_RADII {
            cases.extend(
                [Order::Forward, Order::Binary].map(|order| rows.search(order, radius, Edges::Scale)),
            );
        }
        for edges in [Edges::Scale, Edges::Zero] {
            cases.extend(MORE_RADII.map(|radius| rows.search(Order::Bracketed, radius, edges)));
        }
        for radius in MAX_RADII {
            cases.extend(rows.thesis_frames(radius));
            cases.extend(rows.scan_frames(radius));
            cases.push(rows.planned(radius));
        }
        if map.name == CAUSTIC {
            cases.extend(Situation::ALL.map(|situation| rows.situation(situation)));
        }
        cases.extend(rivals(settings, map));
        cases
    }
}

/// Every pipeline whose shaders are timed.
pub(super) fn pipelines(settings: &BenchSettings) -> Vec<Settings> {
    let mut pipelines = settings.pipelines();
    pipelines.push(Settings { masked: true, ..settings.base });
    pipelines
}

/// The scanlines at the questions of the frames; the tree, which supports zero edges only, at one.
fn rivals(settings: &BenchSettings, map: &MapInfo) -> Vec<(Case, Work)> {
    let asked = |rivals: Vec<Rival>, radii: &[u32], edges| {
        let (max_radius, edges) = (radii.to_vec(), vec![edges]);
        rival::cases(&BenchSettings { max_radius, edges, rivals, ..settings.clone() }, map)
    };
    let (trees, others) = settings.rivals.iter().partition(|rival| **rival == Rival::Kiddo);
    let mut cases = asked(others, &MAX_RADII, Edges::Scale);
    cases.extend(asked(trees, &[SITUATION_RADIUS], Edges::Zero));
    cases
}

fn maps_of(size: [u32; 2]) -> [MapSource; 5] {
    let empty = MapInfo {
        name: MOSTLY_EMPTY.to_owned(),
        size,
        origin: format!("seed {SEED}, 1 photon a pixel in the lower left quarter, uniform"),
    };
    [
        synthetic(SPARSE, Kind::Uniform, size, 0.05),
        synthetic("uniform-dense", Kind::Uniform, size, 10.0),
        synthetic(CAUSTIC, Kind::Caustic, size, 10.0),
        synthetic("step", Kind::Step, size, 10.0),
        MapSource::new(empty, move || mostly_empty(UVec2::from_array(size))),
    ]
}

fn synthetic(name: &str, kind: Kind, size: [u32; 2], density: f64) -> MapSource {
    let origin = format!("seed {SEED}, {density} photons a pixel, {}", format!("{kind:?}").to_lowercase());
    let info = MapInfo { name: name.to_owned(), size, origin };
    MapSource::new(info, move || synth::map(kind, UVec2::from_array(size), density, SEED))
}

fn mostly_empty(size: UVec2) -> Image<u32> {
    let quarter = synth::map(Kind::Uniform, (size + 1) / 2, 1.0, SEED);
    let end = quarter.size();
    Image::from_fn(size, |x, y| if x < end.x && y < end.y { quarter.at(x, y) } else { 0 })
}
