//! OSMesa, which systems with Mesa 25.1 or newer do not offer: what only it can show is counted as absent there, by name.

use std::io::{self, Write as _};
use std::panic::Location;
use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;

use varikernel::context::{self, DeviceChoice};

/// How many tests found it absent in this run.
static ABSENT: AtomicU32 = AtomicU32::new(0);

/// Whether OSMesa is here. Where it can't be had, the test that asks says so by name, past the harness, which keeps what tests
/// print; where its package is offered (`.ci/install-gl` installs it), the test fails.
#[track_caller]
pub(crate) fn osmesa_is_here() -> bool {
    let (candidates, _) = context::candidates();
    let osmesa = candidates.iter().find(|candidate| candidate.choice == DeviceChoice::OsMesa).unwrap();
    if osmesa.is_installed() {
        return true;
    }
    assert!(!is_offered(), "libosmesa6 is offered here and not installed: run .ci/install-gl");
    let count = ABSENT.fetch_add(1, Ordering::Relaxed) + 1;
    // With one thread for all tests, it has no test's name.
    let thread = thread::current();
    let name = thread.name().filter(|name| *name != "main");
    let name = name.map_or_else(|| Location::caller().to_string(), str::to_owned);
    writeln!(io::stderr(), "absent ({count}): {name} on OSMesa: libosmesa6 is not offered here").unwrap();
    false
}

/// Whether this system's packages have it; without apt, nobody offers it.
fn is_offered() -> bool {
    let policy = Command::new("apt-cache").args(["policy", "libosmesa6"]).env("LC_ALL", "C").output();
    policy.is_ok_and(|output| has_candidate(&String::from_utf8_lossy(&output.stdout)))
}

/// Whether `apt-cache policy` tells of a version that can be installed.
fn has_candidate(policy: &str) -> bool {
    let candidate = policy.lines().find_map(|line| line.trim().strip_prefix("Candidate: "));
    candidate.is_some_and(|version| version != "(none)")
}

#[test]
fn apt_tells_whether_a_package_is_offered() {
    assert!(has_candidate(
        "libosmesa6:\n  Installed: (none)\n  Candidate: 22.3.6-1+deb12u2\n  Version table:\n"
    ));
    assert!(!has_candidate("libosmesa6:\n  Installed: (none)\n  Candidate: (none)\n"));
    assert!(!has_candidate(""));
}
