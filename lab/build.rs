//! The commit that this is built from, for the reports, where git has one.

use std::path::Path;
use std::process::Command;

fn main() {
    // Something has to be named, or each build would run this again.
    println!("cargo::rerun-if-changed=build.rs");
    // A package that was unpacked within another repository is not of its commit.
    let is_ours = git(&["rev-parse", "--show-toplevel"])
        .and_then(|top| Path::new(&top).canonicalize().ok())
        .is_some_and(|top| Path::new("..").canonicalize().is_ok_and(|ours| ours == top));
    let mut commit = None;
    if is_ours {
        commit = git(&["describe", "--always", "--dirty", "--abbrev=12"]);
        // Where they are in worktrees and submodules as well; one that is not there would count as changed.
        for file in ["HEAD", "logs/HEAD"] {
            let path = git(&["rev-parse", "--git-path", file]).filter(|path| Path::new(path).exists());
            if let Some(path) = path {
                println!("cargo::rerun-if-changed={path}");
            }
        }
    }
    println!("cargo::rustc-env=VARIKERNEL_COMMIT={}", commit.as_deref().unwrap_or("unknown"));
}

/// What git answers, if it knows.
fn git(arguments: &[&str]) -> Option<String> {
    let output =
        Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}
