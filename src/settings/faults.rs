//! The faults of the thesis's printed listings, which can be switched on to measure what they spoil.

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
