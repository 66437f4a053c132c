//! Photons and what they add up to in cells of all sizes, for discs of many widths at a cost that hardly
//! depends on how many photons these hold.
//!
//! Photons are sorted by surface, by the axis that their normal is nearest to, and along a Z curve. So those
//! of a cell are next to each other, and those of the 8 cells in it as well. A cell that is small as seen
//! from a place counts as a whole, others are opened (J. Barnes, P. Hut, "A hierarchical O(N log N)
//! force-calculation algorithm", 1986). Memory: at most about 30 bytes a photon beside the photon.

use glam::{UVec3, Vec3};
use rayon::prelude::*;

use super::nearest::around_most;
use super::rings::{DISCS, Held, Met, Rings, Run, mean};
use super::sight::Place;
use crate::photon::PhotonPoint;

/// The Z curve has 2^12 cells along each axis.
const DOUBLINGS: u32 = 12;
const LAST_CELL: f32 = 4095.0;
/// Cells that hold fewer photons in the mean are left out.
const LEAST_PHOTONS: usize = 3;

/// Cells of one size that hold photons.
#[derive(Debug)]
struct Level {
    runs: Vec<Run>,
    /// Where the smaller cells of each begin, or else its photons, and where the last end.
    begins: Vec<u32>,
}

/// Photons and what they add up to.
#[derive(Debug)]
pub(super) struct PhotonSums {
    photons: Vec<PhotonPoint>,
    /// From small cells to the largest, one for each group of photons.
    levels: Vec<Level>,
    /// Those of the largest cells.
    groups: Vec<u64>,
    /// The root of the mean square of a photon's power.
    usual: f64,
}

impl PhotonSums {
    pub(super) fn new(photons: &[PhotonPoint]) -> Self {
        let mut photons = photons.to_vec();
        let (min, max) = around_most(&photons);
        let scale = LAST_CELL / (max - min).max_element().max(f32::MIN_POSITIVE);
        let code = |photon: &PhotonPoint| {
            let cell = ((photon.position - min) * scale).clamp(Vec3::ZERO, Vec3::splat(LAST_CELL));
            group(photon) << (3 * DOUBLINGS) | along_z_curve(cell.as_uvec3())
        };
        photons.par_sort_by_cached_key(code);
        let squares: f64 = photons.par_iter().map(|photon| mean(photon.power.as_dvec3()).powi(2)).sum();
        #[expect(clippy::cast_precision_loss, reason = "less than 2^53")]
        let usual = (squares / photons.len().max(1) as f64).sqrt();

        let mut codes: Vec<u64> = photons.par_iter().map(code).collect();
        let mut levels: Vec<Level> = Vec::new();
        let mut doublings = 0;
        while doublings < DOUBLINGS {
            doublings += 1;
            let of_cell = |code: u64| code >> (3 * doublings);
            let mut begins = begins(&codes, of_cell);
            if doublings < DOUBLINGS && begins.len() * LEAST_PHOTONS > photons.len() {
                continue;
            }
            codes = begins.iter().map(|&begin| codes[begin as usize]).collect();
            let whole = levels.last().map_or(photons.len(), |level| level.runs.len());
            begins.push(u32::try_from(whole).expect("fewer than 2^32 photons"));
            let parts = |ends: &[u32]| ends[0] as usize..ends[1] as usize;
            let runs = if let Some(level) = levels.last() {
                let sum = |ends: &[u32]| Run::sum(&level.runs[parts(ends)].iter().copied());
                begins.par_windows(2).map(sum).collect()
            } else {
                let run = |photon| Run::of(photon, usual);
                let sum = |ends: &[u32]| Run::sum(&photons[parts(ends)].iter().map(run));
                begins.par_windows(2).map(sum).collect()
            };
            levels.push(Level { runs, begins });
        }
        let groups = codes.iter().map(|code| code >> (3 * DOUBLINGS)).collect();
        Self { photons, levels, groups, usual }
    }

