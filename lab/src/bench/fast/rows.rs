//! The rows of a map: what a case is called and what it runs, in one place for the run and for its targets.

use crate::bench::case::{Case, Stage};
use crate::bench::settings::MapInfo;
use crate::bench::situation::Situation;
use crate::bench::work::Work;
use varikernel::measure::Unit;
use varikernel::settings::{Edges, Laboratory, Order, SatBuild, SatSamples, Search, Settings};

/// All orders of a search in a table.
pub(super) const ORDERS: [Order; 3] = Order::ALL;
/// The thesis's.
const THESIS_ORDERS: [Order; 2] = [Order::Forward, Order::Binary];
/// The thesis's two builds.
const THESIS_SAMPLES: [SatSamples; 2] = [SatSamples::Two, SatSamples::Four];

/// Makes the rows of a map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows<'a> {
    pub(super) map: &'a MapInfo,
    pub(super) base: Settings,
}

impl Rows<'_> {
    pub(super) fn unit(self, unit: Unit) -> (Case, Work) {
        (Case::unit(unit, self.map), Work::Unit(unit))
    }

    /// By 2 samples, by 4, and by a scan. The binary search that checks them is one of the frames'.
    pub(super) fn builds(self) -> [(Case, Work); 3] {
        let search = self.question(Order::Binary, super::MAX_RADII[0], Edges::Scale);
        let [two, four] = THESIS_SAMPLES.map(|samples| doubling(search, samples));
        [two, four, search].map(|settings| self.row(Stage::Build, settings))
    }

    pub(super) fn search(self, order: Order, max_radius: u32, edges: Edges) -> (Case, Work) {
        self.row(Stage::Search, self.question(order, max_radius, edges))
    }

    /// The thesis's builds with its orders.
    pub(super) fn thesis_frames(self, max_radius: u32) -> Vec<(Case, Work)> {
        let orders = THESIS_ORDERS.map(|order| self.question(order, max_radius, Edges::Scale));
        let frames = THESIS_SAMPLES.into_iter().flat_map(|samples| orders.map(|of| doubling(of, samples)));
        frames.map(|settings| self.row(Stage::Frame, settings)).collect()
    }

    /// The scan with every order.
    pub(super) fn scan_frames(self, max_radius: u32) -> [(Case, Work); 3] {
        ORDERS.map(|order| self.row(Stage::Frame, self.question(order, max_radius, Edges::Scale)))
    }

    /// What the planner chooses.
    pub(super) fn planned(self, max_radius: u32) -> (Case, Work) {
        let settings = self.question(self.base.search.order, max_radius, Edges::Scale);
        (Case::planned(settings.search, self.map), Work::Planned(settings))
    }

    pub(super) fn situation(self, situation: Situation) -> (Case, Work) {
        let settings = self.question(Order::Bracketed, super::SITUATION_RADIUS, Edges::Scale);
        let settings = Settings { masked: situation.is_masked(), ..settings };
        (Case::of_situation(situation, &settings, self.map), Work::Situation(situation, settings))
    }

    fn row(self, stage: Stage, settings: Settings) -> (Case, Work) {
        (Case::of(stage, &settings, settings.storage, self.map), Work::Pipeline(settings))
    }

    /// A table by a scan.
    fn question(self, order: Order, max_radius: u32, edges: Edges) -> Settings {
        let search = Search { max_radius, edges, order, ..self.base.search };
        Settings {
            search,
            laboratory: Laboratory { sat_build: SatBuild::Scan, ..self.base.laboratory },
            ..self.base
        }
    }
}

fn doubling(settings: Settings, sat_samples: SatSamples) -> Settings {
    Settings {
        laboratory: Laboratory { sat_build: SatBuild::Doubling, sat_samples, ..settings.laboratory },
        ..settings
    }
}
