//! The rules of the house that code can check, each with a planted fault that it has to see.
//!
//! | file | rule |
//! |---|---|
//! | `arrows` | a room of the library names only rooms below it |
//! | `circles` | inside a folder, no files and sub-folders name each other in a circle |
//! | `stages` | a stage names no other stage |
//! | `names` | one style of modules, and no two files of one name unless their rooms say which |
//! | `lengths` | how long a file may be |
//! | `shaders` | `glsl/` tells the same story as `src/` |
//! | `unsafe_code` | where `unsafe` may stand |
//! | `dependencies` | what the library pulls in, and the Rust version that all dependencies need |
//!
//! `tokens` and `modules` read the sources for them.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod arrows;
mod circles;
mod dependencies;
mod lengths;
mod modules;
mod names;
mod shaders;
mod stages;
mod tokens;
mod unsafe_code;

use std::fs;
use std::path::{Path, PathBuf};

/// Where the sources of each package are.
const SOURCES: [&str; 3] = ["src", "lab/src", "cli/src"];

/// How the names of shaders end.
const SHADERS: [&str; 3] = ["frag", "glsl", "vert"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All files below `folder` with one of the extensions, sorted; both paths begin at the root of the
/// repository.
fn files_below(folder: &str, extensions: &[&str]) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(root().join(folder)).unwrap() {
        let path = entry.unwrap().path();
        let name = path.strip_prefix(root()).unwrap().to_owned();
        if path.is_dir() {
            files.extend(files_below(name.to_str().unwrap(), extensions));
        } else if path.extension().is_some_and(|found| extensions.iter().any(|one| found == *one)) {
            files.push(name);
        }
    }
    files.sort();
    files
}

/// Fails with a line for each fault.
fn assert_none(faults: &[String]) {
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}

fn text_of(file: &Path) -> String {
    fs::read_to_string(root().join(file)).unwrap()
}
