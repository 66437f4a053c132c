//! The suite of the fast path: its rows, its targets and its command.

use std::sync::LazyLock;

use assert_cmd::Command;
use predicates::str::contains;
use varikernel::settings::{Edges, Faults, Order};
use varikernel_lab::bench::{
    self, AUTO, BenchSettings, FastSuite, Protocol, Report, Run, Side, Situation, Stage, Target,
};

const SIZE: [u32; 2] = [96, 80];
const MAPS: [&str; 5] = ["uniform-sparse", "uniform-dense", "caustic", "step", "mostly-empty"];

fn settings() -> BenchSettings {
    let suite = FastSuite { sizes: vec![SIZE], build_sizes: vec![[32, 32]] };
    BenchSettings::fast(suite, Protocol { sets: 1, iterations: 3, budget_s: 300.0 })
}

fn run(earlier: Option<Report>) -> Report {
    let settings = settings();
    let maps = settings.suite.as_ref().unwrap().maps();
    bench::run(&crate::egl(), &settings, &maps, earlier, &mut |_, _| Ok(())).unwrap()
}

/// A run on small maps, three samples a case: an edit goes back and forth.
static REPORT: LazyLock<Report> = LazyLock::new(|| run(None));

#[test]
fn every_row_is_there_with_the_right_answer() {
    let report = &*REPORT;
    assert_eq!(report.left_out, []);
    for run in &report.runs {
        assert_eq!(run.wrong_pixels, 0, "{}", run.case);
    }
    let count = |of: &dyn Fn(&Run) -> bool| report.runs.iter().filter(|run| of(run)).count();
    for map in MAPS {
        let of_stage = |stage| {
            count(&|run| {
                let case = &run.case;
                case.stage == stage && case.map == map && case.size == SIZE && case.situation().is_none()
            })
        };
        // Three orders at two MR, the bracketed one at a third and with zero edges at three; four frames of
        // the thesis, three of the scan and the planner's, at two MR.
        assert_eq!([Stage::Copy, Stage::Probe, Stage::Search, Stage::Frame].map(of_stage), [1, 1, 10, 16]);
        assert_eq!(of_stage(Stage::Build), if map == "caustic" { 3 } else { 0 });
    }
    assert_eq!(count(&|run| run.case.size == [32, 32]), 2 + 3);
    for situation in Situation::ALL {
        let runs: Vec<_> = report.runs.iter().filter(|run| run.case.situation() == Some(situation)).collect();
        let [run] = runs.as_slice() else { panic!("{situation:?}: {} rows", runs.len()) };
        let case = &run.case;
        assert_eq!((case.variant.as_str(), case.map.as_str()), (situation.name(), "caustic"));
        assert_eq!((case.max_radius, case.search), (Some(32), Some(Order::Bracketed)));
    }
    for run in report.runs.iter().filter(|run| run.case.variant == AUTO) {
        let planned = run.planned.as_deref().unwrap();
        assert!(planned.contains(": radii of about"), "{planned}");
    }
    let ranked = report.ranking(Stage::Frame, "caustic", SIZE);
    assert!(ranked.len() == 16, "situations are not ranked");
}

#[test]
fn a_planted_fault_is_seen_in_every_frame_that_counts() {
    let mut settings = settings();
    settings.base.laboratory.faults = Faults { border_test: true, ..Faults::NONE };
    settings.base.search.order = Order::Binary;
    let maps = settings.suite.as_ref().unwrap().maps();
    let caustic = maps.into_iter().find(|map| map.info.name == "caustic" && map.info.size == SIZE).unwrap();
    let report = bench::run(&crate::egl(), &settings, &[caustic], None, &mut |_, _| Ok(())).unwrap();
    let counted = report.runs.iter().filter(|run| !matches!(run.case.stage, Stage::Copy | Stage::Probe));
    assert!(counted.clone().count() > 0 && counted.clone().all(Run::is_wrong));
    let refused = report.left_out.iter().filter(|left_out| left_out.case.situation().is_some());
    assert_eq!(refused.count(), Situation::ALL.len(), "a bracketed search runs without faults alone");
    assert!(report.targets.iter().all(|target| target.measured.is_none() && !target.holds));
}

#[test]
fn files_hold_targets_and_are_resumed_and_compared() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.json");
    REPORT.save(&path).unwrap();
    let loaded = Report::load(&path).unwrap();
    assert_eq!(loaded.settings, REPORT.settings);
    assert_eq!(named(&loaded), named(&REPORT));
    let json: serde_json::Value = serde_json::from_reader(std::fs::File::open(&path).unwrap()).unwrap();
    for name in ["name", "what", "map", "size", "question", "measured", "side", "bound", "unit", "holds"] {
        assert!(!json["targets"][0][name].is_null(), "targets[].{name}");
    }

    loaded.check_resumable(&path, &REPORT).unwrap();
    let mut part = REPORT.clone();
    part.runs.truncate(40);
    let resumed = run(Some(part.clone()));
    assert!(resumed.runs[..40] == part.runs[..], "whole cases are not measured again");
    assert_eq!((resumed.runs.len(), named(&resumed)), (loaded.runs.len(), named(&loaded)));
    let comparison = bench::compare(&loaded, &resumed);
    assert_eq!(comparison.both.len(), loaded.runs.len());
    assert!(comparison.only_old.is_empty() && comparison.only_new.is_empty());

    let mut other = settings();
    other.suite = Some(FastSuite { sizes: vec![SIZE], build_sizes: Vec::new() });
    let now = Report { settings: other, ..loaded.clone() };
    assert!(loaded.check_resumable(&path, &now).unwrap_err().to_string().contains("other settings"));
}

