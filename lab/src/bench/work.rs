//! What a row of a timing run makes the machine do.

use super::situation::Situation;
use crate::rivals::Rival;
use varikernel::measure::Unit;
use varikernel::settings::{Search, Settings};

/// What a case runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Work {
    Unit(Unit),
    Pipeline(Settings),
    /// The frame of what the planner makes of the settings.
    Planned(Settings),
    Situation(Situation, Settings),
    Rival(Rival, Search),
}
