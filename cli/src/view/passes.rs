//! The passes of a step, grouped into stages.

use std::time::Duration;

/// What the labels of passes of light from tables begin with.
const TABLES: [&str; 11] = [
    "logarithms of areas",
    "sum of logarithms",
    "areas of pixels",
    "neighbours on a face",
    "longer extents",
    "extents on curves",
    "light",
    "flux",
    "test of noise",
    "smooth light",
    "widths",
];
/// Stages, each with how the labels of its passes begin; what is not there is part of [`RADII`], whose passes
/// are many.
const STAGES: [(&str, &[&str]); 6] = [
    ("surfaces", &["surfaces"]),
    ("density", &["density", "coarser"]),
    ("radii", &[]),
    ("kernels", &["splat", "gather"]),
    ("tables", &TABLES),
    ("shading", &["shade"]),
];
/// The place of the radii.
const RADII: usize = 2;

/// The time of each stage that has passes, in the order above.
pub(super) fn grouped<'a>(
    passes: impl Iterator<Item = (&'a str, Duration)>,
) -> impl Iterator<Item = (&'static str, Duration)> {
    let mut times = [None; STAGES.len()];
    for (label, time) in passes {
        let is_of = |(_, starts): &(&str, &[&str])| starts.iter().any(|start| label.starts_with(start));
        let stage = STAGES.iter().position(is_of).unwrap_or(RADII);
        *times[stage].get_or_insert(Duration::ZERO) += time;
    }
    STAGES.into_iter().zip(times).filter_map(|((stage, _), time)| Some((stage, time?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_are_added_up_by_stage() {
        let passes = [
            ("splat spread", 3),
            ("density", 1),
            ("splat covered", 4),
            ("sat tiles", 2),
            ("radius blocks", 5),
        ];
        assert_eq!(seconds(&passes), [("density", 1), ("radii", 7), ("kernels", 7)]);
        let of_tables = [
            ("coarser units", 1),
            ("sum of logarithms", 2),
            ("light table run sums", 3),
            ("test of noise, wide", 4),
            ("light from tables", 5),
            ("shade", 6),
        ];
        assert_eq!(seconds(&of_tables), [("density", 1), ("tables", 14), ("shading", 6)]);
    }

    fn seconds(passes: &[(&'static str, u64)]) -> Vec<(&'static str, u64)> {
        let passes = passes.iter().map(|&(label, seconds)| (label, Duration::from_secs(seconds)));
        grouped(passes).map(|(stage, time)| (stage, time.as_secs())).collect()
    }
}
