//! From a value to a colour.

use std::ops::RangeInclusive;

use super::Image;

/// Where the colours begin in TURBO: before that it is nearly black, which reads as nothing at all.
const FIRST: f64 = 0.07;

/// Colours for a range of values, spread by logarithm of value + 1, as zero has a place too: from 1 to 2 is
/// as far as from 3 to 5.
///
/// Most radii of a good map are small, and one more pixel matters more there than at the far end. TURBO
/// changes its hue all the way, so that 1 and 2 are apart at first sight; maps that only brighten, such as
/// VIRIDIS, leave both dark.
pub(super) struct ColourMap {
    lowest: u32,
    highest: u32,
}

impl ColourMap {
    /// The given range, or that of the image.
    ///
    /// # Panics
    /// If the range is empty.
    pub(super) fn new(range: Option<&RangeInclusive<u32>>, image: &Image<u32>) -> Self {
        let (lowest, highest) = range.map_or_else(
            || {
                let bounds = |(low, high): (u32, u32), &value: &u32| (low.min(value), high.max(value));
                image.values().iter().fold((u32::MAX, 0), bounds)
            },
            |range| (*range.start(), *range.end()),
        );
        assert!(lowest <= highest, "the range {lowest} to {highest} is empty");
        Self { lowest, highest }
    }

    pub(super) fn lowest(&self) -> u32 {
        self.lowest
    }

    pub(super) fn highest(&self) -> u32 {
        self.highest
    }

    /// Where the value lies in the range, from 0 to 1; values outside count as its ends.
    pub(super) fn place(&self, value: u32) -> f64 {
        if self.lowest == self.highest {
            return 0.0;
        }
        let steps = |value: u32| ((f64::from(value) + 1.0) / (f64::from(self.lowest) + 1.0)).ln();
        steps(value.clamp(self.lowest, self.highest)) / steps(self.highest)
    }

    pub(super) fn colour(&self, value: u32) -> [u8; 3] {
        Self::colour_at(self.place(value))
    }

    /// The colour at a place on the legend's bar, from 0 to 1.
    pub(super) fn bar_colour(&self, place: f64) -> [u8; 3] {
        // A range of one value has one colour.
        Self::colour_at(if self.lowest == self.highest { 0.0 } else { place })
    }

    fn colour_at(place: f64) -> [u8; 3] {
        colour_of_bar(place)
    }
}

/// The colour at a place on a legend's bar, from 0 to 1, in all pictures of maps: sRGB.
#[must_use]
pub fn colour_of_bar(place: f64) -> [u8; 3] {
    colorous::TURBO.eval_continuous(FIRST + (1.0 - FIRST) * place).as_array()
}
