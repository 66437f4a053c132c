//! Every other way against the best fixed radius, with the same photons.

use serde::{Deserialize, Serialize};

use super::metric::Sweep;
use super::{Chosen, Family, Metric, PictureRow, Way};
use crate::confidence::RatioInterval;
use varikernel::settings::{Kernel, PictureSettings};

/// Who is better on these seeds: the interval of 95 % decides. The widths were chosen on the same seeds, so
/// that it describes the rows and is too narrow for others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Winner {
    /// What each pixel or photon chose a width for: variable radii, or tables.
    Variable,
    /// The fixed radius.
    Fixed,
    /// The seeds do not decide.
    Undecided,
}

impl Winner {
    /// By the ratio of the other error over the fixed one.
    #[must_use]
    pub fn by(ratio: &RatioInterval) -> Self {
        if ratio.is_below_one() {
            Self::Variable
        } else if ratio.is_above_one() {
            Self::Fixed
        } else {
            Self::Undecided
        }
    }
}

/// One way against the best fixed radius.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The way, and its error.
    pub chosen: Chosen,
    /// Its error over that of the fixed radius, paired by seed.
    pub ratio: RatioInterval,
    /// Who is better.
    pub winner: Winner,
}

/// The other ways against the best fixed radius, from the same photons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EqualPhotons {
    /// The scene's name.
    pub scene: String,
    /// Photons that left the lights.
    pub photons: u32,
    /// The falloff of both.
    pub kernel: Kernel,
    /// What is compared.
    pub metric: Metric,
    /// The fixed radius with the least mean error.
    pub fixed: Chosen,
    /// The n with the least mean error: chosen knowing the answer, as the fixed radius is.
    pub best: Comparison,
    /// The program's default n, which is chosen without the answer; if it was tried.
    pub default: Option<Comparison>,
    /// A gather with that n; if it was tried.
    pub gather: Option<Comparison>,
    /// Light from tables, where nothing is chosen; if it was tried.
    pub tables: Option<Comparison>,
    /// The error of tables over that of the default n, paired by seed.
    pub tables_over_default: Option<RatioInterval>,
}

/// Compares, for each scene, number of photons and kernel among `rows`, and each metric. What lacks fixed or
/// variable rows is left out.
#[must_use]
pub fn equal_photons(rows: &[PictureRow]) -> Vec<EqualPhotons> {
    let mut found = Vec::new();
    for (scene, photons, kernel) in distinct(rows, |row| (row.scene.as_str(), row.photons, row.kernel)) {
        let sweep = Sweep::new(
            rows.iter()
                .filter(|row| (row.scene.as_str(), row.photons, row.kernel) == (scene, photons, kernel)),
        );
        for metric in Metric::ALL {
            let Some(fixed) = sweep.best(metric, Family::Fixed) else { continue };
            let compare = |chosen: Chosen| {
                let ratio = RatioInterval::of(&paired(&sweep, metric, chosen.way, fixed.way))?;
                Some(Comparison { chosen, ratio, winner: Winner::by(&ratio) })
            };
            let Some(best) = sweep.best(metric, Family::Variable).and_then(compare) else { continue };
            let min_photons = PictureSettings::default().min_photons;
            let usual = Way::Variable { min_photons };
            found.push(EqualPhotons {
                scene: scene.to_owned(),
                photons,
                kernel,
                metric,
                fixed,
                best,
                default: sweep.one(metric, usual).and_then(compare),
                gather: sweep.one(metric, Way::Gather { min_photons }).and_then(compare),
                tables: sweep.one(metric, Way::Tables).and_then(compare),
                tables_over_default: RatioInterval::of(&paired(&sweep, metric, Way::Tables, usual)),
            });
        }
    }
    found
}

/// Errors of two ways for the seeds that both have.
fn paired(sweep: &Sweep<'_>, metric: Metric, first: Way, second: Way) -> Vec<(f64, f64)> {
    let second = sweep.of(second);
    let pair = |row: &PictureRow| {
        let other = second.iter().find(|other| other.seed == row.seed)?;
        Some((metric.of(row), metric.of(other)))
    };
    sweep.of(first).into_iter().filter_map(pair).collect()
}

/// What `key` says of the rows, without repetition, in their order.
pub(super) fn distinct<'a, K: PartialEq>(
    rows: &'a [PictureRow],
    key: impl Fn(&'a PictureRow) -> K,
) -> Vec<K> {
    let mut keys = Vec::new();
    for row in rows {
        let key = key(row);
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys
}
