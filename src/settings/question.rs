//! The question: by which rule a radius is found, n, MR, what counts outside the map, and the order in which
//! radii are tried.

/// The largest possible [`Search::max_radius`]: the area (2 MR + 1)² still fits 32 bits.
pub const MAX_RADIUS_LIMIT: u32 = 32_767;

/// The largest [`Search::max_radius`] of [`Rule::Even`], in pixels.
pub const MAX_EVEN_RADIUS: u32 = 64;

/// Steps of a variance in which [`Rule::Even`] tells how far a box is from even; what is left is cut off.
pub(crate) const EVEN_STEPS: u32 = 32;

/// The most steps that count, so that one bright pixel does not decide alone: 6 variances.
pub(crate) const MOST_EVEN_STEPS: u32 = 6 * EVEN_STEPS;

/// Pixels from one test of [`Rule::Even`] to the next, along rows and columns: a wide box differs little from
/// that of its neighbour.
pub(crate) fn even_step(radius: u32) -> u32 {
    if radius <= 8 { 1 } else { radius / 4 }
}

/// Pixels of the side of the tiles whose radii a [`Order::Bracketed`] search bounds first.
pub(crate) const BRACKET_TILE_SIDE: u32 = 64;

/// By which rule a pixel's radius is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum Rule {
    /// The smallest box that holds at least n photons (thesis 1.3).
    #[default]
    Nearest,
    /// The widest box over which the density is even but for noise, by a test that is pooled over the pixels
    /// around; there is no n.
    ///
    /// Radii are 0, 1, 2, 4, ... up to MR, a power of two of at most [`MAX_EVEN_RADIUS`].
    /// [`Search::min_photons`] and [`Search::order`] are not asked for. With [`Edges::Scale`] densities are
    /// those of the pixels inside the map; with [`Edges::Zero`] the map's edge is one of the density.
    /// [`reference::even`](crate::reference::even) is the definition.
    Even,
}

impl Rule {
    /// Whether it is the usual one, which files leave out.
    #[cfg(feature = "serde")]
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
    pub(super) fn is_usual(&self) -> bool {
        *self == Self::default()
    }
}

/// The question: the smallest radius whose box holds at least n photons (thesis 1.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Search {
    /// n, "MP" in the thesis's listings: photons that a box has to hold, at least 1.
    pub min_photons: u32,
    /// MR: where the search ends, in pixels, from 1 to [`MAX_RADIUS_LIMIT`]; it may exceed the map.
    ///
    /// Pixels that find too few photons get MR.
    pub max_radius: u32,
    /// What counts outside the map.
    pub edges: Edges,
    /// In which order radii are tried; without effect on exact results.
    pub order: Order,
}

impl Search {
    /// The radius that no counted box exceeds in area: MR, and for a bracketed search half a tile more, since
    /// it counts boxes around tiles of 64 x 64 pixels.
    #[must_use]
    pub fn largest_counted_radius(&self) -> u32 {
        match self.order {
            Order::Forward | Order::Binary => self.max_radius,
            Order::Bracketed => self.max_radius.saturating_add(BRACKET_TILE_SIDE / 2),
        }
    }
}

/// What a box holds where it reaches past the map (thesis 3.1, 4.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum Edges {
    /// Nothing is outside.
    Zero,
    /// As much, per area, as inside: the count is scaled by total area over inside area.
    Scale,
}

/// In which order radii are tried (thesis 3.5).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum Order {
    /// 1, 2, 3, ... up to the first that holds enough: as many counts as the radius is long.
    Forward,
    /// Halving the range from 1 to MR: about log2 MR counts, whatever the radius.
    Binary,
    /// Halving the few radii that are left when those of a block of pixels around are bounded first: about
    /// two counts, whatever the radius and MR. For the summed-area table.
    Bracketed,
}

impl Order {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Forward, Self::Binary, Self::Bracketed];
}

/// Who decides how a frame is searched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Planning {
    /// The settings: each frame by their method, in their order.
    #[default]
    AsAsked,
    /// The [`planner`](crate::radius::planner), for each frame anew by the photons of the frames before.
    ///
    /// The question and all that does not decide speed are kept; method, build, storage and order are the
    /// planner's. After a frame, the photons of each 64 x 64 pixels are counted (4 fetches a tile) and
    /// fetched when the GPU is done with them: no frame waits, so that the first is planned without a census,
    /// and each later one by that of a frame or a few before it.
    EachFrame,
}

impl Planning {
    /// Whether it is the usual one, which files leave out.
    #[cfg(feature = "serde")]
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
    pub(super) fn is_usual(&self) -> bool {
        *self == Self::default()
    }
}
