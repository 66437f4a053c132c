//! From the samples of a file to counts: the checks that every format shares.

use std::fmt::Debug;

use exr::prelude::f16;
use glam::UVec2;

use super::Image;

/// What is wrong inside a file, before its path is known; see [`crate::Error::File`].
#[derive(Debug)]
pub(super) struct Problem {
    pub(super) what: String,
    pub(super) remedy: String,
}

impl Problem {
    pub(super) fn new(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { what: what.into(), remedy: remedy.into() }
    }

    /// A file that ends too early, or is broken inside.
    pub(super) fn damaged(what: impl Into<String>) -> Self {
        Self::new(what, "make the file again, or copy it again from where it came from")
    }
}

/// How [`super::read_counts`] reads.
#[derive(Clone, Copy, Debug)]
pub struct ReadOptions<'a> {
    /// The EXR channel to read, as `channel` or `layer.channel`; `None` takes the only one that there is.
    /// NPY and PNG have no named channels, so that a name is an error there.
    pub channel: Option<&'a str>,
    /// The longest side that is accepted, in pixels.
    pub max_side: u32,
    /// The most pixels that are accepted. Reading takes 4 bytes of memory a pixel, and up to 2 more for a
    /// PNG.
    pub max_pixels: u64,
}

impl Default for ReadOptions<'_> {
    /// The only channel, at most 65536 pixels a side and 2^28 pixels (16384 x 16384, 1 GiB as counts).
    fn default() -> Self {
        Self { channel: None, max_side: 1 << 16, max_pixels: 1 << 28 }
    }
}

impl ReadOptions<'_> {
    /// The size that a header claims, if it is within the limits.
    pub(super) fn check_size(&self, width: u64, height: u64) -> Result<UVec2, Problem> {
        if width == 0 || height == 0 {
            return Err(Problem::new(
                format!("the image has no pixels ({width} x {height})"),
                "give a map of at least 1 x 1 pixel",
            ));
        }
        let too_large = |limit: String| {
            Problem::new(
                format!("the header claims {width} x {height} pixels, more than {limit}"),
                "give a smaller map, or cut it into parts",
            )
        };
        let (Ok(x), Ok(y)) = (u32::try_from(width), u32::try_from(height)) else {
            return Err(too_large(format!("{} a side", self.max_side)));
        };
        if x.max(y) > self.max_side {
            return Err(too_large(format!("{} a side", self.max_side)));
        }
        // Both are below 2^32, so that the product is below 2^64.
        if width * height > self.max_pixels {
            return Err(too_large(format!("{} in all", self.max_pixels)));
        }
        Ok(UVec2::new(x, y))
    }

    /// An error where a channel was named for a format without names.
    pub(super) fn refuse_channel(&self, format: &str) -> Result<(), Problem> {
        self.channel.map_or(Ok(()), |name| {
            Err(Problem::new(
                format!("there is no channel \"{name}\": {format} holds one unnamed channel"),
                "leave the channel out",
            ))
        })
    }
}

/// Why a sample is not a count.
#[derive(Clone, Copy)]
pub(super) enum Refusal {
    Negative,
    Fraction,
    NotANumber,
    Infinite,
    TooLarge,
}

impl Refusal {
    fn what(self) -> &'static str {
        match self {
            Self::Negative => "negative",
            Self::Fraction => "not a whole number",
            Self::NotANumber => "not a number",
            Self::Infinite => "infinite",
            Self::TooLarge => "above 4294967295",
        }
    }

    fn remedy(self) -> &'static str {
        match self {
            Self::Negative | Self::Fraction => {
                "give the number of photons in each pixel, not a density, a difference or a normalised map"
            }
            Self::NotANumber | Self::Infinite => {
                "give the number of photons in each pixel, 0 where there are none"
            }
            Self::TooLarge => "split the photons over several maps: a count has 32 bits",
        }
    }
}

/// What the samples of a file stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// Photons: whole numbers.
    Counts,
    /// Yes or no: 0 is no, any other number is yes, and is read as 1.
    Mask,
}

