//! What photons carry together, which decides the units of exact sums.

use std::ops::Add;

use crate::photon::PhotonPoint;

/// Number and power of photons, seen or not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhotonTotals {
    /// How many there are.
    pub count: u64,
    /// Sum of their power, linear RGB; not negative and finite.
    pub power: [f64; 3],
    /// Sum of the squares of their power, the three colours together.
    pub squares: f64,
}

impl PhotonTotals {
    /// Those of some photons.
    #[must_use]
    pub fn of(photons: &[PhotonPoint]) -> Self {
        let mut totals = Self { count: photons.len() as u64, ..Self::default() };
        for photon in photons {
            let power = photon.power.as_dvec3();
            for (sum, power) in totals.power.iter_mut().zip(power.to_array()) {
                *sum += power;
            }
            totals.squares += power.element_sum().powi(2);
        }
        totals
    }

    /// Whether every photon of them had power that is finite; and none of a sum that is negative.
    pub(crate) fn is_finite(&self) -> bool {
        self.power.iter().chain([&self.squares]).all(|sum| sum.is_finite() && *sum >= 0.0)
    }

    /// Mean of the squared powers, 0 without photons.
    pub(crate) fn mean_square(&self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "a mean")]
        let count = self.count.max(1) as f64;
        self.squares / count
    }
}

impl Add for PhotonTotals {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let power = std::array::from_fn(|colour| self.power[colour] + other.power[colour]);
        Self { count: self.count + other.count, power, squares: self.squares + other.squares }
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable as _;
    use glam::Vec3;

    use super::*;

    #[test]
    fn sums_by_hand() {
        let photon =
            |red, green, blue| PhotonPoint { power: Vec3::new(red, green, blue), ..PhotonPoint::zeroed() };
        let two = PhotonTotals::of(&[photon(1.0, 2.0, 3.0), photon(0.0, 0.0, 3.0)]);
        assert_eq!(two, PhotonTotals { count: 2, power: [1.0, 2.0, 6.0], squares: 45.0 });
        let four = PhotonTotals { count: 4, power: [2.0, 4.0, 12.0], squares: 90.0 };
        assert_eq!(two + two, four);
        let means = [two, PhotonTotals::default()].map(|totals| totals.mean_square());
        assert!(means.iter().zip([22.5, 0.0]).all(|(mean, expected)| (mean - expected).abs() < 1e-12));
        assert!(two.is_finite() && !PhotonTotals::of(&[photon(f32::NAN, 0.0, 0.0)]).is_finite());
    }
}
