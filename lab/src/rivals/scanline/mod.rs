//! An exact table, and a search that starts from the row before: the fastest exact way on a processor that we
//! know.
//!
//! With zero edges, radii of neighbours differ by at most one: |R(p) - R(q)| <= max(|dx|, |dy|), the map's
//! edges and the cap at MR included. So the radius next to a radius r is r - 1, r or r + 1, and two counts
//! decide which. The neighbour is the one in the row before, so that no pixel of a row waits for another one,
//! and nothing branches: a core has the counts of many pixels in flight at once.
//!
//! With scaled edges neighbours may differ by any amount. But no scaled radius is larger than the one with
//! zero edges, R, and both are equal where the distance a to the nearest edge of the map is R or more.
//! Elsewhere the scaled radius is in (a, R]: these pixels alone are searched again, from the radius of the
//! pixel before.
//!
//! Cost: one pass for the table and 8 reads a pixel, whatever the map, n and MR; with scaled edges at least 4
//! more for a pixel nearer to the edge than its radius. Memory: the table, with margins of MR. All of it is
//! allocated once. On all cores, the map is cut into bands of rows, each with a table of its own that reaches
//! MR rows into its neighbours', so that no core waits for another.
//!
//! Limit of exactness: none. Sums are modulo 2^32 of counts clamped to n (facts 1 and 2 of
//! [`exactness`](varikernel::maps::exactness)); where a box could hold 2^32 of them all the same, the
//! definition's table of u64 answers, slowly.
//!
//! Tried and left out: the left neighbour in place of the one above takes twice the time; a second count only
//! where the first asks for it takes half of it on empty maps, as much on a caustic and a fifth more on
//! sparse ones.

mod march;
mod table;

use glam::UVec2;
use rayon::prelude::*;

use march::Band;
use varikernel::image::Image;
use varikernel::reference::{Radii, radius_by_table};
use varikernel::settings::Search;

/// Bands that each thread gets: several, so that a slow one does not delay all.
const BANDS_A_THREAD: usize = 4;
/// The least pixels of a band: a tenth of a millisecond's work, ten times what handing it out costs.
const BAND_PIXELS: u32 = 1 << 14;

/// How many cores take part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cores {
    /// The caller's.
    One,
    /// As many as rayon's pool has threads.
    All,
}

/// What is asked of a map of one size.
#[derive(Clone, Copy, Debug)]
struct Question {
    size: UVec2,
    search: Search,
    /// The largest radius that is tried with zero edges: MR, or what covers the map from any pixel if that is
    /// less.
    reach: u32,
}

impl Question {
    /// Whether no box that is counted holds 2^32 photons, with counts clamped to n.
    fn fits_32_bits(&self, density: &Image<u32>) -> bool {
        let limit = 1 << 32;
        let min_photons = self.search.min_photons;
        // One radius more than `reach` is counted, but never returned.
        let sides = self.size.min(UVec2::splat(2 * self.reach + 3));
        let area = u64::from(sides.x) * u64::from(sides.y);
        let clamped_total =
            || density.values().iter().map(|&count| u64::from(count.min(min_photons))).sum::<u64>();
        u128::from(area) * u128::from(min_photons) < limit || u128::from(clamped_total()) < limit
    }
}

/// The search and its memory, for maps of one size.
#[derive(Debug)]
pub struct Scanline {
    question: Question,
    bands: Vec<Band>,
    radii: Radii,
}

impl Scanline {
    /// Allocates for maps of `size`.
    ///
    /// # Panics
    /// If a side of `size` is zero.
    #[must_use]
    pub fn new(size: UVec2, search: Search, cores: Cores) -> Self {
        let covers_all = (size.max_element() - 1).max(1);
        let question = Question { size, search, reach: search.max_radius.min(covers_all) };
        let band_rows = match cores {
            Cores::One => size.y,
            Cores::All => band_rows(question, rayon::current_num_threads()),
        };
        Self::in_bands(question, band_rows)
    }

    fn in_bands(question: Question, band_rows: u32) -> Self {
        let size = question.size;
        let radii = Radii { radius: Image::filled(size, 0), limited: Image::filled(size, 0) };
        let rows = (0..size.y).step_by(band_rows as usize).map(|y| y..(y + band_rows).min(size.y));
        Self { question, bands: rows.map(|rows| Band::new(question, rows)).collect(), radii }
    }

