//! The content of the page's template: every number as text.

use std::fmt::Write as _;

use super::{Report, plot};
use crate::thesis::claims::{Group, Judged, verdict_counts};
use crate::thesis::density::{self, Inference};
use crate::thesis::judgement::Verdict;
use crate::thesis::listings::{FaultRow, FloatRow};
use crate::thesis::quantity::{Card, Measurements, Quantity, Timing};
use crate::thesis::tables::{self, Table};
use crate::thesis::{counted::PyramidCost, figures};
use varikernel::settings::Split;

/// Radii of the page's table of fetches; the file has all.
const SHOWN_RADII: [u32; 9] = [1, 2, 3, 4, 8, 16, 30, 31, 32];

/// The page.
#[derive(askama::Template)]
#[template(path = "report.html")]
pub(super) struct Page<'a> {
    report: &'a Report<'a>,
    verdicts: [(Verdict, usize); 4],
    groups: Vec<(&'static str, Vec<&'a Judged>)>,
    tables: Vec<TableView>,
    figures: Vec<String>,
    inference: Vec<Inference>,
    costs: Vec<(u32, Vec<&'a PyramidCost>)>,
    faults: &'a [FaultRow],
    floats: &'a [FloatRow],
}

impl<'a> Page<'a> {
    pub(super) fn of(report: &'a Report<'a>) -> Self {
        let evidence = report.evidence;
        let mut drawn: Vec<String> =
            figures::ALL.iter().map(|figure| plot::figure_svg(figure, &evidence.measurements)).collect();
        if !evidence.orders.is_empty() {
            drawn.push(plot::orders_svg(&evidence.orders));
        }
        let costs = SHOWN_RADII
            .into_iter()
            .map(|radius| (radius, evidence.pyramid_costs.iter().filter(|of| of.radius == radius).collect()))
            .filter(|(_, costs): &(u32, Vec<&PyramidCost>)| !costs.is_empty())
            .collect();
        Self {
            report,
            verdicts: verdict_counts(report.judged),
            groups: groups(report.judged),
            tables: tables::all().iter().map(|table| TableView::of(table, &evidence.measurements)).collect(),
            figures: drawn,
            inference: density::infer(),
            costs,
            faults: &evidence.faults,
            floats: &evidence.floats,
        }
    }
}

fn groups(judged: &[Judged]) -> Vec<(&'static str, Vec<&Judged>)> {
    [
        (Group::Timed, "By the clock"),
        (Group::Counted, "By counting"),
        (Group::Listing, "The listings as printed"),
        (Group::Printed, "The thesis against itself"),
        (Group::Future, "Future work of chapter 6"),
    ]
    .into_iter()
    .map(|(group, title)| (title, judged.iter().filter(|one| one.claim.group == group).collect()))
    .collect()
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "a template passes references")]
fn verdict_class(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Confirmed => "confirmed",
        Verdict::Refuted => "refuted",
        Verdict::HoldsHereOnly => "partly",
        Verdict::CannotBeTested => "untested",
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "a template passes references")]
fn split_name(split: &Split) -> &'static str {
    match split {
        Split::Odd => "first listing",
        Split::Larger => "second listing",
    }
}

/// A table with ours beside the printed values.
struct TableView {
    number: u32,
    title: &'static str,
    row_name: &'static str,
    cards: Vec<Card>,
    quantities: Vec<Quantity>,
    rows: Vec<(u32, Vec<GroupView>)>,
}

/// One quantity in one row.
struct GroupView {
    printed: Vec<String>,
    here: Here,
    /// Ours over each card's.
    ratios: Vec<String>,
}

/// Our side of a cell.
enum Here {
    Timed { ms: String, copies: String },
    NotRun(String),
}

impl TableView {
    fn of(table: &Table, measurements: &Measurements) -> Self {
        let (quantities, cards) = (table.quantities(), table.cards());
        let rows = table
            .rows
            .iter()
            .map(|&(row, _)| {
                let group = |&quantity| GroupView::of(table, quantity, &cards, row, measurements);
                (row, quantities.iter().map(group).collect())
            })
            .collect();
        let row_name = quantities[0].row_name();
        Self { number: table.number, title: table.title, row_name, cards, quantities, rows }
    }

