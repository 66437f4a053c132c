//! `varikernel bench` as a user runs it.

use std::path::Path;
use std::time::{Duration, Instant};

use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt as _;
use predicates::str::contains;
use varikernel_lab::bench::Report;

/// `varikernel bench` on EGL; `options` is split at spaces.
fn bench(options: &str) -> Command {
    let mut command = Command::cargo_bin("varikernel").unwrap();
    command.args(["bench", "--device", "egl"]).args(options.split_whitespace());
    command
}

fn names(report: &Report) -> Vec<String> {
    report.runs.iter().map(|run| run.case.to_string()).collect()
}

#[test]
fn a_killed_run_goes_on_where_it_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.json");
    let options = "--sizes 64 --methods sat,pyramid --searches forward";
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin!("varikernel"))
        .args(["bench", "--device", "egl", "--budget", "60s", "--protocol", "thesis", "--json"])
        .arg(&file)
        .args(options.split(' '))
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let start = Instant::now();
    while !Report::load(&file).is_ok_and(|report| report.runs.len() >= 3) {
        assert!(start.elapsed() < Duration::from_secs(30), "nothing was saved");
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();

    let before = Report::load(&file).unwrap();
    let resume = format!("{options} --protocol thesis --budget 1s --resume");
    bench(&resume).arg(&file).assert().success().stdout(contains("sat-doubling-4"));
    let after = Report::load(&file).unwrap();
    assert_eq!(names(&after)[..before.runs.len()], names(&before)[..]);
    for (before, after) in before.runs.iter().zip(&after.runs) {
        assert_eq!(after.samples_ms[..before.samples_ms.len()], before.samples_ms[..], "{}", before.case);
    }
    assert!(after.runs.len() > before.runs.len() || after.runs[0].sets.len() > before.runs[0].sets.len());
}

#[test]
fn a_run_of_something_else_is_not_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.json");
    let options = "--sizes 16 --methods sat --searches binary --budget 1s";
    bench(options).arg("--json").arg(&file).assert().success();
    let refused = |options: &str, why: &str| {
        let before = std::fs::read(&file).unwrap();
        bench(options)
            .arg("--resume")
            .arg(&file)
            .assert()
            .code(2)
            .stderr(contains("can't be resumed").and(contains(why)).and(contains("help:")));
        assert_eq!(std::fs::read(&file).unwrap(), before, "the file is as it was");
    };
    refused(&format!("{options} -r 16"), "other settings");
    refused(&options.replace("16", "32"), "other maps or sizes");
    let change = |from: &dyn Fn(&mut Report)| {
        let mut report = Report::load(&file).unwrap();
        from(&mut report);
        report.save(&file).unwrap();
    };
    change(&|report| report.program = "0.0.1".to_owned());
    refused(options, "version 0.0.1");
    change(&|report| report.device.renderer = "GeForce GTX 480".to_owned());
    refused(options, "GeForce GTX 480");
}

#[test]
fn mistakes_are_told_before_anything_is_timed() {
    let refused = |options: &str, why: &str| {
        bench(options).assert().code(2).stderr(contains(why));
    };
    refused("--sizes 64,zero", "zero");
    refused("--sizes 0", "a side goes from 1");
    refused("--map no-such-kind", "neither a readable file nor one of");
    refused("--budget 5", "time unit");
    refused("--min-photons 0", "give a whole number from 1 to 4294967295");
    refused("--max-radius -3", "give a whole number from 1 to 32767");
    refused("--json /no/such/folder/run.json", "/no/such/folder does not exist");
    refused("--resume /no/such/run.json", "/no/such does not exist");
}

#[test]
fn a_budget_that_is_too_small_says_what_was_left_out() {
    bench("--sizes 16 --budget 1ns")
        .assert()
        .code(2)
        .stdout(contains("left out").and(contains("budget")))
        .stderr(contains("no method was timed"));
}

#[test]
fn a_table_fits_80_columns() {
    let output =
        bench("--sizes 16,8 --methods naive-mipmap,averaged-mipmap,sat --sat-samples 16 --budget 2s")
            .assert()
            .success()
            .get_output()
            .stdout
            .clone();
    let text = String::from_utf8(output).unwrap();
    for line in text.lines() {
        assert!(line.chars().count() <= 80, "{line}");
    }
    assert!(text.contains("caustic 16 x 16: n 25, MR 32, edges scale"), "{text}");
    assert!(text.contains("its own") && text.contains("exact"), "{text}");
}

#[test]
fn a_run_compared_with_itself_and_with_a_slower_one() {
    let folder = tempfile::tempdir().unwrap();
    let (old, new) = (folder.path().join("old.json"), folder.path().join("new.json"));
    bench("--sizes 16 --methods sat --searches binary --sat-samples 4 --budget 20s")
        .arg("--json")
        .arg(&old)
        .assert()
        .success();
    let compared = |old: &Path, new: &Path| {
        let mut command = Command::cargo_bin("varikernel").unwrap();
        let assert = command.args(["bench", "--compare"]).args([old, new]).assert().success();
        String::from_utf8(assert.get_output().stdout.clone()).unwrap()
    };
    let text = compared(&old, &old);
    assert!(text.contains("1.000  no difference") && !text.contains(" slower\n"), "{text}");

    let mut report = Report::load(&old).unwrap();
    for run in &mut report.runs {
        run.statistics.median_ms *= 100.0;
        for set in &mut run.sets {
            set.median_ms *= 100.0;
        }
    }
    report.save(&new).unwrap();
    let text = compared(&old, &new);
    assert_eq!(text.matches(" slower\n").count(), report.runs.len(), "{text}");
    assert_eq!(compared(&new, &old).matches(" faster\n").count(), report.runs.len());
}
