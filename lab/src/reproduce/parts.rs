//! The timing runs behind the thesis's tables, and which of their rows each cell is.

use glam::UVec2;

use super::RunFile;
use crate::bench::{BenchSettings, Case, MapInfo, MapSource, Protocol, Report, Run, Stage};
use crate::summary::RadiusSummary;
use crate::synth::{self, Kind};
use crate::thesis::density::{self, SEARCH};
use crate::thesis::evidence::OrderPoint;
use crate::thesis::quantity::{Measured, Measurements, Quantity, Timing};
use crate::thesis::tables;
use varikernel::image::Image;
use varikernel::reference;
use varikernel::settings::{Edges, Method, Order, SatBuild, SatSamples, Settings};

/// The seed of every map.
const SEED: u64 = 1;
/// The map whose density is inferred from the thesis.
const THESIS_LIKE: &str = "thesis-like";
/// Largest side that the pyramid was timed at (A.2).
const PYRAMID_SIDE: u32 = 512;
/// Photons a pixel of the maps on which the orders cross, and their side.
const ORDER_DENSITIES: [f64; 6] = [8.0, 2.0, 0.5, 0.25, 0.125, 0.03125];
const ORDER_SIDE: u32 = 256;

const SAT: &str = "sat";
const PYRAMID: &str = "pyramid";
const BRUTE_FORCE: &str = "brute force";
const MIPMAP_BUILD: &str = "mipmap build";
const MAX_RADIUS: &str = "max radius";
const ORDERS: &str = "orders";
const OTHER_MAPS: &str = "other maps";

/// One timing run.
#[derive(Debug)]
pub struct Part {
    /// Its name in `run.json`.
    pub name: &'static str,
    /// Its share of the budget, against those of the others.
    pub share: f64,
    /// Its maps.
    pub maps: Vec<MapSource>,
    methods: Vec<Method>,
    sat_samples: Vec<SatSamples>,
    searches: Vec<Order>,
    max_radius: Vec<u32>,
}

impl Part {
    /// The settings of its run: the thesis's, for these methods.
    pub(super) fn settings(&self, protocol: Protocol) -> BenchSettings {
        BenchSettings {
            methods: self.methods.clone(),
            sat_builds: vec![SatBuild::Doubling],
            storages: Vec::new(),
            sat_samples: self.sat_samples.clone(),
            searches: self.searches.clone(),
            min_photons: vec![SEARCH.min_photons],
            max_radius: self.max_radius.clone(),
            edges: vec![Edges::Scale],
            rivals: Vec::new(),
            suite: None,
            base: Settings::thesis(),
            protocol,
        }
    }
}

/// All parts; cheap ones first, so that a short budget leaves out the expensive ones.
pub(super) fn all(real_map: &Image<u32>, real_name: &str) -> Vec<Part> {
    let thesis_like: Vec<(MapInfo, Image<u32>)> = density::infer()
        .into_iter()
        .map(|inference| {
            let size = UVec2::splat(inference.size);
            let made = density::matching_map(size, inference.mean_radius, SEED);
            let origin = format!(
                "seed {SEED}, {:.5} photons a pixel, mean radius {:.3} for {:.3} inferred",
                made.density, made.mean_radius, inference.mean_radius
            );
            (MapInfo { name: THESIS_LIKE.to_owned(), size: size.to_array(), origin }, made.map)
        })
        .collect();
    let sizes = |wanted: &dyn Fn(u32) -> bool| -> Vec<MapSource> {
        let chosen = thesis_like.iter().filter(|(info, _)| wanted(info.size[0])).cloned();
        chosen.map(|(info, map)| MapSource::new(info, move || map.clone())).collect()
    };
    let part = |name, share, maps, methods: &[Method]| Part {
        name,
        share,
        maps,
        methods: methods.to_vec(),
        sat_samples: vec![SatSamples::Two, SatSamples::Four],
        searches: vec![Order::Forward, Order::Binary],
        max_radius: vec![SEARCH.max_radius],
    };
    let table = [Method::SummedAreaTable];
    let others = [
        MapSource::synthetic(Kind::Sparse, UVec2::splat(512), SEED),
        MapSource::synthetic(Kind::Uniform, UVec2::splat(512), SEED),
        MapSource::given(real_name, real_map.clone()),
    ];
    vec![
        part(SAT, 30.0, sizes(&|_| true), &table),
        Part {
            sat_samples: vec![SatSamples::Four],
            searches: vec![Order::Binary],
            max_radius: vec![32, 64, 128, 256],
            ..part(MAX_RADIUS, 6.0, sizes(&|side| side == 512), &table)
        },
        Part {
            searches: vec![Order::Forward],
            ..part(MIPMAP_BUILD, 4.0, sizes(&|_| true), &[Method::NaiveMipmap])
        },
        Part {
            sat_samples: vec![SatSamples::Four],
            ..part(ORDERS, 8.0, ORDER_DENSITIES.map(order_map).into(), &table)
        },
        part(OTHER_MAPS, 8.0, others.into(), &table),
        part(PYRAMID, 28.0, sizes(&|side| side <= PYRAMID_SIDE), &[Method::Pyramid]),
        Part {
            searches: vec![Order::Forward],
            ..part(BRUTE_FORCE, 20.0, sizes(&|_| true), &[Method::BruteForce])
        },
    ]
}

