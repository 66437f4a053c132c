//! The program as a user runs it: arguments in, files, text and an exit code out.

#![expect(clippy::unwrap_used, reason = "in the helpers of tests too, a panic is the report")]

mod against;
mod bad_input;
mod compare;
mod devices;
mod exact;
mod files;
mod glsl;
mod gltf;
mod interrupt;
mod masks;
#[path = "../../../tests/common/osmesa.rs"]
mod osmesa;
mod outputs;
mod owners;
mod photons;
mod render;
mod rule;
mod saving;
mod shell;
mod stress;
mod survey;
mod synth;

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use glam::UVec2;
use tempfile::TempDir;
use varikernel::Image;
use varikernel::image::{ReadOptions, read_counts, write_counts};

/// A folder of its own, in which the program runs.
struct Workplace {
    folder: TempDir,
}

impl Workplace {
    fn new() -> Self {
        Self { folder: TempDir::new().unwrap() }
    }

    /// With the shipped map as `cornell.exr`.
    fn with_cornell() -> Self {
        let place = Self::new();
        let map = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/maps/cornell_glass_512.exr");
        fs::copy(map, place.path("cornell.exr")).unwrap();
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The program, to be run here with `arguments`, which are separated by spaces.
    fn command(&self, arguments: &str) -> Command {
        let mut command = Command::cargo_bin("varikernel").unwrap();
        command
            .args(arguments.split_whitespace())
            .current_dir(self.folder.path())
            .env_remove("RUST_LOG")
            .timeout(Duration::from_mins(3));
        command
    }

    #[track_caller]
    fn run(&self, arguments: &str) -> Assert {
        self.command(arguments).assert()
    }

    /// What a run that succeeds prints.
    #[track_caller]
    fn answer(&self, arguments: &str) -> String {
        let output = self.run(arguments).success();
        String::from_utf8(output.get_output().stdout.clone()).unwrap()
    }

    /// The object that a run with `--json` prints.
    #[track_caller]
    fn json(&self, arguments: &str) -> serde_json::Value {
        serde_json::from_str(&self.answer(arguments)).unwrap()
    }

    /// Exit code 2, all `words` and no panic on stderr, nothing on stdout, and not a byte in the folder
    /// changed.
    #[track_caller]
    fn refuses(&self, arguments: &str, words: &[&str]) {
        let before = self.content();
        let run = self.run(arguments).code(2).stdout("");
        let stderr = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        for word in words.iter().chain(&["error: "]) {
            assert!(stderr.contains(word), "{arguments}: {word:?} is not in: {stderr}");
        }
        assert!(!stderr.contains("panicked"), "{arguments}: {stderr}");
        assert!(self.content() == before, "{arguments} changed the folder: {:?}", self.content().keys());
    }

    /// Every file and what is in it.
    fn content(&self) -> BTreeMap<String, Vec<u8>> {
        let files = fs::read_dir(self.folder.path()).unwrap().map(|entry| {
            let entry = entry.unwrap();
            (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())
        });
        files.collect()
    }

    fn put(&self, name: &str, bytes: &[u8]) {
        fs::write(self.path(name), bytes).unwrap();
    }

    fn put_map(&self, name: &str, map: &Image<u32>) {
        write_counts(&self.path(name), "photons", map, &[]).unwrap();
    }

    #[track_caller]
    fn map(&self, name: &str) -> Image<u32> {
        read_counts(&self.path(name), &ReadOptions::default()).unwrap()
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }
}

/// Zero everywhere but at one place.
fn one_pixel(size: UVec2, x: u32, y: u32, value: u32) -> Image<u32> {
    let mut map = Image::filled(size, 0);
    map.set(x, y, value);
    map
}
