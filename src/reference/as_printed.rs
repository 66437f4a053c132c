//! What the listings of 4.2 compute as they are printed, reads outside the texture giving 0.
//!
//! The faults are those of [`Faults`]; without any, this is the definition again.

use glam::{IVec2, UVec2};

use super::{Inside, Radii, binary_search, enough, total_area};
use crate::image::Image;
use crate::settings::{Edges, Faults, Order, SatSamples, Search};

/// The table that the generation listing builds, in wrapping u32.
#[must_use]
pub fn summed_area_table(density: &Image<u32>, samples: SatSamples, faults: Faults) -> Image<u32> {
    let size = density.size();
    let samples = samples.count();
    let axes = if faults.swapped_axes { [IVec2::Y, IVec2::X] } else { [IVec2::X, IVec2::Y] };
    let mut table = density.clone();
    for (axis, side) in axes.into_iter().zip([size.x, size.y]) {
        for pass in (0..).take_while(|&pass| samples.pow(pass) < side) {
            let stride = samples.pow(pass).cast_signed();
            let offsets: Vec<IVec2> = if faults.sample_stride && samples > 2 {
                let first = axis * (1 << pass);
                let added = (1..samples.cast_signed()).map(|i| first + IVec2::X * (i * stride));
                std::iter::once(first).chain(added).collect()
            } else {
                (1..samples.cast_signed()).map(|i| axis * (i * stride)).collect()
            };
            let before = table;
            table = Image::from_fn(size, |x, y| {
                let here = UVec2::new(x, y).as_ivec2();
                let added = offsets.iter().map(|&offset| fetch(&before, here - offset));
                added.fold(before.at(x, y), u32::wrapping_add)
            });
        }
    }
    table
}

/// The radii that the sampling listing finds in the table of the generation listing.
///
/// Counts are no longer monotone in the radius, so the order of the search matters.
#[must_use]
pub fn radius(density: &Image<u32>, search: Search, samples: SatSamples, faults: Faults) -> Radii {
    let size = density.size();
    let table = summed_area_table(density, samples, faults);
    Radii::from_fn(size, search.max_radius, |x, y| {
        let holds_enough = |radius: u32| {
            let center = UVec2::new(x, y).as_ivec2();
            let radius_i = radius.cast_signed();
            let photons = sample(&table, center - radius_i, center + radius_i, faults);
            let inside = Inside::of_box(size, x, y, radius);
            if faults.float_ratio && search.edges == Edges::Scale {
                enough_by_float_ratio(photons, total_area(radius), inside.area(), search.min_photons)
            } else {
                enough(u64::from(photons), total_area(radius), inside.area(), search)
            }
        };
        match search.order {
            Order::Forward => (1..=search.max_radius).find(|&radius| holds_enough(radius)),
            Order::Binary | Order::Bracketed => binary_search(search.max_radius, holds_enough),
        }
    })
}

/// Section 4.4 word by word: outside area over inside area, clamped to 0, scales the sum, all in f32.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "the rounding of f32 is what is reproduced")]
pub fn enough_by_float_ratio(photons: u32, total: u64, inside: u64, min_photons: u32) -> bool {
    let ratio = ((total - inside) as f32 / inside as f32).max(0.0);
    photons as f32 + photons as f32 * ratio >= min_photons as f32
}

/// The sampling listing for the box from `lo` to `hi`, both included, neither clipped.
fn sample(table: &Image<u32>, lo: IVec2, hi: IVec2, faults: Faults) -> u32 {
    let last = if faults.clamp_to_63 { IVec2::splat(63) } else { table.size().as_ivec2() - 1 };
    let clamped = |x, y| fetch(table, IVec2::new(x, y).clamp(IVec2::ZERO, last));
    let (ll, ur) = (lo - 1, hi);
    let cut = |coordinate: i32| if faults.border_test { coordinate > 0 } else { coordinate >= 0 };
    let corner = if faults.corner_test { !(ll.x < 0 && ll.y < 0) } else { cut(ll.x) && cut(ll.y) };

    let mut value = clamped(ur.x, ur.y);
    if cut(ll.x) {
        value = value.wrapping_sub(clamped(ll.x, ur.y));
    }
    if cut(ll.y) {
        value = value.wrapping_sub(clamped(ur.x, ll.y));
    }
    if corner {
        value = value.wrapping_add(fetch(table, ll));
    }
    // The listing's value is an int, and below zero is no photon; the corrected sampling counts in uint.
    if faults.in_table_sampling() { value.cast_signed().max(0).cast_unsigned() } else { value }
}

/// The entry, or 0 outside.
fn fetch(table: &Image<u32>, at: IVec2) -> u32 {
    let inside = at.cmpge(IVec2::ZERO).all() && at.cmplt(table.size().as_ivec2()).all();
    if inside { table.at(at.x.cast_unsigned(), at.y.cast_unsigned()) } else { 0 }
}
