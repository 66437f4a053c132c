//! Where each number breaks, by the rows of a run.

use std::collections::BTreeMap;

use serde::Serialize;

use super::row::{Decision, Row};

/// Where one number breaks.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Break {
    /// The least total that gave a wrong pixel.
    pub first_wrong: Option<u64>,
    /// The largest total that gave none.
    pub last_right: Option<u64>,
    /// The largest total that was accepted.
    pub last_accepted: Option<u64>,
    /// The least total that was refused.
    pub first_refused: Option<u64>,
    /// Accepted and refused rows, and refused ones that would have been right.
    pub rows: [usize; 3],
}

pub(super) fn breaks(rows: &[Row]) -> BTreeMap<String, Break> {
    let mut numbers: BTreeMap<String, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        if let Some(number) = &row.number {
            numbers.entry(number.clone()).or_default().push(row);
        }
    }
    let of_one = |rows: Vec<&Row>| {
        let totals = |chosen: &dyn Fn(&Row) -> bool| {
            let chosen: Vec<u64> =
                rows.iter().filter(|row| chosen(row)).filter_map(|row| row.total).collect();
            (chosen.iter().min().copied(), chosen.iter().max().copied(), chosen.len())
        };
        let is = |decision| move |row: &Row| row.decision == Some(decision);
        let (_, last_accepted, accepted) = totals(&is(Decision::Accepted));
        let (first_refused, _, refused) = totals(&is(Decision::Refused));
        let needless = totals(&|row| is(Decision::Refused)(row) && row.wrong == Some(0)).2;
        Break {
            first_wrong: totals(&|row| row.wrong.is_some_and(|wrong| wrong > 0)).0,
            last_right: totals(&|row| row.wrong == Some(0)).1,
            last_accepted,
            first_refused,
            rows: [accepted, refused, needless],
        }
    };
    numbers.into_iter().map(|(number, rows)| (number, of_one(rows))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::Verdict;

    #[test]
    fn breaks_by_hand() {
        let row = |total, decision, wrong| Row {
            number: Some("f32".to_owned()),
            total: Some(total),
            decision: Some(decision),
            wrong: Some(wrong),
            ..Row::new("", &[], Verdict::Kept)
        };
        let rows = [
            row(10, Decision::Accepted, 0),
            row(30, Decision::Refused, 5),
            row(40, Decision::Refused, 0),
            row(20, Decision::Refused, 2),
            row(15, Decision::Accepted, 0),
        ];
        let expected = Break {
            first_wrong: Some(20),
            last_right: Some(40),
            last_accepted: Some(15),
            first_refused: Some(20),
            rows: [2, 3, 1],
        };
        assert_eq!(breaks(&rows), BTreeMap::from([("f32".to_owned(), expected)]));
    }
}
