//! `study --against`: pictures of any renderer, judged.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use glam::UVec2;
use predicates::prelude::PredicateBooleanExt as _;
use predicates::str::contains;
use serde_json::Value;
use tempfile::TempDir;
use varikernel::Image;
use varikernel::image::LayerFile;

const SIZE: UVec2 = UVec2::new(6, 4);

fn varikernel() -> Command {
    Command::cargo_bin("varikernel").unwrap()
}

/// An even picture, half of whose pixels are `off` by that much.
fn write(folder: &Path, name: &str, off: f32) {
    let light = |x: u32, _| [0.25, if x.is_multiple_of(2) { 2.0 + off } else { 2.0 }, 0.5];
    LayerFile::new(SIZE)
        .colours("", ['R', 'G', 'B'], &Image::from_fn(SIZE, light))
        .write(&folder.join(name), &[])
        .unwrap();
}

/// A wall whose right half is another surface, with a caustic in one pixel of the left.
fn write_layers(folder: &Path) {
    let right = |x: u32| x >= 4;
    let grey = |value: f32| Image::filled(SIZE, [value; 3]);
    let normal = Image::from_fn(SIZE, |x, _| if right(x) { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] });
    let indirect = Image::from_fn(SIZE, |x, y| [if (x, y) == (0, 0) { 0.9 } else { 0.1 }; 3]);
    LayerFile::new(SIZE)
        .colours("", ['R', 'G', 'B'], &grey(2.0))
        .colours("direct", ['R', 'G', 'B'], &grey(1.0))
        .colours("indirect", ['R', 'G', 'B'], &indirect)
        .colours("albedo", ['R', 'G', 'B'], &grey(0.5))
        .colours("normal", ['X', 'Y', 'Z'], &normal)
        .values("depth", &Image::filled(SIZE, 3.0))
        .write(&folder.join("layers.exr"), &[])
        .unwrap();
}

const ROWS: &str = "scene,way,options,seed,seconds,file
wall,reference,,,,reference.exr
wall,layers,,,,layers.exr
wall,ours,fast,1,1,a.exr
wall,ours,slow,1,4,b.exr
wall,\"other 1.0, denoised\",,1,2,c.exr
";

fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    for (name, off) in [("reference.exr", 0.0), ("a.exr", 0.4), ("b.exr", 0.1), ("c.exr", 0.8)] {
        write(folder.path(), name, off);
    }
    write_layers(folder.path());
    fs::write(folder.path().join("runs.csv"), ROWS).unwrap();
    folder
}

fn against(folder: &Path) -> Command {
    let mut command = varikernel();
    command.current_dir(folder).args(["study", "--against", "runs.csv", "-o", "found"]);
    command
}

#[test]
fn pictures_are_judged_in_equal_time_and_at_equal_error() {
    let folder = folder();
    against(folder.path()).assert().success().stdout(contains("other 1.0, denoised").and(contains("4.00")));
    let text = fs::read_to_string(folder.path().join("found/against.json")).unwrap();
    let found: Value = serde_json::from_str(&text).unwrap();
    let scene = &found["scenes"][0];
    let close = |value: &Value, expected: f64| (value.as_f64().unwrap() - expected).abs() < 1e-5;
    // Half of the pixels are off by 0.4 of 2.
    let error = &scene["ways"][0]["points"][0]["pictures"][0]["errors"][0];
    assert!(close(&error["rmse"], 0.2 * 0.5_f64.sqrt()) && close(&error["bias"], 0.1), "{error}");
    // After 2 s ours are off by 0.2, and the other by 0.8, as ours never were.
    let other = &scene["ways"][1]["comparisons"][0][0];
    assert_eq!(other["region"], "whole");
    assert!(close(&other["equal_time"]["ratio"], 4.0), "{other}");
    assert!(other["equal_error"].is_null(), "{other}");
    // The first row ends at the caustic, and both sides of the fold are edges.
    let errors = scene["ways"][0]["points"][0]["pictures"][0]["errors"].as_array().unwrap();
    let pixels: Vec<_> = errors
        .iter()
        .map(|error| (error["region"].as_str().unwrap(), error["pixels"].as_u64().unwrap()))
        .collect();
    assert_eq!(pixels, [("whole", 24), ("edges", 8), ("caustic", 1), ("rest", 15)]);

    let csv = fs::read_to_string(folder.path().join("found/against.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 3 * 4, "{csv}");
    let html = fs::read_to_string(folder.path().join("found/against.html")).unwrap();
    for words in ["other 1.0, denoised", "wall: caustic", "RMSE (% of the mean)", "--against runs.csv"] {
        assert!(html.contains(words), "{words}");
    }
}

#[test]
fn json_goes_to_stdout_and_nothing_else() {
    let folder = folder();
    let output = against(folder.path()).arg("--json").output().unwrap();
    assert!(output.status.success());
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["scenes"][0]["scene"], "wall");
}

#[test]
fn what_is_wrong_is_said_before_anything_is_written() {
    let refused = |change: &dyn Fn(&Path), words: &[&str]| {
        let folder = folder();
        change(folder.path());
        let output = against(folder.path()).output().unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{text}");
        for word in words {
            assert!(text.contains(word), "{word}: {text}");
        }
        assert!(!folder.path().join("found/against.json").exists());
    };
    let rows = |from: &'static str, to: &'static str| {
        move |folder: &Path| fs::write(folder.join("runs.csv"), ROWS.replace(from, to)).unwrap()
    };
    refused(&rows(",4,b.exr", ",,b.exr"), &["runs.csv", "line 5", "no seconds", "help:"]);
    refused(&rows("b.exr", "absent.exr"), &["absent.exr", "no such file"]);
    refused(&rows("seconds", "time"), &["runs.csv", "time", "help:"]);
    refused(&|folder| fs::remove_file(folder.join("runs.csv")).unwrap(), &["runs.csv", "help:"]);
    refused(&|folder| write(folder, "c.exr", f32::NAN), &["c.exr", "12 pixels are not finite"]);
    refused(
        &|folder| {
            let small =
                LayerFile::new(UVec2::ONE).colours("", ['R', 'G', 'B'], &Image::filled(UVec2::ONE, [1.0; 3]));
            small.write(&folder.join("c.exr"), &[]).unwrap();
        },
        &["c.exr", "1 x 1 pixels", "6 x 4"],
    );
    refused(&|folder| write(folder, "layers.exr", 0.0), &["layers.exr", "direct.R", "but"]);
    let folder = folder();
    against(folder.path()).arg("--quick").assert().code(2).stderr(contains("--quick"));
}
