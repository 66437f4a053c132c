//! `varikernel reproduce`: the thesis's tables and claims on this machine.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use varikernel::context::DeviceChoice;
use varikernel::gl::Gl;
use varikernel::image::{check_writable, write_atomically};
use varikernel_lab::report::Report;
use varikernel_lab::reproduce::{self, RunFile};
use varikernel_lab::thesis::claims::{self, Group, Judged};

use super::numbers::duration;
use super::saving::{Autosave, Resume, how_to_go_on};
use super::{Outcome, device, output, real_map};

/// Reproduce the thesis: its tables, figures and claims, timed and judged on this machine.
///
/// Writes a folder with report.html (one self-contained page), claims.csv, tables/, figures/ and run.json
/// (every sample).
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Folder to write to; made if it is missing.
    #[arg(short, long, default_value = "reproduction", value_name = "FOLDER")]
    output: PathBuf,

    /// Time for all timing runs, such as 90s or 10m; what does not fit is marked in the tables [default: 4m,
    /// or 24h with --full].
    #[arg(long, value_parser = duration, allow_negative_numbers = true)]
    budget: Option<Duration>,

    /// Take the thesis's 5 sets of 1000 iterations for every cell, as far as the budget goes.
    #[arg(long)]
    full: bool,

    /// Go on with the run.json in the folder; the budget is a new one.
    #[arg(long)]
    resume: bool,

    /// OpenGL device: auto, egl, egl:INDEX, osmesa, or part of a renderer's name.
    #[arg(long, default_value_t = DeviceChoice::Auto)]
    device: DeviceChoice,

    /// Print the claims as one JSON array instead of lines.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    let usual = Duration::from_secs(if args.full { 24 * 3600 } else { 4 * 60 });
    let budget = args.budget.unwrap_or(usual);
    if budget < Duration::from_secs(5) {
        bail!("--budget {budget:?} is not possible: give at least 5s, for a sample of the smallest maps");
    }
    for folder in [args.output.clone(), args.output.join("tables"), args.output.join("figures")] {
        output::make_folder(&folder)?;
    }
    let run_json = args.output.join("run.json");
    check_writable(&run_json)?;
    let earlier = if args.resume { RunFile::load(&run_json)? } else { RunFile::default() };
    let gl = device::open(&args.device)?;
    let cornell = real_map::read()?;
    let real = (&cornell, real_map::NAME);

    // What needs no clock is printed at once.
    let begun = Instant::now();
    let counted = reproduce::counted(&gl, real)?;
    let counted_seconds = begun.elapsed().as_secs_f64();
    let mut shown = Vec::new();
    if !args.json {
        let early = claims::judge_all(&counted);
        shown = vec![Group::Counted, Group::Listing, Group::Printed];
        print_claims(early.iter().filter(|one| shown.contains(&one.claim.group)))?;
    }

    let bar = progress_bar();
    let mut autosave = Autosave::new(Duration::from_secs(2));
    let run = reproduce::time(&gl, real, budget, args.full, (earlier, &run_json), &mut |run, progress| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of 1000")]
        bar.set_position((1000.0 * progress.done) as u64);
        bar.set_prefix(format!("at most {} s left", progress.budget_left.as_secs() + 1));
        bar.set_message(format!("{}: {}", progress.part, progress.case));
        autosave.save_if_due(|| run.save(&run_json));
        Ok(())
    })?;
    bar.finish_and_clear();
    let resume = Resume::Switch("--resume");
    let missing = !run_json.exists();
    run.save(&run_json)
        .map_err(|error| how_to_go_on(error, if missing { &Resume::Anew } else { &resume }))?;

    let evidence = reproduce::with_timings(counted, &run);
    let judged = reproduce::judge(&evidence, &run, counted_seconds);
    if args.json {
        output::print_json(&judged.iter().map(as_json).collect::<Vec<_>>())?;
    } else {
        print_claims(judged.iter().filter(|one| !shown.contains(&one.claim.group)))?;
    }
    let report = Report {
        command: &output::command(),
        environment: &environment(&gl, &run),
        evidence: &evidence,
        judged: &judged,
        other_maps: &reproduce::other_maps(&run),
        notes: &notes(&run),
    };
    for (name, text) in report.files() {
        write_atomically(&args.output.join(name), |file| std::io::Write::write_all(file, text.as_bytes()))
            .map_err(|error| how_to_go_on(error, &resume))?;
    }
    if !args.json {
        print_summary(&judged, &args.output)?;
    }
    Ok(Outcome::Done)
}

fn progress_bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{wide_bar} {percent} %, {prefix}\n{msg}");
    let bar = ProgressBar::new(1000);
    bar.with_style(style.unwrap_or_else(|error| unreachable!("a fixed template: {error}")))
}

fn print_claims<'a>(judged: impl Iterator<Item = &'a Judged>) -> Result<()> {
    let mut rows = Vec::new();
    for one in judged {
        let answer = if one.judgement.ours.is_empty() { &one.judgement.note } else { &one.judgement.ours };
        let text = format!("{}\n  {answer}", one.claim.statement);
        rows.push([one.judgement.verdict.to_string(), one.claim.section.clone(), text]);
    }
    output::print_rows(&rows)
}

fn print_summary(judged: &[Judged], folder: &Path) -> Result<()> {
    let counts = claims::verdict_counts(judged);
    let counts: Vec<_> = counts
        .iter()
        .map(|(verdict, count)| format!("{count} {}", verdict.to_string().to_lowercase()))
        .collect();
    output::print(&format!("\n{} claims: {}", judged.len(), counts.join(", ")))?;
    output::print(&format!("written: {}", folder.join("report.html").display()))
}

fn as_json(one: &Judged) -> serde_json::Value {
    serde_json::json!({
        "id": one.claim.id,
        "section": one.claim.section,
        "statement": one.claim.statement,
        "thesis": one.claim.thesis,
        "ours": one.judgement.ours,
        "verdict": one.judgement.verdict.to_string(),
        "note": one.judgement.note,
        "seconds": one.seconds,
    })
}

fn environment(gl: &Gl, run: &RunFile) -> Vec<(String, String)> {
    let device = varikernel_lab::bench::Device::of(gl.info());
    let shaders = run.parts.iter().map(|part| part.report.shaders.clone()).collect::<Vec<_>>().join(", ");
    [
        ("renderer", device.renderer),
        ("driver", device.version),
        ("kind", if device.software { "software renderer" } else { "hardware" }.to_owned()),
        ("processor", format!("{}, {} threads", device.processor, device.threads)),
        ("program", format!("varikernel {}, commit {}", env!("CARGO_PKG_VERSION"), varikernel_lab::COMMIT)),
        ("shader hashes", shaders),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .to_vec()
}

/// What a reader has to know of this run.
fn notes(run: &RunFile) -> Vec<String> {
    let runs = || run.parts.iter().flat_map(|part| &part.report.runs);
    let samples: usize = runs().map(|run| run.samples_ms.len()).sum();
    let suspect: usize = runs().map(|run| run.suspect.len()).sum();
    let left_out: usize = run.parts.iter().map(|part| part.report.left_out.len()).sum();
    let wrong: usize = runs().filter(|run| run.is_wrong()).count();
    vec![format!(
        "{samples} samples were taken; in {suspect} of them the GPU query and the clock disagree. {left_out} \
         cases were left out, and {wrong} of an exact method gave a wrong answer."
    )]
}
