//! What goes to stdout and stderr, and whether files can take the rest.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use comfy_table::presets::NOTHING;
use comfy_table::{ContentArrangement, Table};
use serde::Serialize;
use varikernel::image::{check_writable, output_place};

/// Columns of a terminal that tables fit into.
const WIDTH: u16 = 80;

/// A folder for outputs, with those above it.
pub(crate) fn make_folder(folder: &Path) -> Result<()> {
    fs::create_dir_all(folder).with_context(|| format!("can't make the folder {}", folder.display()))
}

/// One JSON object and a newline.
pub(crate) fn print_json(value: &impl Serialize) -> Result<()> {
    print(&serde_json::to_string_pretty(value)?)
}

/// Text and a newline. A closed pipe comes back as an error instead of a panic.
pub(crate) fn print(text: &str) -> Result<()> {
    let mut stdout = io::stdout().lock();
    writeln!(stdout, "{text}").and_then(|()| stdout.flush()).context("the answer could not be printed")
}

/// A table of names and values as text.
pub(crate) fn print_facts(facts: &[(&str, String)]) -> Result<()> {
    let rows: Vec<_> = facts.iter().map(|(name, value)| [(*name).to_owned(), value.clone()]).collect();
    print_rows(&rows)
}

/// Rows of columns as text, broken where they do not fit.
pub(crate) fn print_rows<const COLUMNS: usize>(rows: &[[String; COLUMNS]]) -> Result<()> {
    let mut table = Table::new();
    table.load_style(NOTHING).set_content_arrangement(ContentArrangement::Dynamic).set_width(WIDTH);
    table.add_rows(rows);
    print(&table.trim_fmt())
}

/// Sentences as text, a line each or more.
pub(crate) fn print_sentences(sentences: &[String]) -> Result<()> {
    let rows: Vec<_> = sentences.iter().map(|sentence| [sentence.clone()]).collect();
    print_rows(&rows)
}

/// The command line, for reports.
pub(crate) fn command() -> String {
    let call = std::iter::once("varikernel".to_owned()).chain(words_of_the_call().skip(1));
    call.map(|word| quoted(&word)).collect::<Vec<_>>().join(" ")
}

/// The program and its arguments; what is no Unicode in them is replaced.
pub(crate) fn words_of_the_call() -> impl Iterator<Item = String> {
    std::env::args_os().map(|word| word.to_string_lossy().into_owned())
}

/// A word for a shell.
pub(crate) fn quoted(text: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./:=,+@%".contains(letter);
    if !text.is_empty() && text.chars().all(plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', "'\\''"))
    }
}

/// The error and what caused it, as one message.
#[expect(clippy::print_stderr, reason = "the one place for the program's last words")]
pub(crate) fn print_error(error: &anyhow::Error) {
    eprintln!("error: {error}");
    for cause in error.chain().skip(1) {
        eprintln!("caused by: {cause}");
    }
}

/// Whether the reader closed the pipe, which is no error: `varikernel ... | head`.
pub(crate) fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let mut causes = error.chain().filter_map(|cause| cause.downcast_ref::<io::Error>());
    causes.any(|cause| cause.kind() == io::ErrorKind::BrokenPipe)
}

/// Refuses outputs, by the names of their options, that can't be written or would replace the input or each
/// other.
pub(crate) fn check_files(input: (&str, &Path), outputs: &[(&str, Option<&Path>)]) -> Result<()> {
    let mut taken = vec![(input.0, place_of(input.1))];
    for &(name, path) in outputs {
        let Some(path) = path else { continue };
        check_writable(path)?;
        let place = place_of(path);
        if let Some((other, _)) = taken.iter().find(|(_, other)| *other == place) {
            bail!("{}: {name} is the same file as {other}\nhelp: choose another name", path.display());
        }
        taken.push((name, place));
    }
    Ok(())
}

/// The file itself, whichever way it is named and whether or not it exists.
fn place_of(path: &Path) -> PathBuf {
    let path = output_place(path).unwrap_or_else(|_| path.to_owned());
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    folder.canonicalize().unwrap_or_default().join(path.file_name().unwrap_or_default())
}
