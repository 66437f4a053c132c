//! Devices as the program opens them: where a driver may end the process, a child of the program tries it
//! first.

use std::env;
use std::process::{Command, Stdio};
use std::time::Duration;

use serde::{Deserialize, Serialize};
use varikernel::context::{self, Candidate, DeviceChoice, Refusal};
use varikernel::gl::{DeviceInfo, Gl};
use varikernel::{Error, Result};

use super::child::{reader, wait};

/// A driver that takes longer is taken to hang.
const LIMIT: Duration = Duration::from_mins(1);

/// The result of opening a device.
#[derive(Clone, Serialize, Deserialize)]
#[serde(untagged)]
pub(crate) enum Answer {
    /// It works.
    Works {
        /// What it reports about itself.
        info: DeviceInfo,
    },
    /// It does not.
    Fails {
        /// Why.
        error: String,
        /// What helps.
        remedy: String,
        /// Whether the driver ended the process, or had to be ended.
        #[serde(skip)]
        crashed: bool,
    },
}

impl Answer {
    /// Of a device that is opened in this process.
    fn here(candidate: &Candidate) -> Self {
        match candidate.open() {
            Ok(gl) => Self::Works { info: gl.info().clone() },
            Err(error) => Refusal::from(error).into(),
        }
    }

    fn failed(error: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Fails { error: error.into(), remedy: remedy.into(), crashed: false }
    }
}

impl From<Refusal> for Answer {
    fn from(refusal: Refusal) -> Self {
        Self::failed(refusal.reason, refusal.remedy)
    }
}

/// Opens the device of that choice. Where the environment sets what drivers read, each is tried in a child
/// first: some values end the process that opens a device.
pub(crate) fn open(choice: &DeviceChoice) -> Result<Gl> {
    if context::driver_variables().is_empty() {
        return context::open(choice);
    }
    context::open_by(choice, &mut |candidate| match in_child(candidate) {
        Answer::Works { .. } => candidate.open(),
        Answer::Fails { error, remedy, .. } => Err(Error::NoContext { reason: error, remedy }),
    })
}

/// Whether a driver would end this process, for what opens a context in another way: tried as by [`open`],
/// and an error only where every device fails and one does so by a crash.
#[cfg(feature = "window")]
pub(crate) fn check_for_crashes() -> Result<()> {
    if context::driver_variables().is_empty() {
        return Ok(());
    }
    let (candidates, _) = context::candidates();
    let mut crash = Ok(());
    for candidate in &candidates {
        match in_child(candidate) {
            Answer::Works { .. } => return Ok(()),
            Answer::Fails { error, remedy, crashed: true } if crash.is_ok() => {
                crash = Err(Error::NoContext { reason: error, remedy });
            }
            Answer::Fails { .. } => {}
        }
    }
    crash
}

/// The answer of the device of that name, opened in this process.
pub(crate) fn answer_here(choice: &DeviceChoice) -> Answer {
    let (candidates, _) = context::candidates();
    match candidates.iter().find(|candidate| candidate.choice == *choice) {
        Some(candidate) => Answer::here(candidate),
        None => Answer::failed("there is no such device", "`varikernel devices` lists them"),
    }
}

/// The answer of a device that a child of this program opens, whatever happens to the child.
pub(crate) fn in_child(candidate: &Candidate) -> Answer {
    let mut command = match env::current_exe() {
        Ok(program) => Command::new(program),
        Err(error) => {
            return Answer::failed(format!("this program can't be found: {error}"), "start it by its path");
        }
    };
    command.args(["devices", "--answer-of", &candidate.choice.to_string()]);
    answer_of(command, LIMIT)
}

/// What a child prints, or how it ended without an answer.
fn answer_of(mut command: Command, limit: Duration) -> Answer {
    let piped = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = match piped.spawn() {
        Ok(child) => child,
        Err(error) => {
            return Answer::failed(format!("no process to try it in: {error}"), "end other processes");
        }
    };
    let (stdout, stderr) = (reader(child.stdout.take()), reader(child.stderr.take()));
    let end = wait(&mut child, limit);
    let (stdout, stderr) = (stdout.join().unwrap_or_default(), stderr.join().unwrap_or_default());
    let words = String::from_utf8_lossy(&stderr);
    match (serde_json::from_slice(&stdout), end) {
        (Ok(Answer::Fails { error, remedy, .. }), _) => Answer::failed(with_words(error, &words), remedy),
        (Ok(answer), _) => answer,
        (Err(_), end) => {
            let end = match end {
                Ok(Some(status)) => format!("the driver ended the process that tried it ({status})"),
                Ok(None) => format!("the driver gave no answer within {} s", limit.as_secs()),
                Err(error) => format!("the process that tried it can't be waited for: {error}"),
            };
            let Refusal { reason, remedy } = context::unexplained(&with_words(end, &words));
            Answer::Fails { error: reason, remedy, crashed: true }
        }
    }
}

/// With the first line that the driver printed, if it did.
fn with_words(error: String, words: &str) -> String {
    let lines = || words.lines().filter(|line| !line.trim().is_empty());
    // Mesa's messages are closer to the cause than those of the libraries below it.
    let of_mesa = |line: &&str| line.starts_with("MESA") || line.starts_with("libEGL");
    match lines().find(of_mesa).or_else(|| lines().next()) {
        Some(line) => format!("{error}; the driver says: {}", line.trim()),
        None => error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    fn of_shell(script: &str, limit: Duration) -> (String, String) {
        let mut shell = Command::new("sh");
        shell.args(["-c", script]);
        match answer_of(shell, limit) {
            Answer::Fails { error, remedy, .. } => (error, remedy),
            Answer::Works { info } => (info.renderer, String::new()),
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_child_that_crashes_hangs_or_says_nothing_is_an_answer() {
        let (crash, remedy) = of_shell("kill -SEGV $$", LIMIT);
        assert!(crash.contains("signal: 11 (SIGSEGV)") && !remedy.is_empty(), "{crash}");
        let (words, _) = of_shell("echo a remark >&2; echo libEGL warning: no >&2; exit 3", LIMIT);
        assert!(words.contains("exit status: 3") && words.contains("says: libEGL warning: no"), "{words}");
        let (hang, _) = of_shell("exec sleep 100", Duration::ZERO);
        assert!(hang.contains("no answer within 0 s"), "{hang}");
    }

    #[cfg(unix)]
    #[test]
    fn the_answer_of_a_child_is_passed_on_with_the_words_of_its_driver() {
        let (error, remedy) = of_shell("echo oops >&2; echo '{\"error\":\"no\",\"remedy\":\"try\"}'", LIMIT);
        assert_eq!((error.as_str(), remedy.as_str()), ("no; the driver says: oops", "try"));
        // More than a pipe holds.
        let (error, _) =
            of_shell("yes | head -n 200000 >&2; echo '{\"error\":\"no\",\"remedy\":\"\"}'", LIMIT);
        assert_eq!(error, "no; the driver says: y");
    }
}
