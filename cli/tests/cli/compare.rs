//! `compare`: equal, different, and not comparable.

use glam::UVec2;
use predicates::prelude::*;

use crate::{Workplace, one_pixel};

#[test]
fn equal_maps_exit_0_whatever_their_formats() {
    let place = Workplace::new();
    for name in ["a.exr", "b.npy", "c.png"] {
        place.put_map(name, &one_pixel(UVec2::new(5, 4), 3, 2, 7));
    }
    for arguments in ["compare a.exr a.exr", "compare a.exr b.npy", "compare c.png a.exr"] {
        assert_eq!(place.answer(arguments), "all 20 pixels are equal\n");
    }
    assert_eq!(place.json("compare a.exr b.npy --json")["wrong_pixels"], 0);
}

#[test]
fn one_planted_pixel_exits_1_and_is_shown() {
    let place = Workplace::new();
    let mut map = one_pixel(UVec2::new(5, 4), 0, 0, 11);
    place.put_map("a.exr", &map);
    map.set(3, 2, 8);
    place.put_map("b.npy", &map);
    let shown = predicate::str::contains("1 of 20 pixels (5.0000 %)")
        .and(predicate::str::contains("(3, 2): 0 and 8"))
        .and(predicate::str::contains("0.400000 over all pixels"));
    place.run("compare a.exr b.npy").code(1).stdout(shown).stderr("");

    let run = place.run("compare b.npy a.exr --json").code(1);
    let difference: serde_json::Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
    assert_eq!(difference["first"], serde_json::json!([{ "x": 3, "y": 2, "a": 8, "b": 0 }]));
    assert_eq!(difference["max"], 8);
}

#[test]
fn one_planted_pixel_in_a_radius_map_is_seen() {
    let place = Workplace::with_cornell();
    place.answer("radius cornell.exr -o radius.npy");
    let mut map = place.map("radius.npy");
    let right = map.at(300, 200);
    map.set(300, 200, right + 1);
    place.put_map("planted.npy", &map);
    let words = format!("(300, 200): {right} and {}", right + 1);
    place.run("compare radius.npy planted.npy").code(1).stdout(predicate::str::contains(words));
}

#[test]
fn different_sizes_exit_2_with_both_files_and_sizes() {
    let place = Workplace::new();
    place.put_map("a.exr", &one_pixel(UVec2::new(5, 4), 0, 0, 1));
    place.put_map("b.npy", &one_pixel(UVec2::new(4, 5), 0, 0, 1));
    place.refuses("compare a.exr b.npy", &["b.npy: 4 x 5 pixels", "a.exr has 5 x 4", "help: "]);
}

#[test]
fn a_channel_is_chosen_in_the_exr_alone() {
    let place = Workplace::new();
    place.put("two.exr", &crate::files::exr(&[("photons", &[1.0, 2.0]), ("weights", &[0.5, 0.0])]));
    place.put("a.npy", &crate::files::npy("<u4", "(1, 2)", &[1_u32, 2].map(u32::to_le_bytes).concat()));
    place.answer("compare two.exr a.npy --channel photons");
    place.refuses("compare two.exr a.npy", &["two.exr: 2 channels", "photons, weights"]);
    place.refuses("compare a.npy a.npy --channel photons", &["a.npy", "photons"]);
}

#[test]
fn a_missing_map_exits_2() {
    let place = Workplace::new();
    place.put_map("a.npy", &one_pixel(UVec2::ONE, 0, 0, 1));
    place.refuses("compare a.npy b.npy", &["b.npy: there is no such file", "help: "]);
}
