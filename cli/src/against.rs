//! `varikernel study --against`: pictures of other renderers beside ours.

use std::io::Write as _;
use std::path::Path;

use anyhow::Result;
use varikernel::image::{check_writable, write_atomically};
use varikernel_lab::against::Against;

use super::share_bar::ShareBar;
use super::{Outcome, output};

/// Judges the pictures that a file names, and writes what was found into a folder.
pub(super) fn run(file: &Path, folder: &Path, json: bool) -> Result<Outcome> {
    output::make_folder(folder)?;
    let [html, csv, whole] = ["html", "csv", "json"].map(|kind| folder.join(format!("against.{kind}")));
    for path in [&html, &csv, &whole] {
        check_writable(path)?;
    }
    let bar = ShareBar::new();
    let against = Against::read(file, &mut |path, done| bar.show(done, path.display().to_string()))?;
    bar.finish();
    against.save(&whole)?;
    against.save_csv(&csv)?;
    let page = against.html(&output::command());
    write_atomically(&html, |file| file.write_all(page.as_bytes()))?;
    if json {
        output::print_json(&against)?;
        return Ok(Outcome::Done);
    }
    let names = ["scene", "way", "options", "s", "RMSE, %", "median, %", "in equal time"];
    let rows: Vec<_> = std::iter::once(names.map(str::to_owned)).chain(against.rows()).collect();
    output::print_rows(&rows)?;
    output::print(&format!("written: {}", html.display()))?;
    Ok(Outcome::Done)
}
