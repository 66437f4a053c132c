//! `varikernel reproduce`: a whole folder within seconds, gone on with, and refused where it can't be.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt as _;
use predicates::str::contains;
use varikernel_lab::reproduce::RunFile;
use varikernel_lab::thesis::{claims, tables};

fn reproduce(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("varikernel").unwrap();
    command.args(["reproduce", "--budget", "5s", "-o"]).arg(folder);
    command
}

#[test]
fn a_short_budget_gives_every_file_and_says_what_it_left_out_and_a_second_run_goes_on() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("out");
    let printed = reproduce(&folder).assert().success().get_output().stdout.clone();
    let printed = String::from_utf8(printed).unwrap();
    assert!(printed.lines().all(|line| line.chars().count() <= 80), "{printed}");
    assert!(printed.contains("claims:") && printed.contains("report.html"), "{printed}");

    let html = fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(html.contains("llvmpipe") || html.contains("hardware"), "the environment is told");
    assert!(html.contains("Other maps"), "the sparse, dense and real maps are told");
    let rows = csv::Reader::from_path(folder.join("claims.csv")).unwrap().into_records().count();
    assert_eq!(rows, claims::all().len());
    for table in tables::all() {
        let rows = fs::read_to_string(folder.join(format!("tables/a{}.csv", table.number))).unwrap();
        assert_eq!(rows.lines().count(), table.rows.len() + 1, "A.{}", table.number);
    }
    assert!(fs::read_to_string(folder.join("figures/5.13.svg")).unwrap().starts_with("<svg"));
    let samples = || {
        let run = RunFile::load(&folder.join("run.json")).unwrap();
        let parts = run.parts.iter().flat_map(|part| &part.report.runs);
        parts.map(|run| run.samples_ms.len()).sum::<usize>()
    };
    let before = samples();
    assert!(before > 0);
    assert!(RunFile::load(&folder.join("run.json")).unwrap().gains.iter().all(|gain| gain.wrong_pixels == 0));

    reproduce(&folder).arg("--resume").assert().success();
    assert!(samples() > before, "the samples of the first run are kept");

    // What another device measured is not mixed with this one's.
    let text = fs::read_to_string(folder.join("run.json")).unwrap();
    fs::write(folder.join("run.json"), text.replace("\"renderer\":\"", "\"renderer\":\"another ")).unwrap();
    reproduce(&folder).arg("--resume").assert().code(2).stderr(contains("another").and(contains("resume")));
}

#[test]
fn what_cannot_be_done_is_refused_before_anything_is_timed() {
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("file");
    fs::write(&file, "not a folder").unwrap();
    reproduce(&file.join("out")).assert().code(2).stderr(contains("can't make the folder"));
    let empty = place.path().join("empty");
    reproduce(&empty).arg("--resume").assert().code(2).stderr(contains("run.json").and(contains("help:")));
    Command::cargo_bin("varikernel")
        .unwrap()
        .args(["reproduce", "--budget", "1s", "-o"])
        .arg(place.path().join("short"))
        .assert()
        .code(2)
        .stderr(contains("--budget"));
    fs::write(empty.join("run.json"), "{\"parts\":").unwrap();
    reproduce(&empty).arg("--resume").assert().code(2).stderr(contains("is not the file of a run"));
}
