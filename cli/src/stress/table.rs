//! The results of a stress run as text: promises, numbers, renderers.

use anyhow::Result;
use varikernel_lab::stress::{Found, Judged, Renderer, Report, Row, Verdict};

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

    output::print("\nNUMBERS: by the total of photons in a map, and rows")?;
    let mut rows = vec![["", "accepted to", "refused from", "first wrong", "rows"].map(str::to_owned)];
    for (number, found) in report.breaks() {
        let [accepted, refused, needless] = found.rows;
        let counts = format!("{accepted} accepted, {refused} refused, {needless} *");
        let totals = [found.last_accepted, found.first_refused, found.first_wrong];
        let [last, first, wrong] = totals.map(|total| total.map_or_else(|| "-".to_owned(), in_short));
        rows.push([number, last, first, wrong, counts]);
    }
    output::print_rows(&rows)?;
    output::print("* refused, though no pixel would have been wrong")?;

    output::print("\nOTHER SUMS")?;
    let others = report.rows.iter().filter(|row| {
        ["ratio/", "blending/", "splat/", "order/"].iter().any(|part| row.id.starts_with(part))
    });
    output::print_rows(&others.map(other).collect::<Vec<_>>())?;

    output::print("\nRENDERERS: hashes of four radius maps; how many of all are the definition's")?;
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

/// Powers of two, and one more, as such; other large ones by two digits.
fn in_short(total: u64) -> String {
    if total < 100_000 {
        total.to_string()
    } else if total.is_power_of_two() {
        format!("2^{}", total.ilog2())
    } else if (total - 1).is_power_of_two() {
        format!("2^{} + 1", total.ilog2())
    } else {
        #[expect(clippy::cast_precision_loss, reason = "two digits are shown")]
        let total = total as f64;
        format!("{total:.1e}")
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
    if let Some(error) = row.largest_error.filter(|_| row.wrong.is_some_and(|wrong| wrong > 0)) {
        let error = if error.fract() == 0.0 { error.to_string() } else { format!("{error:.1e}") };
        parts.push(format!("by up to {error}"));
    }
    if !row.note.is_empty() {
        parts.push(row.note.clone());
    }
    parts.join("; ")
}

fn renderer(report: &Report, renderer: &Renderer) -> [String; 3] {
    let row = report.rows.iter().find(|row| row.id == format!("bits/{}", renderer.name));
    let text = match (&renderer.found, row) {
        (Found::Ran(bits), Some(row)) => {
            let hashes = bits.hashes.iter().filter(|(case, _)| case.starts_with("auto/"));
            let hashes: Vec<_> =
                hashes.map(|(_, hash)| hash.as_ref().map_or("-", |hash| &hash[..8])).collect();
            let of = row.of.unwrap_or(0);
            format!("{}  {} of {of}; {}", hashes.join(" "), of - row.wrong.unwrap_or(0), row.note)
        }
        (_, Some(row)) => row.note.clone(),
        (_, None) => String::new(),
    };
    [row.map_or_else(String::new, |row| verdict(row.verdict)), renderer.name.clone(), text]
}

#[cfg(test)]
mod tests {
    use super::in_short;

    #[test]
    fn totals_by_hand() {
        let texts = [2049, 1 << 24, (1 << 24) + 1, 267_294_964, 1_000_065_264].map(in_short);
        assert_eq!(texts, ["2049", "2^24", "2^24 + 1", "2.7e8", "1.0e9"]);
    }
}
