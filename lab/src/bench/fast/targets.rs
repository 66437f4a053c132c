//! The targets of the suite, each a ratio of medians of the same map in the same run.
//!
//! A row that is missing or wrong leaves its targets without a measure, also where it would be one of several
//! to find the best among: the best of the others might not be the best.

use super::rows::Rows;
use super::{CAUSTIC, MAX_RADII, MORE_RADII, MOSTLY_EMPTY, SITUATION_RADIUS, SPARSE};
use crate::bench::case::Case;
use crate::bench::report::{Report, Run};
use crate::bench::situation::Situation;
use crate::bench::suite::FastSuite;
use crate::bench::target::{Bound, Side, Target};
use crate::bench::work::Work;
use varikernel::measure::Unit;
use varikernel::settings::{Edges, Order};

/// Builds are given in copies from the first side on, and compared with doubling up to the second, which both
/// include.
const LARGE: u32 = 1024;
const SMALL: u32 = 256;
/// The mean radius above which a bracketed search should beat both others.
const LONG: f64 = 4.0;

const COPIES: &str = "copies";
const PROBES: &str = "probe passes";
const AS_FAST: &str = "times as fast";
const AS_LONG: &str = "times as long";

impl Report {
    /// Judges the suite's targets anew, if a suite was run.
    pub fn update_targets(&mut self) {
        self.targets = self.settings.suite.as_ref().map_or_else(Vec::new, |suite| of(suite, self));
    }
}

/// The targets by kind, then by map.
fn of<'a>(suite: &FastSuite, report: &'a Report) -> Vec<Target> {
    let judge = |map| Judge { report, rows: Rows { map, base: report.settings.base } };
    let maps: Vec<Judge<'_>> = report.maps.iter().map(judge).collect();
    let mut targets: Vec<Target> = maps.iter().flat_map(Judge::builds).collect();
    targets.sort_by(|a, b| a.name.cmp(&b.name));
    let kinds: [fn(&Judge<'a>) -> Vec<Target>; 6] = [
        Judge::bracketed_in_probes,
        Judge::bracketed_by_max_radius,
        Judge::bracketed_against_others,
        Judge::planned,
        Judge::situations,
        Judge::against_the_thesis,
    ];
    let whole: Vec<_> = maps.iter().filter(|judge| suite.sizes.contains(&judge.rows.map.size)).collect();
    targets.extend(kinds.iter().flat_map(|kind| whole.iter().flat_map(|judge| kind(judge))));
    targets
}

type Row = (Case, Work);

/// The rows of a map, to be compared with each other.
#[derive(Clone, Copy)]
struct Judge<'a> {
    report: &'a Report,
    rows: Rows<'a>,
}

