//! Which targets of a run hold.

use anyhow::Result;
use varikernel_lab::bench::Target;

use super::cells::{align_right, new_table, three_digits};
use crate::output;

/// How a bench's are.
pub(crate) const MEDIANS: &str = "ratios of the medians above";

/// A table for each kind of target, and how they are measured; nothing without any.
pub(crate) fn print(targets: &[Target], measured_as: &str) -> Result<()> {
    if targets.is_empty() {
        return Ok(());
    }
    output::print(&format!("\ntargets, as {measured_as}"))?;
    for kind in targets.chunk_by(|a, b| a.name == b.name) {
        let mut table = new_table(&["", "measured", "bound", "map", ""]);
        align_right(&mut table, 1..=2);
        for target in kind {
            table.add_row([
                verdict(target).to_owned(),
                target.measured.map_or_else(String::new, three_digits),
                format!("{} {}", target.side, target.bound),
                map(target),
                target.question.clone(),
            ]);
        }
        let Target { name, what, unit, .. } = &kind[0];
        output::print(&format!("\n{name}, in {unit}:\n{what}"))?;
        output::print(&table.trim_fmt())?;
    }
    let count = |wanted| targets.iter().filter(|target| verdict(target) == wanted).count();
    let missing = match count(NOT_MEASURED) {
        0 => String::new(),
        missing => format!(", {missing} were not measured"),
    };
    let (hold, fail) = (count(HOLDS), count(FAILS));
    output::print(&format!("\n{hold} of {} targets hold, {fail} FAIL{missing}", targets.len()))
}

const HOLDS: &str = "holds";
const FAILS: &str = "FAILS";
const NOT_MEASURED: &str = "not measured";

fn verdict(target: &Target) -> &'static str {
    match target.measured {
        None => NOT_MEASURED,
        Some(_) if target.holds => HOLDS,
        Some(_) => FAILS,
    }
}

fn map(target: &Target) -> String {
    let [width, height] = target.size;
    format!("{} {width} x {height}", target.map)
}
