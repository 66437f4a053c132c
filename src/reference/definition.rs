//! The definition of a radius map, as nested loops.

use super::{Inside, Radii, total_area};
use crate::image::Image;
use crate::settings::{Edges, Search};

/// For each pixel, the smallest radius from 1 to MR whose box holds at least n photons; MR where none does
/// (thesis 1.3, 3.1, 3.2).
#[must_use]
pub fn radius(density: &Image<u32>, search: Search) -> Radii {
    Radii::from_fn(density.size(), search.max_radius, |x, y| {
        (1..=search.max_radius).find(|&radius| {
            let inside = Inside::of_box(density.size(), x, y, radius);
            let mut photons = 0;
            for row in inside.lo.y..=inside.hi.y {
                for column in inside.lo.x..=inside.hi.x {
                    photons += u64::from(density.at(column, row));
                }
            }
            enough(photons, total_area(radius), inside.area(), search)
        })
    })
}

/// Whether `photons` inside the map are enough for a box of `total` pixels of which `inside` are inside.
///
/// `Edges::Scale` asks whether `photons * total / inside >= n`, without dividing.
#[must_use]
pub fn enough(photons: u64, total: u64, inside: u64, search: Search) -> bool {
    let wanted = u64::from(search.min_photons);
    match search.edges {
        Edges::Zero => photons >= wanted,
        Edges::Scale => u128::from(photons) * u128::from(total) >= u128::from(wanted) * u128::from(inside),
    }
}
