//! Which maps meet which numbers: sides, densities, shapes, and the questions.

use super::Extent;
use super::number::Number;
use super::shape::Shape;
use varikernel::settings::{Edges, Order, Search};

/// MR of all questions.
const MAX_RADIUS: u32 = 32;

/// The question for a map of so many photons a pixel: n that a radius of about 5 holds, 25 at least.
#[must_use]
pub fn question(density: f64) -> Search {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let min_photons = ((100.0 * density).round() as u32).max(25);
    Search { min_photons, max_radius: MAX_RADIUS, edges: Edges::Scale, order: Order::Binary }
}

/// The largest side: a row of it takes 3.6 GB.
const LARGEST: u32 = 8192;

/// Maps of one side.
pub(super) struct Level {
    pub(super) side: u32,
    pub(super) densities: Vec<f64>,
    pub(super) shapes: &'static [Shape],
    pub(super) numbers: &'static [Number],
}

/// The brackets' boxes, of MR and 32 more, hold less than 2^32 of it, and maps of 256 x 256 more: for u32
/// alone.
const PAST_2_TO_THE_32: f64 = 100_000.0;
/// Its shapes: of the others a box would hold more.
const EVEN: &[Shape] = &[Shape::Uniform, Shape::HalfInShadow, Shape::Checkerboard];

/// What is run for an extent, on textures of at most `largest` a side.
pub(super) fn levels(extent: Extent, largest: u32) -> Vec<Level> {
    let few = &[Shape::Uniform, Shape::Spike, Shape::Corner];
    let level = |side, powers: &[i32], shapes, numbers| Level {
        side,
        densities: powers.iter().map(|&power| 4.0_f64.powi(power)).collect(),
        shapes,
        numbers,
    };
    let all = [-3, -2, -1, 0, 1, 2, 3, 4, 5, 6];
    let mut levels = match extent {
        Extent::Quick => vec![
            level(64, &[-3, 2, 6], &Shape::ALL, &Number::ALL),
            level(256, &[0, 6], &Shape::ALL, &Number::ALL),
        ],
        Extent::Usual => vec![
            level(64, &all, &Shape::ALL, &Number::ALL),
            level(256, &[-3, 0, 2, 4, 5, 6], &Shape::ALL, &Number::ALL),
            level(1024, &[-3, 1, 3, 6], &Shape::ALL, &Number::ALL),
            level(2048, &[2, 6], few, &Number::FEW),
            level(4096, &[0, 6], &few[..2], &Number::FEW[..3]),
        ],
        Extent::Full => {
            let sides = [64, 256, 1024, 2048, 4096].into_iter();
            let mut levels: Vec<_> = sides.map(|side| level(side, &all, &Shape::ALL, &Number::ALL)).collect();
            levels.push(level(LARGEST, &[0, 6], &few[..2], &Number::FEW[..3]));
            levels
        }
    };
    levels.push(Level {
        side: 256,
        densities: vec![PAST_2_TO_THE_32],
        shapes: EVEN,
        numbers: &[Number::U32Scan, Number::U32Doubling],
    });
    levels.retain(|level| level.side <= largest);
    levels
}

/// What an extent leaves out of what the device can have: sides 64 to 4096, densities 4^-3 to 4^6, all shapes
/// and numbers.
pub(super) fn pruned(extent: Extent, largest: u32) -> Vec<String> {
    let mut pruned = match extent {
        Extent::Quick => {
            vec!["sides past 256; all but 3 and 2 of 10 densities; past 10^6 kernels a pixel".to_owned()]
        }
        Extent::Usual => vec![
            "densities: 6 of 10 at side 256, 4 at 1024, 2 at 2048 and 4096".to_owned(),
            "shapes: uniform, spike and corner at 2048, the first two at 4096".to_owned(),
            "numbers: 5 of 10 at 2048, 3 at 4096".to_owned(),
        ],
        Extent::Full if largest < LARGEST => Vec::new(),
        Extent::Full => {
            vec![format!("2 of 10 densities, 2 of 6 shapes, 3 of 10 numbers at side {LARGEST}; all past it")]
        }
    };
    if largest < 4096 {
        pruned.push(format!("sides past {largest}, the largest texture of this device"));
    }
    pruned
}

#[cfg(test)]
mod tests {
    use super::*;
    use varikernel::maps::CountBounds;

    #[test]
    fn questions_grow_with_the_density() {
        assert_eq!([0.015_625, 0.25, 1.0, 4096.0].map(|d| question(d).min_photons), [25, 25, 100, 409_600]);
    }

    #[test]
    fn a_full_run_leaves_nothing_out() {
        let rows = |extent| {
            let count = |level: &Level| level.densities.len() * level.shapes.len() * level.numbers.len();
            levels(extent, 4096).iter().map(count).sum::<usize>()
        };
        assert_eq!(rows(Extent::Full), 5 * 10 * 6 * 10 + 6);
        assert!(pruned(Extent::Full, 4096).is_empty() && rows(Extent::Usual) < rows(Extent::Full));
        assert!(levels(Extent::Full, 1024).iter().all(|level| level.side <= 1024));
        // Where textures are larger, a few larger maps are run, and what they leave out is reported.
        let sides = |largest| levels(Extent::Full, largest).iter().map(|level| level.side).max();
        assert_eq!([4096, 8191, 16_384].map(sides), [4096, 4096, 8192].map(Some));
        assert_eq!(pruned(Extent::Full, 16_384).len(), 1);
    }

    #[test]
    fn even_maps_wrap_a_table_and_fit_the_boxes_of_brackets() {
        for shape in EVEN {
            let map = shape.map(256, PAST_2_TO_THE_32, 1);
            let search = Search { order: Order::Bracketed, ..question(PAST_2_TO_THE_32) };
            assert_eq!(search.largest_counted_radius(), 64);
            let bounds = CountBounds::of(&map, search);
            assert!(bounds.total > 1 << 32 && bounds.densest_box < 1 << 32, "{shape:?}: {bounds:?}");
        }
        // Twice as many do not.
        let map = Shape::HalfInShadow.map(256, 2.0 * PAST_2_TO_THE_32, 1);
        let search = Search { order: Order::Bracketed, ..question(PAST_2_TO_THE_32) };
        assert!(CountBounds::of(&map, search).densest_box >= 1 << 32);
    }
}
