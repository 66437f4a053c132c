//! The targets of the suite, each a ratio of medians of the same map in the same run.
//!
//! A row that is missing or wrong leaves its targets without a measure, also where it would be one of several to find the
//! best among: the best of the others might not be the best.

use super::rows::Rows;
use super::{CAUSTIC, FastSuite, MAX_RADII, MORE_RADII, MOSTLY_EMPTY, SITUATION_RADIUS, SPARSE};
use crate::measure::Unit;
use crate::measure::bench::case::{Case, Work, edges_name};
use crate::measure::bench::report::{Report, Run};
use crate::measure::bench::situation::Situation;
use crate::measure::bench::target::{Side, Target};
use crate::settings::{Edges, Order};

/// Sides from which on a build is told in copies, as far as which it is compared with doubling, and at which both.
const LARGE: u32 = 1024;
const SMALL: u32 = 256;
/// The mean radius above which a bracketed search should beat both others.
const LONG: f64 = 4.0;

const COPIES: &str = "copies";
const PROBES: &str = "probe passes";
const AS_FAST: &str = "times as fast";
const AS_LONG: &str = "times as long";

/// The targets by kind, then by map.
pub(super) fn of<'a>(suite: &FastSuite, report: &'a Report) -> Vec<Target> {
    let judge = |map| Judge { report, rows: Rows { map, base: report.settings.base } };
    let maps: Vec<Judge<'_>> = report.maps.iter().map(judge).collect();
    let builds = maps.iter().filter(|judge| judge.rows.map.name == CAUSTIC).flat_map(Judge::builds);
    let kinds: [fn(&Judge<'a>) -> Vec<Target>; 6] = [
        Judge::bracketed_in_probes,
        Judge::bracketed_by_max_radius,
        Judge::bracketed_against_others,
        Judge::planned,
        Judge::situations,
        Judge::against_the_thesis,
    ];
    let whole: Vec<_> = maps.iter().filter(|judge| suite.sizes.contains(&judge.rows.map.size)).collect();
    builds.chain(kinds.iter().flat_map(|kind| whole.iter().flat_map(|judge| kind(judge)))).collect()
}

/// The rows of a map, to be held against each other.
#[derive(Clone, Copy)]
struct Judge<'a> {
    report: &'a Report,
    rows: Rows<'a>,
}

type Row = (Case, Work);

