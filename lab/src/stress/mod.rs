//! Numbers under stress: where sums break, and whether the program accepts only what it gets right.
//!
//! Every number in which sums can be kept meets maps of growing totals and adverse shapes ([`Number`],
//! [`Shape`]), the definition's radii beside it; then the sums outside of the tables: ratios, blending,
//! kernels; then the order of the photons, and the same maps on every renderer. Each [`Row`] backs one or
//! more of the [`PROMISES`] that the documentation makes. What the program refuses is computed all the same,
//! for information: those rows say where each number breaks.

mod bits;
mod breaks;
mod file;
mod grid;
mod level;
mod number;
mod order;
mod promise;
mod row;
mod shape;
mod sums;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::bench::Device;
use varikernel::error::Result;
use varikernel::gl::Gl;

pub use bits::{Bits, Case, Found, Renderer, cases};
pub use breaks::Break;
pub use level::question;
pub use number::Number;
pub use promise::{Judged, PROMISES, Promise};
pub use row::{Decision, Row, Verdict};
pub use shape::Shape;

/// How much is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Extent {
    /// Sides of 64 and 256: within a minute on two processor cores.
    Quick,
    /// Up to sides of 4096, with fewer densities, shapes and numbers as sides grow: within ten minutes.
    Usual,
    /// Everything at sides of 64 to 4096, and a little at 8192 where the device has such textures: for hours.
    Full,
}

/// What is run, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StressSettings {
    /// How much.
    pub extent: Extent,
    /// Runs one of the numbers with a misprint of the thesis, to check that the rows show it.
    pub planted: bool,
}

/// All that a run found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The program's version.
    pub program: String,
    /// The OpenGL device of all rows but those of other renderers.
    pub device: Device,
    /// The settings.
    pub settings: StressSettings,
    /// What was left out, in words.
    pub pruned: Vec<String>,
    /// Everything that was found.
    pub rows: Vec<Row>,
    /// The same maps on other renderers and numbers of threads.
    pub renderers: Vec<Renderer>,
    /// Whether nothing is to come: until then no promise is judged in the files.
    pub complete: bool,
}

/// How far a run is.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// From 0 to 1.
    pub done: f64,
    /// What was just done.
    pub row: String,
}

impl Report {
    /// An empty one.
    #[must_use]
    pub fn new(gl: &Gl, settings: StressSettings) -> Self {
        Self {
            program: env!("CARGO_PKG_VERSION").to_owned(),
            device: Device::of(gl.info()),
            settings,
            pruned: level::pruned(settings.extent, gl.info().max_texture_size),
            rows: Vec::new(),
            renderers: Vec::new(),
            complete: false,
        }
    }

    /// Adds what the renderers found, and the rows that compare it with the definition; with it a report is
    /// complete.
    pub fn compare_renderers(&mut self, renderers: Vec<Renderer>) {
        self.rows.extend(bits::rows(&renderers));
        self.renderers = renderers;
        self.complete = true;
    }

    /// The verdict on each promise, by the rows that back it.
    #[must_use]
    pub fn judge(&self) -> Vec<Judged> {
        promise::judge(&self.rows)
    }

    /// Where each number breaks, by the rows of wrong pixels.
    #[must_use]
    pub fn breaks(&self) -> BTreeMap<String, Break> {
        breaks::breaks(&self.rows)
    }
}

/// Runs everything that needs one context only; `each` is called after each row, to save and to show. The
/// report is complete with [`Report::compare_renderers`].
///
/// # Errors
/// Those of the device, and of `each`.
pub fn run(
    gl: &Gl,
    settings: StressSettings,
    each: &mut dyn FnMut(&Report, Progress) -> Result<()>,
) -> Result<Report> {
    let mut report = Report::new(gl, settings);
    let grid_share = 0.85;
    grid::rows(gl, settings, &mut |row, done| {
        report.rows.push(row);
        let row = report.rows.last().map(|row| row.id.clone()).unwrap_or_default();
        each(&report, Progress { done: grid_share * done, row })
    })?;
    let mut done = grid_share;
    let mut others = |rows: Vec<Row>| {
        for row in rows {
            done += (1.0 - done) / 8.0;
            let progress = Progress { done, row: row.id.clone() };
            report.rows.push(row);
            each(&report, progress)?;
        }
        Ok(())
    };
    others(sums::ratio_rows())?;
    others(order::rows(gl)?)?;
    others(sums::blending_rows(gl)?)?;
    others(sums::splat_rows(gl, settings.extent)?)?;
    Ok(report)
}
