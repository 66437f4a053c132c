//! `varikernel survey`: all that a machine's owner is asked for, in one call.

mod part;
mod summary;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, bail};
use serde::{Deserialize, Serialize};
use varikernel::context::DeviceChoice;
use varikernel::image::write_atomically;

use super::share_bar::ShareBar;
use super::{Outcome, numbers, output};
use part::{End, Part};

/// What each part left behind, in the folder.
const RECORD: &str = "survey.json";

/// Measure this machine for the project's table of cards: one folder, within ten minutes.
///
/// Runs devices, stress --quick, bench (the answers of every method), bench --suite fast, bench --suite picture
/// and reproduce, one after the other, each in a process of its own, so that one that fails or hangs is told
/// and the rest goes on. What is done is kept: --resume runs the others alone. The folder holds what each
/// prints and saves, and nothing about you: names and versions of devices, driver and processor, and times. The
/// last line is this machine's row of the table. Exit code 1 if a part failed.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Folder to write to; made if it is missing.
    #[arg(short, long, value_name = "FOLDER", default_value = "survey")]
    output: PathBuf,

    /// Time for all parts together, such as 10m; each gets its share.
    #[arg(long, default_value = "10m", value_parser = numbers::duration)]
    budget: Duration,

    /// Run these parts alone, in their order.
    #[arg(long, value_delimiter = ',', default_values_t = Part::ALL, hide_default_value = true)]
    parts: Vec<Part>,

    /// Leave out the parts that the folder says are done.
    #[arg(long)]
    resume: bool,

    /// OpenGL device: auto, egl, egl:INDEX, osmesa, or part of a renderer's name.
    #[arg(long, default_value_t = DeviceChoice::Auto)]
    device: DeviceChoice,

    /// Print one JSON object instead of lines.
    #[arg(long)]
    json: bool,
}

/// What is known of a machine so far.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Record {
    program: String,
    commit: String,
    device: String,
    parts: Vec<Done>,
}

/// A part that has run.
#[derive(Debug, Serialize, Deserialize)]
struct Done {
    part: Part,
    /// As it can be run again, in the folder.
    command: String,
    seconds: f64,
    end: End,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    if args.budget < Duration::from_secs(30) {
        bail!("--budget {:?} is not possible: give at least 30s", args.budget);
    }
    let folder = &args.output;
    output::make_folder(folder)?;
    let path = folder.join(RECORD);
    let earlier = if args.resume { earlier(&path)? } else { Record::default() };
    let mut record = Record {
        program: env!("CARGO_PKG_VERSION").to_owned(),
        commit: varikernel_lab::COMMIT.to_owned(),
        device: args.device.to_string(),
        parts: earlier.parts,
    };
    let is_done = |part: &Part| record.parts.iter().any(|done| done.part == *part && done.end == End::Done);
    let due: Vec<Part> =
        Part::ALL.into_iter().filter(|part| args.parts.contains(part) && !is_done(part)).collect();
    let share_of = |parts: &[Part]| parts.iter().map(|part| part.share()).sum::<f64>();
    let bar = ShareBar::new();
    for (index, &part) in due.iter().enumerate() {
        bar.show(share_of(&due[..index]) / share_of(&due), format!("{part}"));
        let begun = Instant::now();
        let words = part.words(args.budget, &args.device);
        let end = part::run(part, &words, folder, 2 * part.budget(args.budget) + Duration::from_mins(1))?;
        let command = std::iter::once("varikernel").chain(words.iter().map(String::as_str));
        let command = command.map(output::quoted).collect::<Vec<_>>().join(" ");
        record.parts.retain(|done| done.part != part);
        record.parts.push(Done { part, command, seconds: begun.elapsed().as_secs_f64(), end });
        record.parts.sort_by_key(|done| done.part);
        save(&record, &path)?;
    }
    bar.finish();
    save(&record, &path)?;

    let row = summary::row(folder);
    if args.json {
        output::print_json(&serde_json::json!({ "record": record, "row": row }))?;
    } else {
        let rows = record.parts.iter().map(|done| {
            let end = match &done.end {
                End::Done => "done".to_owned(),
                End::Failed { why } => format!("failed: {why}"),
            };
            [done.part.to_string(), format!("{:.0} s", done.seconds), end]
        });
        output::print_rows(&rows.collect::<Vec<_>>())?;
        output::print(&format!("written: {}\n\n{}\n{row}", path.display(), summary::HEADER))?;
    }
    let all_done = args
        .parts
        .iter()
        .all(|part| record.parts.iter().any(|done| done.part == *part && done.end == End::Done));
    Ok(if all_done { Outcome::Done } else { Outcome::Differs })
}

fn earlier(path: &Path) -> Result<Record> {
    let text = match fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Record::default()),
        Err(error) => return Err(error).with_context(|| format!("can't read {}", path.display())),
    };
    serde_json::from_str(&text).with_context(|| {
        format!("{} is no record of a survey; leave --resume out to begin anew", path.display())
    })
}

fn save(record: &Record, path: &Path) -> Result<()> {
    let text = serde_json::to_string_pretty(record)? + "\n";
    Ok(write_atomically(path, |file| std::io::Write::write_all(file, text.as_bytes()))?)
}