impl Judge<'_> {
    fn builds(&self) -> Vec<Target> {
        let [two, four, scan] = self.rows.builds();
        let side = self.rows.map.size.into_iter().max().unwrap_or(0);
        let doubling = self.best(&[two, four]);
        let mut targets = Vec::new();
        if side >= LARGE {
            let copies = ratio(self.time(&scan), self.unit(Unit::Copy));
            let what = self.on_map("build of the table by a scan");
            targets.push(Target::new("build", what, copies, (Side::AtMost, 3.5), COPIES));
        }
        if side == LARGE {
            let gain = ratio(doubling, self.time(&scan));
            let what = self.on_map("build by a scan, against the better doubling");
            targets.push(Target::new("build-gain", what, gain, (Side::AtLeast, 5.0), AS_FAST));
        }
        if side <= SMALL {
            let against = ratio(self.time(&scan), doubling);
            let what = self.on_map("build by a scan, against the better doubling");
            targets.push(Target::new("build-small", what, against, (Side::AtMost, 1.0), AS_LONG));
        }
        targets
    }

    /// The slowest of its questions.
    fn bracketed_in_probes(&self) -> Vec<Target> {
        let questions =
            [Edges::Scale, Edges::Zero].into_iter().flat_map(|edges| MORE_RADII.map(|of| (of, edges)));
        let times = questions.map(|(radius, edges)| {
            let time = self.time(&self.rows.search(Order::Bracketed, radius, edges))?;
            Some((time, format!("slowest bracketed search, MR {radius} {}", edges_name(edges))))
        });
        let slowest = times.collect::<Option<Vec<_>>>().and_then(|times| {
            times.into_iter().reduce(|slowest, next| if next.0 > slowest.0 { next } else { slowest })
        });
        let (time, what) =
            slowest.map_or((None, "slowest bracketed search".to_owned()), |(time, what)| (Some(time), what));
        let probes = ratio(time, self.unit(Unit::Probe));
        vec![Target::new("bracketed", self.on_map(&what), probes, (Side::AtMost, 3.0), PROBES)]
    }

    fn bracketed_by_max_radius(&self) -> Vec<Target> {
        let search = |radius| self.time(&self.rows.search(Order::Bracketed, radius, Edges::Scale));
        let what = self.on_map("bracketed search, MR 512 against MR 32");
        let bound = (Side::AtMost, 1.1);
        vec![Target::new("bracketed-mr", what, ratio(search(512), search(32)), bound, AS_LONG)]
    }

    fn bracketed_against_others(&self) -> Vec<Target> {
        let against = |radius| {
            let search = |order| self.rows.search(order, radius, Edges::Scale);
            let bracketed = search(Order::Bracketed);
            let mean = self.run(&bracketed).and_then(|run| run.mean_radius);
            // Without a mean, nothing was measured either.
            let bound = match mean {
                Some(mean) if mean > LONG => (Side::Below, 1.0),
                _ => (Side::AtMost, 1.1),
            };
            let mean = mean.map_or_else(String::new, |mean| format!(", mean radius {mean:.1}"));
            let what = format!("bracketed search, against the better other, MR {radius}{mean}");
            let best = self.best(&[search(Order::Forward), search(Order::Binary)]);
            let measured = ratio(self.time(&bracketed), best);
            Target::new("bracketed-rank", self.on_map(&what), measured, bound, AS_LONG)
        };
        MAX_RADII.map(against).into()
    }

    fn planned(&self) -> Vec<Target> {
        let against = |radius| {
            let mut fixed = self.rows.thesis_frames(radius);
            fixed.extend(self.rows.scan_frames(radius));
            let measured = ratio(self.time(&self.rows.planned(radius)), self.best(&fixed));
            let what = self.on_map(&format!("frame planned, against the best fixed one, MR {radius}"));
            Target::new("auto", what, measured, (Side::AtMost, 1.1), AS_LONG)
        };
        MAX_RADII.map(against).into()
    }

    fn situations(&self) -> Vec<Target> {
        if self.rows.map.name != CAUSTIC {
            return Vec::new();
        }
        let time = |situation| self.time(&self.rows.situation(situation));
        let [.., whole] = self.rows.scan_frames(SITUATION_RADIUS).map(|row| self.time(&row));
        let search = self.time(&self.rows.search(Order::Bracketed, SITUATION_RADIUS, Edges::Scale));
        let (copy, probe) = (self.unit(Unit::Copy), self.unit(Unit::Probe));
        let of_frame = "of a whole frame";
        let judged = |name, what, situation, against, bound, unit| {
            let measured = ratio(time(situation), against);
            Target::new(name, self.on_map(what), measured, (Side::AtMost, bound), unit)
        };
        let half =
            |against, what| judged("half-masked", what, Situation::HalfMasked, against, 0.6, "of the search");
        let (known, unknown) = ("frame known to be empty", "frame empty, at most 1 photon known");
        vec![
            judged("empty", known, Situation::Empty, copy, 1.5, COPIES),
            judged("empty", unknown, Situation::EmptyUnknown, copy, 1.5, COPIES),
            judged("quarter", "frame with photons in a quarter", Situation::Quarter, whole, 0.6, of_frame),
            half(time(Situation::NoneMasked), "search half masked, against a mask of all"),
            half(search, "search half masked, against no mask"),
            judged("unchanged", "frame unchanged", Situation::Unchanged, copy, 0.1, COPIES),
            judged(
                "tile",
                "frame with a tile changed in the middle",
                Situation::TileChanged,
                whole,
                0.3,
                of_frame,
            ),
            judged(
                "tile",
                "frame with a tile changed at the lower left",
                Situation::CornerChanged,
                whole,
                0.3,
                of_frame,
            ),
            judged("certify", "proof", Situation::Certify, probe, 2.5, PROBES),
        ]
    }

    fn against_the_thesis(&self) -> Vec<Target> {
        let gain = |radius, least| {
            let thesis = self.best(&self.rows.thesis_frames(radius));
            let measured = ratio(thesis, self.time(&self.rows.planned(radius)));
            let what = self.on_map(&format!("frame planned, against the thesis's best, MR {radius}"));
            Target::new("frame", what, measured, (Side::AtLeast, least), AS_FAST)
        };
        let is_sparse = [SPARSE, MOSTLY_EMPTY].contains(&self.rows.map.name.as_str());
        let [short, long] = MAX_RADII;
        vec![gain(short, 3.0), gain(long, if is_sparse { 4.5 } else { 3.0 })]
    }

    fn unit(&self, unit: Unit) -> Option<f64> {
        self.time(&self.rows.unit(unit))
    }

    /// The least time of all; nothing if one is missing.
    fn best(&self, rows: &[Row]) -> Option<f64> {
        let times: Vec<f64> = rows.iter().map(|row| self.time(row)).collect::<Option<_>>()?;
        times.into_iter().reduce(f64::min)
    }

    fn time(&self, row: &Row) -> Option<f64> {
        Some(self.run(row)?.statistics.median_ms)
    }

    fn run(&self, (case, _): &Row) -> Option<&Run> {
        self.report.run(case).filter(|run| !run.is_wrong())
    }

    fn on_map(&self, what: &str) -> String {
        let [width, height] = self.rows.map.size;
        format!("{what}: {} {width} x {height}", self.rows.map.name)
    }
}

/// Nothing if one is missing, or the second too short to be measured.
fn ratio(time: Option<f64>, against: Option<f64>) -> Option<f64> {
    let against = against.filter(|&against| against > 0.0)?;
    Some(time? / against)
}