    /// In an order of their own.
    pub(super) fn photons(&self) -> &[PhotonPoint] {
        &self.photons
    }

    /// The root of the mean square of a photon's power.
    pub(super) fn usual_power(&self) -> f64 {
        self.usual
    }

    /// What the discs around a place hold, from the narrowest, whose radius is in scene units, to the widest.
    pub(super) fn around(&self, place: &Place, narrowest: f64) -> [Held; DISCS] {
        let mut rings = Rings::new(place, narrowest);
        let first = GROUPS * number(place.surface);
        let begin = self.groups.partition_point(|&group| group < first);
        let end = self.groups.partition_point(|&group| group < first + GROUPS);
        for index in begin..end {
            self.visit(self.levels.len() - 1, index, &mut rings);
        }
        rings.discs(narrowest)
    }

    /// Adds a cell to the rings, or what is in it.
    fn visit(&self, level: usize, index: usize, rings: &mut Rings) {
        let Level { runs, begins } = &self.levels[level];
        let parts = begins[index] as usize..begins[index + 1] as usize;
        match rings.meet(&runs[index]) {
            Met::Outside => {}
            Met::Small => rings.add(&runs[index]),
            Met::Large if level > 0 => parts.for_each(|part| self.visit(level - 1, part, rings)),
            Met::Large => {
                for photon in &self.photons[parts] {
                    rings.add(&Run::of(photon, self.usual));
                }
            }
        }
    }
}

/// Where cells begin.
fn begins(codes: &[u64], of_cell: impl Fn(u64) -> u64) -> Vec<u32> {
    let is_first = |&index: &usize| index == 0 || of_cell(codes[index - 1]) != of_cell(codes[index]);
    #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 photons")]
    let begins = (0..codes.len()).filter(is_first).map(|index| index as u32).collect();
    begins
}

/// Groups of each surface: by the axis that is nearest to the normal.
const GROUPS: u64 = 6;

fn group(photon: &PhotonPoint) -> u64 {
    let axis = photon.normal.abs().max_position();
    GROUPS * number(photon.surface) + 2 * axis as u64 + u64::from(photon.normal[axis] < 0.0)
}

/// Of a surface.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole numbers up to 2^24")]
fn number(surface: f32) -> u64 {
    surface as u64
}

/// Where a cell is on the curve: the bits of its coordinates by turns.
fn along_z_curve(cell: UVec3) -> u64 {
    let apart = |bits: u32| {
        [(16, 0x0F00_00FF), (8, 0x0F00_F00F), (4, 0xC30C_30C3), (2, 0x0002_4924_9249)]
            .into_iter()
            .fold(u64::from(bits), |bits, (by, mask)| (bits | bits << by) & mask)
    };
    apart(cell.x) << 2 | apart(cell.y) << 1 | apart(cell.z)
}

#[cfg(test)]
#[expect(clippy::cast_precision_loss, reason = "small numbers, and random bits")]
mod tests {
    use std::f64::consts::PI;

    use glam::DVec3;

    use super::*;

    /// From 0 to 1, after SplitMix64.
    fn random(seed: u64) -> impl FnMut() -> f32 {
        let mut state = seed;
        move || {
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((z >> 40) as f32) / 16_777_216.0
        }
    }

    fn photon(x: f32, z: f32, power: f32) -> PhotonPoint {
        let power = Vec3::new(power, 2.0 * power, 0.0);
        PhotonPoint { position: Vec3::new(x, 0.0, z), normal: Vec3::Y, power, surface: 3.0 }
    }

    fn place(x: f64, z: f64) -> Place {
        let position = DVec3::new(x, 0.0, z);
        Place { pixel: 0, position, normal: DVec3::Y, share: Vec3::ONE, distance: 1.0, surface: 3.0 }
    }

