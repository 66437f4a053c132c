//! Tables A.1 to A.8 as printed, from `assets/thesis/`.

use super::quantity::{Card, Quantity};
use Quantity::{BruteForce, PyramidBuild, PyramidFrame, SatBuild, SatFrame, SatSearch, SatSearchByMaxRadius};
use varikernel::settings::{Order, SatSamples};

const FORWARD: Order = Order::Forward;
const BINARY: Order = Order::Binary;
const CARDS: [Card; 2] = Card::ALL;

/// One of the thesis's tables.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// 1 for A.1.
    pub number: u32,
    /// What it holds, in our words; A.8 is printed with A.7's caption.
    pub title: &'static str,
    /// What each column after the first times, and on which card.
    pub columns: Vec<(Quantity, Card)>,
    /// Sizes, or MR in A.7, and the milliseconds of each column.
    pub rows: Vec<(u32, Vec<f64>)>,
}

impl Table {
    /// What was timed, each once, in the order of the columns.
    #[must_use]
    pub fn quantities(&self) -> Vec<Quantity> {
        let mut quantities = Vec::new();
        for &(quantity, _) in &self.columns {
            if !quantities.contains(&quantity) {
                quantities.push(quantity);
            }
        }
        quantities
    }

    /// The cards, each once.
    #[must_use]
    pub fn cards(&self) -> Vec<Card> {
        CARDS.into_iter().filter(|&card| self.columns.iter().any(|&(_, of)| of == card)).collect()
    }

    /// The printed milliseconds.
    #[must_use]
    pub fn printed(&self, quantity: Quantity, card: Card, row: u32) -> Option<f64> {
        let column = self.columns.iter().position(|&column| column == (quantity, card))?;
        let (_, values) = self.rows.iter().find(|&&(printed, _)| printed == row)?;
        values.get(column).copied()
    }
}

/// All tables, A.1 first.
///
/// # Panics
/// If a file of `assets/thesis/` is not what its columns say: they are part of the program.
#[must_use]
pub fn all() -> Vec<Table> {
    let both = |quantity| CARDS.map(|card| (quantity, card)).to_vec();
    let orders = |of: fn(Order) -> Quantity| {
        CARDS.iter().flat_map(|&card| [(of(FORWARD), card), (of(BINARY), card)]).collect()
    };
    let frames = |card| {
        [SatSamples::Two, SatSamples::Four]
            .into_iter()
            .flat_map(|samples| [FORWARD, BINARY].map(|order| (SatFrame(samples, order), card)))
            .collect()
    };
    let builds = CARDS
        .iter()
        .flat_map(|&card| [SatSamples::Two, SatSamples::Four].map(|samples| (SatBuild(samples), card)));
    macro_rules! table {
        ($number:literal, $title:literal, $columns:expr) => {{
            let text = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/thesis/a", $number, ".csv"));
            table($number, $title, $columns, text)
        }};
    }
    vec![
        table!(1, "Building the summed mipmap", both(PyramidBuild)),
        table!(2, "Building and searching the summed mipmap", orders(PyramidFrame)),
        table!(3, "Building and searching the summed-area table, GTX 260", frames(Card::Gtx260)),
        table!(4, "Building and searching the summed-area table, GTX 480", frames(Card::Gtx480)),
        table!(5, "Building the summed-area table", builds.collect()),
        table!(6, "Searching the summed-area table", orders(SatSearch)),
        table!(
            7,
            "Binary search of the summed-area table by maximum radius, 512²",
            both(SatSearchByMaxRadius)
        ),
        table!(8, "Brute force (its printed caption repeats that of A.7)", both(BruteForce)),
    ]
}

/// What a full run has to time: each quantity in each of its rows, once, though A.3 and A.4 share theirs.
#[must_use]
pub fn cells() -> Vec<(Quantity, u32)> {
    let mut cells = Vec::new();
    for table in all() {
        for quantity in table.quantities() {
            for &(row, _) in &table.rows {
                if !cells.contains(&(quantity, row)) {
                    cells.push((quantity, row));
                }
            }
        }
    }
    cells
}

/// The printed milliseconds of `quantity` on `card`, as (row, ms).
#[must_use]
pub fn printed_series(quantity: Quantity, card: Card) -> Vec<(u32, f64)> {
    let tables = all();
    let Some((table, column)) = tables.iter().find_map(|table| {
        let column = table.columns.iter().position(|&column| column == (quantity, card))?;
        Some((table, column))
    }) else {
        return Vec::new();
    };
    table.rows.iter().map(|(row, values)| (*row, values[column])).collect()
}

fn table(number: u32, title: &'static str, columns: Vec<(Quantity, Card)>, text: &str) -> Table {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let rows = reader
        .deserialize::<(u32, Vec<f64>)>()
        .map(|row| row.unwrap_or_else(|error| panic!("Table A.{number}: {error}")))
        .inspect(|(row, values)| assert_eq!(values.len(), columns.len(), "Table A.{number}, row {row}"))
        .collect();
    Table { number, title, columns, rows }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_has_the_printed_rows() {
        let rows: Vec<_> = all().iter().map(|table| (table.number, table.rows.len())).collect();
        assert_eq!(rows, [(1, 5), (2, 4), (3, 5), (4, 5), (5, 5), (6, 5), (7, 4), (8, 5)]);
    }

    #[test]
    fn values_typed_from_the_appendix() {
        let tables = all();
        let expect = |number: usize, quantity, card, row, ms: f64| {
            assert_eq!(
                tables[number - 1].printed(quantity, card, row),
                Some(ms),
                "A.{number} {quantity} {row}"
            );
        };
        expect(1, PyramidBuild, Card::Gtx260, 1024, 0.418);
        expect(1, PyramidBuild, Card::Gtx480, 256, 0.346);
        expect(2, PyramidFrame(BINARY), Card::Gtx260, 512, 1914.8);
        expect(2, PyramidFrame(FORWARD), Card::Gtx480, 64, 30.937);
        expect(3, SatFrame(SatSamples::Four, BINARY), Card::Gtx260, 512, 1.357);
        expect(4, SatFrame(SatSamples::Two, FORWARD), Card::Gtx480, 1024, 4.354);
        expect(5, SatBuild(SatSamples::Two), Card::Gtx480, 128, 0.2474);
        expect(6, SatSearch(FORWARD), Card::Gtx260, 1024, 5.365);
        expect(7, SatSearchByMaxRadius, Card::Gtx480, 256, 0.427);
        expect(8, BruteForce, Card::Gtx480, 1024, 1514.013);
        assert_eq!(tables[1].printed(BruteForce, Card::Gtx480, 64), None);
    }

    #[test]
    fn a_full_run_times_each_cell_once() {
        // A.1 5, A.2 2 x 4, A.3 with A.4 4 x 5, A.5 2 x 5, A.6 2 x 5, A.7 4, A.8 5.
        assert_eq!(cells().len(), 5 + 8 + 20 + 10 + 10 + 4 + 5);
    }

    #[test]
    fn column_heads_are_those_of_the_appendix() {
        for (table, heads) in all().iter().zip([2, 4, 4, 4, 4, 4, 2, 2]) {
            assert_eq!(table.columns.len(), heads);
        }
        let search = printed_series(SatSearch(BINARY), Card::Gtx480);
        assert_eq!(search, [(64, 0.015), (128, 0.024), (256, 0.080), (512, 0.275), (1024, 1.064)]);
    }
}
