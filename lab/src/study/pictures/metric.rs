//! The metrics of the study, and the settings that are best by each.

use serde::{Deserialize, Serialize};

use super::{Family, PictureRow, Way};
use crate::confidence::Confidence;

/// One number of a [`PictureRow`], so that less is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Metric {
    /// Root mean squared error of indirect light, inside of faces.
    Rmse,
    /// Relative mean squared error of indirect light, inside of faces.
    RelativeMse,
    /// The first, over all pixels: edges of faces, mirrors and glass too.
    RmseOfAll,
    /// The second, over all pixels.
    RelativeMseOfAll,
    /// 1 - SSIM of the whole picture.
    Dissimilarity,
    /// FLIP of the whole picture.
    Flip,
}

impl Metric {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Rmse,
        Self::RelativeMse,
        Self::RmseOfAll,
        Self::RelativeMseOfAll,
        Self::Dissimilarity,
        Self::Flip,
    ];

    /// Its name, to show.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rmse => "RMSE",
            Self::RelativeMse => "relative MSE",
            Self::RmseOfAll => "RMSE, all pixels",
            Self::RelativeMseOfAll => "relative MSE, all pixels",
            Self::Dissimilarity => "1 - SSIM",
            Self::Flip => "FLIP",
        }
    }

    /// The number, 0 for the reference itself.
    #[must_use]
    pub fn of(self, row: &PictureRow) -> f64 {
        match self {
            Self::Rmse => row.inside.rmse,
            Self::RelativeMse => row.inside.relative_mse,
            Self::RmseOfAll => row.error.rmse,
            Self::RelativeMseOfAll => row.error.relative_mse,
            Self::Dissimilarity => 1.0 - row.error.ssim,
            Self::Flip => row.error.flip,
        }
    }
}

/// One way among those tried, and its error over the seeds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chosen {
    /// With its n or radius.
    pub way: Way,
    /// Its error by the metric of the comparison.
    pub error: Confidence,
    /// Whether a smaller or larger one that wasn't tried may be better.
    pub at_end: bool,
}

/// The rows of one scene, number of photons and kernel, by increasing width and then seed.
pub(super) struct Sweep<'a> {
    rows: Vec<&'a PictureRow>,
}

impl<'a> Sweep<'a> {
    pub(super) fn new(rows: impl Iterator<Item = &'a PictureRow>) -> Self {
        let mut rows: Vec<_> = rows.collect();
        rows.sort_by_key(|row| (row.way, row.seed));
        Self { rows }
    }

    /// The rows of one way, by seed.
    pub(super) fn of(&self, way: Way) -> Vec<&'a PictureRow> {
        self.rows.iter().copied().filter(|row| row.way == way).collect()
    }

    /// Errors of one way, by seed.
    pub(super) fn errors(&self, way: Way, metric: Metric) -> Vec<f64> {
        self.of(way).iter().map(|row| metric.of(row)).collect()
    }

    /// The ways of a family, without repetition.
    fn ways(&self, family: Family) -> Vec<Way> {
        let ways = self.rows.iter().map(|row| row.way);
        let mut ways: Vec<_> = ways.filter(|way| way.family() == family).collect();
        ways.dedup();
        ways
    }

    /// Whether a way has a row of the last seed that any has: the first seed alone draws what others needn't.
    pub(super) fn is_whole(&self, way: Way) -> bool {
        let most = self.rows.iter().map(|row| row.seed).max();
        most.is_some_and(|most| self.of(way).iter().any(|row| row.seed == most))
    }

    /// A way and those beside it that were tried.
    pub(super) fn around(&self, way: Way) -> Vec<Way> {
        let ways = self.ways(way.family());
        let Some(place) = ways.iter().position(|&tried| tried == way) else { return Vec::new() };
        ways[place.saturating_sub(1)..ways.len().min(place + 2)].to_vec()
    }

    /// The least and the widest way of a family; nothing if there is none.
    pub(super) fn ends(&self, family: Family) -> Option<(Way, Way)> {
        let ways = self.ways(family);
        Some((*ways.first()?, *ways.last()?))
    }

    /// The way of a family with the least mean error over all seeds; nothing if there is none.
    pub(super) fn best(&self, metric: Metric, family: Family) -> Option<Chosen> {
        let ways = self.ways(family);
        let errors = ways
            .iter()
            .enumerate()
            .filter(|(_, way)| self.is_whole(**way))
            .filter_map(|(place, &way)| Some((place, Confidence::of(&self.errors(way, metric))?)));
        let (place, error) = errors.min_by(|(_, a), (_, b)| a.mean.total_cmp(&b.mean))?;
        let is_swept = matches!(family, Family::Variable | Family::Fixed);
        let at_end = is_swept && ((place == 0 && !ways[0].is_least()) || place + 1 == ways.len());
        Some(Chosen { way: ways[place], error, at_end })
    }

    /// One way, if it was tried.
    pub(super) fn one(&self, metric: Metric, way: Way) -> Option<Chosen> {
        let error = Confidence::of(&self.errors(way, metric))?;
        Some(Chosen { way, error, at_end: false })
    }
}
