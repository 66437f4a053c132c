//! One style of modules, and names that say which file is meant.
//!
//! A module with others inside is a folder with `mod.rs`. A name stands for one module of a package, unless
//! it is in the table of what several rooms have a part in, each under its own folder's name. A name that
//! means one thing here and another there does not belong in the table: it gets a longer name in one of the
//! places.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::{SOURCES, assert_none, files_below};

/// The names that stand for several modules of a package, and what they have in common.
const SHARED: [(&str, &[(&str, &str)]); 3] = [
    (
        "src",
        &[
            ("context", "the OpenGL context that a host has, or that the library opens"),
            ("density", "photons per pixel: the map, and the stage that counts them"),
            ("direct", "light that comes without a detour: all at once, step by step, and its definition"),
            ("even", "radii by the rule of even density: with OpenGL, and by their definition"),
            ("frame", "what a host brings each frame, for Rust and for C"),
            ("irradiance", "what reaches a surface: the map, the stages, their settings, their C interface"),
            ("layers", "parts of a picture: where they are made, and their file"),
            ("light", "what lamps send out, and what of it arrives"),
            ("material", "what a surface is made of: ours, and as a format has it"),
            ("picture", "the picture of a scene: what is asked of it, and its definition"),
            ("pipeline", "density map in, radius map out, for Rust and for C"),
            ("pyramid", "the mipmap of sums, with OpenGL and by its definition"),
            ("radius", "half a side of the smallest box: the map, and how it is found"),
            ("reference", "what a result is compared with"),
            ("settings", "what is asked for, of the library and of the room above it"),
            ("summed_area_table", "the table of sums, with OpenGL and by its definition"),
            ("surfaces", "what pixels show: the maps, and the stage that draws them"),
            ("tables", "what sums of boxes are read from: of photons, of light, and by the definition"),
            ("texture", "an image on a surface or in OpenGL: ours, and as a format has it"),
        ],
    ),
    (
        "lab/src",
        &[
            ("density", "photons per area: how well it is estimated, and how much of it the thesis had"),
            ("files", "the files of the runs that the folder makes"),
            ("picture", "the picture of a scene: its errors, and its run time"),
            ("report", "what a run found: as data, and as a page"),
            ("row", "a line of what a run found"),
            ("rows", "the lines that a suite has"),
            ("shape", "what the photons of a map look like"),
            ("targets", "what a suite or study should reach, and whether it does"),
        ],
    ),
    (
        "cli/src",
        &[
            ("report", "what the verb of the folder answers"),
            ("table", "what the verb of the folder found, for people"),
        ],
    ),
];

/// Modules `name.rs` beside a folder `name`.
fn beside_folders(files: &[PathBuf]) -> Vec<String> {
    let is_folder = |path: &Path| files.iter().any(|file| file.parent() == Some(path));
    let modules = files.iter().filter(|file| is_folder(&file.with_extension("")));
    modules.map(|file| format!("{} is beside a folder of its name: use mod.rs", file.display())).collect()
}

/// What is wrong with the names of modules, or with the table of shared ones.
fn repeated(files: &[PathBuf], shared: &[(&str, &str)]) -> Vec<String> {
    let mut named: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for file in files {
        let module = if file.ends_with("mod.rs") { file.parent().unwrap() } else { file };
        let name = module.file_stem().unwrap().to_str().unwrap();
        named.entry(name).or_default().push(file.display().to_string());
    }
    let is_shared = |name: &str| shared.iter().any(|(word, _)| *word == name);
    let again = named.iter().filter(|(name, files)| files.len() > 1 && !is_shared(name));
    let mut faults: Vec<String> =
        again.map(|(name, files)| format!("{name} is the name of {}", files.join(", "))).collect();
    let single = shared.iter().filter(|(name, _)| named.get(name).is_none_or(|files| files.len() < 2));
    faults.extend(single.map(|(name, _)| format!("{name} is in the table, and not shared")));
    faults
}

#[test]
fn a_module_with_others_inside_is_a_folder() {
    for folder in SOURCES.into_iter().chain(["tests", "lab/tests", "cli/tests", "examples"]) {
        assert_none(&beside_folders(&files_below(folder, &["rs"])));
    }
}

#[test]
fn no_two_modules_have_one_name_by_accident() {
    for (sources, shared) in SHARED {
        assert_none(&repeated(&files_below(sources, &["rs"]), shared));
    }
}

#[test]
fn a_second_style_and_a_second_use_of_a_name_are_seen() {
    let files = |names: &[&str]| names.iter().map(PathBuf::from).collect::<Vec<_>>();
    assert_eq!(beside_folders(&files(&["src/gl/mod.rs", "src/gl/pass.rs", "src/maps.rs"])), [""; 0]);
    let expected = ["src/gl.rs is beside a folder of its name: use mod.rs"];
    assert_eq!(beside_folders(&files(&["src/gl.rs", "src/gl/pass.rs"])), expected);

    let tables = files(&["src/gl/table.rs", "src/reference/table/mod.rs", "src/gl/mod.rs"]);
    let expected = ["table is the name of src/gl/table.rs, src/reference/table/mod.rs"];
    assert_eq!(repeated(&tables, &[]), expected);
    assert_eq!(repeated(&tables, &[("table", "")]), [""; 0]);
    assert_eq!(repeated(&tables, &[("table", ""), ("gl", "")]), ["gl is in the table, and not shared"]);
}