    /// The radii of `density`, in photons per pixel.
    ///
    /// # Panics
    /// If the map is of another size.
    pub fn run(&mut self, density: &Image<u32>) -> &Radii {
        let Question { size, search, .. } = self.question;
        assert_eq!(density.size(), size, "a map of another size");
        if !self.question.fits_32_bits(density) {
            self.radii = radius_by_table(density, search);
            return &self.radii;
        }
        let (radius, limited) = (self.radii.radius.values_mut(), self.radii.limited.values_mut());
        if let [whole] = self.bands.as_mut_slice() {
            whole.march(density, radius, limited);
        } else {
            let pixels = self.bands[0].pixels();
            let targets = radius.par_chunks_mut(pixels).zip(limited.par_chunks_mut(pixels));
            self.bands.par_iter_mut().zip(targets).for_each(|(band, (radius, limited))| {
                band.march(density, radius, limited);
            });
        }
        &self.radii
    }

    /// What the last run found; zeros before the first.
    #[must_use]
    pub fn radii(&self) -> &Radii {
        &self.radii
    }
}

/// Rows of a band: few, but no fewer than its table overlaps those of its neighbours, unless threads would go
/// without.
fn band_rows(question: Question, threads: usize) -> u32 {
    let rows = question.size.y;
    let least = BAND_PIXELS.div_ceil(question.size.x).min(rows);
    let shared_by = |bands: usize| rows.div_ceil(u32::try_from(bands).unwrap_or(u32::MAX));
    shared_by(BANDS_A_THREAD * threads).max((2 * question.reach).min(shared_by(threads))).max(least)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use varikernel::settings::{Edges, Order};

    fn question(size: UVec2, min_photons: u32, max_radius: u32, edges: Edges) -> Question {
        let search = Search { min_photons, max_radius, edges, order: Order::Binary };
        Scanline::new(size, search, Cores::One).question
    }

    #[test]
    fn bands_by_hand() {
        let rows = |width: u32, height: u32, max_radius: u32, threads: usize| {
            band_rows(question(UVec2::new(width, height), 1, max_radius, Edges::Zero), threads)
        };
        // Four a thread; as high as two radii; one a thread.
        assert_eq!(
            [rows(1024, 1024, 32, 2), rows(1024, 1024, 100, 2), rows(1024, 1024, 1000, 2)],
            [128, 200, 512]
        );
        // As many pixels as are worthwhile, and no more rows than there are.
        assert_eq!([rows(128, 200, 2, 8), rows(64, 64, 2, 8), rows(1, 1, 2, 8)], [128, 64, 1]);
    }

    #[test]
    fn sums_fit_or_the_definition_takes_over() {
        let fits = |side: u32, count: u32, min_photons: u32| {
            let density = Image::filled(UVec2::splat(side), count);
            question(density.size(), min_photons, 1, Edges::Zero).fits_32_bits(&density)
        };
        // A box of one radius more than MR has 25 pixels: by n alone up to 171,798,691, whatever the total.
        assert!(fits(9, u32::MAX, 171_798_691) && !fits(9, u32::MAX, 171_798_692));
        // By the total: 81 counts that reach 2^32 - 1 at most.
        assert!(fits(9, 53_024_287, u32::MAX) && !fits(9, 53_024_288, u32::MAX));
    }

    proptest! {
        /// However the rows are cut, bands agree with the definition.
        #[test]
        fn bands_agree_with_the_definition(
            (width, height, band_rows) in (1..14_u32, 1..14_u32, 1..15_u32),
            counts in proptest::collection::vec(
                prop_oneof![6 => Just(0_u32), 2 => 1..9_u32, 1 => Just(u32::MAX)],
                196,
            ),
            (min_photons, max_radius, scale) in (1..60_u32, 1..20_u32, any::<bool>()),
        ) {
            let density = Image::from_fn(UVec2::new(width, height), |x, y| counts[(14 * y + x) as usize]);
            let edges = if scale { Edges::Scale } else { Edges::Zero };
            let question = question(density.size(), min_photons, max_radius, edges);
            let mut scanline = Scanline::in_bands(question, band_rows);
            let defined = varikernel::reference::radius(&density, question.search);
            prop_assert_eq!(scanline.run(&density), &defined);
        }
    }
}
