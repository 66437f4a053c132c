//! A stage names no stage: what passes between them is in `maps`, and what puts them in order is above them.

use crate::assert_none;
use crate::modules::{Package, Place, words};

/// The stages of a picture beside the radii: whole modules, or the maker alone where its map is in the same
/// file.
const STAGES: [&str; 10] = [
    "maps::mask::MaskMaker",
    "maps::position::PositionMaker",
    "light::density",
    "light::splat",
    "light::gather",
    "light::tables",
    "render::surfaces",
    "render::bounce_map",
    "render::shadow_map",
    "render::shade",
];

fn faults(package: &Package) -> Vec<String> {
    let stages = STAGES.map(|stage| stage.split("::").map(str::to_owned).collect::<Place>());
    let mut faults = Vec::new();
    for (path, module) in &package.0 {
        let is_own = |stage: &Place| {
            let of_stage = package.module_of(stage);
            of_stage.len() == 2 && path.starts_with(of_stage)
        };
        if !stages.iter().any(is_own) {
            continue;
        }
        for place in module.names.iter().map(|name| package.defined_at(name)) {
            if stages.iter().any(|stage| place.starts_with(stage) && !is_own(stage)) {
                faults.push(format!("{} names {}", module.file, words(&place)));
            }
        }
    }
    faults
}

#[test]
fn a_stage_names_no_stage() {
    let package = Package::of("src");
    for stage in STAGES {
        let place: Place = stage.split("::").map(str::to_owned).collect();
        let depth = package.module_of(&place).len();
        let is_there = depth == 2
            && (place.len() == depth
                || package.0[&place[..depth]].tokens.iter().any(|token| token.is_word(&place[depth])));
        assert!(is_there, "{stage} is not there");
    }
    assert_none(&faults(&package));
}

#[test]
fn a_stage_that_names_another_is_seen() {
    let files = |gather| {
        [
            ("maps/mod.rs", "mod mask; pub use mask::{Mask, MaskMaker};"),
            ("maps/mask.rs", "pub struct Mask; pub struct MaskMaker;"),
            ("light/mod.rs", "mod density; mod gather; pub use density::DensityStage;"),
            ("light/density.rs", "pub struct DensityStage; pub(super) fn draw() {}"),
            ("light/gather.rs", gather),
            ("render/surfaces.rs", ""),
            ("render/cube_map.rs", ""),
        ]
    };
    let faults = |gather| faults(&Package::planted(&files(gather)));
    assert_eq!(faults("use crate::maps::Mask; use crate::render::cube_map; use self::f;"), [""; 0]);
    assert_eq!(
        faults("use super::DensityStage;"),
        ["src/light/gather.rs names light::density::DensityStage"]
    );
    assert_eq!(
        faults("fn f() { super::density::draw() }"),
        ["src/light/gather.rs names light::density::draw"]
    );
    assert_eq!(faults("use crate::maps::MaskMaker;"), ["src/light/gather.rs names maps::mask::MaskMaker"]);
    assert_eq!(faults("use crate::render::surfaces;"), ["src/light/gather.rs names render::surfaces"]);
}
