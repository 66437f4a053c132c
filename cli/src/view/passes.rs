//! The passes of a step, grouped into stages.

use std::time::Duration;

/// Stages, each with how the labels of its passes begin; what is not there is part of the radii, whose passes
/// are many.
const STAGES: [(&str, &[&str]); 5] = [
    ("surfaces", &["surfaces"]),
    ("density", &["density"]),
    ("radii", &[]),
    ("kernels", &["splat"]),
    ("shading", &["shade"]),
];

/// The time of each stage that has passes, in the order above.
pub(super) fn grouped<'a>(
    passes: impl Iterator<Item = (&'a str, Duration)>,
) -> impl Iterator<Item = (&'static str, Duration)> {
    let mut times = [None; STAGES.len()];
    for (label, time) in passes {
        let is_of = |(_, starts): &(&str, &[&str])| starts.iter().any(|start| label.starts_with(start));
        let stage = STAGES.iter().position(is_of).unwrap_or(2);
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
        let passes = passes.map(|(label, seconds)| (label, Duration::from_secs(seconds)));
        let found: Vec<_> =
            grouped(passes.into_iter()).map(|(stage, time)| (stage, time.as_secs())).collect();
        assert_eq!(found, [("density", 1), ("radii", 7), ("kernels", 7)]);
    }
}
