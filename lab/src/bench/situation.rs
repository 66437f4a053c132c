//! Frames that need not do everything, as cases of a timing run.

use super::case::{Case, Stage};
use super::settings::MapInfo;
use varikernel::settings::Settings;

/// Work that a frame can leave out, or that follows it.
///
/// Each is a row of its own: a frame, a search or a proof by the table that is built by a scan, timed after
/// whatever has to be there before, and checked against the definition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Situation {
    /// A frame without photons, which the host declares.
    Empty,
    /// A frame without photons, of which the host declares only that there is 1 at most.
    EmptyUnknown,
    /// A frame with the photons of the lower left quarter of the map alone.
    Quarter,
    /// A search with a mask that needs every pixel.
    NoneMasked,
    /// A search with a mask that needs the right half of the pixels.
    HalfMasked,
    /// The same frame again, which the host declares.
    Unchanged,
    /// A frame after an edit of 64 x 64 pixels in the middle.
    TileChanged,
    /// A frame after an edit of the first 64 x 64 pixels, at the lower left, on which every later entry of a
    /// table depends.
    CornerChanged,
    /// A frame with photons in addition, 1 a pixel.
    Added,
    /// The proof of the radii that are there.
    Certify,
}

impl Situation {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Empty,
        Self::EmptyUnknown,
        Self::Quarter,
        Self::NoneMasked,
        Self::HalfMasked,
        Self::Unchanged,
        Self::TileChanged,
        Self::CornerChanged,
        Self::Added,
        Self::Certify,
    ];

    /// Its variant in tables and files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Empty => "sat-scan-empty",
            Self::EmptyUnknown => "sat-scan-empty-unknown",
            Self::Quarter => "sat-scan-quarter",
            Self::NoneMasked => "sat-scan-none-masked",
            Self::HalfMasked => "sat-scan-half-masked",
            Self::Unchanged => "sat-scan-unchanged",
            Self::TileChanged => "sat-scan-tile-changed",
            Self::CornerChanged => "sat-scan-corner-changed",
            Self::Added => "sat-scan-added",
            Self::Certify => "certify",
        }
    }

    /// Whether its pipeline takes masks.
    pub(super) fn is_masked(self) -> bool {
        matches!(self, Self::NoneMasked | Self::HalfMasked)
    }

    fn stage(self) -> Stage {
        match self {
            Self::NoneMasked | Self::HalfMasked => Stage::Search,
            Self::Certify => Stage::Certify,
            _ => Stage::Frame,
        }
    }
}

impl Case {
    /// A situation of a pipeline of `settings`.
    pub(super) fn of_situation(situation: Situation, settings: &Settings, map: &MapInfo) -> Self {
        Self {
            variant: situation.name().to_owned(),
            ..Self::of(situation.stage(), settings, settings.storage, map)
        }
    }

    /// The situation that was timed, if it was not a whole frame or a part of one.
    #[must_use]
    pub fn situation(&self) -> Option<Situation> {
        Situation::ALL.into_iter().find(|situation| self.variant == situation.name())
    }
}
