//! OSMesa, which systems with Mesa 25.1 or newer do not offer: tests that need it are reported as absent
//! there, by name.

use std::collections::BTreeSet;
use std::io::{self, Write as _};
use std::panic::Location;
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use std::thread;

use varikernel::context::{self, DeviceChoice};

/// The tests that found it absent in this run.
static ABSENT: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());

/// Whether OSMesa is here. Where it can't be had, the name of the test that needs it is printed past the
/// harness, which captures the output of tests; where its package is offered (`.ci/install-gl` installs it),
/// the test fails.
#[track_caller]
pub(crate) fn osmesa_is_here() -> bool {
    let (candidates, _) = context::candidates();
    let osmesa = candidates.iter().find(|candidate| candidate.choice == DeviceChoice::OsMesa).unwrap();
    if osmesa.is_installed() {
        return true;
    }
    assert!(!is_offered(), "libosmesa6 is offered here and not installed: run .ci/install-gl");
    // With one thread for all tests, it has no test's name.
    let thread = thread::current();
    let name = thread.name().filter(|name| *name != "main");
    let name = name.map_or_else(|| Location::caller().to_string(), str::to_owned);
    let mut absent = ABSENT.lock().unwrap_or_else(PoisonError::into_inner);
    if absent.insert(name.clone()) {
        let count = absent.len();
        let line = format!("absent ({count}): {name} on OSMesa: libosmesa6 is not offered here\n");
        io::stderr().write_all(line.as_bytes()).unwrap();
    }
    false
}

/// Whether this system's packages have it, as `.ci/install-gl` asks apt; without apt, it is absent.
fn is_offered() -> bool {
    can_install("libosmesa6")
}

/// Whether apt could install that package beside all that is here.
pub(crate) fn can_install(package: &str) -> bool {
    let simulated = Command::new("apt-get").args(["install", "--simulate", package]).output();
    simulated.is_ok_and(|output| output.status.success())
}
