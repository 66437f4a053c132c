//! A rectangle of values with `(x, y)` access, and its files.
//!
//! Row 0 is the first row of the picture, in memory, in every file format and in the textures made from it.

#[cfg(feature = "files")]
mod atomic;
#[cfg(feature = "files")]
mod attribute;
#[cfg(feature = "files")]
mod colour_map;
#[cfg(feature = "scene")]
mod colours;
#[cfg(feature = "files")]
mod counts;
mod difference;
#[cfg(feature = "files")]
mod exr;
#[cfg(feature = "files")]
mod files;
#[cfg(feature = "scene")]
mod layers;
#[cfg(feature = "files")]
mod map_picture;
#[cfg(feature = "files")]
mod npy;
#[cfg(feature = "files")]
mod png;
#[cfg(feature = "scene")]
mod sheet;
#[cfg(feature = "files")]
mod temporary;
#[cfg(feature = "scene")]
mod tone;

#[cfg(feature = "files")]
pub use atomic::{check_writable, output_place, write_atomically};
#[cfg(feature = "files")]
pub use attribute::{Attribute, AttributeValue};
#[cfg(feature = "files")]
pub use colour_map::colour_of_bar;
#[cfg(feature = "scene")]
pub use colours::{Colours, read_channels, read_colours};
#[cfg(feature = "files")]
pub use counts::ReadOptions;
pub use difference::{Difference, Place};
#[cfg(feature = "scene")]
pub(crate) use files::open_file;
#[cfg(feature = "files")]
pub use files::{Format, read_counts, read_counts_of, read_mask, write_counts, write_picture};
#[cfg(feature = "scene")]
pub use layers::{LayerFile, write_colours};
#[cfg(feature = "files")]
pub use map_picture::Picture;
#[cfg(feature = "scene")]
pub use map_picture::picture_of;
#[cfg(feature = "scene")]
pub use sheet::{Tile, contact_sheet};
#[cfg(feature = "files")]
pub use temporary::{Discarded, discard_unfinished_files};
#[cfg(feature = "scene")]
pub use tone::ToneMap;

use glam::UVec2;

/// The photon density map that comes with the library, as an EXR file: 2.9 million landings in a Cornell box
/// with a glass sphere, 512 x 512 pixels (`assets/maps/README.md`).
#[cfg(feature = "files")]
pub const CORNELL_GLASS_EXR: &[u8] = include_bytes!("../../assets/maps/cornell_glass_512.exr");

/// Values on a grid of `size.x` columns and `size.y` rows, at least one of each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image<T> {
    size: UVec2,
    values: Vec<T>,
}

impl<T: Copy> Image<T> {
    /// An image that holds `value` everywhere.
    ///
    /// # Panics
    /// If a side of `size` is zero.
    #[must_use]
    pub fn filled(size: UVec2, value: T) -> Self {
        assert!(size.min_element() > 0, "an image has at least one pixel, not {size}");
        Self { size, values: vec![value; size.x as usize * size.y as usize] }
    }

    /// An image of `values`, row after row.
    ///
    /// # Panics
    /// If a side of `size` is zero, or `values` does not fill it exactly.
    #[must_use]
    pub fn from_values(size: UVec2, values: Vec<T>) -> Self {
        assert!(size.min_element() > 0, "an image has at least one pixel, not {size}");
        assert_eq!(values.len(), size.x as usize * size.y as usize, "values for a size of {size}");
        Self { size, values }
    }

    /// An image whose value at each `(x, y)` is `value(x, y)`.
    ///
    /// # Panics
    /// If a side of `size` is zero.
    #[must_use]
    pub fn from_fn(size: UVec2, mut value: impl FnMut(u32, u32) -> T) -> Self {
        assert!(size.min_element() > 0, "an image has at least one pixel, not {size}");
        let mut values = Vec::with_capacity(size.x as usize * size.y as usize);
        for y in 0..size.y {
            values.extend((0..size.x).map(|x| value(x, y)));
        }
        Self { size, values }
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// All values, row after row.
    #[must_use]
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// All values, row after row, to be written.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// The value at column `x` and row `y`.
    ///
    /// # Panics
    /// If the place is outside the image.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> T {
        self.values[self.index(x, y)]
    }

    /// Puts `value` at column `x` and row `y`.
    ///
    /// # Panics
    /// If the place is outside the image.
    pub fn set(&mut self, x: u32, y: u32, value: T) {
        let index = self.index(x, y);
        self.values[index] = value;
    }

    /// The image with `f` applied to each value.
    #[must_use]
    pub fn map<U: Copy>(&self, f: impl Fn(T) -> U) -> Image<U> {
        Image { size: self.size, values: self.values.iter().map(|&value| f(value)).collect() }
    }

    fn index(&self, x: u32, y: u32) -> usize {
        assert!(x < self.size.x && y < self.size.y, "({x}, {y}) is outside {}", self.size);
        y as usize * self.size.x as usize + x as usize
    }
}
