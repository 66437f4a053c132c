//! `varikernel synth`: seeded test maps.

use std::path::PathBuf;

use anyhow::{Context as _, Result, bail};
use clap::ValueEnum as _;
use glam::UVec2;
use varikernel::image::{Attribute, Format, ReadOptions, check_writable, write_counts};
use varikernel_lab::synth::{self, Kind};
use varikernel_lab::total_photons;

use super::numbers::{fraction, whole};
use super::{Outcome, output};

/// Make a seeded density map for tests.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// What the photons are drawn from.
    kind: Kind,

    /// File to write: .exr or .npy (u32), or .png (16-bit grey, counts up to 65535).
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,

    /// Columns and rows.
    #[arg(long, default_value = "512x512", value_parser = parse_size, value_name = "WIDTHxHEIGHT")]
    size: UVec2,

    /// Photons per pixel on average, fractions too; each kind has its usual one.
    #[arg(long, value_name = "NUMBER", value_parser = fraction::<f64>("0.5"), allow_negative_numbers = true)]
    density: Option<f64>,

    /// A whole number; the same seed gives the same map.
    #[arg(long, default_value_t = 1, value_parser = whole(0..=u64::MAX), allow_negative_numbers = true)]
    seed: u64,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    Format::of(&args.output)?;
    check_writable(&args.output)?;
    let density = args.density.unwrap_or_else(|| args.kind.usual_density());
    check_density(args, density)?;
    let map = synth::map(args.kind, args.size, density, args.seed);
    let kind = format!("{:?}", args.kind).to_lowercase();
    let attributes = [
        Attribute::text("varikernel.kind", &kind),
        Attribute::text("varikernel.density", density.to_string()),
        Attribute::text("varikernel.seed", args.seed.to_string()),
        Attribute::text("varikernel.version", env!("CARGO_PKG_VERSION")),
    ];
    write_counts(&args.output, "density", &map, &attributes)?;
    output::print_facts(&[
        ("map", format!("{kind}, seed {}", args.seed)),
        ("size", format!("{} x {}", args.size.x, args.size.y)),
        ("photons", total_photons(&map).to_string()),
        ("written", args.output.display().to_string()),
    ])?;
    Ok(Outcome::Done)
}

/// Refuses what can't be drawn or would overflow the count of a pixel.
fn check_density(args: &Args, density: f64) -> Result<()> {
    let pixels = f64::from(args.size.x) * f64::from(args.size.y);
    let most = match args.kind {
        Kind::Empty => 0.0,
        // Half of the pixels hold twice the mean.
        Kind::Checkerboard => f64::from(u32::MAX) / 2.0,
        // One by one, and all may land in one pixel.
        _ => f64::from(u32::MAX) / pixels,
    };
    if !(0.0..=most).contains(&density) {
        let kind = args.kind.to_possible_value().unwrap_or_else(|| unreachable!("no kind is hidden"));
        let UVec2 { x, y } = args.size;
        bail!(
            "--density {density} is not possible: {} of {x} x {y} pixels takes 0 to {most} photons per pixel",
            kind.get_name()
        );
    }
    Ok(())
}

/// 640x480, within what can be read again.
pub(super) fn parse_size(text: &str) -> Result<UVec2> {
    let (width, height) = text.split_once('x').context("write it as 640x480")?;
    let parse = |text: &str| text.parse::<u32>().context("write it as 640x480");
    let size = UVec2::new(parse(width)?, parse(height)?);
    let limits = ReadOptions::default();
    if size.min_element() == 0 || size.max_element() > limits.max_side {
        bail!("a side goes from 1 to {} pixels", limits.max_side);
    }
    if u64::from(size.x) * u64::from(size.y) > limits.max_pixels {
        bail!("{} pixels are the most that this program reads again", limits.max_pixels);
    }
    Ok(size)
}
