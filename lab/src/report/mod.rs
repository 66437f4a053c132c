//! One page that compares a run with the thesis: `report.html`, its tables as CSV and its figures as SVG.
//!
//! The page is self-contained: no file and no network is needed to read it, in light or dark.

mod plot;
mod view;

use askama::Template as _;

pub use plot::{figure_svg, orders_svg};
pub use view::table_csv;

use crate::reproduce::OtherMap;
use crate::thesis::claims::{self, Judged};
use crate::thesis::evidence::Evidence;
use crate::thesis::{figures, tables};

/// The content of the page.
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
    /// The summed-area table's times on maps of other densities.
    pub other_maps: &'a [OtherMap],
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

    /// Every file of a reproduction but the raw samples, as (path inside the folder, text): `report.html`,
    /// `claims.csv`, `tables/a1.csv` to `a8.csv`, `figures/5.1.svg` to `5.13.svg`.
    ///
    /// # Panics
    /// Never: memory takes all that is written.
    #[must_use]
    pub fn files(&self) -> Vec<(String, String)> {
        let mut claims = Vec::new();
        claims::write_csv(&mut claims, self.judged).expect("memory takes all that is written");
        let claims = String::from_utf8(claims).expect("CSV of text is text");
        let measured = &self.evidence.measurements;
        let mut files = vec![("report.html".to_owned(), self.html()), ("claims.csv".to_owned(), claims)];
        files.extend(
            tables::all()
                .iter()
                .map(|table| (format!("tables/a{}.csv", table.number), table_csv(table, measured))),
        );
        files.extend(
            figures::ALL
                .iter()
                .map(|figure| (format!("figures/5.{}.svg", figure.number), figure_svg(figure, measured))),
        );
        if !self.evidence.orders.is_empty() {
            files.push(("figures/orders.svg".to_owned(), orders_svg(&self.evidence.orders)));
        }
        files
    }
}
