//! The photons of each tile of a map, by which a search is planned.

use glam::UVec2;

use crate::image::Image;
use crate::settings::Search;

/// Pixels of the side of a census tile.
pub const CENSUS_SIDE: u32 = 64;

/// Photons in each tile of [`CENSUS_SIDE`]² pixels, tiles at the end cut to the map; more than 32 bits hold
/// are taken as the most that they do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Census {
    map_size: UVec2,
    photons: Image<u32>,
}

impl Census {
    /// Counts the photons of a map.
    #[must_use]
    pub fn of(density: &Image<u32>) -> Self {
        let map_size = density.size();
        let photons = Image::from_fn(tiles(map_size), |x, y| {
            let first = UVec2::new(x, y) * CENSUS_SIDE;
            let end = (first + CENSUS_SIDE).min(map_size);
            let sum: u64 = (first.y..end.y)
                .flat_map(|y| (first.x..end.x).map(move |x| u64::from(density.at(x, y))))
                .sum();
            u32::try_from(sum).unwrap_or(u32::MAX)
        });
        Self { map_size, photons }
    }

    /// What was counted elsewhere: `photons` of each tile of a map of `map_size`.
    pub(crate) fn counted(map_size: UVec2, photons: Image<u32>) -> Self {
        debug_assert_eq!(photons.size(), tiles(map_size), "a count for each tile");
        Self { map_size, photons }
    }

    /// The mean radius that the densities of the tiles let expect, from 1 to MR.
    #[must_use]
    pub fn expected_radius(&self, search: Search) -> f64 {
        self.mean(|photons, area| {
            let density = f64::from(photons) / area;
            let side = (f64::from(search.min_photons) / density).sqrt();
            // An empty tile has an infinite side.
            ((side - 1.0) / 2.0).clamp(1.0, f64::from(search.max_radius))
        })
    }

    /// The part of the area where n photons lie in 16 pixels or fewer, so that radii are 1 or 2.
    #[must_use]
    pub fn dense_share(&self, search: Search) -> f64 {
        self.mean(|photons, area| {
            f64::from(u8::from(16.0 * f64::from(photons) >= f64::from(search.min_photons) * area))
        })
    }

    /// The mean over the map of a function of a tile's photons and area.
    fn mean(&self, of_tile: impl Fn(u32, f64) -> f64) -> f64 {
        let size = self.photons.size();
        let (mut sum, mut total_area) = (0.0, 0.0);
        for y in 0..size.y {
            for x in 0..size.x {
                let first = UVec2::new(x, y) * CENSUS_SIDE;
                let extent = (self.map_size - first).min(UVec2::splat(CENSUS_SIDE));
                let area = f64::from(extent.x * extent.y);
                sum += area * of_tile(self.photons.at(x, y), area);
                total_area += area;
            }
        }
        sum / total_area
    }
}

/// Columns and rows of the census of a map.
pub(crate) fn tiles(map_size: UVec2) -> UVec2 {
    (map_size + CENSUS_SIDE - 1) / CENSUS_SIDE
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    #[test]
    fn a_census_counts_cut_tiles_by_their_own_area() {
        let density = Image::from_fn(UVec2::new(65, 64), |x, _| u32::from(x == 64));
        let census = Census::of(&density);
        assert_eq!(census.photons.values(), [0, 64]);
        let search = Search { min_photons: 9, max_radius: 40, ..Settings::default().search };
        // 64 columns without a photon get MR, one with a photon in each pixel needs 9 pixels: radius 1.
        assert!((census.expected_radius(search) - (64.0 * 40.0 + 1.0) / 65.0).abs() < 1e-12);
        assert!((census.dense_share(search) - 1.0 / 65.0).abs() < 1e-12);
    }
}