    /// By a loop over photons.
    fn red_around(photons: &[PhotonPoint], place: &Place, radius: f64) -> f64 {
        let weighed = photons.iter().map(|photon| {
            let squared = photon.position.as_dvec3().distance_squared(place.position) / radius.powi(2);
            f64::from(photon.power.x) * (1.0 - squared).max(0.0)
        });
        2.0 * weighed.sum::<f64>() / (PI * radius.powi(2))
    }

    #[test]
    fn discs_hold_what_a_loop_over_photons_finds() {
        let mut number = random(1);
        let photons: Vec<_> = (0..50_000).map(|_| photon(number(), number(), 1.0)).collect();
        let sums = PhotonSums::new(&photons);
        for (x, z) in [(0.5, 0.5), (0.31, 0.77), (0.0, 0.2), (1.0, 1.0)] {
            let place = place(x, z);
            let held = sums.around(&place, 0.004);
            // Cells that count as a whole are not where their photons are; narrow discs hold little.
            for (disc, held) in held.iter().enumerate().skip(3) {
                let found = red_around(&photons, &place, 0.004 * f64::from(1 << disc));
                assert!((held.power.x / found - 1.0).abs() < 0.1, "{disc}: {} {found}", held.power.x);
                assert!((held.power.y / held.power.x - 2.0).abs() < 1e-5);
                assert!((held.squares / held.power.x - 1.0).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn a_photon_is_held_as_it_is_by_the_discs_that_reach_it() {
        let photons = [photon(3.0, 4.0, 7.0)];
        let held = PhotonSums::new(&photons).around(&place(0.0, 0.0), 1.0);
        for (disc, held) in held.iter().enumerate() {
            let found = red_around(&photons, &place(0.0, 0.0), f64::from(1 << disc));
            assert!((held.power.x - found).abs() <= 1e-6 * found, "{disc}");
            assert_eq!(held.power.x > 0.0, disc >= 3);
        }
    }

    #[test]
    fn photons_of_other_surfaces_and_other_sides_are_left_out() {
        let there = photon(0.0, 0.0, 1.0);
        let photons = [
            PhotonPoint { surface: 2.0, ..there },
            PhotonPoint { surface: 4.0, ..there },
            PhotonPoint { normal: Vec3::NEG_Y, ..there },
            PhotonPoint { normal: Vec3::X, ..there },
        ];
        let held = PhotonSums::new(&photons).around(&place(0.0, 0.0), 1.0);
        assert_eq!(held, [Held::default(); DISCS]);
    }

    #[test]
    fn nothing_is_held_of_no_photons_and_of_those_without_power() {
        for photons in [vec![], vec![photon(0.0, 0.0, 0.0); 9]] {
            let held = PhotonSums::new(&photons).around(&place(0.0, 0.0), 1.0);
            assert_eq!(held, [Held::default(); DISCS]);
        }
    }

    #[test]
    fn powers_may_be_far_apart() {
        let mut number = random(2);
        let power = |number: &mut dyn FnMut() -> f32| 1e-6 * (12.0 * number()).exp2().powi(3);
        let photons: Vec<_> = (0..5000).map(|_| photon(number(), number(), power(&mut number))).collect();
        let sums = PhotonSums::new(&photons);
        let place = place(0.4, 0.6);
        for (disc, held) in sums.around(&place, 0.01).iter().enumerate().skip(2) {
            let found = red_around(&photons, &place, 0.01 * f64::from(1 << disc));
            assert!((held.power.x - found).abs() <= 0.05 * found, "{disc}: {} {found}", held.power.x);
            assert!(held.squares.is_finite() && held.squares >= 0.0);
        }
    }

    #[test]
    fn the_curve_takes_bits_by_turns() {
        for cell in [UVec3::new(1, 2, 4), UVec3::new(4095, 0, 1234), UVec3::new(0, 4095, 2748)] {
            let bits = (0..12).map(|bit| {
                let of = |side: u32| u64::from(side >> bit & 1);
                (of(cell.x) << 2 | of(cell.y) << 1 | of(cell.z)) << (3 * bit)
            });
            assert_eq!(along_z_curve(cell), bits.sum::<u64>());
        }
    }
}
