//! The density map of Figures 3.2 to 3.4, as far as they determine it.
//!
//! The figures give four numbers: 9 photons within radius 1, 41 within radius 2, 25 wanted, and a naive
//! mipmap that finds too few before level 3 of an 8 x 8 map. This map has all four: the pixel is the last of
//! a thin quadrant.

use glam::UVec2;

use varikernel::image::Image;
use varikernel::reference::{self, Inside};
use varikernel::settings::{Edges, Faults, Order, Search, Split};

/// The pixel whose radius is asked for.
pub const PIXEL: UVec2 = UVec2::new(3, 3);

/// Photons wanted in Figure 3.3, and the whole map as limit.
pub const SEARCH: Search =
    Search { min_photons: 25, max_radius: 8, edges: Edges::Zero, order: Order::Forward };

/// An 8 x 8 map with the counts of the figures.
#[must_use]
pub fn map() -> Image<u32> {
    #[rustfmt::skip]
    let counts = vec![
        1, 1, 1, 1, 2, 2, 2, 2,
        1, 1, 1, 1, 2, 2, 2, 2,
        1, 1, 1, 1, 1, 3, 2, 2,
        1, 1, 1, 1, 1, 3, 2, 2,
        2, 2, 1, 1, 1, 3, 2, 2,
        2, 2, 3, 3, 2, 2, 2, 2,
        2, 2, 2, 2, 2, 2, 2, 2,
        2, 2, 2, 2, 2, 2, 2, 2,
    ];
    Image::from_values(UVec2::splat(8), counts)
}

/// The radii by the definition and by the naive mipmap for [`PIXEL`].
#[must_use]
pub fn radii() -> (u32, u32) {
    let at = |radii: &reference::Radii| radii.radius.at(PIXEL.x, PIXEL.y);
    (at(&reference::radius(&map(), SEARCH)), at(&reference::naive_mipmap(&map(), SEARCH)))
}

/// Fetches of a pyramid for radius 1 and 2 around [`PIXEL`], as Figure 3.4 counts them.
#[must_use]
pub fn pyramid_fetches(split: Split) -> [usize; 2] {
    [1, 2].map(|radius| {
        let inside = Inside::of_box(UVec2::splat(8), PIXEL.x, PIXEL.y, radius);
        reference::pyramid::cover(inside, 3, split, Faults::NONE).blocks.len()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use varikernel::reference::Table;

    #[test]
    fn the_map_has_the_photons_of_figures_3_2_to_3_4() {
        let map = map();
        let table = Table::new(&map);
        let within = |radius| table.count(Inside::of_box(map.size(), PIXEL.x, PIXEL.y, radius));
        assert_eq!((within(1), within(2)), (9, 41));
        let quadrant = Inside { lo: UVec2::ZERO, hi: UVec2::splat(3) };
        assert!(table.count(quadrant) < 25);
    }

    #[test]
    fn the_naive_mipmap_answers_4_where_2_is_enough() {
        assert_eq!(radii(), (2, 4));
    }

    #[test]
    fn the_first_listing_takes_the_fetches_of_figure_3_4() {
        assert_eq!(pyramid_fetches(Split::Odd), [6, 13]);
    }
}
