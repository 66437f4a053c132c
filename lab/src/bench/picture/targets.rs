//! The targets of the suite of a picture, each from medians of the same run.

use super::rows::Work;
use super::{PictureCase, PictureRow, PictureSuite};
use crate::bench::settings::MapInfo;
use crate::bench::target::{Bound, Side, Target};

/// Light from tables is judged at this size.
const LARGE: [u32; 2] = [1920, 1080];
/// With so many photons, and against so many.
const MILLION: u32 = 1_000_000;
const TEN_MILLION: u32 = 10_000_000;

/// All of them, of each case that was run; what lacks a row, or has a wrong one, is not measured.
pub(super) fn of(suite: &PictureSuite, cases: &[PictureCase]) -> Vec<Target> {
    let judge = |case| Judge { suite, case };
    let mut targets: Vec<Target> = cases.iter().map(|case| judge(case).density()).collect();
    targets.extend(cases.iter().map(|case| judge(case).photons()));
    let at = |photons| cases.iter().find(|case| (case.size, case.photons) == (LARGE, photons));
    if let Some(case) = at(MILLION) {
        targets.extend(judge(case).tables());
        if let Some(more) = at(TEN_MILLION) {
            targets.push(judge(more).against_fewer(case));
        }
    }
    targets
}

/// A case of a suite.
#[derive(Clone, Copy)]
struct Judge<'a> {
    suite: &'a PictureSuite,
    case: &'a PictureCase,
}

impl Judge<'_> {
    fn density(self) -> Target {
        let kind = ("density", "photons counted, against the same photons as points");
        let measured = row(self.case, Work::Density).and_then(|row| row.point_passes);
        self.target(kind, measured, (Side::AtMost, 6.0, "point-only passes"))
    }

    fn photons(self) -> Target {
        let millions = f64::from(self.case.photons) / 1e6;
        let measured = ms(self.case, &[Work::Photons]).map(|ms| ms / 1e3 / millions);
        let kind = ("photons", "a million photons traced, with 8 landings");
        self.target(kind, measured, (Side::AtMost, 2.0, "seconds"))
    }

    /// Whole against whole: what counts photons is on both sides.
    fn tables(self) -> [Target; 4] {
        let whole = ms(self.case, &[Work::Whole]);
        let against = |works: &[Work]| Some(ms(self.case, works)? / whole.filter(|&whole| whole > 0.0)?);
        let copies = row(self.case, Work::Whole).and_then(|row| row.copies);
        let variable = against(&[Work::Density, Work::Radius, Work::SplatVariable]);
        let fixed = against(&[Work::Density, Work::SplatFixed]);
        let all = "light from tables, from photons on the GPU on";
        let stretch = "light from tables, as far as it could get";
        let kinds = [
            ("tables-variable", "light from tables, against counts, radii and splats of variable radii"),
            ("tables-fixed", "light from tables, against counts and splats of the fixed radius"),
        ];
        [
            self.target(("tables", all), copies, (Side::AtMost, 120.0, "copies")),
            self.target(("tables-stretch", stretch), copies, (Side::AtMost, 60.0, "copies")),
            self.target(kinds[0], variable, (Side::AtLeast, 30.0, "times as fast")),
            self.target(kinds[1], fixed, (Side::AtLeast, 8.0, "times as fast")),
        ]
    }

    /// Against a case of fewer photons.
    fn against_fewer(self, fewer: &PictureCase) -> Target {
        let [more, fewer] = [self.case, fewer].map(|case| ms(case, &[Work::Tables]));
        let measured = more.zip(fewer.filter(|&fewer| fewer > 0.0)).map(|(more, fewer)| more / fewer);
        let kind =
            ("tables-photons", "light from tables without the counting, against a tenth of the photons");
        self.target(kind, measured, (Side::AtMost, 1.2, "times as long"))
    }

    fn target(self, kind: (&str, &str), measured: Option<f64>, bound: Bound) -> Target {
        let map = MapInfo { name: self.suite.scene.clone(), size: self.case.size, origin: String::new() };
        Target::new(kind, &map, format!("{} photons", self.case.photons), measured, bound)
    }
}

/// A row whose answer is right.
fn row(case: &PictureCase, work: Work) -> Option<&PictureRow> {
    case.rows.iter().find(|row| row.name == work.name() && row.right)
}

/// The medians of some rows together; nothing if one is missing.
fn ms(case: &PictureCase, works: &[Work]) -> Option<f64> {
    works.iter().map(|&work| Some(row(case, work)?.statistics.median_ms)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Statistics;

    fn case(photons: u32, rows: &[(Work, f64)]) -> PictureCase {
        let row = |&(work, ms): &(Work, f64)| PictureRow {
            name: work.name().to_owned(),
            samples_ms: vec![ms],
            wall_ms: vec![ms],
            statistics: Statistics::of(&[ms]).unwrap(),
            suspect: Vec::new(),
            point_passes: Some(ms / 4.0),
            copies: Some(ms / 2.0),
            fragments_per_photon: None,
            ns_per_fragment: None,
            right: true,
        };
        let rows = rows.iter().map(row).collect();
        PictureCase { size: LARGE, photons, drawn: 1, contributing: 1, rows, left_out: Vec::new() }
    }

    #[test]
    fn targets_by_hand() {
        let few = [
            (Work::Density, 20.0),
            (Work::Radius, 30.0),
            (Work::SplatVariable, 5950.0),
            (Work::SplatFixed, 1580.0),
            (Work::Tables, 150.0),
            (Work::Whole, 200.0),
            (Work::Photons, 1500.0),
        ];
        let many = [(Work::Tables, 195.0), (Work::Whole, 400.0)];
        let mut cases = vec![case(MILLION, &few), case(TEN_MILLION, &many)];
        let suite = PictureSuite::default();
        let judged = |cases: &[PictureCase]| -> Vec<(String, Option<f64>, bool)> {
            of(&suite, cases).into_iter().map(|of| (of.name, of.measured, of.holds)).collect()
        };
        let found = judged(&cases);
        for expected in [
            ("density", Some(5.0), true),
            ("photons", Some(1.5), true),
            ("tables", Some(100.0), true),
            ("tables-stretch", Some(100.0), false),
            ("tables-variable", Some(30.0), true),
            ("tables-fixed", Some(8.0), true),
            ("tables-photons", Some(1.3), false),
        ] {
            let (name, measured, holds) = expected;
            assert!(found.contains(&(name.to_owned(), measured, holds)), "{expected:?} in {found:?}");
        }
        assert_eq!(found.len(), 2 + 2 + 4 + 1);
        // A wrong row measures nothing.
        cases[0].rows[5].right = false;
        let wrong = judged(&cases).into_iter().filter(|(name, ..)| name.starts_with("tables"));
        assert_eq!(wrong.filter(|(_, measured, _)| measured.is_none()).count(), 4);
        // Other sizes are not judged.
        for case in &mut cases {
            case.size = [512; 2];
        }
        assert_eq!(judged(&cases).len(), 4);
    }
}
