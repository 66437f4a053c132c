//! `varikernel stress`: where sums break, and whether the promises about them hold.

mod renderers;
mod table;

use std::path::PathBuf;
use std::time::Duration;

use anyhow::Result;
use varikernel::context::DeviceChoice;
use varikernel::image::check_writable;
use varikernel_lab::stress::{self, Extent, Report, StressSettings, Verdict};

use super::numbers::whole;
use super::saving::{Autosave, Resume, how_to_go_on};
use super::share_bar::ShareBar;
use super::{Outcome, device, output};

/// How often a renderer computes the same maps, to see that it always gives the same bits; and in a quick
/// run.
const TIMES: [u32; 2] = [100, 20];

/// The part of the time that everything on one device takes.
const MAPS_SHARE: f64 = 0.9;

/// Put numbers under stress: where sums in each of them break, and whether the promises about exactness hold.
///
/// Every number in which sums can be kept meets maps of growing totals and adverse shapes, the definition
/// beside it; then blended counts and kernels, and the order of the photons, all on one device; then a few
/// maps on every renderer and number of threads found here. Writes a folder with stress.csv (a line a row)
/// and stress.json. Exit code 1 if a promise is broken.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub(crate) struct Args {
    /// Folder to write to; made if it is missing.
    #[arg(short, long, default_value = "stress", value_name = "FOLDER")]
    output: PathBuf,

    /// Sides of 64 and 256 alone: within a minute on two processor cores.
    #[arg(long, conflicts_with = "full")]
    quick: bool,

    /// Every side up to 4096, density, shape and number, and a few maps of 8192 x 8192 where the device has
    /// such textures: for hours on a software renderer.
    #[arg(long)]
    full: bool,

    /// OpenGL device: auto, egl, egl:INDEX, osmesa, or part of a renderer's name.
    #[arg(long, default_value_t = DeviceChoice::Auto)]
    device: DeviceChoice,

    /// Print one JSON object instead of tables.
    #[arg(long)]
    json: bool,

    /// Run one of the numbers with a misprint of the thesis, to check that it is reported.
    #[arg(long, hide = true)]
    plant_fault: bool,

    /// Print the hashes of the maps that all renderers compute, so many times, and nothing else.
    #[arg(long, hide = true, value_name = "TIMES")]
    #[arg(value_parser = whole(1..=u32::MAX), allow_negative_numbers = true)]
    bits: Option<u32>,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    if let Some(times) = args.bits {
        output::print_json(&renderers::found_here(&args.device, times)?)?;
        return Ok(Outcome::Done);
    }
    let folder = &args.output;
    output::make_folder(folder)?;
    let (json, csv) = (folder.join("stress.json"), folder.join("stress.csv"));
    check_writable(&json)?;
    check_writable(&csv)?;
    let save = |report: &Report| report.save_csv(&csv).and_then(|()| report.save_json(&json));

    let gl = device::open(&args.device)?;
    let extent = match (args.quick, args.full) {
        (true, _) => Extent::Quick,
        (_, true) => Extent::Full,
        _ => Extent::Usual,
    };
    let settings = StressSettings { extent, planted: args.plant_fault };
    let bar = ShareBar::new();
    let mut autosave = Autosave::new(Duration::from_secs(5));
    let mut report = stress::run(&gl, settings, &mut |report, progress| {
        bar.show(MAPS_SHARE * progress.done, progress.row);
        autosave.save_if_due(|| save(report));
        Ok(())
    })?;
    autosave.save_if_due(|| save(&report));
    report.compare_renderers(renderers::all(&gl, TIMES[usize::from(args.quick)], &mut |name, done| {
        bar.show(MAPS_SHARE + (1.0 - MAPS_SHARE) * done, format!("the same maps: {name}"));
    })?);
    bar.finish();
    save(&report).map_err(|error| how_to_go_on(error, &Resume::Anew))?;

    let judged = report.judge();
    if args.json {
        output::print_json(&serde_json::json!({
            "report": report,
            "promises": judged,
            "breaks": report.breaks(),
        }))?;
    } else {
        table::print(&report, &judged)?;
        output::print(&format!("\nwritten: {} and {}", csv.display(), json.display()))?;
    }
    let is_kept = judged.iter().all(|judged| judged.verdict == Verdict::Kept)
        && report.rows.iter().all(|row| row.verdict != Verdict::Broken);
    Ok(if is_kept { Outcome::Done } else { Outcome::Differs })
}
