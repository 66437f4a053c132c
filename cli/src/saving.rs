//! Saves during long runs, and how to resume where the last save fails.

use std::time::{Duration, Instant};

use anyhow::anyhow;
use varikernel::Error;

use super::output::{quoted, words_of_the_call};

/// Saves now and then. One that fails does not end the run: the disk may have room at the next.
pub(super) struct Autosave {
    every: Duration,
    last: Instant,
    is_failing: bool,
}

impl Autosave {
    pub(super) fn new(every: Duration) -> Self {
        Self { every, last: Instant::now(), is_failing: false }
    }

    /// From now on, saves this far apart at least.
    pub(super) fn wait(&mut self, every: Duration) {
        self.every = every;
    }

    /// Saves where the last time is long enough ago.
    pub(super) fn save_if_due(&mut self, save: impl FnOnce() -> varikernel::Result<()>) {
        if self.last.elapsed() < self.every {
            return;
        }
        let saved = save();
        match &saved {
            Err(error) if !self.is_failing => {
                let problem = match error {
                    Error::File { path, problem, .. } => format!("{}: {problem}", path.display()),
                    other => other.to_string(),
                };
                tracing::warn!("{problem}; this run goes on, and saves again later");
            }
            _ => {}
        }
        self.is_failing = saved.is_err();
        self.last = Instant::now();
    }
}

/// The options that go on with what was saved.
pub(super) enum Resume {
    /// Nothing was saved, or the verb starts anew each time.
    Anew,
    /// A switch.
    Switch(&'static str),
    /// In the place of the option that named the file, the one that goes on with it.
    Instead { of: &'static str, option: &'static str },
}

/// The error at the end of a long run, with the command that goes on from what was saved.
pub(super) fn how_to_go_on(error: Error, resume: &Resume) -> anyhow::Error {
    let command = resume.command(words_of_the_call());
    let next = match resume {
        Resume::Anew => "run it again",
        _ => "go on with what was saved",
    };
    match error {
        Error::File { path, problem, .. } => {
            anyhow!("{}: {problem}\nhelp: make room on the disk, then {next}: {command}", path.display())
        }
        other => anyhow!("{other}\nhelp: then {next}: {command}"),
    }
}

impl Resume {
    /// The command that does so, quoted for a shell, after the command line `call`.
    fn command(&self, call: impl Iterator<Item = String>) -> String {
        let mut words: Vec<String> = call.collect();
        match *self {
            Self::Anew => {}
            Self::Switch(switch) => {
                if !words.iter().any(|word| word == switch) {
                    words.push(switch.to_owned());
                }
            }
            Self::Instead { of, option } => {
                for word in &mut words {
                    match word.strip_prefix(of) {
                        Some(rest) if rest.is_empty() || rest.starts_with('=') => {
                            *word = format!("{option}{rest}");
                        }
                        _ => {}
                    }
                }
            }
        }
        words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn command(resume: &Resume, call: &str) -> String {
        resume.command(call.split('|').map(str::to_owned))
    }

    #[test]
    fn commands_go_on_where_a_run_stopped() {
        let switch = Resume::Switch("--resume");
        assert_eq!(
            command(&switch, "./varikernel|study|-o|my study|--quick"),
            "./varikernel study -o 'my study' --quick --resume"
        );
        assert_eq!(command(&switch, "varikernel|study|--resume"), "varikernel study --resume");
        assert_eq!(command(&Resume::Anew, "varikernel|stress"), "varikernel stress");
        let instead = Resume::Instead { of: "--json", option: "--resume" };
        assert_eq!(
            command(&instead, "varikernel|bench|--json|a.json|--csv|--json.csv"),
            "varikernel bench --resume a.json --csv --json.csv"
        );
        assert_eq!(command(&instead, "varikernel|bench|--json=a.json"), "varikernel bench --resume=a.json");
    }

    #[test]
    fn a_save_that_fails_is_tried_again() {
        let mut autosave = Autosave::new(Duration::ZERO);
        let full = || {
            Err(Error::File {
                path: "run.json".into(),
                problem: "the disk is full".to_owned(),
                remedy: "make room on it".to_owned(),
            })
        };
        autosave.save_if_due(full);
        assert!(autosave.is_failing);
        autosave.save_if_due(|| Ok(()));
        assert!(!autosave.is_failing);
        let mut later = Autosave::new(Duration::MAX);
        later.save_if_due(|| panic!("not yet"));
        assert!(!later.is_failing);
    }
}
