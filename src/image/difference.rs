//! How two maps differ, pixel by pixel.

use std::fmt;

use crate::error::{Error, Result};
use crate::image::Image;

/// Places that a [`Difference`] remembers.
const PLACES: usize = 5;

/// What differs between two maps of one size.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Difference {
    /// Pixels that were compared.
    pub pixels: u64,
    /// Pixels whose values differ.
    pub wrong_pixels: u64,
    /// The largest |a - b|.
    pub max: u64,
    /// The mean of |a - b| over all pixels.
    pub mean: f64,
    /// The first pixels that differ, row by row; at most five.
    pub first: Vec<Place>,
}

/// A pixel with two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Place {
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// Value in the first map.
    pub a: u32,
    /// Value in the second map.
    pub b: u32,
}

impl Difference {
    /// Compares every pixel of `a` with that of `b`.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if their sizes differ.
    pub fn between<T: Copy + Into<u32>>(a: &Image<T>, b: &Image<T>) -> Result<Self> {
        if a.size() != b.size() {
            let text = |image: &Image<T>| format!("{} x {}", image.size().x, image.size().y);
            return Err(Error::Mismatch { what: "size of the second map", expected: text(a), got: text(b) });
        }
        let width = a.size().x as usize;
        let mut difference =
            Self { pixels: a.values().len() as u64, wrong_pixels: 0, max: 0, mean: 0.0, first: Vec::new() };
        let mut sum = 0_u64;
        for (index, (&a, &b)) in a.values().iter().zip(b.values()).enumerate() {
            let (a, b): (u32, u32) = (a.into(), b.into());
            if a == b {
                continue;
            }
            difference.wrong_pixels += 1;
            difference.max = difference.max.max(u64::from(a.abs_diff(b)));
            sum += u64::from(a.abs_diff(b));
            if difference.first.len() < PLACES {
                let coordinate = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
                difference.first.push(Place {
                    x: coordinate(index % width),
                    y: coordinate(index / width),
                    a,
                    b,
                });
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "a mean is rounded anyway")]
        {
            difference.mean = sum as f64 / difference.pixels as f64;
        }
        Ok(difference)
    }

    /// The part of the pixels that differ, from 0 to 1.
    #[must_use]
    pub fn share(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "a share is rounded anyway")]
        let share = self.wrong_pixels as f64 / self.pixels as f64;
        share
    }

    /// Whether no pixel differs.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.wrong_pixels == 0
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_none() {
            return write!(formatter, "all {} pixels are equal", self.pixels);
        }
        write!(
            formatter,
            "{} of {} pixels differ, by {:.4} on average over all and {} at most; first at ",
            self.wrong_pixels, self.pixels, self.mean, self.max
        )?;
        for (index, Place { x, y, a, b }) in self.first.iter().enumerate() {
            let separator = if index == 0 { "" } else { "; " };
            write!(formatter, "{separator}({x}, {y}): {a} and {b}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    #[test]
    fn counts_largest_mean_and_places_by_hand() {
        let a = Image::from_values(UVec2::new(2, 2), vec![1_u32, 5, 3, 4]);
        let b = Image::from_values(UVec2::new(2, 2), vec![1_u32, 2, 3, 5]);
        let difference = Difference::between(&a, &b).unwrap();
        assert_eq!((difference.pixels, difference.wrong_pixels, difference.max), (4, 2, 3));
        assert!((difference.mean - 1.0).abs() < f64::EPSILON);
        assert_eq!(difference.first[0], Place { x: 1, y: 0, a: 5, b: 2 });
        assert_eq!(difference.first[1], Place { x: 1, y: 1, a: 4, b: 5 });
        assert!(!difference.is_none());
        assert!((difference.share() - 0.5).abs() < f64::EPSILON);
        assert_eq!(
            difference.to_string(),
            "2 of 4 pixels differ, by 1.0000 on average over all and 3 at most; \
             first at (1, 0): 5 and 2; (1, 1): 4 and 5"
        );
        assert!(Difference::between(&a, &a).unwrap().is_none());
    }

    #[test]
    fn other_sizes_are_an_error() {
        let a = Image::filled(UVec2::new(2, 3), 0_u32);
        let b = Image::filled(UVec2::new(3, 2), 0_u32);
        assert!(matches!(Difference::between(&a, &b), Err(Error::Mismatch { .. })));
    }
}
