//! Which radii the faults of the listings make wrong, and where a table in f32 breaks: on any map, without
//! OpenGL.

use std::collections::BTreeSet;

use glam::UVec2;

use crate::synth::{self, Kind};
use varikernel::error::Result;
use varikernel::image::Difference;
use varikernel::image::Image;
use varikernel::reference::{self, Inside, Radii, as_printed, enough, pyramid, total_area};
use varikernel::settings::{Edges, Faults, Order, SatSamples, Search, Split};

/// One fault, alone, and what it does to a map.
#[derive(Clone, Debug, PartialEq)]
pub struct FaultRow {
    /// The map, by its name.
    pub map: String,
    /// The field of [`Faults`], or `all`.
    pub fault: &'static str,
    /// Where the thesis has it.
    pub section: &'static str,
    /// Ours against the definition.
    pub difference: Difference,
}

/// A map that shows the faults which a square map dark at its borders hides: oblong, photons everywhere.
#[must_use]
pub fn oblong_map() -> Image<u32> {
    synth::map(Kind::Uniform, UVec2::new(512, 64), 0.5, 1)
}

/// The name of [`oblong_map`].
pub const OBLONG_MAP: &str = "a uniform map of 512 x 64";

/// Each fault alone and all of the table's together, on `density`; 4 samples a pass.
///
/// # Errors
/// None that a map can cause: both sides have its size.
pub fn fault_rows(density: &Image<u32>, map: &str, search: Search) -> Result<Vec<FaultRow>> {
    let none = Faults::NONE;
    let right = reference::radius_by_table(density, search);
    let table = |faults| as_printed::radius(density, search, SatSamples::Four, faults);
    let row = |fault, section, wrong: Radii| {
        let difference = Difference::between(&right.radius, &wrong.radius)?;
        Ok(FaultRow { map: map.to_owned(), fault, section, difference })
    };
    vec![
        row("clamp_to_63", "4.2", table(Faults { clamp_to_63: true, ..none })),
        row("border_test", "4.2", table(Faults { border_test: true, ..none })),
        row("corner_test", "4.2", table(Faults { corner_test: true, ..none })),
        row(
            "border_test + corner_test",
            "4.2",
            table(Faults { border_test: true, corner_test: true, ..none }),
        ),
        row("swapped_axes", "4.2", table(Faults { swapped_axes: true, ..none })),
        row("sample_stride", "4.2", table(Faults { sample_stride: true, ..none })),
        row("float_ratio", "4.4", table(Faults { float_ratio: true, ..none })),
        row(
            "forgotten_strip",
            "4.3",
            pyramid::radius(density, search, Split::Odd, Faults { forgotten_strip: true, ..none }),
        ),
        row("all of the table's", "4.2, 4.4", table(Faults { forgotten_strip: false, ..Faults::AS_PRINTED })),
    ]
    .into_iter()
    .collect()
}

/// Decisions at the brink that a rounded ratio gets wrong, and how many there are.
///
/// For each box up to `max_radius` and each area that an edge or a corner can leave of it inside the map: the
/// fewest photons that are enough, and one less.
#[must_use]
pub fn misjudged_by_float_ratio(max_radius: u32, min_photons: u32) -> (u64, u64) {
    let search = Search { min_photons, max_radius, edges: Edges::Scale, order: Order::Forward };
    let (mut wrong, mut all) = (0, 0);
    for radius in 1..=max_radius {
        let total = total_area(radius);
        let sides = || u64::from(radius) + 1..=2 * u64::from(radius) + 1;
        let areas: BTreeSet<u64> =
            sides().flat_map(|width| sides().map(move |height| width * height)).collect();
        for inside in areas {
            let fewest = (u64::from(min_photons) * inside).div_ceil(total);
            for photons in [fewest - 1, fewest] {
                let exact = enough(photons, total, inside, search);
                // Fewer than n photons fit.
                let photons = u32::try_from(photons).unwrap_or(u32::MAX);
                let rounded = as_printed::enough_by_float_ratio(photons, total, inside, min_photons);
                wrong += u64::from(exact != rounded);
                all += 1;
            }
        }
    }
    (wrong, all)
}

/// A table in f32 against the definition, at one total.
#[derive(Clone, Debug, PartialEq)]
pub struct FloatRow {
    /// What each count, and n, was multiplied by.
    pub factor: u32,
    /// Photons in the map.
    pub total: u64,
    /// The f32 table's radii against the definition's.
    pub difference: Difference,
}

