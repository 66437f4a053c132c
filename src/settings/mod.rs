//! What is asked of the search: n, MR, edges, method and its variants.
//!
//! Plain structs with public fields; [`Settings::default`] is exact and fast, [`Settings::thesis`] is what the
//! thesis ran.

mod faults;
mod irradiance;
mod kernel;
mod names;
#[cfg(feature = "scene")]
mod picture;
mod validate;

pub use faults::Faults;
pub use irradiance::{Estimate, IrradianceSettings};
pub use kernel::{Kernel, MAX_PICTURE_RADIUS, RadiusChoice};
#[cfg(feature = "scene")]
pub use picture::{DirectLight, FirstBounce, PictureSettings};

/// The largest possible [`Search::max_radius`]: the area (2 MR + 1)² still fits 32 bits.
pub const MAX_RADIUS_LIMIT: u32 = 32_767;

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
    /// The radius that no counted box exceeds in area: MR, and for a bracketed search half a tile more, since it counts
    /// boxes around tiles of 32 x 32 pixels.
    #[must_use]
    pub fn largest_counted_radius(&self) -> u32 {
        match self.order {
            Order::Forward | Order::Binary => self.max_radius,
            Order::Bracketed => self.max_radius + 32,
        }
    }
}

/// What a box holds where it reaches past the map (thesis 3.1, 4.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
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
pub enum Order {
    /// 1, 2, 3, ... up to the first that holds enough: as many counts as the radius is long.
    Forward,
    /// Halving the range from 1 to MR: about log2 MR counts, whatever the radius.
    Binary,
    /// Halving the few radii that are left when those of a block of pixels around are bounded first: about two counts,
    /// whatever the radius and MR. For the summed-area table.
    Bracketed,
}

/// How photons in a box are counted: the thesis's solutions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Method {
    /// Every pixel of every box (3.2, 4.1).
    BruteForce,
    /// Up one column of a summed mipmap, blind to the neighbours: the thesis's counter-example (3.3.1).
    NaiveMipmap,
    /// A box cut into mipmap texels that glGenerateMipmap averaged: approximate (4.3).
    AveragedMipmap,
    /// A box cut into texels of a summed mipmap, with a fixed stack (3.3.2, 4.3).
    Pyramid,
    /// Four texels of a summed-area table (3.4, 4.2).
    #[cfg_attr(feature = "clap", value(name = "sat"))]
    #[cfg_attr(feature = "serde", serde(rename = "sat"))]
    SummedAreaTable,
}

impl Method {
    /// All methods, in the thesis's order.
    pub const ALL: [Self; 5] =
        [Self::BruteForce, Self::NaiveMipmap, Self::AveragedMipmap, Self::Pyramid, Self::SummedAreaTable];

    /// Whether the method answers the box question exactly while its sums are exact.
    #[must_use]
    pub fn is_exact(self) -> bool {
        match self {
            Self::BruteForce | Self::Pyramid | Self::SummedAreaTable => true,
            Self::NaiveMipmap | Self::AveragedMipmap => false,
        }
    }
}

/// How a pyramid's remaining area is split after a sample (thesis 4.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Split {
    /// By which coordinates are odd: the first listing.
    Odd,
    /// So that the larger piece is as large as possible: the second listing.
    Larger,
}

/// How the pyramid finds the level of its next sample (thesis 4.3, 6.3.5).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Matching {
    /// From the top level down until corner and extent fit, by modulo: the thesis's loop.
    Modulo,
    /// From the lowest set bit of the corner and the highest of the extent, without a loop: its future work.
    Bits,
}

/// How a summed-area table is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum SatBuild {
    /// By recursive doubling: each pass adds samples ever further away (3.4.1, 4.2).
    Doubling,
    /// By a scan of tiles, groups of tiles and tiles again: 9 passes whose work does not grow with the side.
    Scan,
}

/// Samples that a doubling pass adds, s; a table of side w takes ⌈log_s w⌉ passes a direction (thesis 4.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum SatSamples {
    /// 2, recursive doubling as Hensley et al. give it.
    #[cfg_attr(feature = "clap", value(name = "2"))]
    Two,
    /// 4, the thesis's faster one.
    #[cfg_attr(feature = "clap", value(name = "4"))]
    Four,
    /// 8.
    #[cfg_attr(feature = "clap", value(name = "8"))]
    Eight,
    /// 16.
    #[cfg_attr(feature = "clap", value(name = "16"))]
    Sixteen,
}

impl SatSamples {
    /// All of them, ascending.
    pub const ALL: [Self; 4] = [Self::Two, Self::Four, Self::Eight, Self::Sixteen];

