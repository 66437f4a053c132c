//! The naive mipmap's result (thesis 3.3.1), which is not the definition.

use glam::UVec2;

use super::{Inside, Radii, Table, enough};
use crate::image::Image;
use crate::settings::Search;

/// For each pixel, half the side of the smallest power-of-two block around it that holds enough; MR where
/// none of half-side below MR, nor the next one, does.
///
/// Level 1 has radius 1, level l has radius 2^(l-1), and the last level tried counts as MR.
#[must_use]
pub fn naive_mipmap(density: &Image<u32>, search: Search) -> Radii {
    let table = Table::new(density);
    let last = density.size() - 1;
    Radii::from_fn(density.size(), search.max_radius, |x, y| {
        for level in 1.. {
            let side = 1_u32 << level;
            let radius = (side / 2).min(search.max_radius);
            let lo = UVec2::new(x, y) / side * side;
            let inside = Inside { lo, hi: (lo + (side - 1)).min(last) };
            let total = u64::from(side) * u64::from(side);
            if enough(table.count(inside), total, inside.area(), search) {
                return Some(radius);
            }
            if radius == search.max_radius {
                return None;
            }
        }
        None
    })
}
