//! `varikernel photons`: photons traced through a scene on the CPU.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context as _, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use varikernel::image::write_atomically;
use varikernel::photon::{
    self, Emission, Ends, Landings, MAX_BOUNCES, PhotonFormat, ROULETTE_AFTER, Tally, TraceSettings,
};
use varikernel::scene::Scene;

use super::numbers::{whole, whole_checked_later};
use super::words::in_words_of_options;
use super::{Outcome, output};

/// Trace photons through a scene and write their diffuse landings.
///
/// Each landing has its position in scene units, the direction from which the photon came, its power before
/// absorption (linear RGB), the surface's normal and name, the number of landings before (from 0), and
/// whether glass has refracted the photon on its way. The result depends on the seed alone, not on the number
/// of threads.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// A scene file, or one of: cornell-glass, cornell-boxes, cornell-empty, mirror-ring, water, still-life,
    /// thin-things.
    #[arg(default_value = "cornell-glass")]
    scene: PathBuf,

    /// File to write: .npy (records), .csv or .ply (binary).
    #[arg(short, long, value_name = "FILE", required_unless_present = "stats")]
    output: Option<PathBuf>,

    /// Photons that leave the lights; 1e6 is a million.
    #[arg(long, default_value = "1e6", value_name = "NUMBER")]
    #[arg(value_parser = parse_count, allow_negative_numbers = true)]
    photons: u32,

    #[arg(help = bounces_help())]
    #[arg(long, value_name = "NUMBER", value_parser = whole_checked_later(1..=u32::MAX))]
    #[arg(allow_negative_numbers = true)]
    bounces: Option<u32>,

    /// A whole number; the same seed gives the same photons.
    #[arg(long, default_value_t = 1, value_parser = whole(0..=u64::MAX), allow_negative_numbers = true)]
    seed: u64,

    /// End photons by chance at every landing, in proportion to what a surface absorbs, instead of dimming
    /// them; the mean is the same.
    #[arg(long)]
    russian_roulette: bool,

    /// Threads that trace [default: one for each processor].
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true)]
    #[arg(value_parser = whole_checked_later(1..=rayon::max_num_threads()))]
    threads: Option<usize>,

    /// File for the shares of landings by bounce and surface, and of the power by bounce, as JSON.
    #[arg(long, value_name = "FILE")]
    stats: Option<PathBuf>,

    /// Print one JSON object instead of a table.
    #[arg(long)]
    json: bool,
}

/// The answer of `--json`.
#[derive(Serialize)]
struct Report<'a> {
    version: &'a str,
    scene: &'a str,
    settings: &'a TraceSettings,
    output: Option<&'a Path>,
    stats_file: Option<&'a Path>,
    landings: u64,
    ends: Ends,
    seconds: f64,
    stats: Landings,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    if let Some(path) = &args.output {
        PhotonFormat::of(path)?;
    }
    let outputs = [("--output", args.output.as_deref()), ("--stats", args.stats.as_deref())];
    output::check_files(("the scene", &args.scene), &outputs)?;
    let scene = load(&args.scene)?;
    let settings = TraceSettings {
        photons: args.photons,
        bounces: args.bounces,
        seed: args.seed,
        russian_roulette: args.russian_roulette,
    };
    let emission = Emission::new(&scene, &settings).map_err(in_words_of_options)?;
    let threads = args.threads.unwrap_or(0);
    if args.threads == Some(0) {
        bail!("--threads 0 is not possible: give at least 1");
    }
    let pool =
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().context("can't start the threads")?;

    let begun = Instant::now();
    let bar = progress_bar(settings.photons);
    let progress = |followed: u32| bar.set_position(followed.into());
    let tally = pool.install(|| trace(args, &scene, &emission, progress))?;
    bar.finish_and_clear();
    let stats = tally.landings(&scene, &emission);
    if let Some(path) = &args.stats {
        let text = serde_json::to_string_pretty(&stats)?;
        write_atomically(path, |file| writeln!(file, "{text}"))?;
    }
    let report = Report {
        version: env!("CARGO_PKG_VERSION"),
        scene: &scene.title,
        settings: &settings,
        output: args.output.as_deref(),
        stats_file: args.stats.as_deref(),
        landings: tally.total(),
        ends: tally.ends,
        seconds: begun.elapsed().as_secs_f64(),
        stats,
    };
    if args.json {
        output::print_json(&report)?;
    } else {
        print(&report)?;
    }
    Ok(Outcome::Done)
}

