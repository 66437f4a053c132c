//! Variable against fixed radii with the same photons.

use serde::{Deserialize, Serialize};

use super::metric::Sweep;
use super::{Chosen, Metric, PictureRow, Width};
use crate::confidence::RatioInterval;
use varikernel::settings::{Kernel, PictureSettings};

/// Who is better on these seeds: the interval of 95 % decides. The widths were chosen on the same seeds, so
/// that it describes the rows and is too narrow for others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Winner {
    /// Variable radii.
    Variable,
    /// The fixed radius.
    Fixed,
    /// The seeds do not decide.
    Undecided,
}

impl Winner {
    /// By the ratio of the variable error over the fixed one.
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

/// One n against the best fixed radius.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// n, and its error.
    pub variable: Chosen,
    /// Variable error over fixed error, paired by seed.
    pub ratio: RatioInterval,
    /// Who is better.
    pub winner: Winner,
}

/// Variable radii against the best fixed one, from the same photons.
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
            let Some(fixed) = sweep.best(metric, true) else { continue };
            let compare = |variable: Chosen| {
                let ratio = RatioInterval::of(&paired(&sweep, metric, variable.width, fixed.width))?;
                Some(Comparison { variable, ratio, winner: Winner::by(&ratio) })
            };
            let Some(best) = sweep.best(metric, false).and_then(compare) else { continue };
            let default = sweep.variable(metric, PictureSettings::default().min_photons).and_then(compare);
            let scene = scene.to_owned();
            found.push(EqualPhotons { scene, photons, kernel, metric, fixed, best, default });
        }
    }
    found
}

/// Errors of two widths for the seeds that both have.
fn paired(sweep: &Sweep<'_>, metric: Metric, first: Width, second: Width) -> Vec<(f64, f64)> {
    let second = sweep.of(second);
    let pair = |row: &PictureRow| {
        let other = second.iter().find(|other| other.seed == row.seed)?;
        Some((metric.of(&row.error), metric.of(&other.error)))
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
