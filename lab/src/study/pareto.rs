//! The Pareto front of time and error, and what to choose for which budget.

use std::cmp::Ordering;
use std::fmt::Write as _;

use serde::Serialize;

use super::radii::{Question, RadiusRow};
use super::variant::VariantName;

/// A way on all maps of a question together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Overall {
    /// The way.
    pub variant: VariantName,
    /// Geometric mean over the maps of a frame's time, in copies.
    pub copies: f64,
    /// Mean over the maps of the mean error, in pixels.
    pub mean_error: f64,
    /// The part of all maps' pixels whose radius is another.
    pub wrong_share: f64,
    /// Bytes of textures.
    pub memory_bytes: u64,
    /// Whether the library guarantees exact radii on every map.
    pub promised: bool,
    /// Whether no other way is both at most as slow and at most as wrong, and better in one of them.
    pub on_front: bool,
}

/// Every way that answered on all maps of a question, fastest first.
#[must_use]
pub fn overall(rows: &[RadiusRow], question: Question) -> Vec<Overall> {
    let rows: Vec<_> = rows.iter().filter(|row| row.question == question).collect();
    let mut maps: Vec<_> = rows.iter().map(|row| &row.map.name).collect();
    maps.sort_unstable();
    maps.dedup();
    let mut all: Vec<Overall> = Vec::new();
    for row in &rows {
        let variant = &row.variant;
        if all.iter().any(|known| known.variant == *variant) {
            continue;
        }
        let same: Vec<_> = rows.iter().filter(|row| row.variant == *variant).collect();
        if same.len() < maps.len() {
            continue;
        }
        #[expect(clippy::cast_precision_loss, reason = "a few maps")]
        let mean =
            |of: fn(&RadiusRow) -> f64| same.iter().map(|row| of(row)).sum::<f64>() / same.len() as f64;
        all.push(Overall {
            variant: variant.clone(),
            copies: mean(|row| row.copies.ln()).exp(),
            mean_error: mean(|row| row.error.mean),
            wrong_share: mean(|row| row.error.wrong_share),
            memory_bytes: row.memory_bytes,
            promised: same.iter().all(|row| row.promised),
            on_front: false,
        });
    }
    all.sort_by(|a, b| a.copies.total_cmp(&b.copies));
    // A result that happens to be exact ranks below one that is guaranteed to be.
    let points: Vec<_> = all.iter().map(|one| (one.copies, (one.mean_error, !one.promised))).collect();
    for index in front(&points) {
        all[index].on_front = true;
    }
    all
}

/// Places of the (cost, error) pairs that no other beats, cheapest first: no other costs at most as much and
/// is at most as wrong, and is better in one of both. Of equals, the first stands.
#[must_use]
pub fn front<E: PartialOrd + Copy>(points: &[(f64, E)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        let ((cost_a, error_a), (cost_b, error_b)) = (points[a], points[b]);
        let by_error = error_a.partial_cmp(&error_b).unwrap_or(Ordering::Equal);
        cost_a.total_cmp(&cost_b).then(by_error)
    });
    let mut least: Option<E> = None;
    order.retain(|&index| {
        let error = points[index].1;
        let better = least.is_none_or(|least| error < least);
        if better {
            least = Some(error);
        }
        better
    });
    order
}

/// What to choose for which budget, a sentence a step.
#[must_use]
pub fn advice(overall: &[Overall]) -> Vec<String> {
    let steps: Vec<_> = overall.iter().filter(|one| one.on_front).collect();
    let Some(first) = steps.first() else { return Vec::new() };
    let mut words = vec![format!("Below {:.1} copies a frame, nothing answers.", first.copies)];
    for step in &steps {
        let mut sentence = format!("From {:.1} copies on, take {}: ", step.copies, step.variant);
        if step.promised {
            sentence += "every radius is exact, on any map that is not refused.";
        } else if step.wrong_share == 0.0 {
            sentence += "every radius is exact on these maps, which nothing promises for others.";
        } else {
            write!(
                sentence,
                "radii are off by {:.2} pixels on the average, and {:.1} % of the pixels \
                 have another radius.",
                step.mean_error,
                100.0 * step.wrong_share
            )
            .expect("writing to a string");
        }
        words.push(sentence);
    }
    if steps.last().is_some_and(|last| last.promised) {
        words.push("More time than that buys nothing.".to_owned());
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::MapInfo;
    use crate::study::radii::RadiusError;

    #[test]
    fn the_front_by_hand() {
        // The second is slower and worse than the first; the fourth is slower than the third and no better.
        let points = [(2.0, 0.5), (3.0, 0.6), (4.0, 0.1), (5.0, 0.1), (1.0, 0.9), (9.0, 0.0)];
        assert_eq!(front(&points), [4, 0, 2, 5]);
        assert_eq!(front(&[(1.0, 0.0), (1.0, 0.0), (1.0, 0.5)]), [0]);
        assert_eq!(front::<f64>(&[]), [0; 0]);
        assert_eq!(front(&[(1.0, (0.0, true)), (2.0, (0.0, false)), (3.0, (0.0, false))]), [0, 1]);
    }

    fn row(map: &str, variant: &str, copies: f64, mean: f64) -> RadiusRow {
        let name = VariantName {
            method: variant.to_owned(),
            build: String::new(),
            storage: String::new(),
            search: String::new(),
            twist: String::new(),
        };
        RadiusRow {
            map: MapInfo { name: map.to_owned(), size: [4, 4], origin: String::new() },
            photons: 1,
            question: Question { side: 4, min_photons: 25, max_radius: 32 },
            variant: name,
            promised: variant == "exact",
            mean_radius: 1.0,
            error: RadiusError { wrong_share: mean / 2.0, mean, rms: mean, max: 1 },
            memory_bytes: 100,
            ms: copies,
            copies,
            samples: 1,
        }
    }

    #[test]
    fn maps_are_taken_together_and_what_lacks_one_is_left_out() {
        let mut rows =
            vec![row("a", "exact", 4.0, 0.0), row("b", "exact", 9.0, 0.0), row("a", "half", 3.0, 0.25)];
        rows.extend([row("b", "half", 3.0, 0.75), row("a", "slow", 20.0, 0.0), row("b", "slow", 20.0, 0.0)]);
        rows.push(row("a", "partly", 1.0, 0.0));
        let overall = overall(&rows, rows[0].question);
        let told: Vec<_> =
            overall.iter().map(|one| (one.variant.method.as_str(), one.copies, one.on_front)).collect();
        // √(4 · 9) = 6.
        assert_eq!((told[0].0, told[0].2), ("half", true));
        assert!(told[1].0 == "exact" && (told[1].1 - 6.0).abs() < 1e-12 && told[1].2);
        assert_eq!((told[2].0, told[2].2), ("slow", false));
        assert_eq!(told.len(), 3);
        assert_eq!((overall[0].mean_error, overall[0].wrong_share), (0.5, 0.25));
        assert_eq!(
            advice(&overall),
            [
                "Below 3.0 copies a frame, nothing answers.",
                "From 3.0 copies on, take half: radii are off by 0.50 pixels on the average, and 25.0 % of \
                 the pixels have another radius.",
                "From 6.0 copies on, take exact: every radius is exact, on any map that is not refused.",
                "More time than that buys nothing."
            ]
        );
        assert_eq!(advice(&[]), [""; 0]);
    }
}
