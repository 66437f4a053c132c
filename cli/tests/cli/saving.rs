//! Long runs whose last save fails say how to go on, and do so.
#![cfg(unix)]

use std::process::Output;

use crate::Workplace;

/// Runs the program where no file may grow past `blocks` of 512 bytes, which stands for a full disk.
fn with_little_room(place: &Workplace, blocks: u32, arguments: &str) -> Output {
    let program = assert_cmd::cargo::cargo_bin("varikernel");
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec '{}' {arguments}", program.display());
    std::process::Command::new("sh")
        .args(["-c", &script])
        .current_dir(place.folder.path())
        .env("MESA_SHADER_CACHE_DISABLE", "true")
        .output()
        .unwrap()
}

/// The command that the help names, without the program.
fn command_in(output: &Output, before: &str) -> String {
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    let help = stderr.lines().find_map(|line| line.strip_prefix(before));
    let command = help.unwrap_or_else(|| panic!("{before:?} is not in: {stderr}"));
    command.split_once(' ').unwrap().1.to_owned()
}

const BENCH: &str = "bench --sizes 16 --methods sat --searches binary --sat-build scan --budget 2s";

#[test]
fn a_bench_without_room_names_the_same_command() {
    let place = Workplace::new();
    let output = with_little_room(&place, 1, &format!("{BENCH} --json run.json"));
    let again = command_in(&output, "help: make room on the disk, then run it again: ");
    assert_eq!(again, format!("{BENCH} --json run.json"));
    // The answer itself is printed all the same, and one warning for all saves that failed.
    assert!(String::from_utf8_lossy(&output.stdout).contains("sat-scan"));
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(stderr.matches("this run goes on, and saves again later").count(), 1, "{stderr}");
    assert_eq!(place.content().len(), 0, "no unfinished file");
    place.answer(&again);
    assert_eq!(place.content().into_keys().collect::<Vec<_>>(), ["run.json"]);
}

#[test]
fn a_bench_that_saved_names_the_command_that_goes_on() {
    let place = Workplace::new();
    place.answer(&format!("{BENCH} --json run.json"));
    let before = place.bytes("run.json");
    let output = with_little_room(&place, 1, &format!("{BENCH} --resume run.json"));
    let resume = command_in(&output, "help: make room on the disk, then go on with what was saved: ");
    assert_eq!(resume, format!("{BENCH} --resume run.json"));
    assert!(place.bytes("run.json") == before);
    place.answer(&resume);
}
