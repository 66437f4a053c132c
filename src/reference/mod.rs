//! The same in plain Rust, slow and obvious, without OpenGL: the definition that everything else is compared
//! with.
//!
//! [`radius`] is the definition; [`radius_by_table`] gives the same for large maps. [`even`] is that of the
//! other rule, [`Rule::Even`](crate::settings::Rule::Even). [`pyramid`],
//! [`naive_mipmap`] and [`as_printed`] mirror what those methods do step by step, so that fetches can be
//! counted and faults predicted. [`splat`], [`gather`] and [`tables`] are what light by photons is, and `direct`
//! what comes without a detour.

pub mod as_printed;
mod definition;
#[cfg(feature = "scene")]
mod direct;
mod even;
mod naive_mipmap;
mod picture;
pub mod pyramid;
mod summed_area_table;
pub mod tables;

pub use definition::{enough, radius};
#[cfg(feature = "scene")]
pub use direct::direct;
pub use even::even;
pub use naive_mipmap::naive_mipmap;
pub use picture::{Shown, gather, gather_at, photon_density, photon_power, splat};
pub use summed_area_table::{Table, binary_search, radius_by_table};

use glam::UVec2;

use crate::image::Image;

/// The result of a search for each pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Radii {
    /// The radius, from 1 to MR; by [`even`] from 0 on.
    pub radius: Image<u32>,
    /// 1 where MR ended the search with too few photons, or with a density that is still even; else 0.
    pub limited: Image<u8>,
}

impl Radii {
    /// The same where `mask` is not 0; elsewhere no radius is needed, which is 0 and not limited.
    ///
    /// # Panics
    /// If the sizes differ.
    #[must_use]
    pub fn where_needed(&self, mask: &Image<u8>) -> Self {
        assert_eq!(mask.size(), self.radius.size(), "mask and radii");
        let needed = |x, y| mask.at(x, y) != 0;
        Self {
            radius: Image::from_fn(mask.size(), |x, y| if needed(x, y) { self.radius.at(x, y) } else { 0 }),
            limited: Image::from_fn(mask.size(), |x, y| if needed(x, y) { self.limited.at(x, y) } else { 0 }),
        }
    }

    /// `found(x, y)` is the radius of each pixel, or nothing where even MR holds too few.
    fn from_fn(size: UVec2, max_radius: u32, found: impl Fn(u32, u32) -> Option<u32>) -> Self {
        let found = Image::from_fn(size, found);
        Self {
            radius: found.map(|radius| radius.unwrap_or(max_radius)),
            limited: found.map(|radius| u8::from(radius.is_none())),
        }
    }
}

/// The pixels of a box that are inside the map: both corners included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inside {
    /// First column and row.
    pub lo: UVec2,
    /// Last column and row.
    pub hi: UVec2,
}

impl Inside {
    /// The part of the box of `radius` around `(x, y)` that is inside a map of `size`.
    #[must_use]
    pub fn of_box(size: UVec2, x: u32, y: u32, radius: u32) -> Self {
        let center = UVec2::new(x, y);
        Self {
            lo: center.saturating_sub(UVec2::splat(radius)),
            hi: center.saturating_add(UVec2::splat(radius)).min(size - 1),
        }
    }

    /// I: how many pixels these are.
    #[must_use]
    pub fn area(self) -> u64 {
        let sides = self.hi - self.lo + 1;
        u64::from(sides.x) * u64::from(sides.y)
    }
}

/// T: the area of a box of `radius`, inside and outside.
#[must_use]
pub fn total_area(radius: u32) -> u64 {
    let side = 2 * u64::from(radius) + 1;
    side * side
}
