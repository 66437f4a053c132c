//! Radii by the rule of even density ([`Rule::Even`](crate::settings::Rule::Even)), decided in whole numbers.
//!
//! Radii of 0, 1, 2, 4, ... are compared, each with the one before. Let the narrow box hold u photons in an
//! area p, and the ring that the wide one adds w in an area q. Where the density is the same in both, w p - u
//! q is 0 but for noise, and photons that fall by chance give it a variance of p q (u + w): the mean of the
//! two densities times p q (p + q). One photon more is counted in it, so that a box without any is not taken
//! for certain. The *departure* of a pixel is the square of w p - u q over that variance.
//!
//! Where the wide box is as wrong by its bias as the narrow one is by its noise, the departure is 2 b / (a +
//! b) in the mean, with a and b the squares of the sides of both boxes ([`even_threshold`]). That of one
//! pixel is noise itself, so the mean over the box of twice the wide radius decides. Where it exceeds the
//! threshold the radius is left out; two in a row end the search, since one alone may be chance. The radius
//! of a pixel is the largest that is not left out. After F. Rousselle, C. Knaus, M. Zwicker, "Adaptive
//! sampling and reconstruction using greedy error minimization" (2011).

use super::{Inside, Radii, Table, total_area};
use crate::image::Image;
use crate::settings::{EVEN_STEPS, Edges, MOST_EVEN_STEPS, Search, even_step};

/// For each pixel, the widest radius of 0, 1, 2, 4, ... MR over which the density is even but for noise.
/// Limited are those that MR ended. n and the order of the search are not asked for.
#[must_use]
pub fn even(density: &Image<u32>, search: Search) -> Radii {
    let (size, photons) = (density.size(), Table::new(density));
    let mut found = Image::filled(size, Found { radius: 0, failures: 0 });
    for wide in std::iter::successors(Some(1), |wide| Some(2 * wide)).take_while(|&r| r <= search.max_radius)
    {
        let step = even_step(wide);
        let departures = Image::from_fn(size.map(|side| side.div_ceil(step)), |x, y| {
            let boxes = [wide / 2, wide].map(|radius| {
                let inside = Inside::of_box(size, step * x, step * y, radius);
                let area = match search.edges {
                    Edges::Zero => total_area(radius),
                    Edges::Scale => inside.area(),
                };
                (photons.count(inside).into(), area.into())
            });
            departure(boxes, wide)
        });
        let sums = Table::new(&departures);
        let (most, of) = even_threshold(wide);
        found = Image::from_fn(size, |x, y| {
            let Inside { lo, hi } = Inside::of_box(size, x, y, 2 * wide);
            let places = Inside { lo: lo.map(|first| first.div_ceil(step)), hi: hi / step };
            let sum = sums.count(places);
            let is_even = sum * u64::from(of) <= u64::from(most * EVEN_STEPS) * places.area();
            match found.at(x, y) {
                ended @ Found { failures: 2.., .. } => ended,
                _ if is_even => Found { radius: wide, failures: 0 },
                before => Found { failures: before.failures + 1, ..before },
            }
        });
    }
    Radii {
        radius: found.map(|found| found.radius),
        limited: found.map(|found| u8::from(2 * found.radius > search.max_radius)),
    }
}

/// What the radii so far say of a pixel.
#[derive(Clone, Copy)]
struct Found {
    /// The largest candidate.
    radius: u32,
    /// Radii after it that are none, in a row.
    failures: u32,
}

/// The departure of boxes of the radius `wide` and half of it that is still taken for even, as a fraction.
fn even_threshold(wide: u32) -> (u32, u32) {
    let [a, b] = [wide / 2, wide].map(|radius| (2 * radius + 1).pow(2));
    (2 * b, a + b)
}

