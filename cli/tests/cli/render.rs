//! `render` and `figures`: pictures in files, and what can't be rendered.

use std::collections::{BTreeMap, BTreeSet};

use exr::prelude::attribute::AttributeValue;
use exr::prelude::{ReadChannels as _, ReadLayers as _};

use crate::Workplace;

const SMALL: &str = "--size 40x30 --photons 4000 --light-samples 1";

fn first_layer(
    place: &Workplace,
    name: &str,
) -> exr::prelude::Layer<exr::prelude::AnyChannels<exr::prelude::FlatSamples>> {
    let file = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(place.path(name))
        .unwrap();
    file.layer_data
}

/// The program's own attributes.
fn attributes(place: &Workplace, name: &str) -> BTreeMap<String, String> {
    let of = |(name, value): (&exr::prelude::Text, &AttributeValue)| {
        let name = name.to_string().strip_prefix("varikernel.")?.to_owned();
        let value =
            if let AttributeValue::Text(text) = value { text.to_string() } else { format!("{value:?}") };
        Some((name, value))
    };
    first_layer(place, name).attributes.other.iter().filter_map(of).collect()
}

fn samples(place: &Workplace, name: &str, channel: &str) -> Vec<f32> {
    let layer = first_layer(place, name);
    let channel = layer.channel_data.list.iter().find(|found| found.name.eq(channel)).unwrap();
    channel.sample_data.values_as_f32().collect()
}

/// Names of the channels, and whether every sample is finite.
fn channels(place: &Workplace, name: &str) -> (BTreeSet<String>, bool) {
    let layer = first_layer(place, name);
    let list = &layer.channel_data.list;
    let finite = list.iter().all(|channel| channel.sample_data.values_as_f32().all(f32::is_finite));
    (list.iter().map(|channel| channel.name.to_string()).collect(), finite)
}

#[test]
fn an_exr_holds_every_layer_and_a_png_a_picture() {
    let place = Workplace::new();
    let answer = place.json(&format!("render -o a.exr {SMALL} --json"));
    let by_splats = place.json(&format!("render -o s.exr {SMALL} --light splat --json"));
    assert!(by_splats["energy_error"].as_f64().unwrap() < 1e-4, "{by_splats}");
    // So small a picture is mostly edges of faces, whose photons tables leave out.
    assert!(answer["energy_error"].as_f64().unwrap() < 0.2, "{answer}");
    let stages: Vec<_> = answer["stages"].as_array().unwrap().iter().map(|of| &of["name"]).collect();
    assert_eq!(stages, ["surfaces", "direct light", "edges", "photons", "light", "file"]);
    assert!(answer["account"]["contributing"].as_u64().unwrap() > 3_000, "{answer}");
    let (names, finite) = channels(&place, "a.exr");
    assert!(finite);
    for name in [
        "R",
        "G",
        "B",
        "direct.R",
        "indirect.G",
        "albedo.B",
        "normal.X",
        "density.Y",
        "radius.Y",
        "limited.Y",
        "depth.Y",
    ] {
        assert!(names.contains(name), "{name} is not in {names:?}");
    }
    let attributes = attributes(&place, "a.exr");
    for (name, value) in [
        ("direct", "Traced"),
        ("first_bounce", "Rays"),
        ("light_samples", "I32(1)"),
        ("estimate", "Tables"),
        ("antialias", "I32(16)"),
        ("filter", "Box"),
    ] {
        assert_eq!(attributes[name], value, "{name}");
    }
    place.run(&format!("render -o b.exr {SMALL}")).success();
    assert!(place.bytes("a.exr") == place.bytes("b.exr"), "the same seed gives the same file");
    place.run(&format!("render -o c.exr {SMALL} --seed 2")).success();
    assert!(place.bytes("a.exr") != place.bytes("c.exr"), "another seed gives another");

    assert!(answer["account"]["cut_off_share"].as_f64() == Some(0.0), "{answer}");
    assert!(!attributes.contains_key("bounces"), "{attributes:?}");

    let facts = place
        .answer(&format!("render mirror-ring -o a.png {SMALL} --light splat --radius fixed:3 --kernel box"));
    assert!(facts.contains("energy") && facts.contains("a.png"), "{facts}");
    assert!(!facts.contains("limited"), "nothing is searched: {facts}");
    let picture = image::open(place.path("a.png")).unwrap().to_rgb8();
    assert_eq!(picture.dimensions(), (40, 30));
    assert!(picture.pixels().any(|pixel| pixel.0 != [0; 3]));
    place.run(&format!("render cornell-boxes -o b.png {SMALL} --light gather --count-correction")).success();
}

