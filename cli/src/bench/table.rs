//! Results of timing runs as text, within 80 columns.

use std::path::Path;
use std::time::Duration;

use anyhow::Result;
use varikernel_lab::bench::{Case, Device, Report, Run, Verdict, compare};

use super::cells::{align_right, new_table, order, three_digits};
use super::rivals;
use crate::output;

/// A quiet machine's quartiles lie closer together than this part of the median.
const QUIET: f64 = 0.2;
/// What the rows of situations are.
const SITUATIONS: &str = "\
empty to added: frames of a table by a scan, without photons (declared by the\n\
host, or not), with those of a quarter, unchanged, after an edit of 64 x 64\n\
pixels in the middle or the lower left corner, with photons in addition;\n\
none-masked, half-masked: searches with a mask.";

/// A run for each section (map, size, question), fastest first within each stage; notes on noise and errors
/// follow.
pub(super) fn print_report(report: &Report, json: Option<&Path>) -> Result<()> {
    let protocol = report.settings.protocol;
    let mut facts = device_facts(&report.device);
    facts.push((
        "protocol",
        format!(
            "{} sets of up to {} samples, within {}",
            protocol.sets,
            protocol.iterations,
            humantime::format_duration(Duration::from_secs_f64(protocol.budget_s))
        ),
    ));
    output::print_facts(&facts)?;
    for section in sections(report.runs.iter().map(|run| &run.case)) {
        let mut runs: Vec<&Run> = report.runs.iter().filter(|run| heading(&run.case) == section).collect();
        runs.sort_by(|a, b| {
            let key = |run: &Run| (run.case.stage, run.is_wrong());
            key(a).cmp(&key(b)).then(a.statistics.median_ms.total_cmp(&b.statistics.median_ms))
        });
        let mut table =
            new_table(&["stage", "variant", "search", "ms", "spread", "copies", "samples", "answer"]);
        align_right(&mut table, 3..=6);
        for run in &runs {
            table.add_row(row(run));
        }
        output::print(&format!("\n{section}"))?;
        output::print(&table.trim_fmt())?;
        for line in rivals::against_the_renderer(&runs) {
            output::print(&line)?;
        }
    }
    output::print(
        "\nFastest first in each stage. ms: median GPU time. spread: distance of the\n\
         quartiles in parts of the median. copies: ms over those of the copy of the same\n\
         map. answer: whether every radius is the definition's, or how many are not.",
    )?;
    if report.runs.iter().any(|run| run.case.situation().is_some()) {
        output::print(SITUATIONS)?;
    }
    if report.runs.iter().any(|run| run.case.rival().is_some()) {
        output::print(rivals::LEGEND)?;
    }
    print_warnings(report)?;
    if let Some(path) = json {
        output::print(&format!("every sample: {}", path.display()))?;
    }
    Ok(())
}

fn row(run: &Run) -> [String; 8] {
    let all = &run.statistics;
    let suspect = if run.suspect.is_empty() { "" } else { "!" };
    [
        run.case.stage.name().to_owned(),
        variant(&run.case),
        order(&run.case).to_owned(),
        three_digits(all.median_ms),
        if all.count > 1 {
            format!("{:.0} %", 100.0 * all.spread_ms() / all.median_ms)
        } else {
            String::new()
        },
        run.copies.map_or_else(String::new, three_digits),
        format!("{suspect}{}", all.count),
        answer(run),
    ]
}

/// Of a situation, its name alone: the variant is the same for all.
fn variant(case: &Case) -> String {
    match case.situation() {
        Some(_) => case.variant.trim_start_matches("sat-scan-").to_owned(),
        None => rivals::marked(case),
    }
}

fn answer(run: &Run) -> String {
    let [width, height] = run.case.size;
    #[expect(clippy::cast_precision_loss, reason = "a share is rounded anyway")]
    let share = 100.0 * run.wrong_pixels as f64 / (f64::from(width) * f64::from(height));
    if run.is_wrong() {
        "WRONG".to_owned()
    } else if run.wrong_pixels > 0 {
        format!("{share:.1} % off")
    } else {
        "exact".to_owned()
    }
}

