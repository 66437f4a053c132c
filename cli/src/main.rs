//! The program, one file a verb: parse, run, print the error chain, exit code.

mod against;
mod bench;
mod child;
mod compare;
mod completions;
mod device;
mod devices;
mod figures;
mod flicker;
mod glsl;
mod interrupt;
mod light;
mod man;
mod method_options;
mod numbers;
mod output;
mod photons;
mod radius;
mod real_map;
mod render;
mod reproduce;
mod saving;
mod share_bar;
mod stress;
mod study;
mod survey;
mod synth;
#[cfg(feature = "window")]
mod view;
mod words;

use std::io::{self, IsTerminal as _};
use std::process::ExitCode;

use anyhow::Result;
use clap::{ArgAction, CommandFactory as _, Parser, Subcommand};
use tracing_subscriber::filter::Targets;
use tracing_subscriber::prelude::*;

const EXAMPLES: &str = "\
Examples:
  varikernel render -o picture.png             a glass Cornell box, by photons with variable kernels
  varikernel view                              the same live, in a window with every setting
  varikernel synth caustic -o map.exr          make a map to try things on
  varikernel radius map.exr -o radius.png      a picture of its radius map
  varikernel radius map.exr -o radius.exr --verify --method pyramid
  varikernel radius map.exr -o radius.exr --certify
  varikernel compare radius.exr other.npy      how two maps differ
  varikernel photons -o photons.npy            trace photons through a Cornell box
  varikernel reproduce                         the thesis's numbers from this machine
  varikernel study                             run time against error, as one page
  varikernel stress --quick                    whether the promises about exactness hold here
  varikernel survey                            all of it in ten minutes, for the table of cards
  varikernel glsl radius-search/inner          a shader's text, for engines with code of their own
  varikernel devices                           the OpenGL devices found here";

/// Variable-kernel radius maps from photon density maps, exact, in OpenGL 3.3 core.
///
/// For each pixel of a map of photon counts: the radius of the smallest box that holds at least n photons
/// (E. W. Bjønnes, Oslo 2010). Exit codes: 0 done, 1 the maps differ, are not
/// proved or a promise is broken, 2 it could not be done.
#[derive(Debug, Parser)]
#[command(name = "varikernel", version, max_term_width = 100)]
#[command(arg_required_else_help = true, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,

    /// Log what happens to stderr; twice for details.
    #[arg(short, long, global = true, action = ArgAction::Count, display_order = 100)]
    verbose: u8,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Render(render::Args),
    #[cfg(feature = "window")]
    View(Box<view::Args>),
    Figures(figures::Args),
    Radius(radius::Args),
    // Boxed: it has by far the most options.
    Bench(Box<bench::Args>),
    Reproduce(reproduce::Args),
    Study(study::Args),
    Stress(stress::Args),
    Survey(survey::Args),
    Compare(compare::Args),
    Photons(photons::Args),
    Synth(synth::Args),
    // Boxed: it has nearly as many.
    Glsl(Box<glsl::Args>),
    Devices(devices::Args),
    Completions(completions::Args),
    Man(man::Args),
}

/// The result of a verb that succeeded.
pub(crate) enum Outcome {
    Done,
    /// The answer to "are they equal?", "is it proved?" or "is it kept?" is no.
    Differs,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    log_to_stderr(cli.verbose);
    interrupt::leave_no_unfinished_files();
    match run(cli) {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Differs) => ExitCode::from(1),
        Err(error) if output::is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            output::print_error(&error);
            ExitCode::from(2)
        }
    }
}

fn run(cli: Cli) -> Result<Outcome> {
    match cli.verb {
        Verb::Render(args) => render::run(&args),
        #[cfg(feature = "window")]
        Verb::View(args) => view::run(&args),
        Verb::Figures(args) => figures::run(&args),
        Verb::Radius(args) => radius::run(&args),
        Verb::Compare(args) => compare::run(&args),
        Verb::Photons(args) => photons::run(&args),
        Verb::Synth(args) => synth::run(&args),
        Verb::Glsl(args) => glsl::run(&args),
        Verb::Reproduce(args) => reproduce::run(&args),
        Verb::Study(args) => study::run(&args),
        Verb::Stress(args) => stress::run(&args),
        Verb::Survey(args) => survey::run(&args),
        Verb::Devices(args) => devices::run(&args),
        Verb::Completions(args) => completions::run(&args),
        Verb::Man(args) => man::run(&args),
        Verb::Bench(args) => bench::run(&args),
    }
}

/// The whole of the command line.
fn command() -> clap::Command {
    Cli::command()
}

/// Warnings always, more with `-v`, or as `RUST_LOG` says.
fn log_to_stderr(verbose: u8) {
    let level = match verbose {
        // winit warns of displays without a size in millimetres, for example.
        0 => "warn,winit=error",
        1 => "info",
        _ => "debug",
    };
    let asked = std::env::var("RUST_LOG").ok().and_then(|text| text.parse::<Targets>().ok());
    let filter = asked.unwrap_or_else(|| level.parse().unwrap_or_default());
    let colours = io::stderr().is_terminal();
    let lines = tracing_subscriber::fmt::layer().with_ansi(colours).with_writer(io::stderr);
    tracing_subscriber::registry().with(lines.with_filter(filter)).init();
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The message with which an option's value is refused; nothing if it is accepted.
    fn refusal(verb: &str, option: &[&str]) -> Option<String> {
        let words = [&["varikernel", verb], option].concat();
        Cli::try_parse_from(words).err().map(|error| error.to_string())
    }

    #[test]
    fn no_option_answers_in_the_words_of_a_parser() {
        let bare =
            ["invalid digit", "invalid float", "number too", "cannot parse", "not in ", "is not a number"];
        let mut numbers = 0;
        for verb in Cli::command().get_subcommands() {
            for option in verb.get_arguments().filter(|option| option.get_action().takes_values()) {
                let Some(long) = option.get_long() else { continue };
                for value in ["-1", "x", "", "1e99", "99999999999999999999", "-1.5e400"] {
                    let joined =
                        refusal(verb.get_name(), &[&format!("--{long}={value}")]).unwrap_or_default();
                    assert!(!bare.iter().any(|words| joined.contains(words)), "{long}: {joined}");
                    // Numbers below zero come as far as the option in both forms.
                    if value == "-1" && joined.contains("give a whole number") {
                        numbers += 1;
                        let apart = refusal(verb.get_name(), &[&format!("--{long}"), value]);
                        assert_eq!(apart.as_ref(), Some(&joined), "{long}");
                    }
                }
            }
        }
        assert!(numbers > 20, "only {numbers} options take whole numbers");
    }

    #[test]
    fn seeds_are_told_their_range() {
        let words = refusal("render", &["-o", "out.exr", "--seed", "-1"]).unwrap_or_default();
        assert!(words.contains("give a whole number from 0 to 18446744073709551615"), "{words}");
    }
}
