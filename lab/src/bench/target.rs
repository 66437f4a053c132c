//! Targets for a method's times, and whether they were reached.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::settings::MapInfo;

/// Which side of its bound a target has to be on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// The bound or less.
    AtMost,
    /// Less than the bound.
    Below,
    /// The bound or more.
    AtLeast,
}

impl fmt::Display for Side {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::AtMost => "<=",
            Self::Below => "<",
            Self::AtLeast => ">=",
        })
    }
}

/// The side, the bound and its unit.
pub(crate) type Bound = (Side, f64, &'static str);

/// A ratio of medians of one run, and what it should be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Target {
    /// Which kind of target; several maps and questions may have one of the same name.
    pub name: String,
    /// What was measured, and against what.
    pub what: String,
    /// The map's name.
    pub map: String,
    /// The map's columns and rows.
    pub size: [u32; 2],
    /// What else distinguishes it from others of that name: MR, edges, the place of an edit.
    pub question: String,
    /// The ratio; none if a row that it needs is missing or wrong.
    pub measured: Option<f64>,
    /// Which side of the bound is meant.
    pub side: Side,
    /// The bound.
    pub bound: f64,
    /// What the ratio is in.
    pub unit: String,
    /// Whether it was measured and is on its side of the bound.
    pub holds: bool,
}

impl Target {
    /// A target, judged.
    pub(crate) fn new(
        (name, what): (&str, &str),
        map: &MapInfo,
        question: String,
        measured: Option<f64>,
        (side, bound, unit): Bound,
    ) -> Self {
        let holds = measured.is_some_and(|measured| match side {
            Side::AtMost => measured <= bound,
            Side::Below => measured < bound,
            Side::AtLeast => measured >= bound,
        });
        Self {
            name: name.to_owned(),
            what: what.to_owned(),
            map: map.name.clone(),
            size: map.size,
            question,
            measured,
            side,
            bound,
            unit: unit.to_owned(),
            holds,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_is_met_on_its_side_and_by_nothing_unmeasured() {
        let map = MapInfo { name: "m".to_owned(), size: [4, 4], origin: String::new() };
        let holds = |measured, side| {
            Target::new(("t", ""), &map, String::new(), measured, (side, 2.0, "copies")).holds
        };
        let sides = [Side::AtMost, Side::Below, Side::AtLeast];
        assert_eq!(sides.map(|side| holds(Some(1.9), side)), [true, true, false]);
        assert_eq!(sides.map(|side| holds(Some(2.0), side)), [true, false, true]);
        assert_eq!(sides.map(|side| holds(Some(2.1), side)), [false, false, true]);
        assert_eq!(sides.map(|side| holds(None, side)), [false; 3]);
        assert_eq!(sides.map(|side| holds(Some(f64::NAN), side)), [false; 3]);
    }
}
