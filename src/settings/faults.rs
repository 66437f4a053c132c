//! The faults of the thesis's printed listings, which can be switched on to measure what they spoil.

use super::{Edges, Method, SatBuild, SatSamples, Settings, Split};

/// Faults of the thesis's printed listings, each of which can be switched on (see
/// [`structure`](crate::radius::tables#as-printed) for what they do).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::struct_excessive_bools, reason = "each fault can be switched on without the others")]
pub struct Faults {
    /// Listing 4.2, sampling: coordinates are clamped to 0..63 whatever the map's size.
    pub clamp_to_63: bool,
    /// Listing 4.2, sampling: `ll.x > 0` where `>= 0` is meant, so that boxes from column or row 1 count 0 as
    /// well.
    pub border_test: bool,
    /// Listing 4.2, sampling: the lower left is added back unless *both* coordinates are outside.
    pub corner_test: bool,
    /// Listing 4.2, generation: horizontal passes move along y and vertical ones along x.
    pub swapped_axes: bool,
    /// Listing 4.2, generation with more than 2 samples: the first offset stays a power of two, one sample
    /// too many is added, and always along x.
    pub sample_stride: bool,
    /// First listing of 4.3: with one odd coordinate, a strip in the other direction alone is forgotten.
    pub forgotten_strip: bool,
    /// Section 4.4: the outside ratio is a rounded f32 division.
    pub float_ratio: bool,
}

impl Faults {
    /// No fault.
    pub const NONE: Self = Self {
        clamp_to_63: false,
        border_test: false,
        corner_test: false,
        swapped_axes: false,
        sample_stride: false,
        forgotten_strip: false,
        float_ratio: false,
    };

    /// Every listing as printed.
    pub const AS_PRINTED: Self = Self {
        clamp_to_63: true,
        border_test: true,
        corner_test: true,
        swapped_axes: true,
        sample_stride: true,
        forgotten_strip: true,
        float_ratio: true,
    };

    /// Whether the sampling of the summed-area table is at fault.
    #[must_use]
    pub fn in_table_sampling(self) -> bool {
        self.clamp_to_63 || self.border_test || self.corner_test
    }
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
