//! What a host's frame brings: the density map, the pixels that need a radius, and what differs from the
//! frame before.

use glam::UVec2;

use crate::maps::DensityMap;
use crate::maps::Mask;

/// One frame of a [`RadiusPipeline`](crate::RadiusPipeline).
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The counts; for [`Changed::Added`], those of the new photons alone.
    pub density: &'a DensityMap,
    /// The pixels that need a radius: those of a mask, or all.
    ///
    /// A mask is for pipelines whose settings say [`masked`](crate::Settings::masked); it may come with some
    /// frames and not with others.
    pub mask: Option<&'a Mask>,
    /// Where counts or mask differ from the frame before.
    pub changed: Changed,
}

impl<'a> Frame<'a> {
    /// Every pixel of `density`, nothing known of the frame before.
    #[must_use]
    pub fn new(density: &'a DensityMap) -> Self {
        Self { density, mask: None, changed: Changed::Everything }
    }

    /// Whether there may be pixels that need no radius.
    pub(crate) fn leaves_out_pixels(&self) -> bool {
        self.mask.is_some_and(|mask| !mask.is_every_pixel())
    }
}

/// Where a frame differs from the one before it, as the host guarantees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Changed {
    /// Anywhere.
    Everything,
    /// Nowhere: the radii of the frame before are the answer, and nothing is drawn.
    Nothing,
    /// In the `size` columns and rows from `first` on, a dirty rectangle; what reaches past the map is
    /// ignored.
    Rectangle {
        /// First column and row.
        first: UVec2,
        /// Columns and rows.
        size: UVec2,
    },
    /// Photons came in addition: the frame's density map holds the new ones, and is added to all before.
    Added,
}

/// The changed columns and rows of a map, up to and without `end`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rectangle {
    pub(crate) first: UVec2,
    pub(crate) end: UVec2,
}

impl Rectangle {
    /// The part of a changed rectangle that lies in a map of `map_size`, nothing if it is empty.
    pub(crate) fn inside(map_size: UVec2, first: UVec2, size: UVec2) -> Option<Self> {
        let end = UVec2::new(first.x.saturating_add(size.x), first.y.saturating_add(size.y)).min(map_size);
        first.cmplt(end).all().then_some(Self { first, end })
    }

    /// The whole map.
    pub(crate) fn whole(map_size: UVec2) -> Self {
        Self { first: UVec2::ZERO, end: map_size }
    }

    /// With `margin` pixels around, where the map has them.
    pub(crate) fn grown(self, margin: u32, map_size: UVec2) -> Self {
        let margin = UVec2::splat(margin);
        Self { first: self.first.saturating_sub(margin), end: (self.end + margin).min(map_size) }
    }
}
