//! Power of the photons of each pixel in whole units, whose sums are exact.
//!
//! - A unit is a power of two, so large that all photons together stay below 2^32 of it: then sums modulo
//!   2^32 over any box are right, and nothing is rounded where powers are divided by it.
//! - A photon is a whole number of units: rounded down or up by chance, as its fraction says, so that the
//!   mean is right however small it is. The chance comes from the photon's own bits, so that a photon is the
//!   same number whatever comes before it.
//! - OpenGL 3.3 cannot blend integers: the numbers are split into their lowest 8 bits and the rest, and both
//!   are added in f32. The rest never reaches 2^24. The lowest 8 bits do not where a pixel holds 65,793
//!   photons or fewer: up to there sums are exact, whatever the order. Above, the order shows: of N photons
//!   on a pixel the sum of these bits is off by up to N 2^-25 of itself.

use super::PhotonTotals;
use crate::error::Result;
use crate::gl::{StateGuard, Texture};
use crate::image::Image;

/// The most that weighing multiplies a pixel's units with: its area rounds up by half of itself at most.
const MOST_WEIGHT: f64 = 1.5;

/// What one unit is, of power and of squared power.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxUnits {
    /// Of the power of a colour, in that of [`PhotonPoint::power`](crate::PhotonPoint::power).
    pub power: f32,
    /// The root of that of squared powers.
    pub square_root: f32,
}

impl FluxUnits {
    /// The smallest units in which such photons fit.
    pub(crate) fn of(totals: &PhotonTotals) -> Self {
        let brightest = totals.power.into_iter().fold(0.0, f64::max);
        Self {
            power: power_of_two(MOST_WEIGHT * brightest / LIMIT),
            square_root: power_of_two((MOST_WEIGHT * MOST_WEIGHT * totals.squares / LIMIT).sqrt()),
        }
    }

    /// The larger of both, each.
    pub(crate) fn max(self, other: Self) -> Self {
        Self { power: self.power.max(other.power), square_root: self.square_root.max(other.square_root) }
    }

    /// Four times these: room for four times the photons before units grow again.
    pub(crate) fn with_room(self) -> Self {
        Self { power: 4.0 * self.power, square_root: 2.0 * self.square_root }
    }
}

/// Sums below this number of units are right modulo 2^32; the margin is for rounding.
const LIMIT: f64 = 4_294_000_000.0;

/// The smallest power of two that is not less, of those whose inverse is a number as well.
#[expect(clippy::cast_possible_truncation, reason = "a power of two within the range of f32")]
fn power_of_two(least: f64) -> f32 {
    least.max(1e-37).log2().ceil().min(126.0).exp2() as f32
}

/// Power of each pixel's photons in units: red, green, blue, and squares of their sum.
#[derive(Debug)]
pub struct FluxMap {
    /// The lowest 8 bits of each photon, added up; GL_RGBA32F.
    low: Texture,
    /// The rest, in 256 units.
    high: Texture,
    units: FluxUnits,
    totals: PhotonTotals,
}

impl FluxMap {
    /// The power that a stage adds up in textures of its own.
    pub(crate) fn of_stage(low: &Texture, high: &Texture) -> Self {
        let totals = PhotonTotals::default();
        Self { low: low.alias(), high: high.alias(), units: FluxUnits::of(&totals), totals }
    }

    /// What one unit is.
    #[must_use]
    pub fn units(&self) -> FluxUnits {
        self.units
    }

    /// What is known of all photons so far.
    #[must_use]
    pub fn totals(&self) -> &PhotonTotals {
        &self.totals
    }

    pub(crate) fn set(&mut self, units: FluxUnits, totals: PhotonTotals) {
        (self.units, self.totals) = (units, totals);
    }

    /// The lowest bits, and the rest.
    pub(crate) fn as_textures(&self) -> [&Texture; 2] {
        [&self.low, &self.high]
    }

    /// Reads it back in units: red, green, blue and squares; waits for the GPU.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn read_units(&self) -> Result<Image<[u64; 4]>> {
        let gl = self.low.gl();
        let _state = StateGuard::new(gl)?;
        let (low, high): (Image<[f32; 4]>, Image<[f32; 4]>) = (self.low.read(0), self.high.read(0));
        gl.check("reading a flux map back")?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole numbers")]
        let whole = |value: f32| value as u64;
        Ok(Image::from_fn(low.size(), |x, y| {
            let (low, high) = (low.at(x, y), high.at(x, y));
            std::array::from_fn(|channel| whole(low[channel]) + 256 * whole(high[channel]))
        }))
    }

    /// Reads the power back, linear RGB; waits for the GPU.
    ///
    /// # Errors
    /// As [`read_units`](Self::read_units).
    pub fn read(&self) -> Result<Image<[f64; 3]>> {
        let unit = f64::from(self.units.power);
        #[expect(clippy::cast_precision_loss, reason = "less than 2^33")]
        let power = |units: u64| units as f64 * unit;
        Ok(self.read_units()?.map(|[red, green, blue, _]| [power(red), power(green), power(blue)]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_by_hand() {
        let of = |power, squares| FluxUnits::of(&PhotonTotals { count: 1, power, squares });
        let limit = LIMIT / 1.5;
        // Just what fits into a unit of 1, and a little more.
        assert_eq!(of([0.0, 0.9 * limit, limit], limit / 1.5), FluxUnits { power: 1.0, square_root: 1.0 });
        let more = of([1.01 * limit, 0.0, 0.0], 1.01 * limit / 1.5);
        assert_eq!(more, FluxUnits { power: 2.0, square_root: 2.0 });
        assert_eq!(more.with_room(), FluxUnits { power: 8.0, square_root: 4.0 });
        // Nothing, and more than f32 holds.
        assert!(of([0.0; 3], 0.0).power > 0.0 && 1.0 / of([0.0; 3], 0.0).power < f32::INFINITY);
        assert!(of([1e300; 3], 1e300).power < f32::INFINITY);
    }
}
