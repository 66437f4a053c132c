//! `varikernel study`: run time against error.

use std::fs;
use std::io::{ErrorKind, Write as _};
use std::path::PathBuf;
use std::time::Duration;

use anyhow::{Context as _, Result};
use varikernel::context::DeviceChoice;
use varikernel::image::{check_writable, write_atomically};
use varikernel_lab::study::{self, Study, StudySettings};

use super::bench::targets;
use super::numbers::whole;
use super::saving::{Autosave, Resume, how_to_go_on};
use super::share_bar::ShareBar;
use super::{Outcome, against, device, flicker, output, real_map};

/// What was found so far is saved as often as this.
const SAVE_EVERY: Duration = Duration::from_secs(10);

/// Compare run time with error: radius maps, estimates of density, and pictures.
///
/// Every method, build, storage and search is timed and compared with the exact radii, beside approximations
/// that are no default anywhere. Estimates of density are compared with densities whose truth is known, and
/// pictures by light from tables, variable radii and gathers with the best fixed radii, which also judges the
/// targets of light from tables and tells bias from noise. The folder gets study.html to look at, study.csv
/// with a row for each measurement, and study.json. Errors are the same at each run, times are not.
///
/// With --against, nothing is drawn: pictures that any renderer made are judged instead, by a CSV file with the
/// columns scene, way (the renderer and its version), options, seed, seconds and file, an EXR beside it. The way
/// "reference" is for pictures whose mean is right, and "layers" for an EXR of `varikernel render`, by which
/// lamps, edges, caustics and penumbras are judged apart. The folder gets against.html, against.csv and
/// against.json.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Folder to write to; made if it is missing.
    #[arg(short, long, default_value = "study", value_name = "FOLDER")]
    output: PathBuf,

    #[command(flatten)]
    extent: Extent,

    /// Go on with the study.partial.json in the folder, or with its study.json; the other options have to be
    /// the same again.
    #[arg(long)]
    resume: bool,

    /// Judge the pictures that this CSV file names instead.
    #[arg(long, value_name = "FILE")]
    #[arg(conflicts_with_all = ["quick", "full", "seeds", "resume", "device"])]
    against: Option<PathBuf>,

    /// Measure instead how much light changes from frame to frame by noise alone, where nothing, the camera or
    /// the lamp moves, and what photons that are kept for 8 frames do about it: flicker.json.
    #[arg(long, conflicts_with_all = ["against", "full", "seeds", "resume"])]
    flicker: bool,

    /// OpenGL device: auto, egl, egl:INDEX, osmesa, or part of a renderer's name.
    #[arg(long, default_value_t = DeviceChoice::Auto)]
    device: DeviceChoice,

    /// Print study.json, against.json or flicker.json instead of tables.
    #[arg(long)]
    json: bool,
}

/// How much is studied.
#[derive(Debug, clap::Args)]
struct Extent {
    /// A look at every part, within a minute.
    #[arg(long)]
    quick: bool,

    /// Every size with every n and MR, for hours on a software renderer.
    #[arg(long, conflicts_with = "quick")]
    full: bool,

    /// Seeds of each picture, 2 where photons are many; errors are told with their intervals [default: 5; 2
    /// with --quick].
    #[arg(long, value_name = "NUMBER", value_parser = whole(2..=1000))]
    #[arg(allow_negative_numbers = true)]
    seeds: Option<u32>,
}

impl Extent {
    fn settings(&self) -> StudySettings {
        let mut settings = if self.quick {
            StudySettings::quick()
        } else if self.full {
            StudySettings::full()
        } else {
            StudySettings::usual()
        };
        settings.pictures.seeds = self.seeds.unwrap_or(settings.pictures.seeds);
        settings
    }
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    if let Some(file) = &args.against {
        return against::run(file, &args.output, args.json);
    }
    if args.flicker {
        return flicker::run(&args.device, &args.output, args.extent.quick, args.json);
    }
    let settings = args.extent.settings();
    let files = Files { folder: &args.output };
    let earlier = if args.resume { Some(files.load()?) } else { None };
    output::make_folder(&args.output)?;
    files.check()?;
    let gl = device::open(&args.device)?;
    if let Some((earlier, path)) = &earlier {
        earlier.check_resumable(path, &Study::begin(&gl, &settings))?;
    }
    let earlier = earlier.map(|(study, _)| study);

    let real = real_map::read()?;
    let bar = ShareBar::new();
    let mut autosave = Autosave::new(SAVE_EVERY);
    let study = study::run(&gl, &settings, (real_map::NAME, &real), earlier, &mut |study, progress| {
        bar.show(progress.done, progress.what.clone());
        autosave.save_if_due(|| study.save(&files.partial()));
        Ok(())
    })?;
    bar.finish();
    files.write(&study)?;
    if args.json {
        output::print_json(&study.with_summary())?;
    } else {
        print(&study, args)?;
    }
    Ok(Outcome::Done)
}

/// The three files.
struct Files<'a> {
    folder: &'a PathBuf,
}

impl Files<'_> {
    /// The file until all is done: an unfinished study does not replace a finished one.
    fn partial(&self) -> PathBuf {
        self.folder.join("study.partial.json")
    }

    /// The study to go on with, and its file: an unfinished one if there is one.
    fn load(&self) -> Result<(Study, PathBuf)> {
        let partial = self.partial();
        let path = if partial.exists() { partial } else { self.folder.join("study.json") };
        Ok((Study::load(&path)?, path))
    }

    fn check(&self) -> Result<()> {
        for name in ["study.json", "study.csv", "study.html"] {
            check_writable(&self.folder.join(name))?;
        }
        Ok(())
    }

    fn write(&self, study: &Study) -> Result<()> {
        let saved = study.save(&self.folder.join("study.json"));
        let resume =
            if saved.is_ok() || self.partial().exists() { Resume::Switch("--resume") } else { Resume::Anew };
        let page = study.html(&output::command());
        saved
            .and_then(|()| study.save_csv(&self.folder.join("study.csv")))
            .and_then(|()| {
                write_atomically(&self.folder.join("study.html"), |file| file.write_all(page.as_bytes()))
            })
            .map_err(|error| how_to_go_on(error, &resume))?;
        match fs::remove_file(self.partial()) {
            Err(error) if error.kind() != ErrorKind::NotFound => Err(error)
                .with_context(|| format!("can't remove {}, which is done with", self.partial().display())),
            _ => Ok(()),
        }
    }
}

/// What to choose, as text; the rest is in the files.
fn print(study: &Study, args: &Args) -> Result<()> {
    let summary = study.summary();
    if let Some((_, overall)) = summary.radii.first() {
        let names = ["way to a radius map, on the front", "copies", "wrong, %", "mean error, px"];
        let mut rows = vec![names.map(str::to_owned)];
        rows.extend(overall.iter().filter(|one| one.on_front).map(|one| {
            [
                one.variant.to_string(),
                format!("{:.1}", one.copies),
                format!("{:.2}", 100.0 * one.wrong_share),
                format!("{:.3}", one.mean_error),
            ]
        }));
        output::print_rows(&rows)?;
    }
    output::print_sentences(&summary.density)?;
    output::print_sentences(&summary.pictures)?;
    targets::print(&summary.targets, "geometric means over the numbers of photons")?;
    output::print(&format!("written: {}", args.output.join("study.html").display()))
}
