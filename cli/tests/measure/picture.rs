//! The suite of a picture: its rows, its targets and its command.

use std::time::Duration;

use assert_cmd::Command;
use predicates::str::contains;
use varikernel_lab::bench::{PictureCase, PictureReport, PictureSuite};

const ROWS: [&str; 18] = [
    "copy",
    "points",
    "density",
    "radius",
    "splat-variable",
    "splat-fixed",
    "gather",
    "flux",
    "tables",
    "tables-moved",
    "whole",
    "photons",
    "stage-flux",
    "stage-areas",
    "stage-tables",
    "stage-tests",
    "stage-gather",
    "stage-smoothing",
];

fn check(report: &PictureReport) {
    for case in &report.cases {
        check_case(case);
    }
    for (case, target) in report.cases.iter().zip(&report.targets) {
        let [.., density] = &case.rows[..3] else { panic!("{case:?}") };
        let ratio = density.statistics.median_ms / case.rows[1].statistics.median_ms;
        assert!((target.measured.unwrap() / ratio - 1.0).abs() < 1e-9 && target.name == "density");
        assert_eq!((target.holds, target.size), (ratio <= 6.0, case.size));
    }
    for (case, target) in report.cases.iter().zip(&report.targets[report.cases.len()..]) {
        let seconds = case.rows[11].statistics.median_ms / 1e3 / (f64::from(case.photons) / 1e6);
        assert!((target.measured.unwrap() - seconds).abs() < 1e-9 && target.name == "photons", "{target:?}");
    }
    assert_eq!(report.targets.len(), 2 * report.cases.len(), "tables are judged at 1080p");
}

fn check_case(case: &PictureCase) {
    let names: Vec<_> = case.rows.iter().map(|row| row.name.as_str()).collect();
    assert_eq!(names, ROWS);
    assert_eq!(case.left_out, []);
    for row in &case.rows {
        assert!(row.statistics.median_ms > 0.0 && row.samples_ms.len() == row.statistics.count, "{row:?}");
        assert!(row.right, "{row:?}");
        let is_splat = row.name.starts_with("splat");
        assert_eq!((row.fragments_per_photon.is_some(), row.ns_per_fragment.is_some()), (is_splat, is_splat));
        assert_eq!(row.point_passes.is_some(), row.name != "photons");
        assert_eq!(row.copies.is_some(), row.name != "photons");
    }
    assert!(case.contributing > case.drawn / 2 && case.contributing <= case.drawn, "{case:?}");
    // Each row is given in the unit.
    let (copy, points, density) = (&case.rows[0], &case.rows[1], &case.rows[2]);
    assert_eq!((copy.copies, points.point_passes), (Some(1.0), Some(1.0)));
    let copies = density.statistics.median_ms / copy.statistics.median_ms;
    assert!((density.copies.unwrap() / copies - 1.0).abs() < 1e-9);
    // A disc of radius 2 covers some 25 pixels, more as a quad around it.
    let fixed = case.rows[5].fragments_per_photon.unwrap();
    assert!((25.0..250.0).contains(&fixed), "{fixed}");
}

#[test]
fn every_stage_is_timed_and_its_answer_right() {
    let suite = PictureSuite {
        sizes: vec![[48, 40], [20, 33]],
        photons: vec![3000],
        samples: 3,
        ..PictureSuite::default()
    };
    let mut saved: Vec<(PictureReport, f64)> = Vec::new();
    let mut save = |report: &PictureReport, done: f64| {
        saved.push((report.clone(), done));
        Ok(())
    };
    let report = suite.run(&crate::egl(), Duration::from_mins(4), &mut save).unwrap();
    assert_eq!(saved.len(), 6);
    for (index, (report, done)) in saved.iter().enumerate() {
        let last = report.cases.last().unwrap();
        assert!(last.rows.iter().all(|row| row.samples_ms.len() == index % 3 + 1), "{last:?}");
        assert_eq!(report.cases.len(), index / 3 + 1);
        assert!(*done > 0.0 && *done <= 1.0);
    }
    assert_eq!(saved[5], (report.clone(), 1.0));
    assert_eq!(report.cases[0], saved[2].0.cases[0], "what is over stays");
    check(&report);
}

#[test]
fn the_command_writes_what_it_found_and_refuses_what_it_does_not_take() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("picture.json");
    let bench = |options: &[&str]| {
        let mut command = Command::cargo_bin("varikernel").unwrap();
        command.args(["bench", "--suite", "picture", "--photons", "2000", "--budget", "4s"]).args(options);
        command
    };
    bench(&["--sizes", "32,24x40", "--json", file.to_str().unwrap()])
        .assert()
        .success()
        .stdout(contains("splat-variable"))
        .stdout(contains("24 x 40, 2000 photons traced"))
        .stdout(contains("stage-smoothing"))
        .stdout(contains("density, in point-only passes"));
    check(&serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap());
    for refused in [
        ["--rivals"].as_slice(),
        &["--build-sizes", "64"],
        &["--protocol", "thesis"],
        &["--storage", "f32"],
        &["--csv", "a.csv"],
    ] {
        bench(refused).assert().code(2).stderr(contains(refused[0]));
    }
    let mut fast = Command::cargo_bin("varikernel").unwrap();
    fast.args(["bench", "--suite", "fast", "--photons", "2000"]);
    fast.assert().code(2).stderr(contains("--photons"));
}