#[test]
fn the_power_that_is_cut_off_is_always_told() {
    let place = Workplace::new();
    let answer = place.answer(&format!("render cornell-boxes -o a.exr {SMALL}"));
    assert!(answer.contains("0.000 % of the power\n"), "{answer}");
    for reference in ["", "--reference 2"] {
        let options = format!("render cornell-boxes -o a.exr {SMALL} {reference} --bounces 2");
        let answer = place.answer(&options);
        assert!(answer.contains(" % of the power, after 2 landings; less without --bounces\n"), "{answer}");
        let answer = place.json(&format!("{options} --json"));
        let share = &answer[if reference.is_empty() { "account" } else { "cut_off_share" }];
        let share = share.get("cut_off_share").unwrap_or(share).as_f64().unwrap();
        assert!((0.2..0.4).contains(&share), "{answer}");
    }
    assert_eq!(attributes(&place, "a.exr")["bounces"], "I32(2)");
}

#[test]
fn edges_are_smooth_unless_they_are_not_asked_for() {
    let place = Workplace::new();
    for (name, options) in
        [("usual.exr", ""), ("hard.exr", "--antialias 1"), ("wide.exr", "--filter mitchell")]
    {
        place.run(&format!("render cornell-empty -o {name} {SMALL} {options}")).success();
    }
    let [usual, hard, wide] = ["usual.exr", "hard.exr", "wide.exr"].map(|name| place.bytes(name));
    assert!(usual != hard && usual != wide);
    for (options, words) in [
        ("--antialias 0", "1 to 1024"),
        ("--antialias 1025", "1 to 1024"),
        ("--antialias 4 --reference 2", "--reference"),
        ("--filter box --reference 2", "--reference"),
        ("--filter gauss", "blackman-harris"),
    ] {
        let said = place.run(&format!("render cornell-empty -o none.exr {SMALL} {options}")).failure();
        let said = String::from_utf8_lossy(&said.get_output().stderr).into_owned();
        assert!(said.contains(words), "{options}: {said}");
        assert!(!place.path("none.exr").exists());
    }
}

#[test]
fn a_reference_is_the_mean_of_seeds() {
    let place = Workplace::new();
    let answer = place.json(&format!("render cornell-empty -o a.exr {SMALL} --reference 2 --json"));
    assert_eq!(answer["reference_seeds"], 2);
    assert!(channels(&place, "a.exr").1);
    let attributes = attributes(&place, "a.exr");
    assert_eq!(attributes["reference_seeds"], "I32(2)");
    assert_eq!((attributes["direct"].as_str(), attributes["light_samples"].as_str()), ("Traced", "I32(1)"));
    assert!(!attributes.contains_key("min_photons"), "{attributes:?}");

    // The seed itself is left to the picture: a reference of one seed has the photons of the next.
    place.run(&format!("render cornell-empty -o one.exr {SMALL} --reference 1 --seed 4")).success();
    for (name, seed) in [("same.exr", 4), ("next.exr", 5)] {
        place.run(&format!("render cornell-empty -o {name} {SMALL} --seed {seed}")).success();
    }
    let density = samples(&place, "one.exr", "density.Y");
    assert_eq!(density, samples(&place, "next.exr", "density.Y"));
    assert_ne!(density, samples(&place, "same.exr", "density.Y"));
}

