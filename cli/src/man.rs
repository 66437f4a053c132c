//! `varikernel man`: manual pages, one for the program and one for each verb.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::Result;
use clap_mangen::Man;
use varikernel::image::write_atomically;

use super::{Outcome, output};

/// Write manual pages, one for the program and one for each verb.
///
/// `varikernel man -o ~/.local/share/man/man1`, and `man varikernel` and `man varikernel-render` find them.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Folder to write to; made if it is missing.
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    let folder = &args.output;
    output::make_folder(folder)?;
    let mut whole = super::command().disable_help_subcommand(true);
    // Names each verb as its page is called.
    whole.build();
    let pages: Vec<_> = std::iter::once(&whole).chain(whole.get_subcommands()).collect();
    for page in &pages {
        let man = Man::new((*page).clone());
        write_atomically(&folder.join(man.get_filename()), |file| {
            let mut text = Vec::new();
            man.render(&mut text)?;
            file.write_all(&text)
        })?;
    }
    output::print(&format!("written: {} pages in {}", pages.len(), folder.display()))?;
    Ok(Outcome::Done)
}
