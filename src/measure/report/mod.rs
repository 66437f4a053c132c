//! One page that holds a run against the thesis: `report.html`, its tables as CSV and its figures as SVG.
//!
//! The page is self-contained: no file and no network is needed to read it, in light or dark.

mod plot;
mod view;

use askama::Template as _;

pub use plot::{figure_svg, orders_svg};
pub use view::table_csv;

use crate::measure::thesis::claims::{Evidence, Judged};

/// What the page tells.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// The command that made it.
    pub command: &'a str,
    /// What it ran on, as (name, value): renderer, driver, processor, commit, shader hash, time.
    pub environment: &'a [(String, String)],
    /// What was measured and counted.
    pub evidence: &'a Evidence,
    /// The claims with their answers.
    pub judged: &'a [Judged],
    /// What a reader has to know of this run: cells left out, samples marked.
    pub notes: &'a [String],
}

impl Report<'_> {
    /// The whole page.
    ///
    /// # Panics
    /// Never: a string takes all that is written.
    #[must_use]
    pub fn html(&self) -> String {
        view::Page::of(self).render().expect("a string takes all that is written")
    }
}
