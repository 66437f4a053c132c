//! The definition for large maps: an exact table of u64 sums, and a binary search.

use super::{Inside, Radii, enough, total_area};
use crate::image::Image;
use crate::settings::Search;

/// Sums of all counts before each column and row: exact for any u32 map that fits in memory.
#[derive(Debug)]
pub struct Table {
    /// One column and row more than the map: entry (x, y) sums the columns below x and the rows below y.
    sums: Image<u64>,
}

impl Table {
    /// Sums `density` once.
    #[must_use]
    pub fn new(density: &Image<u32>) -> Self {
        let mut sums = Image::filled(density.size() + 1, 0_u64);
        for y in 0..density.size().y {
            let mut row = 0;
            for x in 0..density.size().x {
                row += u64::from(density.at(x, y));
                sums.set(x + 1, y + 1, sums.at(x + 1, y) + row);
            }
        }
        Self { sums }
    }

    /// The photons in `inside`.
    #[must_use]
    pub fn count(&self, inside: Inside) -> u64 {
        let (lo, hi) = (inside.lo, inside.hi + 1);
        // The differences are not negative in this order.
        (self.sums.at(hi.x, hi.y) - self.sums.at(lo.x, hi.y))
            - (self.sums.at(hi.x, lo.y) - self.sums.at(lo.x, lo.y))
    }

    /// The most photons that a box of `radius` around any pixel holds.
    #[must_use]
    pub fn densest_box(&self, radius: u32) -> u64 {
        let size = self.sums.size() - 1;
        let pixels = (0..size.y).flat_map(|y| (0..size.x).map(move |x| (x, y)));
        pixels.map(|(x, y)| self.count(Inside::of_box(size, x, y, radius))).max().unwrap_or(0)
    }
}

/// Halves the range from 1 to `max_radius`, as thesis 3.5; nothing if what is left does not hold enough
/// either.
pub fn binary_search(max_radius: u32, holds_enough: impl Fn(u32) -> bool) -> Option<u32> {
    let (mut first, mut last) = (1, max_radius);
    while first < last {
        let middle = first.midpoint(last);
        if holds_enough(middle) {
            last = middle;
        } else {
            first = middle + 1;
        }
    }
    holds_enough(first).then_some(first)
}

/// Equal to [`radius`](super::radius) on every map, in O(log MR) a pixel.
///
/// Both edge rules are monotone in the radius, so halving the range finds the same radius: with zero the
/// count only grows, and with scale a box that holds n of its share at one radius does so at the next
/// (`tests/reference.rs` compares them).
#[must_use]
pub fn radius_by_table(density: &Image<u32>, search: Search) -> Radii {
    let table = Table::new(density);
    Radii::from_fn(density.size(), search.max_radius, |x, y| {
        let holds_enough = |radius| {
            let inside = Inside::of_box(density.size(), x, y, radius);
            enough(table.count(inside), total_area(radius), inside.area(), search)
        };
        binary_search(search.max_radius, holds_enough)
    })
}
