//! The rules of the house that code can check: arrows between modules, where `unsafe` may stand, what each feature
//! pulls in, and the minimum Rust version of the dependencies.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// Each room and the rooms that it may name. `error`, `image` and `settings` are plain data and open to all.
const ARROWS: &[(&str, &[&str])] = &[
    ("error", &[]),
    ("image", &[]),
    ("settings", &[]),
    ("gl", &[]),
    ("context", &["gl"]),
    ("view", &[]),
    ("photon_point", &["view"]),
    ("scene", &["view"]),
    ("photon", &["photon_point", "scene", "view"]),
    ("reference", &["photon_point", "view"]),
    ("synth", &[]),
    ("exactness", &["reference"]),
    ("maps", &["exactness", "gl", "photon_point", "view"]),
    ("mask", &["gl"]),
    ("frame", &["maps", "mask"]),
    ("structure", &["exactness", "frame", "gl", "maps"]),
    ("driver_limits", &["gl", "structure"]),
    ("radius", &["exactness", "frame", "gl", "maps", "mask", "structure"]),
    ("certificate", &["exactness", "gl", "maps", "structure"]),
    (
        "pipeline",
        &["certificate", "exactness", "gl", "driver_limits", "frame", "maps", "mask", "radius", "structure"],
    ),
    ("planner", &["exactness"]),
    ("adaptive", &["exactness", "frame", "gl", "maps", "pipeline", "planner", "structure"]),
    ("position", &["gl", "view"]),
    ("density", &["exactness", "gl", "maps"]),
    ("splat", &["density", "gl", "maps"]),
    ("irradiance", &["density", "frame", "gl", "maps", "pipeline", "splat"]),
    (
        "capi",
        &[
            "adaptive",
            "exactness",
            "frame",
            "gl",
            "irradiance",
            "maps",
            "mask",
            "photon_point",
            "pipeline",
            "position",
            "view",
        ],
    ),
    ("cube_map", &["gl", "scene"]),
    ("bounce_map", &["cube_map", "gl", "photon", "scene"]),
    ("shadow_map", &["cube_map", "gl", "maps", "scene"]),
    ("gbuffer", &["gl", "maps", "scene", "view"]),
    ("shade", &["gl", "maps"]),
    (
        "render",
        &[
            "bounce_map",
            "cube_map",
            "density",
            "frame",
            "gbuffer",
            "gl",
            "irradiance",
            "maps",
            "photon",
            "pipeline",
            "reference",
            "scene",
            "shade",
            "shadow_map",
            "splat",
            "view",
        ],
    ),
    (
        "measure",
        &[
            "certificate",
            "density",
            "exactness",
            "frame",
            "gbuffer",
            "gl",
            "maps",
            "mask",
            "photon",
            "pipeline",
            "planner",
            "radius",
            "reference",
            "render",
            "scene",
            "splat",
            "structure",
            "synth",
            "view",
        ],
    ),
];
const OPEN_TO_ALL: [&str; 3] = ["error", "image", "settings"];
/// OpenGL is a C interface, contexts are opened by C, and C calls us.
const UNSAFE_ROOMS: [&str; 3] = ["capi", "context", "gl"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn files_below(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(files_below(&path, extension));
        } else if path.extension().is_some_and(|found| found == extension) {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// The room of a file: `src/gl/pass.rs` and `src/gl/mod.rs` are `gl`, `src/radius.rs` is `radius`.
fn room(file: &Path) -> String {
    let inside = file.strip_prefix(root().join("src")).unwrap();
    inside.components().next().unwrap().as_os_str().to_str().unwrap().trim_end_matches(".rs").to_owned()
}

/// Whether a text without comments has unsafe code.
fn is_unsafe(code: &str) -> bool {
    ["unsafe {", "unsafe fn", "unsafe impl", "unsafe extern", "#[unsafe("]
        .iter()
        .any(|form| code.contains(form))
}

/// The text without comments, so that documentation may name any room.
fn code(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap()).collect::<Vec<_>>().join("\n")
}

/// Rooms named as `crate::room`, or first in the braces of `crate::{room::Thing, ...}`.
fn named_rooms(code: &str) -> BTreeSet<String> {
    let word = |text: &str| {
        text.chars().take_while(|letter| letter.is_alphanumeric() || *letter == '_').collect::<String>()
    };
    let named = code.split("crate::").skip(1).flat_map(|after| match after.strip_prefix('{') {
        Some(group) => {
            let group = group.split('}').next().unwrap();
            assert!(!group.contains('{'), "one level of braces is all that is read here: {group}");
            group.split(',').map(|name| word(name.trim())).collect()
        }
        None => vec![word(after)],
    });
    named.filter(|name| name.starts_with(char::is_lowercase)).collect()
}

/// Arrows that the table does not allow, as `from -> to`.
fn forbidden(from: &str, code: &str) -> Vec<String> {
    let arrows: BTreeMap<_, _> = ARROWS.iter().copied().collect();
    let allowed = arrows.get(from).unwrap_or_else(|| panic!("room {from} is not in the table of arrows"));
    named_rooms(code)
        .into_iter()
        .filter(|to| to != from && !OPEN_TO_ALL.contains(&to.as_str()) && !allowed.contains(&to.as_str()))
        .map(|to| format!("{from} -> {to}"))
        .collect()
}

#[test]
fn arrows_point_down() {
    let mut found = BTreeSet::new();
    for file in files_below(&root().join("src"), "rs") {
        let room = room(&file);
        // The binary is built on the public library alone, under the crate's name.
        if ["lib", "main", "cli"].contains(&room.as_str()) {
            continue;
        }
        let arrows = forbidden(&room, &code(&fs::read_to_string(&file).unwrap()));
        assert!(arrows.is_empty(), "{}: {arrows:?}", file.display());
        found.insert(room);
    }
    let table: BTreeSet<_> = ARROWS.iter().map(|(room, _)| (*room).to_owned()).collect();
    assert_eq!(found, table, "rooms on disk and in the table");
}

#[test]
fn an_arrow_that_points_up_is_seen() {
    assert_eq!(forbidden("reference", "use crate::gl::Gl;"), ["reference -> gl"]);
    assert_eq!(forbidden("gl", "let x = crate::pipeline::new();"), ["gl -> pipeline"]);
    assert_eq!(forbidden("image", "use crate::{Error, gl::Gl};"), ["image -> gl"]);
    assert!(forbidden("radius", "use crate::gl::Gl; use crate::error::Result;").is_empty());
}

#[test]
fn unsafe_code_stands_in_three_rooms_alone() {
    let mut found = BTreeSet::new();
    for file in files_below(&root().join("src"), "rs") {
        if is_unsafe(&code(&fs::read_to_string(&file).unwrap())) {
            assert!(UNSAFE_ROOMS.contains(&room(&file).as_str()), "{}", file.display());
            found.insert(room(&file));
        }
    }
    assert_eq!(found, UNSAFE_ROOMS.map(str::to_owned).into(), "rooms with unsafe code");
}

#[test]
fn unsafe_code_is_seen_in_each_form() {
    let forms = [
        "unsafe { f() }",
        "unsafe fn f()",
        "unsafe impl T",
        "pub unsafe extern \"C\" fn f()",
        "#[unsafe(no_mangle)]",
    ];
    assert!(forms.into_iter().all(is_unsafe));
    assert!(!is_unsafe("#![expect(unsafe_code)] let is_unsafe = true;"));
}

#[test]
fn every_shader_file_is_used_and_stays_a_page() {
    let sources: String =
        files_below(&root().join("src"), "rs").iter().map(|file| fs::read_to_string(file).unwrap()).collect();
    for extension in ["glsl", "frag", "vert"] {
        for file in files_below(&root().join("glsl"), extension) {
            let name = file.strip_prefix(root().join("glsl")).unwrap().to_str().unwrap();
            assert!(sources.contains(name), "glsl/{name} is not used");
            assert!(fs::read_to_string(&file).unwrap().lines().count() <= 150, "glsl/{name}");
        }
    }
}

fn cargo(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO")).args(arguments).current_dir(root()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The crates that the library itself pulls in without features.
#[test]
fn the_library_without_features_needs_only_small_crates() {
    let tree = cargo(&[
        "tree",
        "--no-default-features",
        "--edges",
        "normal",
        "--depth",
        "1",
        "--prefix",
        "none",
        "--locked",
    ]);
    let direct: BTreeSet<_> = tree.lines().skip(1).filter_map(|line| line.split(' ').next()).collect();
    assert_eq!(direct, BTreeSet::from(["bytemuck", "glam", "glow", "thiserror", "tracing"]));
}

#[test]
fn no_dependency_needs_a_newer_rust_than_the_manifest_promises() {
    let metadata: Value =
        serde_json::from_str(&cargo(&["metadata", "--format-version", "1", "--locked"])).unwrap();
    let version = |text: &str| {
        let mut parts = text.split('.').map(|part| part.parse::<u32>().unwrap());
        (parts.next().unwrap(), parts.next().unwrap_or(0))
    };
    let packages = metadata["packages"].as_array().unwrap();
    let promised = packages.iter().find(|package| package["name"] == "varikernel").unwrap();
    let promised = version(promised["rust_version"].as_str().unwrap());
    let newer: Vec<_> = packages
        .iter()
        .filter(|package| package["rust_version"].as_str().is_some_and(|needed| version(needed) > promised))
        .map(|package| package["name"].as_str().unwrap())
        .collect();
    assert!(newer.is_empty(), "{newer:?} need more than {promised:?}");
    assert!(packages.len() > 50, "the list is read");
}
