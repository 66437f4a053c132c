//! llvmpipe ends the loops of a fragment after 65,535 turns in all, and says nothing.
//!
//! Mesa's compiler counts the turns of all loops of an invocation together (LP_MAX_TGSI_LOOP_ITERATIONS) and then
//! leaves them, so a long search would return a wrong radius. A forward search is therefore cut into passes over ranges
//! of radii that stay below the limit; what cannot be cut is refused before anything is allocated. Other renderers
//! have no such limit and search in one pass.

use std::ops::RangeInclusive;

use crate::error::{Error, Result};
use crate::gl::DeviceInfo;
use crate::settings::{Matching, Method, Order, Settings, Variation};
use crate::structure;

const LLVMPIPE_TURNS: u64 = 65_535;

/// The ranges of radii that a search takes a pass each for, together 1 to MR.
///
/// # Errors
/// [`Error::Setting`] for the radius if the renderer would cut a pass short.
pub(crate) fn passes(device: &DeviceInfo, settings: &Settings) -> Result<Vec<RangeInclusive<u32>>> {
    let max_radius = settings.search.max_radius;
    if !device.is_llvmpipe() || settings.method == Method::NaiveMipmap {
        return Ok(vec![1..=max_radius]);
    }
    let (ranges, most_turns) = match settings.search.order {
        Order::Forward => forward_ranges(settings),
        Order::Binary => (vec![1..=max_radius], binary_turns(settings)),
    };
    if most_turns <= LLVMPIPE_TURNS {
        return Ok(ranges);
    }
    Err(Error::Setting {
        name: "max_radius",
        value: max_radius.to_string(),
        reason: format!(
            "a fragment of this search may loop {most_turns} times, and llvmpipe silently stops after \
             {LLVMPIPE_TURNS}; lower MR or use the summed-area table"
        ),
    })
}

/// As few ranges as keep below the limit, and the most turns of any.
fn forward_ranges(settings: &Settings) -> (Vec<RangeInclusive<u32>>, u64) {
    let (mut ranges, mut most_turns) = (Vec::new(), 0);
    let (mut first, mut turns) = (1, 0);
    for radius in 1..=settings.search.max_radius {
        let of_next_box = turns_of_next_box(settings, radius);
        if radius > first && turns + of_next_box <= LLVMPIPE_TURNS {
            turns += of_next_box;
        } else {
            if radius > first {
                ranges.push(first..=radius - 1);
            }
            (first, turns) = (radius, turns_of_box(settings, radius));
        }
        most_turns = most_turns.max(turns);
    }
    ranges.push(first..=settings.search.max_radius);
    (ranges, most_turns)
}

/// Turns of a binary search in which no radius is enough, the longest there is, and of one more count for the mask.
fn binary_turns(settings: &Settings) -> u64 {
    let max_radius = settings.search.max_radius;
    let (mut first, mut turns) = (1, turns_of_box(settings, max_radius));
    while first < max_radius {
        let middle = first.midpoint(max_radius);
        turns += turns_of_box(settings, middle);
        first = middle + 1;
    }
    turns
}

/// Turns for one radius that a pass begins with: the search's own and those of the counter.
fn turns_of_box(settings: &Settings, radius: u32) -> u64 {
    let side = 2 * u64::from(radius) + 1;
    let matching = match settings.matching {
        Matching::Modulo => u64::from(structure::largest_level(settings.search.max_radius)),
        Matching::Bits => 0,
    };
    1 + match settings.method {
        Method::BruteForce => match settings.variation {
            // All rings up to this one, summed.
            Some(Variation::ReusedSums) => 1 + u64::from(radius) * u64::from(radius + 3),
            Some(Variation::FetchesAtOnce) => 1 + side * (2 + side.div_ceil(4)),
            _ => side + side * side,
        },
        // Four strips, and blocks of at least 2 x 2 in the even rest of at most 2 r by 2 r.
        Method::Pyramid if settings.variation == Some(Variation::WholeStrips) => {
            4 * (1 + side) + 1 + u64::from(radius).pow(2) * (1 + matching)
        }
        Method::Pyramid | Method::AveragedMipmap => structure::most_blocks(radius) * (1 + matching),
        Method::NaiveMipmap | Method::SummedAreaTable => 0,
    }
}

/// Turns for a radius that follows the one before it in the same pass.
fn turns_of_next_box(settings: &Settings, radius: u32) -> u64 {
    if settings.variation == Some(Variation::ReusedSums) {
        2 + turns_of_ring(radius)
    } else {
        turns_of_box(settings, radius)
    }
}

/// Turns to add one ring to a sum: its own, 2 r along its sides, and the one that ends these.
fn turns_of_ring(radius: u32) -> u64 {
    2 + 2 * u64::from(radius)
}
