//! The numbers in which sums are kept, and what the documentation promises of each.

use serde::{Deserialize, Serialize};

use varikernel::settings::{Laboratory, Order, SatBuild, SatSamples, Search, Settings, Storage};

/// In what sums are kept, and how they come about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Number {
    /// The default: u32, a scan, a bracketed search.
    U32Scan,
    /// u32 by doubling, 4 samples.
    U32Doubling,
    /// u16 by a scan.
    U16,
    /// f32 as the thesis, 2 samples.
    F32Doubling2,
    /// The same with 4.
    F32Doubling4,
    /// The same with 8.
    F32Doubling8,
    /// f32 of counts that were clamped to n before.
    F32Clamped,
    /// f32 less the mean.
    F32MinusMean,
    /// f32 less the mean rounded to a whole number.
    F32MinusWholeMean,
    /// f16.
    F16,
}

impl Number {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::U32Scan,
        Self::U32Doubling,
        Self::U16,
        Self::F32Doubling2,
        Self::F32Doubling4,
        Self::F32Doubling8,
        Self::F32Clamped,
        Self::F32MinusMean,
        Self::F32MinusWholeMean,
        Self::F16,
    ];
    /// Those that large maps are for.
    pub(super) const FEW: [Self; 5] =
        [Self::U32Scan, Self::U32Doubling, Self::F32Doubling4, Self::F32Clamped, Self::F32MinusWholeMean];

    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::U32Scan => "u32-scan",
            Self::U32Doubling => "u32-doubling-4",
            Self::U16 => "u16-scan",
            Self::F32Doubling2 => "f32-doubling-2",
            Self::F32Doubling4 => "f32-doubling-4",
            Self::F32Doubling8 => "f32-doubling-8",
            Self::F32Clamped => "f32-clamped",
            Self::F32MinusMean => "f32-minus-mean",
            Self::F32MinusWholeMean => "f32-minus-whole-mean",
            Self::F16 => "f16",
        }
    }

    pub(super) fn settings(self, search: Search) -> Settings {
        let usual = Settings { search, ..Settings::default() };
        let float = |storage, sat_samples| Settings {
            storage,
            laboratory: Laboratory { sat_samples, sat_build: SatBuild::Doubling, ..usual.laboratory },
            ..usual
        };
        match self {
            Self::U32Scan => Settings { search: Search { order: Order::Bracketed, ..search }, ..usual },
            Self::U32Doubling => float(Storage::U32, SatSamples::Four),
            Self::U16 => Settings { storage: Storage::U16, ..usual },
            Self::F32Doubling2 => float(Storage::F32, SatSamples::Two),
            Self::F32Doubling4 | Self::F32Clamped => float(Storage::F32, SatSamples::Four),
            Self::F32Doubling8 => float(Storage::F32, SatSamples::Eight),
            Self::F32MinusMean => float(Storage::F32MinusMean, SatSamples::Four),
            Self::F32MinusWholeMean => float(Storage::F32MinusWholeMean, SatSamples::Four),
            Self::F16 => float(Storage::F16, SatSamples::Four),
        }
    }

    /// The promises that an accepted row of so many photons backs.
    pub(super) fn promises(self, total: u64, clamped: bool, wide: bool) -> Vec<&'static str> {
        let mut promises = vec!["accepted-is-exact"];
        promises.extend(match self {
            Self::U32Scan => Some("default-is-exact"),
            Self::F32Doubling2 | Self::F32Doubling4 | Self::F32Doubling8 => Some("f32-total"),
            Self::F16 => Some("f16-total"),
            Self::F32Clamped => Some("clamped-counts"),
            Self::U32Doubling | Self::U16 | Self::F32MinusMean | Self::F32MinusWholeMean => None,
        });
        match self {
            Self::U32Scan | Self::U32Doubling if total >= 1 << 32 && !clamped => promises.push("u32-wraps"),
            Self::U16 if total >= 1 << 16 && !clamped => promises.push("u16-wraps"),
            _ => (),
        }
        if clamped {
            promises.push("clamped-counts");
        }
        if wide {
            promises.push("wide-products");
        }
        promises
    }
}
