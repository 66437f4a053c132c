//! What Mesa's software renderers silently get wrong, refused or worked around before anything is allocated.
//!
//! llvmpipe ends the loops of a fragment after 65,535 turns in all. Its compiler counts the turns of all
//! loops of an invocation together (LP_MAX_TGSI_LOOP_ITERATIONS) and then leaves them, so a long search would
//! return a wrong radius. A forward search is therefore cut into passes over ranges of radii that stay below
//! the limit; what cannot be cut is refused.
//!
//! softpipe stores to an element of a shader's array with the first fragment's index for all four of a quad,
//! so the stack of a pyramid goes wrong where fragments differ; methods with a stack are refused.
//!
//! Other renderers have no such limits and search in one pass.

use std::collections::BTreeSet;
use std::ops::RangeInclusive;

use crate::error::{Error, Result};
use crate::gl::DeviceInfo;
use crate::radius::tables;
use crate::settings::{Matching, Method, Order, Rule, Settings, Variation};

const LLVMPIPE_TURNS: u64 = 65_535;

/// The ranges of radii that a search takes a pass each for, together 1 to MR.
///
/// # Errors
/// [`Error::Setting`] for the radius if the renderer would cut a pass short, for the method if it can't run
/// it.
pub(crate) fn passes(device: &DeviceInfo, settings: &Settings) -> Result<Vec<RangeInclusive<u32>>> {
    let has_stack = matches!(settings.method, Method::Pyramid | Method::AveragedMipmap);
    if device.is_softpipe() && has_stack {
        return Err(Error::Setting {
            name: "method",
            value: settings.method.name().to_owned(),
            reason:
                "it keeps a stack for each fragment, and softpipe stores to shader arrays wrongly; use the \
                     summed-area table, or another renderer"
                    .to_owned(),
        });
    }
    let max_radius = settings.search.max_radius;
    let has_short_loops = settings.method == Method::NaiveMipmap || settings.rule == Rule::Even;
    if !device.is_llvmpipe() || has_short_loops {
        return Ok(vec![1..=max_radius]);
    }
    let (ranges, most_turns) = match settings.search.order {
        Order::Forward => forward_ranges(settings),
        Order::Binary => (vec![1..=max_radius], binary_turns(settings)),
        // A few dozen turns for whatever MR.
        Order::Bracketed => (vec![1..=max_radius], 0),
    };
    if most_turns <= LLVMPIPE_TURNS {
        return Ok(ranges);
    }
    Err(Error::Setting {
        name: "max_radius",
        value: max_radius.to_string(),
        reason: format!(
            "a fragment of this search may loop {most_turns} times, and llvmpipe silently stops after \
             {LLVMPIPE_TURNS}; lower MR, search in forward order, or use the summed-area table"
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

/// The most turns that a group of fragments can take in a binary search.
///
/// llvmpipe counts the turns of a whole vector of fragments, which wait for each other: at each step the
/// dearest box that any of them may ask for, as long as any of them still searches, and one more box for the
/// mask.
fn binary_turns(settings: &Settings) -> u64 {
    let max_radius = settings.search.max_radius;
    let mut turns = turns_of_box(settings, max_radius);
    if max_radius == 1 {
        return turns;
    }
    // The ranges (first, last) that a fragment may be left with.
    let mut ranges: BTreeSet<(u32, u32)> = BTreeSet::from([(1, max_radius)]);
    while let Some(dearest) = ranges.iter().map(|&(first, last)| first.midpoint(last)).max() {
        turns += turns_of_box(settings, dearest);
        ranges = ranges
            .into_iter()
            .flat_map(|(first, last)| {
                let middle = first.midpoint(last);
                [(first, middle), (middle + 1, last)]
            })
            .filter(|(first, last)| first < last)
            .collect();
    }
    turns
}

/// Turns for one radius that a pass begins with: the search's own and those of the counter. The turn in which
/// a loop ends counts as well.
fn turns_of_box(settings: &Settings, radius: u32) -> u64 {
    let side = 2 * u64::from(radius) + 1;
    let matching = match settings.laboratory.matching {
        Matching::Modulo => u64::from(tables::largest_level(settings.search.max_radius)) + 1,
        Matching::Bits => 0,
    };
    2 + match settings.method {
        Method::BruteForce => match settings.laboratory.variation {
            // All rings up to this one, summed.
            Some(Variation::ReusedSums) => 1 + u64::from(radius) * u64::from(radius + 3),
            Some(Variation::FetchesAtOnce) => 1 + side * (2 + side.div_ceil(4)),
            _ => (side + 1) * (side + 1),
        },
        // Four strips, and blocks of at least 2 x 2 in the even rest of at most 2 r by 2 r.
        Method::Pyramid if settings.laboratory.variation == Some(Variation::WholeStrips) => {
            4 * (1 + side) + 1 + u64::from(radius).pow(2) * (1 + matching)
        }
        Method::Pyramid | Method::AveragedMipmap => 1 + tables::most_blocks(radius) * (1 + matching),
        Method::NaiveMipmap | Method::SummedAreaTable => 0,
    }
}

/// Turns for a radius that follows the one before it in the same pass.
fn turns_of_next_box(settings: &Settings, radius: u32) -> u64 {
    if settings.laboratory.variation == Some(Variation::ReusedSums) {
        2 + turns_of_ring(radius)
    } else {
        turns_of_box(settings, radius)
    }
}

/// Turns to add one ring to a sum: its own, 2 r along its sides, and the one that ends these.
fn turns_of_ring(radius: u32) -> u64 {
    2 + 2 * u64::from(radius)
}
