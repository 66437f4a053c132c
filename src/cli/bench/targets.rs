//! Which targets of a suite hold.

use anyhow::Result;
use varikernel::measure::bench::Target;

use super::table::{align_right, new_table, three_digits};
use crate::cli::output;

/// A row for each target; nothing without any.
pub(super) fn print(targets: &[Target]) -> Result<()> {
    if targets.is_empty() {
        return Ok(());
    }
    let mut table = new_table(&["target", "what", "measured", "bound", "verdict"]);
    align_right(&mut table, 2..=3);
    for target in targets {
        table.add_row([
            target.name.clone(),
            target.what.clone(),
            target.measured.map_or_else(String::new, three_digits),
            format!("{} {} {}", target.side, target.bound, target.unit),
            verdict(target).to_owned(),
        ]);
    }
    output::print("\ntargets: ratios of the medians above")?;
    output::print(&table.trim_fmt())?;
    let count = |wanted| targets.iter().filter(|target| verdict(target) == wanted).count();
    let mut summary = format!("{} of {} targets hold, {} FAIL", count(HOLDS), targets.len(), count(FAILS));
    if count(NOT_MEASURED) > 0 {
        summary += &format!(", {} were not measured", count(NOT_MEASURED));
    }
    output::print(&summary)
}

const HOLDS: &str = "holds";
const FAILS: &str = "FAILS";
const NOT_MEASURED: &str = "no measure";

fn verdict(target: &Target) -> &'static str {
    match target.measured {
        None => NOT_MEASURED,
        Some(_) if target.holds => HOLDS,
        Some(_) => FAILS,
    }
}