#[test]
fn the_sheet_shows_every_figure_with_its_error() {
    let place = Workplace::new();
    let answer =
        place.json(&format!("figures cornell-boxes -o out {SMALL} -r 12 --reference-seeds 2 --json"));
    let figures = answer["figures"].as_array().unwrap();
    let ways: Vec<_> = figures.iter().map(|figure| figure["light"].as_str().unwrap()).collect();
    assert_eq!(ways, ["splat", "splat", "splat", "splat", "tables"]);
    assert_eq!(figures[3]["radius"], "variable", "{answer}");
    assert!(figures[4].get("radius").is_none(), "{answer}");
    assert!(figures.iter().all(|figure| figure["error"]["rmse"].as_f64().unwrap() > 0.0), "{answer}");
    // The caustics and the walls are given separately, for every radius; the two boxes have walls in any
    // case.
    let fixed = answer["fixed"].as_array().unwrap();
    for row in figures.iter().chain(fixed) {
        assert!(row["walls"]["rmse"].as_f64().unwrap() > 0.0, "{row}");
        assert!(row["caustic"].is_null() == (answer["region_pixels"][0] == 0), "{row}");
    }
    let noise = &answer["reference_noise_of_regions"];
    assert!(noise["walls"]["rmse"].as_f64().unwrap() > 0.0, "{noise}");
    let names = ["figures.png", "figures.json", "figure_1_2.png", "figure_1_3.png", "figure_1_4.png"];
    for name in names.into_iter().chain(["variable.png", "tables.png"]) {
        assert!(place.path("out").join(name).is_file(), "{name}");
    }
}

#[test]
fn what_can_not_be_rendered_is_refused_with_the_reason() {
    let place = Workplace::new();
    place.refuses("render -o a.npy", &["a.npy", "EXR or PNG", "help:"]);
    place.refuses("render -o missing/a.png", &["missing", "does not exist"]);
    place.refuses("render nowhere.toml -o a.png", &["nowhere.toml", "no such file"]);
    place.refuses("render -o a.png --photons 0", &["photons"]);
    place.refuses("render -o a.png -n 0", &["--min-photons 0 is not possible"]);
    place.refuses("render -o a.png -r 97", &["--max-radius 97", "96"]);
    place.refuses("render -o a.png --radius wide", &["variable", "fixed:"]);
    place.refuses("render -o a.png --radius fixed:0", &["--radius fixed:0"]);
    place.refuses("render -o a.png --reference 0", &["--reference 0"]);
    for option in ["--light splat", "--radius fixed:2", "--first-bounce maps", "--kernel box", "-n 9", "-r 9"]
    {
        let name = option.split(' ').next().unwrap();
        let name = if let "-n" = name {
            "--min-photons"
        } else if let "-r" = name {
            "--max-radius"
        } else {
            name
        };
        place.refuses(&format!("render -o a.exr --reference 2 {option}"), &["--reference", name]);
    }
    place.refuses("render -o a.png --bounces 0", &["--bounces 0"]);
    place.refuses("render -o a.png --count-correction", &["--count-correction", "--light gather"]);
    for option in ["-n 9", "-r 9", "--kernel box", "--radius fixed:2"] {
        place.refuses(&format!("render -o a.png {option}"), &["for kernels", "--light splat"]);
    }
    place.refuses("render -o a.png --exposure NaN", &["--exposure"]);
    place.refuses("render -o a.png --size 20000x1 --photons 10 --device nonesuch", &["nonesuch"]);
}

#[test]
fn a_camera_that_sees_nothing_gives_a_black_picture() {
    let place = Workplace::new();
    let scene = include_str!("../../../assets/scenes/cornell_boxes.toml");
    place.put("away.toml", scene.replace("direction = [0, 0, 1]", "direction = [0, 0, -1]").as_bytes());
    let answer = place.json(&format!("render away.toml -o a.png {SMALL} --json"));
    assert_eq!(answer["account"]["contributing"], 0, "{answer}");
    let picture = image::open(place.path("a.png")).unwrap().to_rgb8();
    assert!(picture.pixels().all(|pixel| pixel.0 == [0; 3]));
}
