//! The C interface: its header, what it answers, what it refuses, and a host in C++ that uses it.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod header;
mod install;
mod programs;
mod tables;

use std::path::Path;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}