fn named(report: &Report) -> Vec<(String, String)> {
    report.targets.iter().map(|target| (target.name.clone(), target.map.clone())).collect()
}

/// A report by hand: the rows of a run, as if it had been of 1024 x 1024, and times that meet each bound just
/// so.
fn by_hand() -> Report {
    let mut report = REPORT.clone();
    let large = [1024, 1024];
    let suite = report.settings.suite.as_mut().unwrap();
    suite.sizes = vec![large];
    for size in report.maps.iter_mut().map(|map| &mut map.size) {
        *size = if *size == SIZE { large } else { *size };
    }
    for run in &mut report.runs {
        if run.case.size == SIZE {
            run.case.size = large;
        }
        run.statistics.median_ms = milliseconds(run);
        run.mean_radius = run.mean_radius.map(|_| if run.case.map == "step" { 4.5 } else { 3.5 });
    }
    report
}

/// Powers of two and their sums, so that ratios are exact.
fn milliseconds(run: &Run) -> f64 {
    let case = &run.case;
    let is_long = case.max_radius != Some(32);
    match (case.stage, case.variant.as_str(), case.search) {
        (Stage::Copy, ..) => 8.0,
        (Stage::Probe, ..) => 16.0,
        (Stage::Build, "sat-scan", _) => 28.0,
        (Stage::Build, "sat-doubling-2", _) => 140.0,
        (Stage::Build, ..) => 150.0,
        (Stage::Search, "sat-scan-none-masked", _) => 44.0,
        (Stage::Search, "sat-scan-half-masked", _) => 24.0,
        (Stage::Search, _, Some(Order::Bracketed)) if case.edges == Some(Edges::Zero) => 48.0,
        (Stage::Search, _, Some(Order::Bracketed)) | (Stage::Certify, ..) => 40.0,
        (Stage::Search, _, Some(Order::Binary)) => 41.0,
        (Stage::Search, ..) => 100.0,
        (Stage::Frame, AUTO, _) => 64.0,
        (Stage::Frame, "sat-scan-empty" | "sat-scan-empty-unknown", _) => 12.0,
        (Stage::Frame, "sat-scan-quarter", _) => 36.0,
        (Stage::Frame, "sat-scan-unchanged", _) => 0.75,
        (Stage::Frame, "sat-scan-tile-changed" | "sat-scan-corner-changed", _) => 15.0,
        (Stage::Frame, "sat-scan", Some(Order::Bracketed)) => 60.0,
        (Stage::Frame, "sat-scan", _) => 70.0,
        (Stage::Frame, "sat-doubling-4", Some(Order::Binary)) if is_long => 64.0 * 4.5,
        (Stage::Frame, "sat-doubling-4", Some(Order::Binary)) => 64.0 * 3.0,
        (Stage::Frame, ..) => 500.0,
    }
}

/// The one target of a name, map and question.
fn target<'a>(report: &'a Report, name: &str, map: &str, question: &str) -> &'a Target {
    let is_it =
        |target: &&Target| target.name == name && target.map == map && target.question.starts_with(question);
    let found: Vec<_> = report.targets.iter().filter(is_it).collect();
    let [target] = found.as_slice() else { panic!("{name}, {map}, {question}: {found:?}") };
    target
}

