//! What a good run leaves: files by extension, an answer on stdout, logs on stderr.

use exr::prelude::{AttributeValue, MetaData, SampleType, Text};
use glam::UVec2;
use predicates::prelude::*;

use crate::{Workplace, one_pixel};

#[test]
fn an_exr_tells_how_it_was_made() {
    let place = Workplace::with_cornell();
    let report =
        place.json("radius cornell.exr -o radius.exr -n 30 -r 20 --edges zero --method pyramid --json");

    let meta_data = MetaData::read_from_file(place.path("radius.exr"), true).unwrap();
    let header = &meta_data.headers[0];
    assert_eq!(header.channels.list.len(), 1);
    assert_eq!(header.channels.list[0].name, Text::from("radius"));
    assert_eq!(header.channels.list[0].sample_type, SampleType::U32);
    let text = |name: &str| match &header.own_attributes.other[&Text::from(name)] {
        AttributeValue::Text(text) => text.to_string(),
        AttributeValue::I32(number) => number.to_string(),
        other => panic!("{name} is {other:?}"),
    };
    assert_eq!(text("varikernel.version"), env!("CARGO_PKG_VERSION"));
    assert_eq!(text("varikernel.renderer"), report["device"]["renderer"].as_str().unwrap());
    assert_eq!(text("varikernel.map"), "cornell.exr");
    for (setting, value) in [
        ("search.min_photons", "30"),
        ("search.max_radius", "20"),
        ("search.edges", "zero"),
        ("search.order", "binary"),
        ("method", "pyramid"),
        ("split", "larger"),
        ("matching", "bits"),
        ("sat_samples", "4"),
        ("storage", "u32"),
        ("exactness", "required"),
        ("faults.clamp_to_63", "false"),
    ] {
        assert_eq!(text(&format!("varikernel.{setting}")), value, "{setting}");
    }
}

#[test]
fn exr_and_npy_hold_the_same_map_and_png_a_picture_of_it() {
    let place = Workplace::with_cornell();
    for name in ["radius.exr", "radius.npy", "radius.png"] {
        place.answer(&format!("radius cornell.exr -o {name}"));
    }
    place.answer("compare radius.exr radius.npy");
    let bytes = place.bytes("radius.png");
    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"));
    // Colour type 2, RGB; the map's width, and its height with a legend below.
    let number = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    assert_eq!((number(16), bytes[24], bytes[25]), (512, 8, 2));
    assert!(number(20) > 512);
}

#[test]
fn the_limited_mask_marks_where_the_search_ended_with_too_few() {
    let place = Workplace::new();
    // Boxes of radius 2 around columns 0 to 4 hold the hot pixel.
    place.put_map("map.npy", &one_pixel(UVec2::new(9, 1), 2, 0, 100));
    let arguments = "radius map.npy -o radius.npy --limited-mask mask.exr -r 2 -n 100 --edges zero";
    let report = place.json(&format!("{arguments} --json"));
    assert_eq!(place.map("radius.npy").values(), [2, 1, 1, 1, 2, 2, 2, 2, 2]);
    assert_eq!(place.map("mask.exr").values(), [0, 0, 0, 0, 0, 1, 1, 1, 1]);
    assert_eq!(report["limited_mask"], "mask.exr");
    assert!((report["radius"]["limited_share"].as_f64().unwrap() - 4.0 / 9.0).abs() < 1e-9);
    assert!(place.answer(arguments).contains("44.444 % found too few photons"));
}

#[test]
fn the_json_report_has_every_field() {
    let place = Workplace::with_cornell();
    let report = place.json("radius cornell.exr -o radius.npy --json");
    for (pointer, value) in [
        ("/version", env!("CARGO_PKG_VERSION").into()),
        ("/map/file", "cornell.exr".into()),
        ("/map/size", vec![512, 512].into()),
        ("/map/photons", 2_893_438.into()),
        ("/map/max_count", 195.into()),
        ("/output", "radius.npy".into()),
        ("/settings/search/min_photons", 25.into()),
        ("/settings/search/max_radius", 32.into()),
        ("/settings/method", "sat".into()),
        ("/plan/exact", true.into()),
        ("/radius/min", 1.into()),
        ("/radius/max", 32.into()),
        ("/stages/0/stage", "build".into()),
        ("/stages/1/stage", "search".into()),
    ] {
        let value: serde_json::Value = value;
        assert_eq!(report.pointer(pointer), Some(&value), "{pointer}");
    }
    for pointer in
        ["/radius/mean", "/radius/median", "/radius/limited_share", "/stages/0/query_ms", "/stages/1/wall_ms"]
    {
        assert!(report.pointer(pointer).unwrap().as_f64().unwrap() > 0.0, "{pointer}");
    }
    assert!(report.get("verify").is_none(), "nobody asked");
}

