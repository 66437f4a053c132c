//! What this program says of a claim.

use std::fmt;

/// What became of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// It holds in everything that was looked at.
    Confirmed,
    /// It does not hold.
    Refuted,
    /// It holds in the part that the note names, and not in the rest.
    HoldsHereOnly,
    /// It was not looked at; the note says why.
    CannotBeTested,
}

impl Verdict {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Confirmed, Self::HoldsHereOnly, Self::Refuted, Self::CannotBeTested];
}

impl fmt::Display for Verdict {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Confirmed => "confirmed",
            Self::Refuted => "refuted",
            Self::HoldsHereOnly => "holds here only",
            Self::CannotBeTested => "cannot be tested",
        })
    }
}

/// Our answer to a claim.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// The verdict.
    pub verdict: Verdict,
    /// Our figure; empty if there is none.
    pub ours: String,
    /// Conditions, reasons, where it holds.
    pub note: String,
}

impl Judgement {
    pub(super) fn new(verdict: Verdict, ours: impl Into<String>, note: impl Into<String>) -> Self {
        Self { verdict, ours: ours.into(), note: note.into() }
    }

    pub(super) fn confirmed_if(holds: bool, ours: impl Into<String>, note: impl Into<String>) -> Self {
        Self::new(if holds { Verdict::Confirmed } else { Verdict::Refuted }, ours, note)
    }

    /// By how many of the looked-at cases hold.
    pub(super) fn by_cases(cases: &[bool], ours: impl Into<String>, note: impl Into<String>) -> Self {
        let verdict = match cases.iter().filter(|&&holds| holds).count() {
            _ if cases.is_empty() => Verdict::CannotBeTested,
            0 => Verdict::Refuted,
            held if held == cases.len() => Verdict::Confirmed,
            _ => Verdict::HoldsHereOnly,
        };
        Self::new(verdict, ours, note)
    }

    pub(super) fn untested(why: impl Into<String>) -> Self {
        Self::new(Verdict::CannotBeTested, "", why)
    }

    pub(super) fn untimed() -> Self {
        Self::untested("not timed in this run")
    }
}