/// A uniform map; its origin holds the mean radius, which [`orders`] reads again.
fn order_map(density: f64) -> MapSource {
    let map = synth::map(Kind::Uniform, UVec2::splat(ORDER_SIDE), density, SEED);
    let mean = RadiusSummary::of(&reference::radius_by_table(&map, SEARCH)).mean;
    let info = MapInfo {
        name: format!("uniform {density}"),
        size: map.size().to_array(),
        origin: format!("seed {SEED}, mean radius {mean}"),
    };
    MapSource::new(info, move || map.clone())
}

/// The run of a stage on the map of a part that `is_it` picks.
fn find(report: &Report, stage: Stage, is_it: impl Fn(&Case) -> bool) -> Option<&Run> {
    report.runs.iter().find(|run| run.case.stage == stage && is_it(&run.case))
}

/// The part, the stage and the rest of a cell's row.
fn place(quantity: Quantity) -> (&'static str, Stage, Option<Order>, Option<SatSamples>) {
    match quantity {
        Quantity::PyramidBuild => (MIPMAP_BUILD, Stage::Build, None, None),
        Quantity::PyramidFrame(order) => (PYRAMID, Stage::Frame, Some(order), None),
        Quantity::SatFrame(samples, order) => (SAT, Stage::Frame, Some(order), Some(samples)),
        Quantity::SatBuild(samples) => (SAT, Stage::Build, None, Some(samples)),
        Quantity::SatSearch(order) => (SAT, Stage::Search, Some(order), None),
        Quantity::SatSearchByMaxRadius => (MAX_RADIUS, Stage::Search, Some(Order::Binary), None),
        Quantity::BruteForce => (BRUTE_FORCE, Stage::Frame, Some(Order::Forward), None),
    }
}

/// Every cell of the tables.
#[must_use]
pub fn measurements(run: &RunFile) -> Measurements {
    let cell = |(quantity, row)| Measured { quantity, row, timing: timing(run, quantity, row) };
    Measurements(tables::cells().into_iter().map(cell).collect())
}

fn timing(run: &RunFile, quantity: Quantity, row: u32) -> Timing {
    let (name, stage, order, samples) = place(quantity);
    let by_radius = quantity == Quantity::SatSearchByMaxRadius;
    let is_it = |case: &Case| {
        (case.size[0] == row || by_radius)
            && (case.max_radius == Some(row) || !by_radius)
            && (case.search == order || order.is_none())
            && (case.sat_samples == samples || samples.is_none())
            && case.method.is_some()
    };
    let Some(part) = run.part(name) else { return Timing::NotRun("the budget ended before".to_owned()) };
    match find(&part.report, stage, is_it) {
        Some(run) if run.is_wrong() => {
            Timing::NotRun(format!("its answer was wrong in {} pixels", run.wrong_pixels))
        }
        Some(run) => Timing::Median { ms: run.statistics.median_ms, copies: run.copies },
        None => {
            let mut left_out = part.report.left_out.iter();
            let reason = left_out.find(|left| left.case.stage == stage && is_it(&left.case));
            Timing::NotRun(reason.map_or("the budget ended before".to_owned(), |left| left.reason.clone()))
        }
    }
}

/// Forward against binary, by falling density.
#[must_use]
pub fn orders(run: &RunFile) -> Vec<OrderPoint> {
    let Some(part) = run.part(ORDERS) else { return Vec::new() };
    let median = |map: &MapInfo, order| {
        let run =
            find(&part.report, Stage::Search, |case| case.map == map.name && case.search == Some(order))?;
        (!run.is_wrong()).then_some(run.statistics.median_ms)
    };
    let point = |map: &MapInfo| {
        Some(OrderPoint {
            mean_radius: map.origin.rsplit(' ').next()?.parse().ok()?,
            forward_ms: median(map, Order::Forward)?,
            binary_ms: median(map, Order::Binary)?,
        })
    };
    part.report.maps.iter().filter_map(point).collect()
}

/// The table's times on one of the maps beside the thesis-like ones.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherMap {
    /// The map.
    pub map: MapInfo,
    /// What was timed, and its median in milliseconds and copies.
    pub times: Vec<(String, f64, Option<f64>)>,
}

/// The sparse, the dense and the real map beside the thesis-like ones.
#[must_use]
pub fn other_maps(run: &RunFile) -> Vec<OtherMap> {
    let Some(part) = run.part(OTHER_MAPS) else { return Vec::new() };
    let of_map = |map: &MapInfo| {
        let wanted = [Stage::Build, Stage::Search, Stage::Frame];
        let runs =
            part.report.runs.iter().filter(|run| {
                run.case.map == map.name && wanted.contains(&run.case.stage) && !run.is_wrong()
            });
        let times = runs.map(|run| {
            let order = run.case.search.map_or_else(String::new, |order| format!(" {}", order.name()));
            let name = format!("{} {}{order}", run.case.stage.name(), run.case.variant);
            (name, run.statistics.median_ms, run.copies)
        });
        OtherMap { map: map.clone(), times: times.collect() }
    };
    part.report.maps.iter().map(of_map).collect()
}

/// The parts that a claim's evidence comes from.
pub(super) fn of_claim(id: &str) -> &'static [&'static str] {
    match id {
        "sat-fastest" => &[SAT, PYRAMID, BRUTE_FORCE],
        "sat-four-samples" | "sat-cheap" | "parts-and-whole" => &[SAT],
        "pyramid-build-flat" => &[MIPMAP_BUILD],
        "brute-force-linear" | "brute-force-interactive" => &[BRUTE_FORCE],
        "pyramid-slower" | "pyramid-growth" => &[PYRAMID, BRUTE_FORCE],
        "pyramid-forward" => &[PYRAMID],
        "search-crossing" | "future-densities" => &[ORDERS],
        "binary-log" => &[MAX_RADIUS],
        _ => &[],
    }
}
