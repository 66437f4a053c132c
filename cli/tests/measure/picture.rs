//! The suite of a picture: its rows, its targets and its command.

use std::time::Duration;

use assert_cmd::Command;
use predicates::str::contains;
use varikernel_lab::bench::{PictureReport, PictureSuite};

const ROWS: [&str; 11] = [
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
    "photons",
];

fn check(report: &PictureReport) {
    let names: Vec<_> = report.rows.iter().map(|row| row.name.as_str()).collect();
    assert_eq!(names, ROWS);
    for row in &report.rows {
        assert!(row.statistics.median_ms > 0.0 && row.samples_ms.len() == row.statistics.count, "{row:?}");
        assert!(row.right, "{row:?}");
        let is_splat = row.name.starts_with("splat");
        assert_eq!((row.fragments_per_photon.is_some(), row.ns_per_fragment.is_some()), (is_splat, is_splat));
        assert_eq!(row.point_passes.is_some(), row.name != "photons");
        assert_eq!(row.copies.is_some(), row.name != "photons");
    }
    assert!(report.contributing > report.drawn / 2 && report.contributing <= report.drawn, "{report:?}");
    // Each row is given in the unit, and each target from its row.
    let (copy, unit, density) = (&report.rows[0], &report.rows[1], &report.rows[2]);
    let ratio = density.statistics.median_ms / unit.statistics.median_ms;
    let [against_points, traced] = report.targets.as_slice() else { panic!("{:?}", report.targets) };
    assert_eq!((copy.copies, unit.point_passes), (Some(1.0), Some(1.0)));
    let copies = density.statistics.median_ms / copy.statistics.median_ms;
    assert!((density.copies.unwrap() / copies - 1.0).abs() < 1e-9);
    assert!((against_points.measured.unwrap() / ratio - 1.0).abs() < 1e-9);
    assert_eq!(against_points.holds, ratio <= 6.0);
    let seconds = report.rows[10].statistics.median_ms / 1e3 / (f64::from(report.suite.photons) / 1e6);
    assert!((traced.measured.unwrap() - seconds).abs() < 1e-9, "{traced:?}");
    // A disc of radius 2 covers some 25 pixels, more as a quad around it.
    let fixed = report.rows[5].fragments_per_photon.unwrap();
    assert!((25.0..250.0).contains(&fixed), "{fixed}");
}

#[test]
fn every_stage_is_timed_and_its_answer_right() {
    let suite = PictureSuite { size: [48, 40], photons: 3000, samples: 3, ..PictureSuite::default() };
    let mut saved: Vec<(PictureReport, f64)> = Vec::new();
    let mut save = |report: &PictureReport, done: f64| {
        saved.push((report.clone(), done));
        Ok(())
    };
    let report = suite.run(&crate::egl(), Duration::from_mins(1), &mut save).unwrap();
    assert_eq!(saved.len(), 3);
    for (index, (report, done)) in saved.iter().enumerate() {
        assert!(report.rows.iter().all(|row| row.samples_ms.len() == index + 1), "{report:?}");
        assert!(*done > 0.0 && *done <= 1.0);
    }
    assert_eq!(saved[2], (report.clone(), 1.0));
    assert!(report.rows.iter().all(|row| row.samples_ms.len() == 3));
    check(&report);
}

#[test]
fn the_command_writes_what_it_found_and_refuses_what_it_does_not_take() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("picture.json");
    let bench = |options: &[&str]| {
        let mut command = Command::cargo_bin("varikernel").unwrap();
        command.args(["bench", "--suite", "picture", "--photons", "2000", "--budget", "2s"]).args(options);
        command
    };
    bench(&["--sizes", "32", "--json", file.to_str().unwrap()])
        .assert()
        .success()
        .stdout(contains("splat-variable"))
        .stdout(contains("density, in point-only passes"));
    check(&serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap());
    bench(&["--sizes", "32,64"]).assert().code(2).stderr(contains("--sizes"));
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
