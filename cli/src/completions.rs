//! `varikernel completions`: what a shell needs to complete the program's verbs and options.

use anyhow::Result;
use clap_complete::Shell;

use super::{Outcome, output};

/// Print a shell's completions of verbs and options.
///
/// For bash: varikernel completions bash > ~/.local/share/bash-completion/completions/varikernel
/// For zsh, into a folder of $fpath: varikernel completions zsh > _varikernel
/// For fish: varikernel completions fish > ~/.config/fish/completions/varikernel.fish
#[derive(Debug, clap::Args)]
#[command(verbatim_doc_comment)]
pub(crate) struct Args {
    /// bash, elvish, fish, powershell or zsh.
    #[arg(value_name = "SHELL", hide_possible_values = true)]
    shell: Shell,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut super::command(), "varikernel", &mut text);
    output::print(String::from_utf8(text)?.trim_end())?;
    Ok(Outcome::Done)
}
