//! The rooms of the library, from bottom to top, and the arrows between them.

use std::collections::BTreeSet;

use crate::assert_none;
use crate::modules::{Package, words};

/// Plain data that every room above may name, without an arrow.
const OPEN_TO_ALL: [&str; 3] = ["error", "settings", "image"];

/// Each room, and the rooms below it that it names.
const ROOMS: &[(&str, &[&str])] = &[
    ("error", &[]),
    ("settings", &[]),
    ("image", &[]),
    ("view", &[]),
    ("gl", &[]),
    ("context", &["gl"]),
    ("scene", &["view"]),
    ("photon", &["scene", "view"]),
    ("reference", &["photon", "scene", "view"]),
    ("maps", &["gl", "photon", "reference", "view"]),
    ("radius", &["gl", "maps"]),
    ("light", &["gl", "maps", "radius"]),
    ("measure", &["gl", "maps", "radius", "view"]),
    ("render", &["gl", "light", "maps", "photon", "reference", "scene", "view"]),
    ("capi", &["gl", "light", "maps", "photon", "radius", "view"]),
];

type Rooms<'a> = &'a [(&'a str, &'a [&'a str])];

/// What is wrong with the table, or with a package by it.
fn faults(rooms: Rooms<'_>, package: &Package) -> Vec<String> {
    let mut faults = Vec::new();
    for (index, (room, arrows)) in rooms.iter().enumerate() {
        if !package.0.contains_key([(*room).to_owned()].as_slice()) {
            faults.push(format!("the table has a room {room}, which is not there"));
        }
        for to in *arrows {
            if !rooms[..index].iter().any(|(below, _)| below == to) {
                faults.push(format!("the table has {room} -> {to}, which does not point down"));
            }
        }
    }
    let mut used = BTreeSet::new();
    for (path, module) in &package.0 {
        // The root of the library knows all rooms.
        let Some(from) = path.first() else { continue };
        let Some(level) = rooms.iter().position(|(room, _)| room == from) else {
            faults.push(format!("{}: the room {from} is not in the table", module.file));
            continue;
        };
        let (_, arrows) = rooms[level];
        for place in &module.names {
            let Some(to) = package.module_of(place).first() else {
                faults.push(format!("{}: {} goes through lib.rs", module.file, words(place)));
                continue;
            };
            let is_below = rooms[..level].iter().any(|(below, _)| below == to);
            if arrows.contains(&to.as_str()) {
                used.insert((from, to));
            } else if to != from && !(OPEN_TO_ALL.contains(&to.as_str()) && is_below) {
                faults.push(format!("{}: {from} -> {to} by {}", module.file, words(place)));
            }
        }
    }
    for (room, arrows) in rooms {
        for to in arrows.iter().filter(|to| !used.iter().any(|(a, b)| a == room && b == *to)) {
            faults.push(format!("the table has {room} -> {to}, which no file needs"));
        }
    }
    faults
}

/// What files of a package take from its root although it only hands that on.
fn through_the_root(package: &Package) -> Vec<String> {
    let root = &package.0[[].as_slice()].imports;
    let mut faults = Vec::new();
    for module in package.0.values() {
        let names =
            module.names.iter().filter(|place| place.first().is_some_and(|name| root.contains_key(name)));
        faults.extend(names.map(|place| format!("{}: {} goes through lib.rs", module.file, words(place))));
    }
    faults
}

#[test]
fn rooms_of_the_lab_and_the_program_are_named_themselves() {
    for sources in ["lab/src", "cli/src"] {
        assert_none(&through_the_root(&Package::of(sources)));
    }
}

#[test]
fn arrows_point_down() {
    assert_none(&faults(ROOMS, &Package::of("src")));
}

/// The faults of a library of three rooms, `error`, `gl` and `maps` above it, with one more file.
fn with(file: &str, text: &str) -> Vec<String> {
    let rooms: Rooms<'_> = &[("error", &[]), ("gl", &[]), ("maps", &["gl"])];
    let files = [
        ("lib.rs", "pub use error::Error; pub use maps::Map;"),
        ("error.rs", "/// See [`crate::maps::Map`].\npub enum Error {}"),
        ("gl/mod.rs", "use crate::error::Error; pub struct Gl;"),
        ("maps/mod.rs", "use crate::gl::Gl; pub struct Map(Gl);"),
    ];
    faults(rooms, &Package::planted(&[files.as_slice(), &[(file, text)]].concat()))
}

#[test]
fn an_arrow_that_points_up_is_seen_however_it_is_written() {
    assert_eq!(with("gl/pass.rs", "use crate::gl::Gl; use super::Gl;"), [""; 0]);
    let up = "src/gl/pass.rs: gl -> maps by maps::Map";
    assert_eq!(with("gl/pass.rs", "use crate::maps::Map;"), [up]);
    assert_eq!(with("gl/pass.rs", "use crate::{error::{self, Error}, maps::{Map}};"), [up]);
    assert_eq!(with("gl/pass.rs", "fn f() { crate::maps::Map; }"), [up]);
    assert_eq!(with("gl/pass.rs", "use super::super::maps::Map;"), [up]);
    assert_eq!(with("gl/pass.rs", "mod tests { use super::super::super::{maps::Map}; }"), [up]);
    assert_eq!(with("gl/pass.rs", "/* use crate::maps::Map; */ // crate::maps::Map"), [""; 0]);
    // What all may name points up as well, where it is named from below.
    let rooms: Rooms<'_> = &[("error", &[]), ("image", &[])];
    let files = [("error.rs", "use crate::image::Image;"), ("image.rs", "use crate::error::Error;")];
    assert_eq!(faults(rooms, &Package::planted(&files)), ["src/error.rs: error -> image by image::Image"]);
}

#[test]
fn a_way_through_the_root_of_the_library_is_seen() {
    assert_eq!(with("gl/pass.rs", "use crate::Map;"), ["src/gl/pass.rs: Map goes through lib.rs"]);
    assert_eq!(with("gl/pass.rs", "use super::super::Map;"), ["src/gl/pass.rs: Map goes through lib.rs"]);
    assert_eq!(with("maps/mask.rs", "use crate::*;"), ["src/maps/mask.rs: * goes through lib.rs"]);

    let lab = |text| {
        let root = ("lib.rs", "mod a; pub use a::A; pub const COMMIT: &str = \"\";");
        through_the_root(&Package::planted(&[root, ("a.rs", ""), ("b.rs", text)]))
    };
    assert_eq!(lab("use crate::a::A; use crate::COMMIT;"), [""; 0]);
    assert_eq!(lab("use crate::A;"), ["src/b.rs: A goes through lib.rs"]);
}

#[test]
fn a_table_that_is_out_of_date_is_seen() {
    assert_eq!(with("light/mod.rs", ""), ["src/light/mod.rs: the room light is not in the table"]);
    let files = [("error.rs", ""), ("gl.rs", "use crate::maps::Map;"), ("maps.rs", "")];
    let rooms: Rooms<'_> = &[("gl", &["maps"]), ("error", &[]), ("maps", &["gl"]), ("light", &[])];
    let expected = [
        "the table has gl -> maps, which does not point down",
        "the table has a room light, which is not there",
        "the table has maps -> gl, which no file needs",
    ];
    assert_eq!(faults(rooms, &Package::planted(&files)), expected);
}
