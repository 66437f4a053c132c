//! Whether one run was faster than another, given the noise of both.
//!
//! Consecutive samples are correlated (clock rates, other programs), so that thousands of them within a
//! second prove little. Sets are taken at different times, so that they show this. The rule:
//!
//! - fewer than 4 sets on either side: *too few sets*, no verdict;
//! - *faster* or *slower* if every set's median of one side lies beyond every one of the other, and the
//!   medians of all samples differ by at least 3 %. For two runs alike, 4 sets against 4 lie so by chance in
//!   1 of 35 cases, 5 against 5 in 1 of 126;
//! - *no difference* otherwise: none that these two runs could show.

use super::case::Case;
use super::report::{Report, Run};

/// The least number of sets that a verdict needs.
const SETS: usize = 4;
/// The least ratio that counts as a difference: two starts of one program on one machine differ by about this
/// much.
const MARGIN: f64 = 1.03;

/// The verdict on a new time against an old one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The new one is faster.
    Faster,
    /// The new one is slower.
    Slower,
    /// None that these samples show.
    NoDifference,
    /// Fewer than 4 sets on a side.
    TooFewSets,
    /// An exact method gave a wrong answer, old or new.
    Wrong,
}

/// A case that both runs have.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedRun {
    /// The case.
    pub case: Case,
    /// The old median, in milliseconds.
    pub old_ms: f64,
    /// The new median, in milliseconds.
    pub new_ms: f64,
    /// New over old: below 1 is faster.
    pub ratio: f64,
    /// New over old, each in copies of its own run, where both have them.
    pub copies_ratio: Option<f64>,
    /// The verdict.
    pub verdict: Verdict,
}

/// Two runs, case by case.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Cases that both have, in the order of the new run.
    pub both: Vec<ComparedRun>,
    /// Cases of the old run alone.
    pub only_old: Vec<Case>,
    /// Cases of the new run alone.
    pub only_new: Vec<Case>,
}

/// Compares `new` with `old`.
#[must_use]
pub fn compare(old: &Report, new: &Report) -> Comparison {
    let mut comparison = Comparison { both: Vec::new(), only_old: Vec::new(), only_new: Vec::new() };
    for run in &new.runs {
        match old.run(&run.case) {
            Some(before) => comparison.both.push(ComparedRun {
                case: run.case.clone(),
                old_ms: before.statistics.median_ms,
                new_ms: run.statistics.median_ms,
                ratio: run.statistics.median_ms / before.statistics.median_ms,
                copies_ratio: run.copies.zip(before.copies).map(|(new, old)| new / old),
                verdict: verdict(before, run),
            }),
            None => comparison.only_new.push(run.case.clone()),
        }
    }
    let gone = old.runs.iter().filter(|run| new.run(&run.case).is_none());
    comparison.only_old.extend(gone.map(|run| run.case.clone()));
    comparison
}

fn verdict(old: &Run, new: &Run) -> Verdict {
    if old.is_wrong() || new.is_wrong() {
        return Verdict::Wrong;
    }
    if old.sets.len().min(new.sets.len()) < SETS {
        return Verdict::TooFewSets;
    }
    let medians = |run: &Run| run.sets.iter().map(|set| set.median_ms).collect::<Vec<_>>();
    let (old_sets, new_sets) = (medians(old), medians(new));
    let below = |a: &[f64], b: &[f64]| a.iter().all(|a| b.iter().all(|b| a < b));
    let (old_ms, new_ms) = (old.statistics.median_ms, new.statistics.median_ms);
    if below(&new_sets, &old_sets) && new_ms * MARGIN <= old_ms {
        Verdict::Faster
    } else if below(&old_sets, &new_sets) && old_ms * MARGIN <= new_ms {
        Verdict::Slower
    } else {
        Verdict::NoDifference
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::super::case::Stage;
    use super::*;
    use varikernel::gl::Sample;
    use varikernel::settings::Method;

    /// A run with one sample a set, in microseconds.
    fn run(sets_us: &[u64]) -> Run {
        let case = Case {
            stage: Stage::Frame,
            variant: "sat-doubling-4".to_owned(),
            map: "m".to_owned(),
            size: [4, 4],
            method: Some(Method::SummedAreaTable),
            sat_samples: None,
            search: None,
            min_photons: None,
            max_radius: None,
            edges: None,
        };
        let set = |&microseconds: &u64| {
            let time = Duration::from_micros(microseconds);
            [Sample { query: time, wall: time }]
        };
        let mut run = Run::new(case, &set(&sets_us[0]), true).unwrap();
        for microseconds in &sets_us[1..] {
            run.add_set(&set(microseconds), true);
        }
        run
    }

    #[test]
    fn verdicts_respect_the_noise() {
        let old = run(&[100, 101, 102, 103]);
        assert_eq!(verdict(&old, &run(&[90, 91, 92, 93])), Verdict::Faster);
        assert_eq!(verdict(&old, &run(&[110, 111, 112, 113])), Verdict::Slower);
        // One set of four overlaps.
        assert_eq!(verdict(&old, &run(&[90, 91, 92, 101])), Verdict::NoDifference);
        // Apart, but by less than 3 %.
        assert_eq!(verdict(&old, &run(&[104, 104, 104, 104])), Verdict::NoDifference);
        assert_eq!(verdict(&old, &run(&[50, 50, 50])), Verdict::TooFewSets);
    }

    #[test]
    fn a_wrong_answer_is_compared_with_nothing() {
        let mut wrong = run(&[10, 10, 10, 10]);
        wrong.wrong_pixels = 1;
        assert_eq!(verdict(&run(&[100, 101, 102, 103]), &wrong), Verdict::Wrong);
        // An approximate method may differ.
        wrong.case.method = Some(Method::AveragedMipmap);
        assert_eq!(verdict(&run(&[100, 101, 102, 103]), &wrong), Verdict::Faster);
    }
}
