//! `varikernel compare`: how two maps differ.

use std::path::PathBuf;

use anyhow::Result;
use varikernel::image::{ReadOptions, read_counts};
use varikernel::measure::{Difference, Place};

use super::{Outcome, output};

/// Print how two maps differ; exit 1 if they do.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// First map: EXR, PNG (8 or 16-bit grey) or NPY.
    a: PathBuf,

    /// Second map, of the same size.
    b: PathBuf,

    /// Channel to read of EXR files that have several.
    #[arg(long)]
    channel: Option<String>,

    /// Print one JSON object instead of a table.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    let options = ReadOptions { channel: args.channel.as_deref(), ..ReadOptions::default() };
    let difference = Difference::between(&read_counts(&args.a, &options)?, &read_counts(&args.b, &options)?)?;
    if args.json {
        output::print_json(&difference)?;
    } else if difference.is_none() {
        output::print(&difference.to_string())?;
    } else {
        let share = 100.0 * difference.wrong_pixels as f64 / difference.pixels as f64;
        let place = |&Place { x, y, a, b }: &Place| format!("({x}, {y}): {a} and {b}");
        output::print_facts(&[
            ("differ", format!("{} of {} pixels ({share:.4} %)", difference.wrong_pixels, difference.pixels)),
            ("largest", difference.max.to_string()),
            ("mean", format!("{:.6} over all pixels", difference.mean)),
            ("first", difference.first.iter().map(place).collect::<Vec<_>>().join("\n")),
        ])?;
    }
    Ok(if difference.is_none() { Outcome::Done } else { Outcome::Differs })
}
