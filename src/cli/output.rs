//! What goes to stdout and stderr.

use std::io::{self, Write as _};

use anyhow::{Context as _, Result};
use comfy_table::presets::NOTHING;
use comfy_table::{ContentArrangement, Table};
use serde::Serialize;

/// Columns of a terminal that tables fit into.
const WIDTH: u16 = 80;

/// One JSON object and a newline.
pub(crate) fn print_json(value: &impl Serialize) -> Result<()> {
    print(&serde_json::to_string_pretty(value)?)
}

/// Text and a newline. A closed pipe comes back as an error instead of a panic.
pub(crate) fn print(text: &str) -> Result<()> {
    let mut stdout = io::stdout().lock();
    writeln!(stdout, "{text}").and_then(|()| stdout.flush()).context("the answer could not be printed")
}

/// A table of names and values for people.
pub(crate) fn print_facts(facts: &[(&str, String)]) -> Result<()> {
    let rows: Vec<_> = facts.iter().map(|(name, value)| [(*name).to_owned(), value.clone()]).collect();
    print_rows(&rows)
}

/// Rows of columns for people, broken where they do not fit.
pub(crate) fn print_rows<const COLUMNS: usize>(rows: &[[String; COLUMNS]]) -> Result<()> {
    let mut table = Table::new();
    table.load_style(NOTHING).set_content_arrangement(ContentArrangement::Dynamic).set_width(WIDTH);
    table.add_rows(rows);
    print(&table.trim_fmt())
}

/// The error and what caused it, as one message.
#[expect(clippy::print_stderr, reason = "the one place for the program's last words")]
pub(crate) fn print_error(error: &anyhow::Error) {
    eprintln!("error: {error}");
    for cause in error.chain().skip(1) {
        eprintln!("caused by: {cause}");
    }
}

/// Whether the reader of our output went away, which is no error: `varikernel ... | head`.
pub(crate) fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let mut causes = error.chain().filter_map(|cause| cause.downcast_ref::<io::Error>());
    causes.any(|cause| cause.kind() == io::ErrorKind::BrokenPipe)
}
