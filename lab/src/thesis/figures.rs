//! Figures 5.1 to 5.13: which columns each draws.
//!
//! The captions do not always name card and order; where they do not, all that fit are drawn.

use super::quantity::{Card, Quantity};
use Quantity::{BruteForce, PyramidBuild, PyramidFrame, SatBuild, SatFrame, SatSearch, SatSearchByMaxRadius};
use varikernel::settings::{Order, SatSamples};

/// One of the thesis's graphs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// 1 for Figure 5.1.
    pub number: u32,
    /// What it shows, in our words.
    pub title: &'static str,
    /// What is drawn, from ours and from each of `cards`.
    pub quantities: &'static [Quantity],
    /// The printed cards beside ours.
    pub cards: &'static [Card],
    /// Whether times run over orders of magnitude.
    pub logarithmic: bool,
}

const BOTH: &[Card] = &Card::ALL;
const FORWARD: Order = Order::Forward;
const BINARY: Order = Order::Binary;
const TWO: SatSamples = SatSamples::Two;
const FOUR: SatSamples = SatSamples::Four;
const ALL_SOLUTIONS: &[Quantity] =
    &[BruteForce, PyramidFrame(FORWARD), SatFrame(TWO, FORWARD), SatFrame(FOUR, FORWARD)];

/// All of them.
pub const ALL: [Figure; 13] = [
    figure(1, "All solutions, forward search, MR = 32", ALL_SOLUTIONS, BOTH, true),
    figure(2, "All solutions beside the GTX 480", ALL_SOLUTIONS, &[Card::Gtx480], true),
    figure(3, "Brute force", &[BruteForce], BOTH, true),
    figure(4, "Building the summed mipmap", &[PyramidBuild], BOTH, false),
    figure(5, "Pyramid, forward search", &[PyramidFrame(FORWARD)], BOTH, true),
    figure(6, "Pyramid, binary search", &[PyramidFrame(BINARY)], BOTH, true),
    figure(7, "Pyramid against brute force", &[PyramidFrame(FORWARD), BruteForce], BOTH, true),
    figure(
        8,
        "Summed-area table with 2 and 4 samples a pass, built and searched",
        &[SatFrame(TWO, FORWARD), SatFrame(FOUR, FORWARD)],
        BOTH,
        true,
    ),
    figure(
        9,
        "Forward against binary search beside the GTX 480",
        &[SatSearch(FORWARD), SatSearch(BINARY)],
        &[Card::Gtx480],
        true,
    ),
    figure(
        10,
        "Forward against binary search beside the GTX 260",
        &[SatSearch(FORWARD), SatSearch(BINARY)],
        &[Card::Gtx260],
        true,
    ),
    figure(11, "Searching the table, binary", &[SatSearch(BINARY)], BOTH, true),
    figure(
        12,
        "Building the table with 2 and 4 samples a pass",
        &[SatBuild(TWO), SatBuild(FOUR)],
        &[Card::Gtx480],
        true,
    ),
    figure(13, "Binary search by maximum radius, 512²", &[SatSearchByMaxRadius], BOTH, false),
];

const fn figure(
    number: u32,
    title: &'static str,
    quantities: &'static [Quantity],
    cards: &'static [Card],
    logarithmic: bool,
) -> Figure {
    Figure { number, title, quantities, cards, logarithmic }
}

#[cfg(test)]
mod tests {
    use super::super::tables::printed_series;
    use super::*;

    #[test]
    fn every_figure_has_printed_values_for_each_of_its_lines() {
        for (index, figure) in ALL.iter().enumerate() {
            assert_eq!(figure.number as usize, index + 1);
            for &quantity in figure.quantities {
                for &card in figure.cards {
                    assert!(printed_series(quantity, card).len() >= 4, "5.{} {quantity}", figure.number);
                }
                let unit = figure.quantities[0].row_name();
                assert_eq!(quantity.row_name(), unit, "5.{} has one x axis", figure.number);
            }
        }
    }
}
