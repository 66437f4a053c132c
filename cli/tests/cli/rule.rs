//! `--rule even`: the widest boxes of even density, by the definition, and what it refuses.

use glam::UVec2;
use varikernel::Image;

use crate::{Workplace, one_pixel};

#[test]
fn even_radii_are_those_of_the_definition() {
    let place = Workplace::with_cornell();
    for (options, widest) in [("", 16), ("-r 64 --edges zero", 16), ("-r 2 --sat-build doubling", 2)] {
        let report =
            place.json(&format!("radius cornell.exr -o radius.npy --rule even --verify --json {options}"));
        assert_eq!(report["settings"]["rule"], "even", "{options}");
        assert_eq!(report["verify"]["wrong_pixels"], 0, "{options}");
        assert_eq!(report["verify_limited"]["wrong_pixels"], 0, "{options}");
        assert_eq!(report["plan"]["exact"], true, "{options}");
        assert!(report["planned"].is_null(), "{options}");
        assert_eq!(report["radius"]["max"], widest, "{options}");
    }
    let nearest = place.json("radius cornell.exr -o nearest.npy --json");
    assert!(nearest["settings"]["rule"].is_null(), "the usual rule is left out, as it was");
}

#[test]
fn a_bright_pixel_by_hand_a_mask_and_a_picture() {
    let place = Workplace::new();
    place.put_map("map.npy", &one_pixel(UVec2::splat(6), 1, 1, 200));
    let answer = place.answer("radius map.npy -o radius.npy --rule even -r 1 --limited-mask limited.npy");
    assert!(answer.contains("even: the widest box") && answer.contains("are even up to MR"), "{answer}");
    let radius = place.map("radius.npy");
    #[rustfmt::skip]
    assert_eq!(radius.values(), [
        0, 0, 0, 0, 1, 1,
        0, 0, 0, 1, 1, 1,
        0, 0, 0, 1, 1, 1,
        0, 1, 1, 1, 1, 1,
        1, 1, 1, 1, 1, 1,
        1, 1, 1, 1, 1, 1,
    ]);
    assert_eq!(place.map("limited.npy"), radius);
    place.put_map("mask.npy", &Image::from_fn(UVec2::splat(6), |x, _| u32::from(x > 4)));
    let report = place.json("radius map.npy -o masked.npy --rule even -r 1 --mask mask.npy --verify --json");
    assert_eq!(report["verify"]["wrong_pixels"], 0);
    assert_eq!(place.map("masked.npy").values()[..6], [0, 0, 0, 0, 0, 1]);
    place.answer("radius map.npy -o radius.png --rule even -r 1");
}

#[test]
fn what_has_no_meaning_for_the_rule_is_refused_by_name() {
    let place = Workplace::new();
    place.put_map("map.npy", &Image::filled(UVec2::splat(6), 2));
    for (option, words) in [
        ("-n 25", ["-n is for boxes", "--rule nearest"]),
        ("--search forward", ["--search", "--rule nearest"]),
        ("-r 33", ["--max-radius 33", "64"]),
        ("-r 128", ["--max-radius 128", "64"]),
        ("--method pyramid", ["--method pyramid", "summed-area table"]),
        ("--storage u16", ["--storage u16", "u32"]),
        ("--variation unconditional-fetches", ["--variation", "nearest"]),
        ("--certify", ["--rule even", "definition"]),
    ] {
        place.refuses(&format!("radius map.npy -o radius.npy --rule even {option}"), &words);
    }
    place.refuses("radius map.npy -o radius.npy --rule odd", &["odd", "nearest", "even"]);
    place.refuses("glsl --list --rule even -n 9", &["-n is for boxes"]);
    // A box of 3 x 3 that holds 2^32.
    place.put_map("full.npy", &Image::filled(UVec2::splat(6), 500_000_000));
    place.refuses("radius full.npy -o radius.npy --rule even -r 1", &["would not be exact", "lower MR"]);
}

#[test]
fn its_shaders_are_listed_and_named() {
    let place = Workplace::new();
    let list = place.answer("glsl --list --rule even -r 64");
    let order = ["sat-unpack ", "narrow-departures ", "wide-departures ", "even-radii ", "shade "];
    let places: Vec<_> = order.iter().map(|name| list.find(&format!("\n{name}")).unwrap()).collect();
    assert!(places.is_sorted(), "{list}");
    assert!(
        !list.contains("radius-search") && !list.contains("certify") && !list.contains("census"),
        "{list}"
    );
    assert!(place.answer("glsl --rule even -r 64 even-radii").contains("uniform usampler2D of_wide;"));
    assert!(!place.answer("glsl --rule even -r 8 even-radii").contains("of_wide"));
    place.refuses("glsl even-radii", &["even-radii", "add --rule even"]);
}
