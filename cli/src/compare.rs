//! `varikernel compare`: how two maps differ.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use varikernel::Image;
use varikernel::image::{Difference, Place};
use varikernel::image::{Format, ReadOptions, read_counts};

use super::{Outcome, output};

/// Print how two maps differ; exit 1 if they do.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// First map: EXR, PNG (8 or 16-bit grey) or NPY.
    a: PathBuf,

    /// Second map, of the same size; the formats may differ.
    b: PathBuf,

    /// Channel to read of EXR files that have several.
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,

    /// Print one JSON object instead of a table.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    let (a, b) = (read(args, &args.a)?, read(args, &args.b)?);
    if a.size() != b.size() {
        bail!(
            "{}: {} x {} pixels, but {} has {} x {}\nhelp: give two maps of the same size",
            args.b.display(),
            b.size().x,
            b.size().y,
            args.a.display(),
            a.size().x,
            a.size().y
        );
    }
    let difference = Difference::between(&a, &b)?;
    if args.json {
        output::print_json(&difference)?;
    } else if difference.is_none() {
        output::print(&difference.to_string())?;
    } else {
        let percent = 100.0 * difference.share();
        let place = |&Place { x, y, a, b }: &Place| format!("({x}, {y}): {a} and {b}");
        output::print_facts(&[
            (
                "differ",
                format!("{} of {} pixels ({percent:.4} %)", difference.wrong_pixels, difference.pixels),
            ),
            ("largest", difference.max.to_string()),
            ("mean", format!("{:.6} over all pixels", difference.mean)),
            ("first", difference.first.iter().map(place).collect::<Vec<_>>().join("\n")),
        ])?;
    }
    Ok(if difference.is_none() { Outcome::Done } else { Outcome::Differs })
}

/// The channel is for files with named channels: an EXR may be compared with an NPY.
fn read(args: &Args, path: &Path) -> Result<Image<u32>> {
    let no_exr = |path: &PathBuf| !matches!(Format::of(path), Ok(Format::Exr));
    let named = Format::of(path)? == Format::Exr || [&args.a, &args.b].into_iter().all(no_exr);
    let channel = args.channel.as_deref().filter(|_| named);
    Ok(read_counts(path, &ReadOptions { channel, ..ReadOptions::default() })?)
}