impl Judge<'_> {
    fn builds(&self) -> Vec<Target> {
        if self.rows.map.name != CAUSTIC {
            return Vec::new();
        }
        let [two, four, scan] = self.rows.builds();
        let side = self.rows.map.size.into_iter().max().unwrap_or(0);
        let doubling = self.best(&[two, four]);
        let scan = self.time(&scan);
        let against = "a table by a scan, against the better doubling";
        let mut targets = Vec::new();
        if side >= LARGE {
            let (kind, bound) = (("build", "a table by a scan"), (Side::AtMost, 3.5, COPIES));
            targets.push(self.target(kind, "", ratio(scan, self.unit(Unit::Copy)), bound));
        }
        if side == LARGE {
            let bound = (Side::AtLeast, 5.0, AS_FAST);
            targets.push(self.target(("build-gain", against), "", ratio(doubling, scan), bound));
        }
        if side <= SMALL {
            let bound = (Side::AtMost, 1.0, AS_LONG);
            targets.push(self.target(("build-small", against), "", ratio(scan, doubling), bound));
        }
        targets
    }

    /// The slowest of its questions.
    fn bracketed_in_probes(&self) -> Vec<Target> {
        let all_radii = |edges| MORE_RADII.map(|of| (of, edges));
        let questions = [Edges::Scale, Edges::Zero].into_iter().flat_map(all_radii);
        let times = questions.map(|(radius, edges)| {
            let time = self.time(&self.rows.search(Order::Bracketed, radius, edges))?;
            Some((time, format!("MR {radius}, edges {}", edges.name())))
        });
        let slowest = times.collect::<Option<Vec<_>>>().and_then(|times| {
            times.into_iter().reduce(|slowest, next| if next.0 > slowest.0 { next } else { slowest })
        });
        let (time, question) = slowest.unzip();
        let probes = ratio(time, self.unit(Unit::Probe));
        let kind = ("bracketed", "a bracketed search, the slowest of all MR and edges");
        vec![self.target(kind, &question.unwrap_or_default(), probes, (Side::AtMost, 3.0, PROBES))]
    }

    fn bracketed_by_max_radius(&self) -> Vec<Target> {
        let search = |radius| self.time(&self.rows.search(Order::Bracketed, radius, Edges::Scale));
        let kind = ("bracketed-mr", "a bracketed search, MR 512 against MR 32");
        vec![self.target(kind, "", ratio(search(512), search(32)), (Side::AtMost, 1.1, AS_LONG))]
    }

    fn bracketed_against_others(&self) -> Vec<Target> {
        let against = |radius| {
            let search = |order| self.rows.search(order, radius, Edges::Scale);
            let bracketed = search(Order::Bracketed);
            let mean = self.run(&bracketed).and_then(|run| run.mean_radius);
            // Without a mean, nothing was measured either.
            let bound = match mean {
                Some(mean) if mean > LONG => (Side::Below, 1.0, AS_LONG),
                _ => (Side::AtMost, 1.1, AS_LONG),
            };
            let mean = mean.map_or_else(String::new, |mean| format!(", mean radius {mean:.1}"));
            let best = self.best(&[search(Order::Forward), search(Order::Binary)]);
            let measured = ratio(self.time(&bracketed), best);
            let kind = ("bracketed-rank", "a bracketed search, against the better of forward and binary");
            self.target(kind, &format!("MR {radius}{mean}"), measured, bound)
        };
        MAX_RADII.map(against).into()
    }

    fn planned(&self) -> Vec<Target> {
        let against = |radius| {
            let mut fixed = self.rows.thesis_frames(radius);
            fixed.extend(self.rows.scan_frames(radius));
            let measured = ratio(self.time(&self.rows.planned(radius)), self.best(&fixed));
            let kind = ("auto", "a planned frame, against the best fixed one");
            self.target(kind, &format!("MR {radius}"), measured, (Side::AtMost, 1.1, AS_LONG))
        };
        MAX_RADII.map(against).into()
    }

    fn situations(&self) -> Vec<Target> {
        if self.rows.map.name != CAUSTIC {
            return Vec::new();
        }
        let of = |situation| self.time(&self.rows.situation(situation));
        let [.., frame] = self.rows.scan_frames(SITUATION_RADIUS).map(|row| self.time(&row));
        let search = self.time(&self.rows.search(Order::Bracketed, SITUATION_RADIUS, Edges::Scale));
        let (copy, probe) = (self.unit(Unit::Copy), self.unit(Unit::Probe));
        let judged = |kind, question, situation, against, (bound, unit)| {
            self.target(kind, question, ratio(of(situation), against), (Side::AtMost, bound, unit))
        };
        let empty = ("empty", "a frame without photons");
        let quarter = ("quarter", "a frame with photons in a quarter, against all");
        let masked = ("half-masked", "a search with half of the pixels masked, against all");
        let unchanged = ("unchanged", "a frame in which nothing changed");
        let tile = ("tile", "a frame after an edit of 64 x 64 pixels, against a whole one");
        let part = |bound| (bound, AS_LONG);
        vec![
            judged(empty, "known to be empty", Situation::Empty, copy, (1.5, COPIES)),
            judged(empty, "known to have 1 at most", Situation::EmptyUnknown, copy, (1.5, COPIES)),
            judged(quarter, "", Situation::Quarter, frame, part(0.6)),
            judged(masked, "a mask of all", Situation::HalfMasked, of(Situation::NoneMasked), part(0.6)),
            judged(masked, "without a mask", Situation::HalfMasked, search, part(0.6)),
            judged(unchanged, "", Situation::Unchanged, copy, (0.1, COPIES)),
            judged(tile, "in the middle", Situation::TileChanged, frame, part(0.3)),
            judged(tile, "at the lower left", Situation::CornerChanged, frame, part(0.3)),
            judged(("certify", "a proof of radii and table"), "", Situation::Certify, probe, (2.5, PROBES)),
        ]
    }

    fn against_the_thesis(&self) -> Vec<Target> {
        let gain = |radius, least| {
            let thesis = self.best(&self.rows.thesis_frames(radius));
            let measured = ratio(thesis, self.time(&self.rows.planned(radius)));
            let kind = ("frame", "a planned frame, against the thesis's best");
            self.target(kind, &format!("MR {radius}"), measured, (Side::AtLeast, least, AS_FAST))
        };
        let is_sparse = [SPARSE, MOSTLY_EMPTY].contains(&self.rows.map.name.as_str());
        let [short, long] = MAX_RADII;
        vec![gain(short, 3.0), gain(long, if is_sparse { 4.5 } else { 3.0 })]
    }

    fn target(&self, kind: (&str, &str), question: &str, measured: Option<f64>, bound: Bound) -> Target {
        Target::new(kind, self.rows.map, question.to_owned(), measured, bound)
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
}

/// Nothing if one is missing, or the second too short to be measured.
fn ratio(time: Option<f64>, against: Option<f64>) -> Option<f64> {
    let against = against.filter(|&against| against > 0.0)?;
    Some(time? / against)
}
