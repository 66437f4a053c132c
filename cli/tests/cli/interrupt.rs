//! Signals end the program as their sender expects, and no unfinished file stays.
#![cfg(unix)]

use std::os::unix::process::ExitStatusExt as _;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use crate::Workplace;

const HANGUP: i32 = 1;
const INTERRUPT: i32 = 2;
const TERMINATE: i32 = 15;

/// Signals are heard even where the tests were started with `nohup` or in the background of a script, which
/// ignore some of them for all that is started below.
fn listening() -> Command {
    let program = assert_cmd::cargo::cargo_bin("varikernel");
    if cfg!(not(target_os = "linux")) {
        return Command::new(program);
    }
    let mut command = Command::new("env");
    command.arg("--default-signal=HUP,INT,TERM").arg(program);
    command
}

fn start(place: &Workplace, arguments: &str) -> Child {
    listening()
        .args(arguments.split_whitespace())
        .current_dir(place.folder.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// Waits until a file in the folder is called so.
fn wait_for(place: &Workplace, child: &mut Child, is_wanted: impl Fn(&str) -> bool) {
    let begun = Instant::now();
    while !place.content().keys().any(|name| is_wanted(name)) {
        assert!(begun.elapsed() < Duration::from_mins(1), "{:?}", place.content().keys());
        assert!(child.try_wait().unwrap().is_none(), "it ended too early");
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn send(child: &mut Child, signal: i32) -> ExitStatus {
    let sent = Command::new("kill").arg(format!("-{signal}")).arg(child.id().to_string()).status();
    assert!(sent.unwrap().success());
    child.wait().unwrap()
}

#[test]
fn photons_that_are_interrupted_leave_nothing() {
    let place = Workplace::new();
    place.put("old.npy", b"old");
    for name in ["old.npy", "new.npy", "new.csv", "new.ply"] {
        for signal in [INTERRUPT, TERMINATE, HANGUP] {
            let mut child = start(&place, &format!("photons cornell-glass -o {name} --photons 1e9"));
            wait_for(&place, &mut child, |found| found.contains(".part"));
            let status = send(&mut child, signal);
            assert_eq!(status.signal(), Some(signal), "{name}: {status}");
            assert_eq!(place.content().into_keys().collect::<Vec<_>>(), ["old.npy"], "{name}");
            assert_eq!(place.bytes("old.npy"), b"old");
        }
    }
}

#[test]
fn a_shell_sees_the_signal() {
    let place = Workplace::new();
    // The shell sends it, as it waits in the foreground and has no job control.
    let script = format!(
        "'{}' photons -o a.npy --photons 1e9 & while ! ls .a.npy*.part >/dev/null 2>&1; do sleep 0.01; done; \
         kill -TERM $!; wait $!; echo $?; ls -A",
        assert_cmd::cargo::cargo_bin("varikernel").display()
    );
    let output = Command::new("sh").args(["-c", &script]).current_dir(place.folder.path()).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stdout), "143\n");
}

#[cfg(target_os = "linux")]
#[test]
fn a_signal_that_is_ignored_stays_so() {
    let place = Workplace::new();
    // What `nohup` does; the program goes on when its terminal is closed.
    let script = format!(
        "trap '' HUP; exec '{}' photons -o a.npy --photons 1e9",
        assert_cmd::cargo::cargo_bin("varikernel").display()
    );
    let mut child = Command::new("sh")
        .args(["-c", &script])
        .current_dir(place.folder.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_for(&place, &mut child, |found| found.contains(".part"));
    let sent = Command::new("kill").args(["-HUP", &child.id().to_string()]).status();
    assert!(sent.unwrap().success());
    std::thread::sleep(Duration::from_millis(300));
    assert!(child.try_wait().unwrap().is_none(), "it goes on");
    assert_eq!(send(&mut child, TERMINATE).signal(), Some(TERMINATE));
    assert_eq!(place.content().len(), 0);
}

#[test]
fn a_study_that_is_interrupted_leaves_what_it_saved() {
    let place = Workplace::new();
    let mut child =
        start(&place, "bench --json run.json --sizes 32 --methods sat --budget 60s --protocol thesis");
    wait_for(&place, &mut child, |found| found == "run.json");
    assert_eq!(send(&mut child, INTERRUPT).signal(), Some(INTERRUPT));
    assert_eq!(place.content().into_keys().collect::<Vec<_>>(), ["run.json"]);
    serde_json::from_slice::<serde_json::Value>(&place.bytes("run.json")).unwrap();
}