/// A scene file, or where there is none of this name, a scene that comes with the program.
pub(super) fn load(scene: &Path) -> varikernel::Result<Scene> {
    match scene.to_str() {
        Some(name) if !scene.exists() && Scene::shipped_names().any(|shipped| shipped == name) => {
            Scene::shipped(name)
        }
        _ if !scene.exists() => {
            let names = Scene::shipped_names().collect::<Vec<_>>().join(", ");
            Err(varikernel::Error::File {
                path: scene.to_owned(),
                problem: "there is no such file, nor does a scene of this name come with the program"
                    .to_owned(),
                remedy: format!("check the path, or use one of: {names}"),
            })
        }
        _ => Scene::load(scene),
    }
}

fn trace(
    args: &Args,
    scene: &Scene,
    emission: &Emission<'_>,
    progress: impl Fn(u32) + Send,
) -> varikernel::Result<Tally> {
    match &args.output {
        Some(path) => photon::write(path, scene, emission, progress),
        None => photon::trace_in_batches(scene, emission, |_, followed| {
            progress(followed);
            Ok(())
        }),
    }
}

fn progress_bar(photons: u32) -> ProgressBar {
    let style = ProgressStyle::with_template("{wide_bar} {human_pos} of {human_len} photons, {eta} left");
    let bar = ProgressBar::new(photons.into());
    bar.with_style(style.unwrap_or_else(|error| unreachable!("a fixed template: {error}")))
}

fn mean([red, green, blue]: [f64; 3]) -> f64 {
    (red + green + blue) / 3.0
}

#[expect(clippy::cast_precision_loss, reason = "counts are below 2^53")]
fn print(report: &Report<'_>) -> Result<()> {
    let photons = report.settings.photons;
    let percent = |count: u64| format!("{:.3} %", 100.0 * count as f64 / f64::from(photons));
    let ends = report.ends;
    let mut facts = vec![
        ("scene", report.scene.to_owned()),
        ("photons", format!("{photons}, seed {}", report.settings.seed)),
        (
            "landings",
            format!("{}, {:.3} per photon", report.landings, report.landings as f64 / f64::from(photons)),
        ),
        ("left the scene", percent(ends.left)),
        ("absorbed", percent(ends.absorbed)),
        ("bounces used up", percent(ends.bounces_used)),
        ("power cut off", format!("{:.3} %, mean of the colours", 100.0 * mean(report.stats.cut_off))),
    ];
    if ends.given_up > 0 {
        let often = photon::MAX_SPECULAR;
        facts.push((
            "given up",
            format!("{}, after {often} mirrors or glass in a row", percent(ends.given_up)),
        ));
    }
    facts.push(("time", format!("{:.2} s", report.seconds)));
    for path in [report.output, report.stats_file].into_iter().flatten() {
        facts.push(("written", path.display().to_string()));
    }
    output::print_facts(&facts)
}

/// What `--bounces` does, and what is done without it.
pub(super) fn bounces_help() -> String {
    format!(
        "Diffuse landings after which a photon is followed no further [default: none: it is followed to its \
         end, after {ROULETTE_AFTER} landings by Russian roulette, at the latest after {MAX_BOUNCES}]"
    )
}

/// 1000, 1_000 or 1e3.
pub(super) fn parse_count(text: &str) -> Result<u32> {
    let number = text.replace('_', "").parse::<f64>().ok();
    let whole = number.filter(|number| number.fract() == 0.0 && (1.0..=f64::from(u32::MAX)).contains(number));
    let Some(number) = whole else {
        bail!("give a whole number from 1 to {}, such as 1000000 or 1e6", u32::MAX);
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole and inside, as tested above"
    )]
    let count = number as u32;
    Ok(count)
}