    /// s as a number.
    #[must_use]
    pub fn count(self) -> u32 {
        match self {
            Self::Two => 2,
            Self::Four => 4,
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for SatSamples {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u32(self.count())
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for SatSamples {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let count = <u32 as serde::Deserialize>::deserialize(deserializer)?;
        Self::ALL.into_iter().find(|samples| samples.count() == count).ok_or_else(|| {
            serde::de::Error::invalid_value(
                serde::de::Unexpected::Unsigned(u64::from(count)),
                &"2, 4, 8 or 16 samples a pass",
            )
        })
    }
}

/// The number in which sums are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Storage {
    /// 32-bit float, as the thesis: whole numbers up to 2^24.
    F32,
    /// 32-bit unsigned integer: right while every box holds less than 2^32, even where the table wraps.
    U32,
    /// 16-bit unsigned integer: right while every box holds less than 2^16. For the summed-area table.
    U16,
    /// 16-bit float: whole numbers up to 2^11. For the summed-area table, built by doubling.
    F16,
    /// 32-bit float, with the map's mean subtracted from each count and added back by the box's area (Hensley et al. 2005):
    /// never proved exact. For the summed-area table, built by doubling.
    F32MinusMean,
    /// The same with the mean rounded to a whole number.
    F32MinusWholeMean,
}

impl Storage {
    /// Whether sums are whole numbers that wrap; others are floats that round.
    #[must_use]
    pub fn is_integer(self) -> bool {
        matches!(self, Self::U32 | Self::U16)
    }
}

/// Variations of a method that the thesis leaves to future work in chapter 6, to be timed: each gives the same radii.
///
/// Bit operations in place of modulo, which 6.3.5 asks for as well, are [`Matching::Bits`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Variation {
    /// Brute force, forward: the sum of the radius before is kept, and only the new ring is read (6.2.5).
    ReusedSums,
    /// Brute force: four fetches in each turn of the loop (6.2.5).
    FetchesAtOnce,
    /// Pyramid: strips of width or height 1 are summed whole, without matching and stack (6.3.5).
    WholeStrips,
    /// Summed-area table: all four entries are fetched first, then those that count are chosen (6.4.5).
    UnconditionalFetches,
    /// Summed-area table: a doubling pass leaves out texels that are finished (6.4.5).
    UnfinishedTexels,
}

impl Variation {
    /// All of them, in the thesis's order.
    pub const ALL: [Self; 5] = [
        Self::ReusedSums,
        Self::FetchesAtOnce,
        Self::WholeStrips,
        Self::UnconditionalFetches,
        Self::UnfinishedTexels,
    ];

    /// The method that it varies.
    #[must_use]
    pub fn method(self) -> Method {
        match self {
            Self::ReusedSums | Self::FetchesAtOnce => Method::BruteForce,
            Self::WholeStrips => Method::Pyramid,
            Self::UnconditionalFetches | Self::UnfinishedTexels => Method::SummedAreaTable,
        }
    }
}

/// What happens where the sums could round or wrap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Exactness {
    /// An error before anything is computed.
    Required,
    /// It is computed all the same, to measure how wrong it gets.
    Waived,
}

/// Everything that a [`RadiusPipeline`](crate::RadiusPipeline) needs to know beside the map's size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Settings {
    /// The question.
    pub search: Search,
    /// How boxes are counted.
    pub method: Method,
    /// The pyramid's and the averaged mipmap's splitting rule.
    pub split: Split,
    /// How the pyramid and the averaged mipmap match an area with a level.
    pub matching: Matching,
    /// How the summed-area table is built.
    pub sat_build: SatBuild,
    /// Samples a pass when the summed-area table is built by doubling.
    pub sat_samples: SatSamples,
    /// The number in which sums are kept; the averaged mipmap is always f32.
    pub storage: Storage,
    /// A variation of the method, without misprints, or none.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub variation: Option<Variation>,
    /// Which of the thesis's misprints to run with.
    pub faults: Faults,
    /// Whether an inexact result is an error.
    pub exactness: Exactness,
    /// Whether the pixels that found too few photons within MR are marked in a second plane.
    pub limited_mask: bool,
    /// Whether each frame comes with a [`Mask`](crate::Mask) of the pixels that need a radius.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "std::ops::Not::not"))]
    pub masked: bool,
}

impl Default for Settings {
    /// The summed-area table in u32, built by a scan, with a bracketed search: exact, for n = 25 and MR = 32.
    fn default() -> Self {
        Self {
            search: Search { min_photons: 25, max_radius: 32, edges: Edges::Scale, order: Order::Bracketed },
            method: Method::SummedAreaTable,
            split: Split::Larger,
            matching: Matching::Bits,
            sat_build: SatBuild::Scan,
            sat_samples: SatSamples::Four,
            storage: Storage::U32,
            variation: None,
            faults: Faults::NONE,
            exactness: Exactness::Required,
            limited_mask: false,
            masked: false,
        }
    }
}

impl Settings {
    /// The usual settings of a method: [`Settings::default`] for the table; the others have no bracketed search.
    #[must_use]
    pub fn of(method: Method) -> Self {
        let usual = Self::default();
        let order = match method {
            Method::SummedAreaTable => usual.search.order,
            _ => Order::Binary,
        };
        Self { method, search: Search { order, ..usual.search }, ..usual }
    }

    /// The thesis's fastest: a summed-area table in f32, 4 samples a pass, MR = 32 (Figure 5.1), n = 25 (Figure 3.2).
    #[must_use]
    pub fn thesis() -> Self {
        let usual = Self::default();
        Self {
            search: Search { order: Order::Binary, ..usual.search },
            matching: Matching::Modulo,
            sat_build: SatBuild::Doubling,
            storage: Storage::F32,
            ..usual
        }
    }
}
