//! Which table, build and search suit a map: `--method auto`.
//!
//! Measured on llvmpipe at 64² to 2048² (`varikernel bench --suite fast`), in probe passes of the same size:
//!
//! - a table built by a scan costs less than one by doubling at every size, 3 to 6 copies against 8 to 34;
//! - a forward search costs about 0.9 for each radius that it tries, 1.5 to 2 where all are 1;
//! - a bracketed search costs about 2 where photons are dense, 2.7 elsewhere, and half as much again where
//!   scaled edges are near;
//! - a binary search costs log2 MR, and in maps of up to 128², which fit the processor's cache, three
//!   quarters or less of that, while the bracketed search's ten draws cost more there.
//!
//! Brute force wins only below 128², where all radii are 1, by an eighth; pyramids never do. So the decision
//! is for one of three searches in one table. How long a forward search takes is told by the photons of each
//! tile: in a tile with c photons in an area a, a box of radius r holds n where (2 r + 1)² c = n a, on the
//! average.

use std::fmt::Write as _;

use glam::UVec2;

use super::census::{Census, tiles};
use crate::maps::exactness::{self, CountBounds};
use crate::settings::{Edges, Laboratory, Order, Search, Settings};

/// The decision of the planner, and why.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Decision {
    /// The settings asked for, with method, build and order of the search filled in.
    pub settings: Settings,
    /// A sentence with the figures that decided.
    pub reason: String,
}

/// The most pixels of a map that a processor's cache holds with its table.
const SMALL: u32 = 128 * 128;

/// Decides on method, build and order for a map of `map_size` with counts within `bounds`; `census` tells of
/// the map or of one much like it, as that of the frame before.
///
/// The question (n, MR, edges) and all that does not decide speed stay as they are in `settings`.
#[must_use]
pub fn decide(
    settings: &Settings,
    map_size: UVec2,
    census: Option<&Census>,
    bounds: CountBounds,
) -> Decision {
    let usual = Settings::default();
    let in_order = |order| Settings {
        search: Search { order, ..settings.search },
        method: usual.method,
        storage: usual.storage,
        laboratory: Laboratory {
            sat_build: usual.laboratory.sat_build,
            variation: None,
            ..settings.laboratory
        },
        ..*settings
    };
    let is_exact = |order| exactness::plan(&in_order(order), map_size, bounds).is_ok();
    let (order, reason) = match census {
        _ if !is_exact(Order::Bracketed) && is_exact(Order::Binary) => (
            Order::Binary,
            "so many photons are in the map that the larger boxes of a bracketed search might not be exact"
                .to_owned(),
        ),
        None => (
            Order::Bracketed,
            "nothing is known of the photons, and a bracketed search costs much the same for any".to_owned(),
        ),
        Some(census) => cheapest(settings.search, map_size, census),
    };
    tracing::debug!(?order, reason, "planned");
    Decision { settings: in_order(order), reason }
}

/// The order that costs least, in probe passes, by the figures at the head of this file.
fn cheapest(search: Search, map_size: UVec2, census: &Census) -> (Order, String) {
    let radius = census.expected_radius(search);
    let dense = census.dense_share(search);
    let is_small = map_size.x.saturating_mul(map_size.y) <= SMALL;
    let halvings = f64::from(search.max_radius.next_power_of_two().ilog2());
    let forward = 0.6 + 0.9 * radius;
    let binary = (0.3 + halvings) * if is_small { 0.7 } else { 1.0 };
    // Tiles on the map's border, and the next if radii are large, may have scaled counts.
    let tiles = tiles(map_size).as_dvec2();
    let inner = ((tiles - 2.0).max(glam::DVec2::ZERO) / tiles).element_product();
    let elsewhere = if search.edges == Edges::Scale { 2.7 * inner + 4.0 * (1.0 - inner) } else { 2.7 };
    let bracketed = 1.9 * dense + elsewhere * (1.0 - dense);
    let orders = [(Order::Forward, forward), (Order::Binary, binary), (Order::Bracketed, bracketed)];
    let (order, _) =
        orders.into_iter().fold(orders[2], |best, next| if next.1 < best.1 { next } else { best });
    let mut reason = format!(
        "radii of about {radius:.1} are expected, {:.0} % of the map is dense; in probe passes, ",
        100.0 * dense
    );
    write!(reason, "forward {forward:.1}, binary {binary:.1}, bracketed {bracketed:.1}")
        .expect("writing to a string");
    (order, reason)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Image;

    fn order_of(density: &Image<u32>, max_radius: u32) -> Order {
        let usual = Settings::default();
        let settings = Settings { search: Search { max_radius, ..usual.search }, ..usual };
        decide(
            &settings,
            density.size(),
            Some(&Census::of(density)),
            CountBounds::of(density, settings.search),
        )
        .settings
        .search
        .order
    }

    #[test]
    fn dense_maps_go_forward_and_sparse_ones_are_bracketed() {
        let size = UVec2::splat(256);
        assert_eq!(order_of(&Image::filled(size, 10), 32), Order::Forward);
        assert_eq!(
            order_of(&Image::from_fn(size, |x, y| u32::from(x % 8 + y % 8 == 0)), 256),
            Order::Bracketed
        );
        assert_eq!(order_of(&Image::filled(size, 0), 256), Order::Bracketed);
        // Half dense, half dark.
        assert_eq!(
            order_of(&Image::from_fn(size, |x, _| if x < 128 { 0 } else { 20 }), 32),
            Order::Bracketed
        );
        // In a small map, five boxes cost less than ten draws.
        let thin = |x, y| u32::from(x % 8 + y % 8 == 0);
        assert_eq!(order_of(&Image::from_fn(UVec2::splat(64), thin), 32), Order::Binary);
        assert_eq!(order_of(&Image::filled(UVec2::new(1, 1), 1), 32), Order::Forward);
    }

    #[test]
    fn without_a_census_the_decision_is_the_one_that_never_costs_much() {
        let decision = decide(&Settings::thesis(), UVec2::splat(512), None, CountBounds::UNKNOWN);
        assert_eq!(decision.settings.search.order, Order::Bracketed);
        decision.settings.validate().expect("possible settings");
    }

    #[test]
    fn a_map_too_full_for_brackets_is_halved() {
        // A box of MR holds less than 2^32, one of MR + 32 more; clamped to n as well.
        let full = Image::filled(UVec2::splat(100), 2_000_000);
        let usual = Settings::default();
        let search = Search { min_photons: 2_000_000, max_radius: 10, ..usual.search };
        let bounds = CountBounds::of(&full, search);
        let decision = decide(&Settings { search, ..usual }, full.size(), Some(&Census::of(&full)), bounds);
        assert_eq!(decision.settings.search.order, Order::Binary, "{}", decision.reason);
    }
}
