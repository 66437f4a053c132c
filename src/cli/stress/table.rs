//! What a stress run found, for people: promises, numbers, renderers.

use anyhow::Result;
use varikernel::measure::stress::{Judged, Renderer, Report, Row, Verdict};

use super::super::output;

/// Broken rows that are listed; the files have all.
const LISTED: usize = 12;

pub(super) fn print(report: &Report, judged: &[Judged]) -> Result<()> {
    output::print("PROMISES")?;
    let rows: Vec<_> = judged
        .iter()
        .map(|one| {
            let rows = format!("{} of {}", one.kept, one.kept + one.broken.len());
            [verdict(one.verdict), one.promise.id.to_owned(), rows, one.promise.text.to_owned()]
        })
        .collect();
    output::print_rows(&rows)?;

    output::print("\nNUMBERS: total photons of the maps")?;
    let mut rows = vec![
        ["", "accepted up to", "refused from", "first wrong", "accepted", "refused", "needlessly"]
            .map(str::to_owned),
    ];
    let power = |total: Option<u64>| total.map_or_else(|| "-".to_owned(), |total| total.to_string());
    for (number, found) in report.breaks() {
        let [accepted, refused, needless] = found.rows.map(|count| count.to_string());
        let (last, first) = (power(found.last_accepted), power(found.first_refused));
        rows.push([number, last, first, power(found.first_wrong), accepted, refused, needless]);
    }
    output::print_rows(&rows)?;
    output::print("\"needlessly\": refused, though no pixel would have been wrong")?;

    output::print("\nOTHER SUMS")?;
    let others = report.rows.iter().filter(|row| {
        ["ratio/", "blending/", "splat/", "order/"].iter().any(|part| row.id.starts_with(part))
    });
    output::print_rows(&others.map(other).collect::<Vec<_>>())?;

    output::print("\nRENDERERS: hashes of four radius maps, and how many of all maps are right")?;
    output::print_rows(&report.renderers.iter().map(|one| renderer(report, one)).collect::<Vec<_>>())?;

    let broken: Vec<_> = report.rows.iter().filter(|row| row.verdict == Verdict::Broken).collect();
    if !broken.is_empty() {
        output::print(&format!("\nBROKEN: {} rows", broken.len()))?;
        output::print_rows(
            &broken.iter().take(LISTED).map(|row| [row.id.clone(), found(row)]).collect::<Vec<_>>(),
        )?;
    }
    let kept = judged.iter().filter(|one| one.verdict == Verdict::Kept).count();
    let pruned = match report.pruned.as_slice() {
        [] => "nothing".to_owned(),
        pruned => pruned.join("; "),
    };
    output::print_facts(&[
        ("", String::new()),
        ("kept", format!("{kept} of {} promises, in {} rows", judged.len(), report.rows.len())),
        ("left out", pruned),
        ("device", report.device.renderer.clone()),
    ])
}

fn verdict(verdict: Verdict) -> String {
    match verdict {
        Verdict::Kept => "kept".to_owned(),
        Verdict::Broken => "BROKEN".to_owned(),
        Verdict::Information => "-".to_owned(),
    }
}

fn other(row: &Row) -> [String; 3] {
    [verdict(row.verdict), row.id.clone(), found(row)]
}

/// What is wrong, and by how much.
fn found(row: &Row) -> String {
    let mut parts = Vec::new();
    if let (Some(wrong), Some(of)) = (row.wrong, row.of) {
        parts.push(format!("{wrong} of {of} differ"));
    }
    if let Some(error) = row.largest_error.filter(|_| row.wrong != Some(0)) {
        parts.push(format!(
            "by up to {}",
            if error.fract() == 0.0 { error.to_string() } else { format!("{error:.1e}") }
        ));
    }
    if !row.note.is_empty() {
        parts.push(row.note.clone());
    }
    parts.join("; ")
}

fn renderer(report: &Report, renderer: &Renderer) -> [String; 3] {
    let row = report.rows.iter().find(|row| row.id == format!("bits/{}", renderer.name));
    let text = match (&renderer.found, row) {
        (Ok(bits), Some(row)) => {
            let hashes = bits.hashes.iter().filter(|(case, _)| case.starts_with("auto/"));
            let hashes: Vec<_> =
                hashes.map(|(_, hash)| hash.as_ref().map_or("-", |hash| &hash[..8])).collect();
            let of = row.of.unwrap_or(0);
            format!("{}  {} of {of}; {}", hashes.join(" "), of - row.wrong.unwrap_or(0), row.note)
        }
        (Err(reason), _) => reason.clone(),
        (Ok(_), None) => String::new(),
    };
    [row.map_or_else(String::new, |row| verdict(row.verdict)), renderer.name.clone(), text]
}
