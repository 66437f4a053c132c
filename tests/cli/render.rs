//! `render` and `figures`: pictures in files, and what can't be rendered.

use std::collections::BTreeSet;

use exr::prelude::{ReadChannels as _, ReadLayers as _};

use crate::Workplace;

const SMALL: &str = "--size 40x30 --photons 4000 --light-samples 1";

/// Names of the channels, and whether every sample is finite.
fn channels(place: &Workplace, name: &str) -> (BTreeSet<String>, bool) {
    let file = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(place.path(name))
        .unwrap();
    let list = &file.layer_data.channel_data.list;
    let finite = list.iter().all(|channel| channel.sample_data.values_as_f32().all(f32::is_finite));
    (list.iter().map(|channel| channel.name.to_string()).collect(), finite)
}

#[test]
fn an_exr_holds_every_layer_and_a_png_a_picture() {
    let place = Workplace::new();
    let answer = place.json(&format!("render -o a.exr {SMALL} --json"));
    assert!(answer["energy_error"].as_f64().unwrap() < 1e-4, "{answer}");
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
    place.run(&format!("render -o b.exr {SMALL}")).success();
    assert!(place.bytes("a.exr") == place.bytes("b.exr"), "the same seed gives the same file");
    place.run(&format!("render -o c.exr {SMALL} --seed 2")).success();
    assert!(place.bytes("a.exr") != place.bytes("c.exr"), "another seed gives another");

    let facts = place.answer(&format!("render mirror-ring -o a.png {SMALL} --radius fixed:3 --kernel box"));
    assert!(facts.contains("energy") && facts.contains("a.png"), "{facts}");
    let picture = image::open(place.path("a.png")).unwrap().to_rgb8();
    assert_eq!(picture.dimensions(), (40, 30));
    assert!(picture.pixels().any(|pixel| pixel.0 != [0; 3]));
    place.run(&format!("render cornell-boxes -o b.png {SMALL} --gather --count-correction")).success();
}

#[test]
fn a_reference_is_the_mean_of_seeds() {
    let place = Workplace::new();
    let answer = place.json(&format!("render cornell-empty -o a.exr {SMALL} --reference 2 --json"));
    assert_eq!(answer["reference_seeds"], 2);
    assert!(channels(&place, "a.exr").1);
}

#[test]
fn the_sheet_shows_every_figure_with_its_error() {
    let place = Workplace::new();
    let answer =
        place.json(&format!("figures cornell-boxes -o out {SMALL} -r 12 --reference-seeds 2 --json"));
    let figures = answer["figures"].as_array().unwrap();
    assert_eq!(figures.len(), 4);
    assert!(figures.iter().all(|figure| figure["error"]["rmse"].as_f64().unwrap() > 0.0), "{answer}");
    // The caustics and the walls are told apart, for every radius; the two boxes have walls in any case.
    let fixed = answer["fixed"].as_array().unwrap();
    for row in figures.iter().chain(fixed) {
        assert!(row["walls"]["rmse"].as_f64().unwrap() > 0.0, "{row}");
        assert!(row["caustic"].is_null() == (answer["region_pixels"][0] == 0), "{row}");
    }
    for name in
        ["figures.png", "figures.json", "figure_1_2.png", "figure_1_3.png", "figure_1_4.png", "variable.png"]
    {
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
    place.refuses("render -o a.png --bounces 0", &["--bounces 0"]);
    place.refuses("render -o a.png --count-correction", &["--gather"]);
    place.refuses("render -o a.png --exposure NaN", &["--exposure"]);
    place.refuses("render -o a.png --size 20000x1 --photons 10 --device nonesuch", &["nonesuch"]);
}

#[test]
fn a_camera_that_sees_nothing_gives_a_black_picture() {
    let place = Workplace::new();
    let scene = include_str!("../../assets/scenes/cornell_boxes.toml");
    place.put("away.toml", scene.replace("direction = [0, 0, 1]", "direction = [0, 0, -1]").as_bytes());
    let answer = place.json(&format!("render away.toml -o a.png {SMALL} --json"));
    assert_eq!(answer["account"]["contributing"], 0, "{answer}");
    let picture = image::open(place.path("a.png")).unwrap().to_rgb8();
    assert!(picture.pixels().all(|pixel| pixel.0 == [0; 3]));
}
