//! Where a rival (baseline) on the processor beats the renderer, a line under each table.

use varikernel::settings::Method;
use varikernel_lab::bench::{Case, Run, Stage};

use super::cells::{order, three_digits};

/// What the mark means.
pub(super) const LEGEND: &str = "\
*: a rival on the processor, by the clock, from a map in memory to radii there.";

/// The variant of a row, with a mark if it is a rival.
pub(super) fn marked(case: &Case) -> String {
    let mark = if case.rival().is_some() { "*" } else { "" };
    format!("{}{mark}", case.variant)
}

/// A line for the renderer's best exact frame among `runs`, which share map and question, and one for each
/// rival; nothing if there are not both.
pub(super) fn against_the_renderer(runs: &[&Run]) -> Vec<String> {
    let is_whole = |case: &Case| case.stage == Stage::Frame && case.situation().is_none();
    let right = runs.iter().filter(|run| is_whole(&run.case) && !run.is_wrong());
    let milliseconds = |run: &Run| run.statistics.median_ms;
    let exact = right.clone().filter(|run| run.case.method.is_some_and(Method::is_exact));
    let Some(best) = exact.min_by(|a, b| milliseconds(a).total_cmp(&milliseconds(b))) else {
        return Vec::new();
    };
    let rivals = right.filter(|run| run.case.rival().is_some()).map(|run| {
        let ratio = milliseconds(best) / milliseconds(run);
        if ratio > 1.0 {
            format!("  {} beats it: {} times as fast", marked(&run.case), three_digits(ratio))
        } else {
            format!("  {} does not: {} times as long", marked(&run.case), three_digits(1.0 / ratio))
        }
    });
    let lines: Vec<String> = rivals.collect();
    if lines.is_empty() {
        return lines;
    }
    let frame = format!("{} {}", best.case.variant, order(&best.case));
    let head = format!("the renderer's best exact frame: {frame}, {} ms", three_digits(milliseconds(best)));
    std::iter::once(head).chain(lines).collect()
}
