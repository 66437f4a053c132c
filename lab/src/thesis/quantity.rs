//! What was timed: the key that the thesis's columns and our medians share.

use std::fmt;

use varikernel::settings::{Order, SatSamples};

/// One thing that the thesis timed, without the card.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// The summed mipmap is built (Table A.1).
    PyramidBuild,
    /// The summed mipmap is built and searched (A.2).
    PyramidFrame(Order),
    /// The summed-area table is built and searched (A.3, A.4).
    SatFrame(SatSamples, Order),
    /// The summed-area table is built (A.5).
    SatBuild(SatSamples),
    /// The summed-area table is searched (A.6).
    SatSearch(Order),
    /// The same in binary order at 512 x 512, by MR in place of the size (A.7).
    SatSearchByMaxRadius,
    /// Brute force (A.8).
    BruteForce,
}

impl Quantity {
    /// What the first column of its table holds.
    #[must_use]
    pub fn row_name(self) -> &'static str {
        if self == Self::SatSearchByMaxRadius { "Max radius" } else { "Size" }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let order = |order| if order == Order::Forward { "forward" } else { "binary" };
        match *self {
            Self::PyramidBuild => formatter.write_str("pyramid build"),
            Self::PyramidFrame(by) => write!(formatter, "pyramid {}", order(by)),
            Self::SatFrame(samples, by) => write!(formatter, "SAT {} {}", samples.count(), order(by)),
            Self::SatBuild(samples) => write!(formatter, "SAT {} build", samples.count()),
            Self::SatSearch(by) => write!(formatter, "SAT search {}", order(by)),
            Self::SatSearchByMaxRadius => formatter.write_str("SAT search binary"),
            Self::BruteForce => formatter.write_str("brute force"),
        }
    }
}

/// The thesis's graphics cards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Card {
    /// NVIDIA GeForce GTX 260.
    Gtx260,
    /// NVIDIA GeForce GTX 480.
    Gtx480,
}

impl Card {
    /// Both, the older first.
    pub const ALL: [Self; 2] = [Self::Gtx260, Self::Gtx480];
}

impl fmt::Display for Card {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Gtx260 => "GTX 260",
            Self::Gtx480 => "GTX 480",
        })
    }
}

/// The outcome of one cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Timing {
    /// It was timed, and the answer was right.
    Median {
        /// The median, in milliseconds.
        ms: f64,
        /// The same in full-screen copies of one R32UI texel at this size, if those were timed too.
        copies: Option<f64>,
    },
    /// It was not timed; the reason in a few words.
    NotRun(String),
}

/// One cell of our side of the tables.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// What was timed.
    pub quantity: Quantity,
    /// Side of the square map in pixels, or MR (see [`Quantity::row_name`]).
    pub row: u32,
    /// The outcome.
    pub timing: Timing,
}

/// Our cells.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measurements(pub Vec<Measured>);

impl Measurements {
    /// The cell of `quantity` in `row`, if there is one.
    #[must_use]
    pub fn get(&self, quantity: Quantity, row: u32) -> Option<&Timing> {
        self.0.iter().find(|cell| cell.quantity == quantity && cell.row == row).map(|cell| &cell.timing)
    }

    /// Its median in milliseconds, if it was timed.
    #[must_use]
    pub fn ms(&self, quantity: Quantity, row: u32) -> Option<f64> {
        match self.get(quantity, row)? {
            Timing::Median { ms, .. } => Some(*ms),
            Timing::NotRun(_) => None,
        }
    }

    /// All medians of `quantity` as (row, ms), by ascending row.
    #[must_use]
    pub fn series(&self, quantity: Quantity) -> Vec<(u32, f64)> {
        let mut series: Vec<_> = self
            .0
            .iter()
            .filter(|cell| cell.quantity == quantity)
            .filter_map(|cell| Some((cell.row, self.ms(quantity, cell.row)?)))
            .collect();
        series.sort_by_key(|&(row, _)| row);
        series
    }
}
