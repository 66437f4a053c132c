//! No circles inside a folder, in all three packages.
//!
//! The neighbours in a folder are its files and its sub-folders, each sub-folder as a whole. One names
//! another where any path in it leads there, after what modules only hand on is followed to the file that
//! defines it. The folder's own `mod.rs` (for the folder `src`, `lib.rs` or `main.rs`) is no neighbour: it
//! stands for the folder, so that it may name what is inside and what is inside may name what it defines.

use std::collections::{BTreeMap, BTreeSet};

use crate::modules::{Package, Place, words};
use crate::{SOURCES, assert_none};

/// Neighbours that name each other, by folder, each with the paths that tie them.
fn circles(package: &Package) -> Vec<String> {
    let mut arrows: BTreeMap<Place, BTreeMap<&str, BTreeMap<String, String>>> = BTreeMap::new();
    for (from, module) in &package.0 {
        for name in &module.names {
            let place = package.defined_at(name);
            let to = package.module_of(&place);
            let common = from.iter().zip(to).take_while(|(a, b)| a == b).count();
            if common < from.len() && common < to.len() {
                let of_folder = arrows.entry(from[..common].to_vec()).or_default();
                let of_neighbour = of_folder.entry(from[common].as_str()).or_default();
                of_neighbour.entry(to[common].clone()).or_insert_with(|| words(&place));
            }
        }
    }
    let mut circles = Vec::new();
    for (folder, arrows) in &arrows {
        for (from, named) in arrows {
            for (to, by) in named {
                if reached_from(arrows, to).contains(from) {
                    circles.push(format!("in `{}`: {from} -> {to} by {by}", words(folder)));
                }
            }
        }
    }
    circles
}

/// What a neighbour names, and what that names, and so on.
fn reached_from<'a>(
    arrows: &'a BTreeMap<&str, BTreeMap<String, String>>,
    from: &'a str,
) -> BTreeSet<&'a str> {
    let (mut reached, mut next) = (BTreeSet::new(), vec![from]);
    while let Some(at) = next.pop() {
        for to in arrows.get(at).into_iter().flat_map(BTreeMap::keys) {
            if reached.insert(to.as_str()) {
                next.push(to);
            }
        }
    }
    reached
}

#[test]
fn no_neighbours_name_each_other_in_a_circle() {
    for sources in SOURCES {
        assert_none(&circles(&Package::of(sources)));
    }
}

#[test]
fn a_circle_is_seen() {
    let two = [
        ("bench/mod.rs", "mod rivals; mod table; pub use table::order;"),
        ("bench/rivals.rs", "use super::order;"),
        ("bench/table.rs", "use super::rivals;"),
    ];
    let expected = [
        "in `bench`: rivals -> table by bench::table::order",
        "in `bench`: table -> rivals by bench::rivals",
    ];
    assert_eq!(circles(&Package::planted(&two)), expected);
    // By way of a file in between, and of a file in a sub-folder.
    let three = [
        ("bench/case.rs", "use super::settings::Settings;"),
        ("bench/settings.rs", "use super::fast::Suite;"),
        ("bench/fast/mod.rs", "mod rows; pub struct Suite;"),
        ("bench/fast/rows.rs", "use crate::bench::case::Case;"),
    ];
    assert_eq!(circles(&Package::planted(&three)).len(), 3);
}

#[test]
fn a_folder_and_what_is_in_it_may_name_each_other() {
    let files = [
        ("gl/mod.rs", "mod pass; pub use pass::Pass; pub struct Gl;"),
        ("gl/pass.rs", "use super::Gl; use crate::gl::state::State;"),
        ("gl/state.rs", "use super::Gl;"),
    ];
    assert_eq!(circles(&Package::planted(&files)), [""; 0]);
}
