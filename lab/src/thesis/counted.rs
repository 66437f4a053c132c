//! Costs that need no clock: fetches, probes, passes and stack depths.
//!
//! A box of radius r is cut in as many ways as its corner has places against the blocks of the mipmap, so
//! counts are ranges over all places: every corner modulo the smallest power of two that is no smaller than
//! the box, and every pixel of a map on whose edges boxes are clipped.

use glam::UVec2;

use varikernel::reference::pyramid::{self, Cover};
use varikernel::reference::{Inside, total_area};
use varikernel::settings::{Faults, Split};

/// The largest radius of [`pyramid_costs`]: the thesis's MR.
pub const MAX_RADIUS: u32 = 32;
/// Side of the map on whose edges boxes are clipped.
const CLIPPED_MAP: u32 = 64;

/// What counting one box by a pyramid takes, over all its places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PyramidCost {
    /// The splitting rule.
    pub split: Split,
    /// Radius of the box.
    pub radius: u32,
    /// Fewest and most fetches of a box that no edge clips.
    pub fetches: (usize, usize),
    /// The deepest stack of a box that no edge clips.
    pub stack_depth: usize,
    /// The deepest stack in a 64 x 64 map, whose edges clip.
    pub stack_depth_clipped: usize,
    /// Fetches of brute force: (2 r + 1)².
    pub brute_force_fetches: u64,
}

impl PyramidCost {
    /// The deepest stack of all boxes, clipped or not.
    #[must_use]
    pub fn deepest_stack(&self) -> usize {
        self.stack_depth.max(self.stack_depth_clipped)
    }
}

/// The costs of both splitting rules for radii 1 to `max_radius`.
#[must_use]
pub fn pyramid_costs(max_radius: u32) -> Vec<PyramidCost> {
    let radii = 1..=max_radius;
    [Split::Odd, Split::Larger]
        .into_iter()
        .flat_map(|split| radii.clone().map(move |radius| pyramid_cost(radius, split)))
        .collect()
}

fn pyramid_cost(radius: u32, split: Split) -> PyramidCost {
    let side = 2 * radius + 1;
    let period = side.next_power_of_two();
    let mut fetches = (usize::MAX, 0);
    let mut stack_depth = 0;
    for lo in places(period) {
        let Cover { blocks, stack_depth: depth } =
            cover(Inside { lo, hi: lo + (side - 1) }, period.ilog2(), split);
        fetches = (fetches.0.min(blocks.len()), fetches.1.max(blocks.len()));
        stack_depth = stack_depth.max(depth);
    }
    let map = UVec2::splat(CLIPPED_MAP);
    let clipped = places(CLIPPED_MAP)
        .map(|at| cover(Inside::of_box(map, at.x, at.y, radius), CLIPPED_MAP.ilog2(), split).stack_depth);
    PyramidCost {
        split,
        radius,
        fetches,
        stack_depth,
        stack_depth_clipped: clipped.max().unwrap_or(0),
        brute_force_fetches: total_area(radius),
    }
}

fn places(side: u32) -> impl Iterator<Item = UVec2> {
    (0..side).flat_map(move |y| (0..side).map(move |x| UVec2::new(x, y)))
}

fn cover(inside: Inside, top_level: u32, split: Split) -> Cover {
    pyramid::cover(inside, top_level, split, Faults::NONE)
}

/// The largest radius up to which a stack of `entries` is enough, and the depth that the next radius needs
/// (none if all radii of `costs` fit).
#[must_use]
pub fn stack_is_enough_up_to(costs: &[PyramidCost], split: Split, entries: usize) -> (u32, Option<usize>) {
    let of_split = || costs.iter().filter(|cost| cost.split == split);
    match of_split().find(|cost| cost.deepest_stack() > entries) {
        Some(cost) => (cost.radius - 1, Some(cost.deepest_stack())),
        None => (of_split().map(|cost| cost.radius).max().unwrap_or(0), None),
    }
}

/// Fetches of brute force for a pixel of radius `radius`: every box up to it anew, Σ (2 r + 1)².
#[must_use]
pub fn brute_force_fetches(radius: u32) -> u64 {
    (1..=radius).map(total_area).sum()
}

/// Equation 3.1 as printed: Σ over r from 0 to r_max of Σ over i from 0 to r - 1 of 8 i.
///
/// The inner sum is the box of radius r - 1 without its middle, so it is one radius and one pixel short.
#[must_use]
pub fn equation_3_1(max_radius: u32) -> u64 {
    (0..=max_radius).map(|radius| (0..radius).map(|ring| 8 * u64::from(ring)).sum::<u64>()).sum()
}

/// Boxes that a binary search from 1 to `max_radius` counts at most: ⌈log2 MR⌉.
#[must_use]
pub fn binary_probes(max_radius: u32) -> u32 {
    max_radius.next_power_of_two().ilog2()
}

/// Passes that build a table of `side` x `side` with `samples` a pass, and the one before that copies the
/// map.
#[must_use]
pub fn table_passes(side: u32, samples: u32) -> u32 {
    let mut passes = 0;
    let mut done = 1_u64;
    while done < u64::from(side) {
        done *= u64::from(samples);
        passes += 1;
    }
    1 + 2 * passes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cost(radius: u32, split: Split) -> PyramidCost {
        pyramid_cost(radius, split)
    }

    #[test]
    fn fetches_that_geometry_settles() {
        // Three consecutive pixels hold one aligned pair, so 3 x 3 is a block of 2 x 2 and 5 pixels wherever
        // it is.
        assert_eq!(cost(1, Split::Odd).fetches, (6, 6));
        // 17 x 17 around an aligned 16 x 16 leaves 33 pixels.
        assert_eq!(cost(8, Split::Larger).fetches.0, 34);
        assert_eq!(cost(8, Split::Odd).fetches.0, 34);
        // 5 x 5 holds four aligned pairs each way, or one block of 4 x 4.
        assert_eq!(cost(2, Split::Odd).fetches, (10, 13));
    }

    #[test]
    fn sums_by_hand() {
        assert_eq!([1, 2, 3].map(brute_force_fetches), [9, 34, 83]);
        assert_eq!([1, 2, 3].map(equation_3_1), [0, 8, 32]);
        assert_eq!([1, 2, 32, 33, 256].map(binary_probes), [0, 1, 5, 6, 8]);
        assert_eq!((table_passes(512, 2), table_passes(512, 4), table_passes(1024, 4)), (19, 11, 11));
    }

    #[test]
    fn the_first_radius_that_overflows_is_found() {
        let costs = [1, 2, 3].map(|radius| PyramidCost {
            split: Split::Odd,
            radius,
            fetches: (1, 1),
            stack_depth: radius as usize,
            stack_depth_clipped: 1,
            brute_force_fetches: 1,
        });
        assert_eq!(stack_is_enough_up_to(&costs, Split::Odd, 2), (2, Some(3)));
        assert_eq!(stack_is_enough_up_to(&costs, Split::Odd, 3), (3, None));
    }
}