    /// Columns that one quantity takes.
    fn span(&self) -> usize {
        2 * self.cards.len() + 1
    }

    /// Why cells were not run, each reason once.
    fn reasons(&self) -> Vec<&str> {
        let mut reasons: Vec<&str> = Vec::new();
        for group in self.rows.iter().flat_map(|(_, groups)| groups) {
            if let Here::NotRun(why) = &group.here
                && !reasons.contains(&why.as_str())
            {
                reasons.push(why);
            }
        }
        reasons
    }
}

impl GroupView {
    fn of(table: &Table, quantity: Quantity, cards: &[Card], row: u32, measurements: &Measurements) -> Self {
        let printed: Vec<Option<f64>> =
            cards.iter().map(|&card| table.printed(quantity, card, row)).collect();
        let here = match measurements.get(quantity, row) {
            Some(Timing::Median { ms, copies }) => Here::Timed {
                ms: milliseconds(*ms),
                copies: copies.map(|copies| format!("{copies:.1}")).unwrap_or_default(),
            },
            Some(Timing::NotRun(why)) => Here::NotRun(why.clone()),
            None => Here::NotRun("not part of this run".to_owned()),
        };
        let ms = measurements.ms(quantity, row);
        let ratios = printed.iter().map(|&printed| ratio(ms, printed)).collect();
        let printed = printed.into_iter().map(|ms| ms.map(as_printed).unwrap_or_default()).collect();
        Self { printed, here, ratios }
    }
}

fn ratio(here: Option<f64>, printed: Option<f64>) -> String {
    match (here, printed) {
        (Some(here), Some(printed)) => match here / printed {
            ratio if ratio >= 100.0 => format!("×{ratio:.0}"),
            ratio if ratio >= 10.0 => format!("×{ratio:.1}"),
            ratio if ratio >= 0.1 => format!("×{ratio:.2}"),
            ratio => format!("×{ratio:.4}"),
        },
        _ => String::new(),
    }
}

/// Three decimals, as the thesis prints all but one of its times.
fn as_printed(ms: f64) -> String {
    let (three, four) = (format!("{ms:.3}"), format!("{ms:.4}"));
    if four.ends_with('0') { three } else { four }
}

fn milliseconds(ms: f64) -> String {
    if ms < 0.1 { format!("{ms:.4}") } else { format!("{ms:.3}") }
}

/// `table` as CSV: printed columns, ours in milliseconds and copies, ours over each card's, why a cell is
/// missing.
///
/// # Panics
/// Never: memory takes all that is written.
#[must_use]
pub fn table_csv(table: &Table, measurements: &Measurements) -> String {
    let cards = table.cards();
    let mut csv = csv::Writer::from_writer(Vec::new());
    let mut head = vec![table.quantities()[0].row_name().to_owned()];
    for quantity in table.quantities() {
        head.extend(cards.iter().map(|card| format!("{quantity} {card} ms")));
        head.extend(["ms", "copies", "not run"].map(|unit| format!("{quantity} here {unit}")));
        head.extend(cards.iter().map(|card| format!("{quantity} here over {card}")));
    }
    let written = "memory takes all that is written";
    csv.write_record(&head).expect(written);
    for &(row, _) in &table.rows {
        let mut record = vec![row.to_string()];
        for quantity in table.quantities() {
            let group = GroupView::of(table, quantity, &cards, row, measurements);
            record.extend(group.printed);
            record.extend(match group.here {
                Here::Timed { ms, copies } => [ms, copies, String::new()],
                Here::NotRun(why) => [String::new(), String::new(), why],
            });
            record.extend(group.ratios.iter().map(|ratio| ratio.trim_start_matches('×').to_owned()));
        }
        csv.write_record(&record).expect(written);
    }
    String::from_utf8(csv.into_inner().expect(written)).expect("CSV of text is text")
}

/// The estimates of one size, card by card.
fn estimates(inference: &Inference) -> String {
    let mut text = String::new();
    for estimate in &inference.estimates {
        let separator = if text.is_empty() { "" } else { "; " };
        let rounding = 100.0 * estimate.rounding;
        let _ = write!(
            text,
            "{separator}{}: {:.1} or {:.1} (± {rounding:.1} %)",
            estimate.card, estimate.by_ratio, estimate.by_line
        );
    }
    text
}
