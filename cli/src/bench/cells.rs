//! What the tables of timing runs have in common.

use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, ContentArrangement, Table};
use varikernel_lab::bench::{AUTO, Case, Stage};

/// Columns of a terminal that tables fit into.
const WIDTH: u16 = 80;

pub(super) fn new_table(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_style(NOTHING).set_content_arrangement(ContentArrangement::Dynamic).set_width(WIDTH);
    table.set_header(header);
    table
}

pub(super) fn align_right(table: &mut Table, columns: std::ops::RangeInclusive<usize>) {
    for index in columns {
        if let Some(column) = table.column_mut(index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
}

pub(super) fn order(case: &Case) -> &'static str {
    match (case.search, case.stage) {
        (Some(order), _) => order.name(),
        (None, Stage::Copy | Stage::Probe | Stage::Build | Stage::Certify) => "",
        (None, Stage::Frame) if case.variant == AUTO => "planned",
        (None, Stage::Search | Stage::Frame) => "its own",
    }
}

/// Three digits that count, whatever the magnitude.
pub(super) fn three_digits(value: f64) -> String {
    let digits = match value {
        value if value >= 99.95 => 0,
        value if value >= 9.995 => 1,
        value if value >= 0.9995 => 2,
        value if value >= 0.099_95 => 3,
        _ => 4,
    };
    format!("{value:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_of_any_magnitude() {
        let texts = [1234.5, 99.96, 9.996, 9.99, 0.9996, 0.1, 0.0123].map(three_digits);
        assert_eq!(texts, ["1234", "100", "10.0", "9.99", "1.00", "0.100", "0.0123"]);
    }
}
