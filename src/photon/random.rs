//! Random numbers of a photon's own: the same whatever thread follows it, and whatever the others draw.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

/// What the numbers are for, so that where a photon starts and how it goes on are independent.
#[derive(Clone, Copy)]
pub(super) enum Purpose {
    Emission,
    Bounces,
}

/// The numbers of one photon for one purpose.
pub(super) struct Stream(Pcg64Mcg);

impl Stream {
    pub(super) fn new(seed: u64, id: u32, purpose: Purpose) -> Self {
        let family = scramble(seed.wrapping_mul(2).wrapping_add(purpose as u64));
        Self(Pcg64Mcg::seed_from_u64(scramble(family.wrapping_add(u64::from(id)))))
    }

    /// From 0 to less than 1.
    pub(super) fn number(&mut self) -> f64 {
        self.0.random()
    }
}

/// SplitMix64's step: different numbers stay different, and neighbours end far apart
/// (G. Steele and others, "Fast Splittable Pseudorandom Number Generators", 2014).
fn scramble(number: u64) -> u64 {
    let mut mixed = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ (mixed >> 31)
}
