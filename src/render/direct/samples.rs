//! Places on lights: points of the unit square that are spread evenly, however many of them are taken.

use sobol_burley::sample;

/// As many points as the sequence has.
pub(in crate::render) const MOST: u32 = 1 << 16;

/// Sobol's sequence, scrambled after A. Owen by a number of its own (B. Burley, "Practical hash-based Owen
/// scrambling", 2020).
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Samples(u32);

impl Samples {
    /// For a light at a place; the numbers of places and lights may be anything.
    pub(in crate::render) fn new(seed: u64, place: u32, light: u32) -> Self {
        // Odd multiples keep neighbours and seeds apart; the rest is SplitMix64's.
        let mut mixed = seed
            ^ u64::from(place).wrapping_mul(0xbf58_476d_1ce4_e5b9)
            ^ u64::from(light).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let number = (mixed >> 32) as u32;
        Self(number)
    }

    /// The point of a number less than [`MOST`]; those of the first 4, 16, 64, ... are one in each cell of a
    /// grid.
    pub(in crate::render) fn at(self, index: u32) -> [f64; 2] {
        [0, 1].map(|dimension| f64::from(sample(index, dimension, self.0)))
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "whole numbers")]
mod tests {
    use super::*;

    #[test]
    fn points_are_one_in_each_cell_and_others_at_each_place() {
        let of = |place, light| {
            let samples = Samples::new(1, place, light);
            (0..16).map(move |index| samples.at(index)).collect::<Vec<_>>()
        };
        for place in 0..100 {
            let points = of(place, 0);
            for cell in 0..16 {
                let is_in =
                    |[u, v]: &[f64; 2]| (4.0 * u).floor() + 4.0 * (4.0 * v).floor() == f64::from(cell);
                assert_eq!(points.iter().filter(|&uv| is_in(uv)).count(), 1);
            }
            assert_ne!(of(place, 0), of(place + 1, 0));
            assert_ne!(of(place, 0), of(place, 1));
        }
    }
}
