//! The search in a band of rows.

use std::ops::Range;

use super::Question;
use super::table::{Boxes, Table};
use varikernel::image::Image;
use varikernel::reference::{Inside, binary_search, total_area};
use varikernel::settings::Edges;

/// Rows that are searched one after the other, and what that takes.
#[derive(Debug)]
pub(super) struct Band {
    question: Question,
    rows: Range<u32>,
    table: Table,
    /// Radii with zero edges of the row that was searched last; beyond the question's reach where that held
    /// too few.
    zero_edges: Vec<u32>,
}

impl Band {
    /// Allocates for `rows` of the map.
    pub(super) fn new(question: Question, rows: Range<u32>) -> Self {
        let table = Table::new(question, rows.clone());
        Self { question, rows, table, zero_edges: vec![0; question.size.x as usize] }
    }

    /// Its pixels.
    pub(super) fn pixels(&self) -> usize {
        self.rows.len() * self.zero_edges.len()
    }

    /// Searches all rows; `radius` and `limited` are theirs.
    pub(super) fn march(&mut self, density: &Image<u32>, radius: &mut [u32], limited: &mut [u8]) {
        let Question { search, reach, .. } = self.question;
        let width = self.zero_edges.len();
        self.table.fill(density);
        let targets = radius.chunks_exact_mut(width).zip(limited.chunks_exact_mut(width));
        for (y, (radius, limited)) in self.rows.clone().zip(targets) {
            let boxes = self.table.around_row(y);
            let zero_edges = self.zero_edges.as_mut_slice();
            if y == self.rows.start {
                search_first_row(boxes, self.question, zero_edges);
            } else {
                for (x, radius) in zero_edges.iter_mut().enumerate() {
                    *radius = next_radius(boxes, self.question, x, *radius);
                }
            }
            for ((&found, radius), limited) in zero_edges.iter().zip(&mut *radius).zip(&mut *limited) {
                *radius = if found > reach { search.max_radius } else { found };
                *limited = u8::from(found > reach);
            }
            if search.edges == Edges::Scale {
                scale_edges(boxes, self.question, y, radius, limited);
            }
        }
    }
}

/// The first row has none before it, so that each pixel goes on from its left neighbour.
fn search_first_row(boxes: Boxes<'_>, question: Question, zero_edges: &mut [u32]) {
    let Question { search, reach, .. } = question;
    let holds_enough = |radius| boxes.count(0, radius) >= search.min_photons;
    let mut before = binary_search(reach, holds_enough).unwrap_or(reach + 1);
    for (x, radius) in zero_edges.iter_mut().enumerate() {
        before = next_radius(boxes, question, x, before);
        *radius = before;
    }
}

/// The radius with zero edges at column `x`, next to a pixel of radius `before`.
#[inline]
fn next_radius(boxes: Boxes<'_>, question: Question, x: usize, before: u32) -> u32 {
    let too_few = |radius| u32::from(boxes.count(x, radius) < question.search.min_photons);
    // No branch: it would be guessed wrong as often as radii change.
    (before - 1 + too_few(before - 1) + too_few(before)).clamp(1, question.reach + 1)
}

/// Searches those pixels of row `y` again whose box is cut by an edge before it holds enough; `radius` and
/// `limited` are those of zero edges.
fn scale_edges(boxes: Boxes<'_>, question: Question, y: u32, radius: &mut [u32], limited: &mut [u8]) {
    let Question { size, search, reach } = question;
    let from_ends = y.min(size.y - 1 - y);
    // Further in, no radius reaches an edge.
    let margin = if from_ends < reach { size.x } else { reach.min(size.x) };
    let mut before = 1;
    for x in (0..margin).chain(margin.max(size.x - margin)..size.x) {
        let at = x as usize;
        let from_edge = from_ends.min(x).min(size.x - 1 - x);
        if from_edge < radius[at] {
            let holds_enough = |radius: u32| {
                let photons = u64::from(boxes.count(at, radius.min(reach)));
                let inside = Inside::of_box(size, x, y, radius).area();
                // Both areas are below 2^32.
                photons * total_area(radius) >= u64::from(search.min_photons) * inside
            };
            // MR itself is tried only where nothing is known of it.
            let enough = radius[at] + u32::from(limited[at]);
            let found = first_from(before, from_edge, enough, holds_enough);
            radius[at] = found.min(search.max_radius);
            limited[at] = u8::from(found > search.max_radius);
        }
        before = radius[at];
    }
}

/// The first radius in (`too_few`, `enough`] that holds enough; the second bound is known to. Tries `start`
/// first and goes away from it in steps that double.
fn first_from(start: u32, too_few: u32, enough: u32, holds_enough: impl Fn(u32) -> bool) -> u32 {
    let (mut too_few, mut enough) = (too_few, enough);
    let (mut probe, mut step) = (start, 1);
    while enough - too_few > 1 {
        probe = probe.clamp(too_few + 1, enough - 1);
        let is_enough = holds_enough(probe);
        *(if is_enough { &mut enough } else { &mut too_few }) = probe;
        // At most to the middle, so that what is behind a turn is halved.
        let reach = step.min((enough - too_few) / 2);
        probe = if is_enough { enough - reach } else { too_few + reach };
        step *= 2;
    }
    enough
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::first_from;

    #[test]
    fn the_first_is_found_from_any_start() {
        for (too_few, enough) in (0..12).flat_map(|a| (a + 1..14).map(move |b| (a, b))) {
            for (first, start) in (too_few + 1..=enough).flat_map(|first| (0..20).map(move |s| (first, s))) {
                let found = first_from(start, too_few, enough, |radius| radius >= first);
                assert_eq!(found, first, "in ({too_few}, {enough}] from {start}");
            }
        }
    }

    #[test]
    fn a_near_start_takes_few_counts_and_a_far_one_not_many() {
        let counts = |start: u32, first: u32| {
            let counted = Cell::new(0);
            let holds_enough = |radius| {
                counted.set(counted.get() + 1);
                radius >= first
            };
            assert_eq!(first_from(start, 0, 32_767, holds_enough), first);
            counted.get()
        };
        assert_eq!([counts(500, 500), counts(501, 500), counts(499, 500)], [2, 4, 2]);
        assert!(counts(1, 32_000) <= 30, "{}", counts(1, 32_000));
    }
}