/// Notes on how far the numbers can be trusted.
fn print_warnings(report: &Report) -> Result<()> {
    for run in report.runs.iter().filter(|run| run.is_wrong()) {
        output::print(&format!(
            "WRONG: {}: {} pixels differ from the definition; not ranked",
            run.case, run.wrong_pixels
        ))?;
    }
    let suspect: usize = report.runs.iter().map(|run| run.suspect.len()).sum();
    if suspect > 0 {
        let samples: usize = report.runs.iter().map(|run| run.samples_ms.len()).sum();
        let cause = if report.device.software {
            ": something else took the processor"
        } else {
            ", which should not happen; these rows are less reliable"
        };
        output::print(&format!(
            "!: has some of the {suspect} in {samples} samples in which query and clock contradict each\n\
             other{cause}"
        ))?;
    }
    let repeated = report.runs.iter().filter(|run| run.statistics.count > 1);
    let noisy = |run: &&Run| run.statistics.spread_ms() > QUIET * run.statistics.median_ms;
    let (noisy, repeated) = (repeated.clone().filter(noisy).count(), repeated.count());
    if 4 * noisy > repeated {
        output::print(&format!(
            "noisy: {noisy} of {repeated} rows spread by more than {:.0} %;\n\
             repeat this when nothing else runs",
            100.0 * QUIET
        ))?;
    }
    // A whole map that was left out is one line.
    let mut lines: Vec<(String, String, Vec<&Case>)> = Vec::new();
    for left_out in &report.left_out {
        let map = map_name(&left_out.case);
        match lines.iter_mut().find(|(known, reason, _)| *known == map && *reason == left_out.reason) {
            Some((_, _, cases)) => cases.push(&left_out.case),
            None => lines.push((map, left_out.reason.clone(), vec![&left_out.case])),
        }
    }
    let rows: Vec<_> = lines
        .into_iter()
        .map(|(map, reason, cases)| {
            let what = match cases.as_slice() {
                [case] => case.to_string(),
                cases => {
                    let mut names: Vec<&str> = cases.iter().map(|case| case.variant.as_str()).collect();
                    names.sort_unstable();
                    names.dedup();
                    format!("{} cases of {map} ({})", cases.len(), names.join(", "))
                }
            };
            ["left out".to_owned(), format!("{what}: {reason}")]
        })
        .collect();
    if rows.is_empty() { Ok(()) } else { output::print_rows(&rows) }
}

/// Ratios of two runs with a verdict each.
pub(super) fn print_comparison(old: &Report, new: &Report) -> Result<()> {
    let comparison = compare(old, new);
    if old.device == new.device {
        output::print_facts(&device_facts(&new.device))?;
    } else {
        output::print("two devices: the ratios compare them as well, not the program alone")?;
        for (name, report) in [("old", old), ("new", new)] {
            output::print(&format!("{name}: {} ({})", report.device.renderer, report.device.driver))?;
        }
    }
    for section in sections(comparison.both.iter().map(|compared| &compared.case)) {
        let mut table = new_table(&["stage", "variant", "search", "old ms", "new ms", "new/old", "verdict"]);
        align_right(&mut table, 3..=5);
        for compared in comparison.both.iter().filter(|compared| heading(&compared.case) == section) {
            table.add_row([
                compared.case.stage.name(),
                &compared.case.variant,
                order(&compared.case),
                &three_digits(compared.old_ms),
                &three_digits(compared.new_ms),
                &format!("{:.3}", compared.ratio),
                verdict(compared.verdict),
            ]);
        }
        output::print(&format!("\n{section}"))?;
        output::print(&table.trim_fmt())?;
    }
    output::print(
        "\nfaster, slower: every set's median of one lies beyond every one of the other,\n\
         and the medians differ by 3 % or more; for that, each needs 4 sets.",
    )?;
    for (name, cases) in [("old", &comparison.only_old), ("new", &comparison.only_new)] {
        if !cases.is_empty() {
            output::print(&format!("{} cases are in the {name} file only", cases.len()))?;
        }
    }
    Ok(())
}

fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Faster => "faster",
        Verdict::Slower => "slower",
        Verdict::NoDifference => "no difference",
        Verdict::TooFewSets => "too few sets",
        Verdict::Wrong => "WRONG answer",
    }
}

pub(super) fn device_facts(device: &Device) -> Vec<(&'static str, String)> {
    vec![
        ("renderer", device.renderer.clone()),
        ("driver", device.driver.clone()),
        ("processor", format!("{}, {} threads", device.processor, device.threads)),
    ]
}

/// The headings, each once, in the order of the cases.
fn sections<'a>(cases: impl Iterator<Item = &'a Case>) -> Vec<String> {
    let mut sections: Vec<String> = Vec::new();
    for section in cases.map(heading) {
        if !sections.contains(&section) {
            sections.push(section);
        }
    }
    sections
}

/// What the rows of a table have in common.
fn heading(case: &Case) -> String {
    let map = map_name(case);
    match (case.min_photons, case.max_radius, case.edges) {
        (Some(n), Some(radius), Some(edges)) => {
            format!("{map}: n {n}, MR {radius}, edges {}", edges.name())
        }
        _ => map,
    }
}

fn map_name(case: &Case) -> String {
    let [width, height] = case.size;
    format!("{} {width} x {height}", case.map)
}