/// A sample of a file.
pub(super) trait Sample: Copy + Debug {
    /// The count that it stands for, exactly.
    fn count(self) -> Result<u32, Refusal>;
}

/// A sample as part of a mask. Numbers that are no counts are not 0, and so count as set.
fn yes_or_no(sample: impl Sample) -> Result<u32, Refusal> {
    match sample.count() {
        Ok(count) => Ok(u32::from(count != 0)),
        Err(Refusal::NotANumber) => Err(Refusal::NotANumber),
        Err(_) => Ok(1),
    }
}

macro_rules! whole_samples {
    ($($type:ty)*) => {$(
        impl Sample for $type {
            fn count(self) -> Result<u32, Refusal> {
                let wide = i128::from(self);
                u32::try_from(wide).map_err(|_| if wide < 0 { Refusal::Negative } else { Refusal::TooLarge })
            }
        }
    )*};
}
whole_samples!(u8 u16 u32 u64 i8 i16 i32 i64);

impl Sample for f64 {
    fn count(self) -> Result<u32, Refusal> {
        if self.is_nan() {
            Err(Refusal::NotANumber)
        } else if self.is_infinite() {
            Err(Refusal::Infinite)
        } else if self < 0.0 {
            Err(Refusal::Negative)
        } else if self.fract() != 0.0 {
            Err(Refusal::Fraction)
        } else if self > f64::from(u32::MAX) {
            Err(Refusal::TooLarge)
        } else {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "whole and inside the range, as tested above"
            )]
            let count = self as u32;
            Ok(count)
        }
    }
}

impl Sample for f32 {
    fn count(self) -> Result<u32, Refusal> {
        f64::from(self).count()
    }
}

impl Sample for f16 {
    fn count(self) -> Result<u32, Refusal> {
        self.to_f64().count()
    }
}

/// Collects the counts of one map, in any order, and remembers the first sample that is none.
pub(super) struct Counts {
    size: UVec2,
    meaning: Meaning,
    values: Vec<u32>,
    refused: u64,
    /// Index, value and reason of the refused sample that comes first in the image.
    first: Option<(usize, String, Refusal)>,
}

impl Counts {
    /// Zero everywhere; `size` has passed [`ReadOptions::check_size`].
    pub(super) fn new(size: UVec2, meaning: Meaning) -> Result<Self, Problem> {
        let pixels = size.x as usize * size.y as usize;
        let mut values = Vec::new();
        values.try_reserve_exact(pixels).map_err(|_| {
            Problem::new(
                format!("{} x {} counts do not fit into this machine's memory", size.x, size.y),
                "give a smaller map, or cut it into parts",
            )
        })?;
        values.resize(pixels, 0);
        Ok(Self { size, meaning, values, refused: 0, first: None })
    }

    /// Takes the sample of the pixel `index`, counted row after row.
    pub(super) fn put(&mut self, index: usize, sample: impl Sample) {
        let found = match self.meaning {
            Meaning::Counts => sample.count(),
            Meaning::Mask => yes_or_no(sample),
        };
        match found {
            Ok(count) => self.values[index] = count,
            Err(reason) => {
                self.refused += 1;
                if self.first.as_ref().is_none_or(|&(first, ..)| index < first) {
                    self.first = Some((index, format!("{sample:?}"), reason));
                }
            }
        }
    }

    /// The map, if every sample was a count.
    pub(super) fn finish(self) -> Result<Image<u32>, Problem> {
        let Some((index, value, reason)) = self.first else {
            return Ok(Image::from_values(self.size, self.values));
        };
        let (x, y) = (index % self.size.x as usize, index / self.size.x as usize);
        let (what, remedy) = match self.meaning {
            Meaning::Counts => ("are not counts", reason.remedy()),
            Meaning::Mask => ("are not numbers", "give 0 where no radius is needed, else another number"),
        };
        Err(Problem::new(
            format!(
                "the value at ({x}, {y}) is {value}, {}; {} of {} pixels {what}",
                reason.what(),
                self.refused,
                self.values.len()
            ),
            remedy,
        ))
    }
}
