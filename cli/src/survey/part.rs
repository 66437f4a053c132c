//! A part of a survey: another verb of this program, in a process of its own.

use std::fmt;
use std::fs::File;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use anyhow::{Context as _, Result};
use serde::{Deserialize, Serialize};
use varikernel::context::DeviceChoice;

use crate::child::{reader, wait};
use crate::output::make_folder;

/// What is run, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Part {
    /// Every OpenGL device found.
    Devices,
    /// Whether the promises about exactness hold: `stress --quick`.
    Stress,
    /// The answers and times of every method: `bench`.
    Methods,
    /// The fast path: `bench --suite fast`.
    Fast,
    /// The stages of a picture: `bench --suite picture`.
    Picture,
    /// The thesis's tables and claims: `reproduce`.
    Reproduction,
}

/// How a part ended.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum End {
    Done,
    Failed { why: String },
}

impl fmt::Display for Part {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Devices => "devices",
            Self::Stress => "stress",
            Self::Methods => "methods",
            Self::Fast => "fast",
            Self::Picture => "picture",
            Self::Reproduction => "reproduction",
        })
    }
}

impl Part {
    /// All of them.
    pub(super) const ALL: [Self; 6] =
        [Self::Devices, Self::Stress, Self::Methods, Self::Fast, Self::Picture, Self::Reproduction];

    /// Of the whole time.
    pub(super) fn share(self) -> f64 {
        match self {
            Self::Devices => 0.01,
            Self::Stress => 0.12,
            Self::Methods => 0.07,
            Self::Fast => 0.3,
            Self::Picture | Self::Reproduction => 0.25,
        }
    }

    /// Its share of a budget: 5 s at the least.
    pub(super) fn budget(self, whole: Duration) -> Duration {
        whole.mul_f64(self.share()).max(Duration::from_secs(5))
    }

    /// The program's arguments, for files below the folder of the survey.
    pub(super) fn words(self, whole: Duration, device: &DeviceChoice) -> Vec<String> {
        let seconds = format!("{}s", self.budget(whole).as_secs());
        let json = format!("{self}/{self}.json");
        let text = match self {
            Self::Devices => "devices --json".to_owned(),
            Self::Stress => "stress --quick -o stress".to_owned(),
            Self::Methods => format!("bench --sizes 64,256 --budget {seconds} --json {json}"),
            Self::Fast => format!("bench --suite fast --budget {seconds} --json {json}"),
            Self::Picture => {
                format!(
                    "bench --suite picture --sizes 1920x1080 --photons 1e6 --budget {seconds} --json {json}"
                )
            }
            Self::Reproduction => format!("reproduce -o reproduction --budget {seconds}"),
        };
        let mut words: Vec<String> = text.split(' ').map(str::to_owned).collect();
        if self != Self::Devices {
            words.extend(["--device".to_owned(), device.to_string()]);
        }
        words
    }

    /// Where what it prints goes, below the folder of the survey.
    fn printed(self) -> String {
        if self == Self::Devices { "devices/devices.json".to_owned() } else { format!("{self}/table.txt") }
    }
}

/// Runs a part in the folder, and ends it after the limit.
///
/// # Errors
/// Only what keeps any part from running; how this one ended is the answer.
pub(super) fn run(part: Part, words: &[String], folder: &Path, limit: Duration) -> Result<End> {
    let printed = folder.join(part.printed());
    let place = printed.parent().unwrap_or(folder);
    make_folder(place)?;
    let file = File::create(&printed).with_context(|| format!("can't write {}", printed.display()))?;
    let program = std::env::current_exe().context("this program can't be found: start it by its path")?;
    let mut command = Command::new(program);
    command.args(words).current_dir(folder).stdin(Stdio::null()).stdout(file).stderr(Stdio::piped());
    let mut child = match command.spawn() {
        Ok(child) => child,
        Err(error) => return Ok(End::Failed { why: format!("no process for it: {error}") }),
    };
    let stderr = reader(child.stderr.take());
    let status = wait(&mut child, limit).context("a part can't be waited for")?;
    let bytes = stderr.join().unwrap_or_default();
    let last = String::from_utf8_lossy(&bytes);
    // The error, or else the last line.
    let said = last.lines().rev().find(|line| line.starts_with("error")).or_else(|| last.lines().next_back());
    let why = match status {
        Some(status) if status.success() => return Ok(End::Done),
        Some(status) => format!("{status}; {}", said.unwrap_or("it says nothing")),
        None => format!("no end within {} s; {}", limit.as_secs(), said.unwrap_or("it says nothing")),
    };
    Ok(End::Failed { why })
}