#[test]
fn targets_by_hand() {
    let mut report = by_hand();
    report.update_targets();
    let failing: Vec<_> = report.targets.iter().filter(|target| !target.holds).collect();
    assert!(failing.is_empty(), "{failing:?}");
    let of = |name, map, question| {
        let found = target(&report, name, map, question);
        (found.measured.unwrap(), found.side, found.bound)
    };
    let (at_most, at_least) = (Side::AtMost, Side::AtLeast);
    assert_eq!(of("build", "caustic", ""), (3.5, at_most, 3.5));
    assert_eq!(of("build-gain", "caustic", ""), (5.0, at_least, 5.0));
    assert_eq!(of("build-small", "caustic", ""), (0.2, at_most, 1.0));
    assert_eq!(of("bracketed", "step", "MR 32, edges zero"), (3.0, at_most, 3.0));
    assert_eq!(of("bracketed-mr", "step", ""), (1.0, at_most, 1.1));
    assert_eq!(of("bracketed-rank", "caustic", "MR 256, mean radius 3.5"), (40.0 / 41.0, at_most, 1.1));
    assert_eq!(of("bracketed-rank", "step", "MR 32, mean radius 4.5"), (40.0 / 41.0, Side::Below, 1.0));
    assert_eq!(of("auto", "mostly-empty", "MR 32"), (64.0 / 60.0, at_most, 1.1));
    assert_eq!(of("empty", "caustic", "known to be"), (1.5, at_most, 1.5));
    assert_eq!(of("empty", "caustic", "known to have 1"), (1.5, at_most, 1.5));
    assert_eq!(of("quarter", "caustic", ""), (0.6, at_most, 0.6));
    assert_eq!(of("half-masked", "caustic", "a mask of all"), (24.0 / 44.0, at_most, 0.6));
    assert_eq!(of("half-masked", "caustic", "without"), (0.6, at_most, 0.6));
    assert_eq!(of("unchanged", "caustic", ""), (0.75 / 8.0, at_most, 0.1));
    assert_eq!(of("tile", "caustic", "in the middle"), (0.25, at_most, 0.3));
    assert_eq!(of("tile", "caustic", "at the lower left"), (0.25, at_most, 0.3));
    assert_eq!(of("certify", "caustic", ""), (2.5, at_most, 2.5));
    assert_eq!(of("frame", "step", "MR 32"), (3.0, at_least, 3.0));
    assert_eq!(of("frame", "step", "MR 256"), (4.5, at_least, 3.0));
    assert_eq!(of("frame", "uniform-sparse", "MR 256"), (4.5, at_least, 4.5));
    assert_eq!(of("frame", "mostly-empty", "MR 256"), (4.5, at_least, 4.5));
}

#[test]
fn a_planted_failure_is_seen_and_a_wrong_row_is_no_measure() {
    let planted = |change: &dyn Fn(&mut Run)| {
        let mut report = by_hand();
        report.runs.iter_mut().for_each(change);
        report.update_targets();
        let failing = report.targets.iter().filter(|target| !target.holds);
        failing.map(|target| (target.name.clone(), target.map.clone(), target.measured)).collect::<Vec<_>>()
    };
    let failed = |name: &str, map: &str, measured| (name.to_owned(), map.to_owned(), measured);
    let certify = |run: &Run| run.case.situation() == Some(Situation::Certify);
    let slower = planted(&|run| {
        if certify(run) {
            run.statistics.median_ms = 48.0;
        }
    });
    assert_eq!(slower, [failed("certify", "caustic", Some(3.0))]);
    let wrong = planted(&|run| run.wrong_pixels = u64::from(certify(run)));
    assert_eq!(wrong, [failed("certify", "caustic", None)]);
    // The best of the others would not be the best of all.
    let gone = planted(&|run| {
        let is_it = run.case.variant == "sat-doubling-2" && run.case.search == Some(Order::Forward);
        run.wrong_pixels = u64::from(is_it && run.case.map == "step" && run.case.max_radius == Some(32));
    });
    assert_eq!(gone, [failed("auto", "step", None), failed("frame", "step", None)]);
    // With a mean radius above 4 the target is more than to be no slower.
    let rank = planted(&|run| {
        let is_it = run.case.stage == Stage::Search && run.case.search == Some(Order::Binary);
        if is_it && run.case.max_radius == Some(32) {
            run.statistics.median_ms = 40.0;
        }
    });
    assert_eq!(rank, [failed("bracketed-rank", "step", Some(1.0))]);
}

#[test]
fn the_command_prints_verdicts_and_writes_them() {
    let folder = tempfile::tempdir().unwrap();
    let (json, csv) = (folder.path().join("run.json"), folder.path().join("run.csv"));
    let command = |options: &str| {
        let mut command = Command::cargo_bin("varikernel").unwrap();
        command.args(["bench", "--device", "egl", "--suite", "fast"]).args(options.split_whitespace());
        command
    };
    let assert = command("--sizes 24 --build-sizes 16,8 --rivals --budget 10s")
        .arg("--json")
        .arg(&json)
        .arg("--csv")
        .arg(&csv)
        .assert()
        .success();
    let text = String::from_utf8(assert.get_output().stdout.clone()).unwrap();
    for line in text.lines() {
        assert!(line.chars().count() <= 80, "{line}");
    }
    for words in ["bracketed-rank, in times as long:", "targets hold,", "half-masked", "cpu-scanline-1*"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let report = Report::load(&json).unwrap();
    let timed = report.runs.len() + report.left_out.len();
    assert_eq!(timed, 2 * (2 + 3) + 5 * (2 + 10 + 16 + 4 + 1) + 3 + Situation::ALL.len());
    assert_eq!(std::fs::read_to_string(&csv).unwrap().lines().count(), 1 + report.runs.len());
    assert!(!report.targets.is_empty());

    command("--methods sat").assert().code(2).stderr(contains("cannot be used with"));
    command("--map step").assert().code(2).stderr(contains("cannot be used with"));
    let mut without = Command::cargo_bin("varikernel").unwrap();
    without.args(["bench", "--build-sizes", "8"]).assert().code(2).stderr(contains("--suite"));
}
