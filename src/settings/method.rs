//! How photons in a box are counted, and in which number sums are kept.

/// How photons in a box are counted: the thesis's solutions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
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

/// The number in which sums are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum Storage {
    /// 32-bit float, as the thesis: whole numbers up to 2^24.
    F32,
    /// 32-bit unsigned integer: right while every box holds less than 2^32, even where the table wraps.
    U32,
    /// 16-bit unsigned integer: right while every box holds less than 2^16. For the summed-area table.
    U16,
    /// 16-bit float: whole numbers up to 2^11. For the summed-area table, built by doubling.
    F16,
    /// 32-bit float, with the map's mean subtracted from each count and added back by the box's area (Hensley
    /// et al. 2005): never proved exact. For the summed-area table, built by doubling.
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

    /// Whether only the summed-area table, without the listings' faults, is kept in it.
    pub(super) fn is_for_tables_alone(self) -> bool {
        !matches!(self, Self::F32 | Self::U32)
    }
}
