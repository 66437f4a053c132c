//! The program: parse, run, print the error chain, exit code.

mod cli;

use std::process::ExitCode;

use clap::Parser as _;

fn main() -> ExitCode {
    let cli = cli::Cli::parse();
    cli::log_to_stderr(cli.verbose);
    cli::interrupt::leave_no_unfinished_files();
    match cli::run(cli) {
        Ok(cli::Outcome::Done) => ExitCode::SUCCESS,
        Ok(cli::Outcome::Differs) => ExitCode::from(1),
        Err(error) if cli::output::is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            cli::output::print_error(&error);
            ExitCode::from(2)
        }
    }
}
