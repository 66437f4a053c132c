//! What the thesis measures and no host has to decide: variants of methods and builds, and results that may
//! be wrong.

use super::{Edges, Faults, Method, Settings};

/// Variants that are measured against each other; the [default](Self::default) is the right and fast one of
/// each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Laboratory {
    /// The pyramid's and the averaged mipmap's splitting rule.
    pub split: Split,
    /// How the pyramid and the averaged mipmap match an area with a level.
    pub matching: Matching,
    /// How the summed-area table is built.
    pub sat_build: SatBuild,
    /// Samples a pass when the summed-area table is built by doubling.
    pub sat_samples: SatSamples,
    /// A variation of the method, without misprints, or none.
    pub variation: Option<Variation>,
    /// Which of the thesis's misprints to run with.
    pub faults: Faults,
    /// Whether an inexact result is an error.
    pub exactness: Exactness,
}

impl Default for Laboratory {
    /// The second splitting rule, matching by bits, a scan, 4 samples a pass; no misprints, and nothing
    /// inexact.
    fn default() -> Self {
        Self {
            split: Split::Larger,
            matching: Matching::Bits,
            sat_build: SatBuild::Scan,
            sat_samples: SatSamples::Four,
            variation: None,
            faults: Faults::NONE,
            exactness: Exactness::Required,
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
    /// By a scan of tiles, groups of tiles and tiles again: 7 passes whose work does not grow with the side.
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

/// Variations of a method that the thesis leaves to future work in chapter 6, to be timed: each gives the
/// same radii.
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

impl Settings {
    /// The faults that these settings let into the computation: those of the method and the edge rule in use.
    #[must_use]
    pub fn reaching_faults(&self) -> Faults {
        let in_table = self.method == Method::SummedAreaTable;
        let in_doubling = in_table && self.laboratory.sat_build == SatBuild::Doubling;
        let faults = self.laboratory.faults;
        Faults {
            clamp_to_63: faults.clamp_to_63 && in_table,
            border_test: faults.border_test && in_table,
            corner_test: faults.corner_test && in_table,
            swapped_axes: faults.swapped_axes && in_doubling,
            // The listing for 2 samples is right; its extension to more is not.
            sample_stride: faults.sample_stride
                && in_doubling
                && self.laboratory.sat_samples > SatSamples::Two,
            forgotten_strip: faults.forgotten_strip
                && matches!(self.method, Method::Pyramid | Method::AveragedMipmap)
                && self.laboratory.split == Split::Odd,
            float_ratio: faults.float_ratio && self.search.edges == Edges::Scale,
        }
    }
}
