//! One test and its outcome.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Whether the program would compute it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Decision {
    /// Proved exact beforehand, so that it has to be right.
    Accepted,
    /// Refused before anything was computed; what the row reports was computed all the same.
    Refused,
}

/// The verdict of a row on the promises that it backs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Promises nothing.
    Information,
    /// As promised.
    Kept,
    /// Not as promised.
    Broken,
}

impl Verdict {
    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Information => "information",
            Self::Kept => "kept",
            Self::Broken => "broken",
        }
    }

    /// Kept if it is so.
    pub(super) fn kept_if(is_so: bool) -> Self {
        if is_so { Self::Kept } else { Self::Broken }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

/// One test and its outcome; fields that do not apply are absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Its name: `grid/u32-scan/256/4096/spike`.
    pub id: String,
    /// The promises that it backs, by their ids.
    pub promises: Vec<String>,
    /// The verdict on them.
    pub verdict: Verdict,
    /// The number in which sums were kept.
    pub number: Option<String>,
    /// Columns and rows of the map.
    pub side: Option<u32>,
    /// Photons a pixel on average, but for a spike.
    pub density: Option<f64>,
    /// How the photons lie.
    pub shape: Option<String>,
    /// n.
    pub min_photons: Option<u32>,
    /// Photons in the map, or what was summed.
    pub total: Option<u64>,
    /// Whether the program would compute it.
    pub decision: Option<Decision>,
    /// Pixels, decisions or maps that are wrong, and how many there are.
    pub wrong: Option<u64>,
    /// How many there are.
    pub of: Option<u64>,
    /// The largest error: of a radius in pixels, or of a sum relative to it.
    pub largest_error: Option<f64>,
    /// A note for the reader.
    pub note: String,
}

impl Row {
    /// A row with nothing but its name.
    pub(super) fn new(id: impl Into<String>, promises: &[&str], verdict: Verdict) -> Self {
        Self {
            id: id.into(),
            promises: promises.iter().map(|&id| id.to_owned()).collect(),
            verdict,
            number: None,
            side: None,
            density: None,
            shape: None,
            min_photons: None,
            total: None,
            decision: None,
            wrong: None,
            of: None,
            largest_error: None,
            note: String::new(),
        }
    }

    /// The wrong ones among all, from 0 to 1.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "a share is rounded anyway")]
    pub fn wrong_share(&self) -> Option<f64> {
        Some(self.wrong? as f64 / self.of?.max(1) as f64)
    }
}
