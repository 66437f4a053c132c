//! A summed-area table of some rows of a map, for reads without tests.

use std::ops::Range;

use super::Question;
use varikernel::image::Image;

/// Sums modulo 2^32 of counts clamped to n, before each column and row, with margins on the left and right
/// for boxes that reach past the map.
#[derive(Debug)]
pub(super) struct Table {
    question: Question,
    /// The map's rows that it sums: those of the band, and as far around as boxes reach.
    rows: Range<u32>,
    /// Entries of margin before the first column, and as many after the last.
    margin: usize,
    sums: Vec<u32>,
    /// Photons of each column in the rows that were summed so far.
    columns: Vec<u32>,
    /// For each radius, where the entries at the left end of its box's first row and after its last one are,
    /// if the box is around column 0.
    ends: Vec<[usize; 2]>,
}

impl Table {
    /// Allocates for boxes around the pixels of `rows`, up to a radius of one more than is searched.
    pub(super) fn new(question: Question, rows: Range<u32>) -> Self {
        let (width, furthest) = (question.size.x as usize, question.reach + 1);
        let rows = rows.start.saturating_sub(furthest)..(rows.end + furthest).min(question.size.y);
        let margin = furthest as usize;
        let sums = Vec::with_capacity((rows.len() + 1) * (width + 1 + 2 * margin));
        Self { question, rows, margin, sums, columns: vec![0; width], ends: Vec::with_capacity(margin + 1) }
    }

    /// Entries of a row.
    fn stride(&self) -> usize {
        self.columns.len() + 1 + 2 * self.margin
    }

    /// Sums `density`.
    pub(super) fn fill(&mut self, density: &Image<u32>) {
        let (width, limit) = (self.columns.len(), self.question.search.min_photons);
        self.columns.fill(0);
        self.sums.clear();
        self.sums.resize(self.stride(), 0);
        let rows = self.rows.start as usize * width..self.rows.end as usize * width;
        for counts in density.values()[rows].chunks_exact(width) {
            self.sums.resize(self.sums.len() + self.margin + 1, 0);
            let mut sum = 0_u32;
            self.sums.extend(self.columns.iter_mut().zip(counts).map(|(column, &count)| {
                *column = column.wrapping_add(count.min(limit));
                sum = sum.wrapping_add(*column);
                sum
            }));
            self.sums.resize(self.sums.len() + self.margin, sum);
        }
    }

    /// The boxes around the pixels of row `y`, one of the band's.
    pub(super) fn around_row(&mut self, y: u32) -> Boxes<'_> {
        let (stride, margin, rows) = (self.stride(), self.margin, self.rows.clone());
        self.ends.clear();
        self.ends.extend((0..=self.question.reach + 1).map(|radius| {
            let lo = y.saturating_sub(radius) - rows.start;
            let after_hi = (y + radius + 1).min(rows.end) - rows.start;
            [lo, after_hi].map(|row| row as usize * stride + margin - radius as usize)
        }));
        Boxes { sums: &self.sums, ends: &self.ends }
    }
}

/// The boxes around the pixels of one row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Boxes<'a> {
    sums: &'a [u32],
    ends: &'a [[usize; 2]],
}

impl Boxes<'_> {
    /// The photons in the box of `radius` around column `x`.
    #[inline]
    pub(super) fn count(self, x: usize, radius: u32) -> u32 {
        let [first, after_last] = self.ends[radius as usize].map(|left| left + x);
        let side = 2 * radius as usize + 1;
        let before = |left: usize| self.sums[left + side].wrapping_sub(self.sums[left]);
        before(after_last).wrapping_sub(before(first))
    }
}