/// The radii from a table of f32 sums, with each count of `density` and n multiplied by each of `factors`.
///
/// That multiplication changes no radius, so any difference is rounding. Powers of two would not change the
/// rounding either: take odd factors.
///
/// # Errors
/// None that a map can cause: both sides have its size.
pub fn float_rows(density: &Image<u32>, search: Search, factors: &[u32]) -> Result<Vec<FloatRow>> {
    let right = reference::radius_by_table(density, search);
    let rows = factors.iter().map(|&factor| {
        let map = density.map(|count| count.saturating_mul(factor));
        let search = Search { min_photons: search.min_photons.saturating_mul(factor), ..search };
        let radii = radius_by_float_table(&map, search);
        let difference = Difference::between(&right.radius, &radii)?;
        Ok(FloatRow { factor, total: crate::summary::total_photons(&map), difference })
    });
    rows.collect()
}

/// A binary search in a table that recursive doubling with two samples a pass sums in f32 (thesis 4.2).
fn radius_by_float_table(density: &Image<u32>, search: Search) -> Image<u32> {
    let table = float_table(density);
    let entry = |at: UVec2| if at.min_element() == 0 { 0.0 } else { table.at(at.x - 1, at.y - 1) };
    Image::from_fn(density.size(), |x, y| {
        let holds_enough = |radius| {
            let inside = Inside::of_box(density.size(), x, y, radius);
            let (lo, hi) = (inside.lo, inside.hi + 1);
            let photons =
                entry(hi) - entry(UVec2::new(lo.x, hi.y)) - entry(UVec2::new(hi.x, lo.y)) + entry(lo);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a sum of whole numbers, below zero only by rounding"
            )]
            let photons = photons.max(0.0) as u64;
            enough(photons, total_area(radius), inside.area(), search)
        };
        reference::binary_search(search.max_radius, holds_enough).unwrap_or(search.max_radius)
    })
}

fn float_table(density: &Image<u32>) -> Image<f32> {
    let size = density.size();
    #[expect(clippy::cast_precision_loss, reason = "the rounding of f32 is what is tested")]
    let mut table = density.map(|count| count as f32);
    for axis in [UVec2::X, UVec2::Y] {
        let mut step = 1;
        while step < size.dot(axis) {
            let before = table;
            table = Image::from_fn(size, |x, y| {
                let here = UVec2::new(x, y);
                let offset = axis * step;
                let reached = here.cmpge(offset).all();
                before.at(x, y) + if reached { before.at(x - offset.x, y - offset.y) } else { 0.0 }
            });
            step *= 2;
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEARCH: Search =
        Search { min_photons: 25, max_radius: 32, edges: Edges::Scale, order: Order::Binary };

    #[test]
    fn faults_spoil_what_they_are_said_to_spoil() {
        let wrong = |side| {
            let map = synth::map(Kind::Gradient, UVec2::splat(side), 2.0, 3);
            let rows = fault_rows(&map, "gradient", SEARCH).unwrap();
            rows.into_iter().map(|row| (row.fault, row.difference.wrong_pixels)).collect::<Vec<_>>()
        };
        let of = |rows: &[(&str, u64)], fault| rows.iter().find(|row| row.0 == fault).unwrap().1;
        let (small, large) = (wrong(64), wrong(96));
        assert_eq!(of(&small, "clamp_to_63"), 0, "63 is right for 64");
        assert!(of(&large, "clamp_to_63") > 1000);
        assert_eq!(of(&small, "swapped_axes"), 0, "the order of the axes does not matter for a square");
        assert!(of(&small, "sample_stride") > 1000);
        assert!(of(&small, "forgotten_strip") > 0);
        let rows = fault_rows(&oblong_map(), OBLONG_MAP, SEARCH).unwrap();
        let oblong: Vec<_> = rows.iter().map(|row| (row.fault, row.difference.wrong_pixels)).collect();
        assert!(of(&oblong, "border_test") > 0);
        assert!(of(&oblong, "swapped_axes") > 0, "64 columns' passes do not sum 512");
    }

    #[test]
    fn f32_is_exact_up_to_2_to_the_24_and_wrong_above() {
        let map = synth::map(Kind::Gradient, UVec2::splat(128), 0.5, 3);
        let rows = float_rows(&map, SEARCH, &[1, 2001, 65_537]).unwrap();
        assert!(rows[0].total < 1 << 24 && rows[1].total < 1 << 24 && rows[2].total > 1 << 24);
        assert!(rows[0].difference.is_none() && rows[1].difference.is_none());
        assert!(!rows[2].difference.is_none());
    }

    #[test]
    fn a_rounded_ratio_is_wrong_only_where_counts_outgrow_it() {
        assert_eq!(misjudged_by_float_ratio(32, 1000), (0, 12_242));
        // f32 does not hold n itself.
        assert!(misjudged_by_float_ratio(32, (1 << 26) + 1).0 > 0);
    }
}