#[test]
fn tables_fit_80_columns() {
    let place = Workplace::with_cornell();
    let long = format!("{}.npy", "a-long-name-".repeat(15));
    place.answer("synth spike -o other.npy");
    let naive = format!("radius cornell.exr -o {long} --method naive-mipmap --verify");
    for arguments in [naive.as_str(), "compare cornell.exr other.npy", "devices", "synth uniform -o a.npy"] {
        let run = place.run(arguments);
        let answer = String::from_utf8(run.get_output().stdout.clone()).unwrap();
        assert!(answer.lines().count() > 2, "{arguments}: {answer}");
        for line in answer.lines() {
            assert!(line.chars().count() <= 80, "{arguments}: {line}");
        }
    }
}

#[test]
fn help_fits_80_columns_and_names_every_verb() {
    let place = Workplace::new();
    let help_of = |arguments: &str| {
        let run = place.command(arguments).env("COLUMNS", "80").assert().success();
        String::from_utf8(run.get_output().stdout.clone()).unwrap()
    };
    let help = help_of("--help");
    for verb in ["radius", "compare", "photons", "synth", "devices"] {
        assert!(help.contains(&format!("\n  {verb} ")), "{help}");
        let pages = ["-h", "--help"].map(|option| help_of(&format!("{verb} {option}")));
        let lines = pages.iter().flat_map(|page| page.lines());
        for line in lines.chain(help.lines()) {
            assert!(line.chars().count() <= 80, "{verb}: {line}");
        }
    }
}

#[test]
fn help_of_verbs_with_many_options_is_in_groups() {
    let place = Workplace::new();
    for (verb, groups) in [
        ("radius", &["Input and output", "Question", "Method", "Thesis's variants", "Exactness"][..]),
        ("bench", &["Suite and maps", "Method", "Question", "Time", "Input and output"]),
        ("render", &["Input and output", "Picture", "Photons", "Kernels", "Direct light"]),
        ("glsl", &["Input and output", "Question", "Method", "Host's textures", "Kernels"]),
    ] {
        let help = place.answer(&format!("{verb} --help"));
        let places: Vec<_> = groups.iter().map(|group| help.find(&format!("\n{group}:\n"))).collect();
        assert!(places.is_sorted() && places[0].is_some(), "{groups:?}: {help}");
    }
}

#[test]
fn stdout_holds_the_answer_and_stderr_the_log() {
    let place = Workplace::with_cornell();
    place.run("radius cornell.exr -o radius.npy").success().stderr("");
    let loud = place.run("radius cornell.exr -o radius.npy --json -v").success();
    let stderr = String::from_utf8(loud.get_output().stderr.clone()).unwrap();
    for word in ["read", "cornell.exr", "opened", "written", "radius.npy"] {
        assert!(stderr.contains(word), "{word:?} is not in: {stderr}");
    }
    assert!(!stderr.contains('\x1b'), "no colours in a file: {stderr}");
    serde_json::from_slice::<serde_json::Value>(&loud.get_output().stdout).unwrap();
}

#[test]
fn an_output_is_replaced_and_nothing_else_is_left() {
    let place = Workplace::with_cornell();
    place.put("radius.npy", b"old");
    place.answer("radius cornell.exr -o radius.npy");
    assert_eq!(place.content().into_keys().collect::<Vec<_>>(), ["cornell.exr", "radius.npy"]);
    assert_eq!(place.map("radius.npy").size(), UVec2::splat(512));
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_error() {
    use std::process::{Command, Stdio};

    let place = Workplace::with_cornell();
    place.answer("synth sparse -o other.npy");
    for arguments in [
        "radius cornell.exr -o radius.npy",
        "radius cornell.exr -o radius.npy --json",
        "compare cornell.exr other.npy",
        "devices",
        "synth uniform -o a.npy",
        "--help",
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = Command::new(assert_cmd::cargo::cargo_bin("varikernel"))
            .args(arguments.split_whitespace())
            .current_dir(place.folder.path())
            .stdout(writer)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
            .wait_with_output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments}");
        assert!(predicate::str::is_empty().eval(&String::from_utf8_lossy(&output.stderr)), "{arguments}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_stdout_is_an_error() {
    let place = Workplace::new();
    place.answer("synth uniform -o map.npy --size 4x4");
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = std::process::Command::new(assert_cmd::cargo::cargo_bin("varikernel"))
        .args(["compare", "map.npy", "map.npy"])
        .current_dir(place.folder.path())
        .stdout(full)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("could not be printed"));
}
