//! The metrics of the study, and the settings that are best by each.

use serde::{Deserialize, Serialize};

use super::{PictureRow, Width};
use crate::confidence::Confidence;
use crate::picture::PictureError;

/// One number of a [`PictureError`], so that less is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Metric {
    /// Root mean squared error of indirect light.
    Rmse,
    /// Relative mean squared error of indirect light.
    RelativeMse,
    /// 1 - SSIM of the whole picture.
    Dissimilarity,
    /// FLIP of the whole picture.
    Flip,
}

impl Metric {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Rmse, Self::RelativeMse, Self::Dissimilarity, Self::Flip];

    /// Its name, to show.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rmse => "RMSE",
            Self::RelativeMse => "relative MSE",
            Self::Dissimilarity => "1 - SSIM",
            Self::Flip => "FLIP",
        }
    }

    /// The number, 0 for the reference itself.
    #[must_use]
    pub fn of(self, error: &PictureError) -> f64 {
        match self {
            Self::Rmse => error.rmse,
            Self::RelativeMse => error.relative_mse,
            Self::Dissimilarity => 1.0 - error.ssim,
            Self::Flip => error.flip,
        }
    }
}

/// One width among those tried, and its error over the seeds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chosen {
    /// n, or the radius.
    pub width: Width,
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
        rows.sort_by_key(|row| (row.width, row.seed));
        Self { rows }
    }

    /// The rows of one width, by seed.
    pub(super) fn of(&self, width: Width) -> Vec<&'a PictureRow> {
        self.rows.iter().copied().filter(|row| row.width == width).collect()
    }

    /// Errors of one width, by seed.
    pub(super) fn errors(&self, width: Width, metric: Metric) -> Vec<f64> {
        self.of(width).iter().map(|row| metric.of(&row.error)).collect()
    }

    /// The widths, without repetition, of those that `wanted` lets pass.
    fn widths(&self, wanted: impl Fn(Width) -> bool) -> Vec<Width> {
        let mut widths: Vec<_> =
            self.rows.iter().map(|row| row.width).filter(|&width| wanted(width)).collect();
        widths.dedup();
        widths
    }

    /// The smallest and the largest variable or fixed width; nothing if there is none.
    pub(super) fn ends(&self, is_fixed: bool) -> Option<(Width, Width)> {
        let widths = self.widths(|width| width.is_fixed() == is_fixed);
        Some((*widths.first()?, *widths.last()?))
    }

    /// The variable or fixed width with the least mean error over the seeds; nothing if there is none.
    pub(super) fn best(&self, metric: Metric, is_fixed: bool) -> Option<Chosen> {
        let widths = self.widths(|width| width.is_fixed() == is_fixed);
        let errors = widths
            .iter()
            .enumerate()
            .filter_map(|(place, &width)| Some((place, Confidence::of(&self.errors(width, metric))?)));
        let (place, error) = errors.min_by(|(_, a), (_, b)| a.mean.total_cmp(&b.mean))?;
        let at_end = (place == 0 && !widths[0].is_least()) || place + 1 == widths.len();
        Some(Chosen { width: widths[place], error, at_end })
    }

    /// One variable width, if it was tried.
    pub(super) fn variable(&self, metric: Metric, min_photons: u32) -> Option<Chosen> {
        let width = Width::Variable { min_photons };
        let error = Confidence::of(&self.errors(width, metric))?;
        Some(Chosen { width, error, at_end: false })
    }
}