/// The departure of a narrow and a `wide` box from an even density, by their photons and areas.
fn departure([(narrow, p), (all, area)]: [(u128, u128); 2], wide: u32) -> u32 {
    let (ring, q) = (all - narrow, area - p);
    if q == 0 {
        // The map ends both: nothing is known, which decides nothing.
        let (most, of) = even_threshold(wide);
        return most * EVEN_STEPS / of;
    }
    let difference = (ring * p).abs_diff(narrow * q);
    let variance = p * q * (all + 1);
    let steps = u128::from(EVEN_STEPS) * difference * difference / variance;
    u32::try_from(steps).map_or(MOST_EVEN_STEPS, |steps| steps.min(MOST_EVEN_STEPS))
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    fn search(max_radius: u32, edges: Edges) -> Search {
        Search { max_radius, edges, ..crate::settings::Settings::default().search }
    }

    /// Radii of a row, by counts of a map of which all rows are the same.
    fn row(counts: &[u32], rows: u32, max_radius: u32) -> Vec<u32> {
        let size = UVec2::new(u32::try_from(counts.len()).unwrap(), rows);
        let map = Image::from_fn(size, |x, _| counts[x as usize]);
        let found = even(&map, search(max_radius, Edges::Scale)).radius;
        (0..size.x).map(|x| found.at(x, rows / 2)).collect()
    }

    #[test]
    fn departures_by_hand() {
        // 1 photon in 1 pixel, 8 in the 8 around: the same.
        assert_eq!(departure([(1, 1), (9, 9)], 1), 0);
        // 4 and 8: (8 - 4 · 8)² = 576 over 1 · 8 · 13 is 5.54 variances, or 177.2 steps.
        assert_eq!(departure([(4, 1), (12, 9)], 1), 177);
        // 5 and 8: 1024 / (8 · 14) is 9.1, of which 6 count; so does any more.
        assert_eq!(departure([(5, 1), (13, 9)], 1), 192);
        let most = u128::from(u32::MAX);
        assert_eq!(departure([(0, 4225), (most, 16_641)], 64), 192);
        // No photon is the same everywhere; one more is the least that noise is taken for.
        assert_eq!(departure([(0, 1), (0, 9)], 1), 0);
        // (1 · 1 - 0 · 8)² over 8 · 2: a sixteenth.
        assert_eq!(departure([(0, 1), (1, 9)], 1), 2);
        // Nothing is known: 18 / 10, cut to 57 / 32.
        assert_eq!(departure([(3, 2), (3, 2)], 1), 57);
        assert_eq!(even_threshold(1), (18, 10));
        assert_eq!(even_threshold(64), (33_282, 20_866));
    }

    #[test]
    fn even_ground_takes_the_widest_box() {
        for edges in [Edges::Zero, Edges::Scale] {
            for size in [UVec2::ONE, UVec2::new(1, 7), UVec2::new(200, 1), UVec2::new(33, 20)] {
                let empty = even(&Image::filled(size, 0), search(64, edges));
                assert!(empty.radius.values().iter().all(|&radius| radius == 64), "{size}");
                assert!(empty.limited.values().iter().all(|&limited| limited == 1), "{size}");
            }
        }
        for count in [1, 1000, 1_000_000] {
            let found = even(&Image::filled(UVec2::new(33, 20), count), search(32, Edges::Scale));
            assert!(found.radius.values().iter().all(|&radius| radius == 32), "{count}");
        }
        // Where nothing is outside, the density ends at the edge of the map.
        let found = even(&Image::filled(UVec2::splat(150), 1000), search(64, Edges::Zero));
        assert_eq!([found.radius.at(0, 75), found.radius.at(75, 75)], [0, 16]);
        assert_eq!([found.limited.at(0, 75), found.limited.at(75, 75)], [0, 0]);
    }

    #[test]
    fn a_bright_pixel_by_hand() {
        let mut map = Image::filled(UVec2::splat(6), 0);
        map.set(1, 1, 200);
        // The nine tests that see it are at 6 variances. Of the columns in a box of radius 2, cut to the map,
        // 3 of 3, 3 of 4, 3 of 5, 2 of 5, 1 of 4 and none belong to these, and rows alike; 6 times the
        // product may be 1.8, and is just that for 3 / 4 · 2 / 5.
        let found = even(&map, search(1, Edges::Scale));
        #[rustfmt::skip]
        assert_eq!(found.radius.values(), [
            0, 0, 0, 0, 1, 1,
            0, 0, 0, 1, 1, 1,
            0, 0, 0, 1, 1, 1,
            0, 1, 1, 1, 1, 1,
            1, 1, 1, 1, 1, 1,
            1, 1, 1, 1, 1, 1,
        ]);
        assert_eq!(found.limited.map(u32::from), found.radius);
    }

    #[test]
    fn a_step_keeps_its_edge() {
        let counts: Vec<u32> = (0..80).map(|x| if x < 40 { 100 } else { 800 }).collect();
        let found = row(&counts, 9, 16);
        // Tests of radius r that see the step are those less than r columns from it, all at 6 variances. Of
        // the 4 r + 1 columns of a box, about a quarter may be theirs: at column 20, 5 of 33 see it with
        // radius 8, and 3 places of 9 with 16.
        assert_eq!(found[36..44], [1, 1, 0, 0, 0, 0, 1, 1]);
        assert_eq!([0, 20, 30, 34].map(|x: usize| found[x]), [8, 8, 4, 2]);
        assert!(found[..40].is_sorted_by(|a, b| a >= b), "{found:?}");
    }

    #[test]
    fn a_ramp_is_no_edge_and_a_line_is_one() {
        let ramp: Vec<u32> = (0..100).map(|x| 1000 + 10 * x).collect();
        assert_eq!(row(&ramp, 40, 16)[50], 16, "boxes around a pixel have the mean of a ramp");
        let line: Vec<u32> = (0..101).map(|x| if x == 50 { 80 } else { 10 }).collect();
        let found = row(&line, 40, 16);
        assert_eq!([found[50], found[51], found[0], found[100]], [0, 0, 16, 16]);
    }

    #[test]
    fn a_spike_of_a_billion_in_an_empty_map_keeps_to_itself() {
        let mut map = Image::filled(UVec2::splat(61), 0);
        map.set(30, 30, 1_000_000_000);
        let found = even(&map, search(16, Edges::Scale)).radius;
        let along = |x: u32| found.at(x, 30);
        // 9 of the 25 tests around the spike see it: 6 · 9 / 25 > 1.8; 6 of 25 do not reach that.
        assert_eq!([28, 29, 30, 31, 32].map(along), [1, 0, 0, 0, 1]);
        // 25 of the 81 places in the box of radius 32 around a corner see it with radius 16, none with 8.
        assert_eq!(found.at(0, 0), 8);
        let mirrored = Image::from_fn(map.size(), |x, y| found.at(60 - x, 60 - y));
        assert!(found == mirrored);
    }
}
