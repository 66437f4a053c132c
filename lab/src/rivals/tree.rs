//! A k-d tree of the photons, searched for the n nearest of each pixel, as photon mappers do.
//!
//! The radius is the distance of the n-th nearest photon in the Chebyshev metric, at least 1; MR where fewer
//! than n are within MR. Photons are at the centres of their pixels, so that distances are whole. It supports
//! zero edges only: a nearest-neighbour search does not involve the area of a box.
//!
//! The tree is built anew for each map, as it has to be for each frame of photons, by one core; the searches
//! are shared out among all. A pixel's photons are one point with a count, at most n of which matter. This
//! favours the tree: with a point for each photon, a tree of ten a pixel takes eight times as long to build
//! and the whole up to twice as long, for the same radii.
//!
//! Version 6 of the crate, which needs a newer Rust, takes as long and finds the same.
//!
//! Cost: O(log) nodes and the n nearest points for each pixel, with an allocation. Limit of exactness:
//! coordinates are in f32, exact up to a side of 2^24; the rest depends on the crate, whose result is checked
//! like any method's.

use std::num::NonZero;

use glam::UVec2;
use kiddo::Chebyshev;
use kiddo::immutable::float::kdtree::ImmutableKdTree;
use rayon::prelude::*;

use varikernel::image::Image;
use varikernel::reference::Radii;
use varikernel::settings::Search;

/// Points of a leaf: the crate's own default.
const BUCKET: usize = 32;

/// The search and its memory, for maps of one size.
#[derive(Debug)]
pub struct Tree {
    search: Search,
    /// Pixels with photons.
    points: Vec<[f32; 2]>,
    /// The photons of each point.
    counts: Vec<u32>,
    radii: Radii,
}

impl Tree {
    /// Allocates for maps of `size`; the search's edges are taken as zero.
    ///
    /// # Panics
    /// If a side of `size` is zero.
    #[must_use]
    pub fn new(size: UVec2, search: Search) -> Self {
        let radii = Radii { radius: Image::filled(size, 0), limited: Image::filled(size, 0) };
        Self { search, points: Vec::new(), counts: Vec::new(), radii }
    }

    /// The radii of `density`, in photons per pixel.
    ///
    /// # Panics
    /// If the map is of another size.
    pub fn run(&mut self, density: &Image<u32>) -> &Radii {
        let width = density.size().x as usize;
        assert_eq!(density.size(), self.radii.radius.size(), "a map of another size");
        let lit = density.values().iter().enumerate().filter(|&(_, &count)| count > 0);
        self.points.clear();
        self.counts.clear();
        for (index, &count) in lit {
            self.points.push(place(index, width));
            self.counts.push(count);
        }
        let tree: ImmutableKdTree<f32, u32, 2, BUCKET> = ImmutableKdTree::new_from_slice(&self.points);
        let (search, counts) = (self.search, &self.counts);
        let radius = self.radii.radius.values_mut().par_iter_mut();
        let limited = self.radii.limited.values_mut().par_iter_mut();
        radius.zip(limited).enumerate().for_each(|(index, (radius, limited))| {
            let found = nth_nearest(&tree, counts, place(index, width), search);
            *radius = found.unwrap_or(search.max_radius);
            *limited = u8::from(found.is_none());
        });
        &self.radii
    }

    /// What the last run found; zeros before the first.
    #[must_use]
    pub fn radii(&self) -> &Radii {
        &self.radii
    }
}

/// The centre of a pixel, in pixels.
fn place(index: usize, width: usize) -> [f32; 2] {
    #[expect(clippy::cast_precision_loss, reason = "a side of 2^24 is more than any device's textures have")]
    [index % width, index / width].map(|pixel| pixel as f32)
}

/// The radius of the smallest box around `place` with n photons, if one within MR has them.
fn nth_nearest(
    tree: &ImmutableKdTree<f32, u32, 2, BUCKET>,
    counts: &[u32],
    place: [f32; 2],
    search: Search,
) -> Option<u32> {
    // Every point has at least one photon.
    let most_points = NonZero::new(counts.len().min(search.min_photons as usize))?;
    #[expect(clippy::cast_precision_loss, reason = "MR is below 2^15")]
    let nearest = tree.nearest_n_within::<Chebyshev>(&place, search.max_radius as f32, most_points, true);
    let mut photons = 0;
    let last = nearest.iter().find(|point| {
        photons += u64::from(counts[point.item as usize]);
        photons >= u64::from(search.min_photons)
    })?;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number up to MR")]
    let distance = last.distance as u32;
    Some(distance.max(1))
}
