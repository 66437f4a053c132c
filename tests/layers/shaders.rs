//! `glsl/` tells the same story as `src/`.
//!
//! Every shader outside of `glsl/common` is in a folder that has the path of a module of the library, and is
//! named by a file of that module. Nothing else names shaders by file.

use crate::modules::{Package, Place};
use crate::tokens::Token;
use crate::{SHADERS, assert_none, files_below};

/// Text files that several modules put into their shaders.
const COMMON: &str = "common";

/// What is wrong with shaders, by their names below `glsl/`, in a library.
fn faults(shaders: &[String], package: &Package) -> Vec<String> {
    let mut faults = Vec::new();
    for shader in shaders {
        let (folder, _) = shader.rsplit_once('/').unwrap_or_default();
        let place: Place = folder.split('/').map(str::to_owned).collect();
        let is_common = folder == COMMON;
        let named = |module: &[Token]| module.contains(&Token::Text(shader.clone()));
        let mut files = package.0.iter().filter(|(_, module)| named(&module.tokens));
        if !is_common && !package.0.contains_key(&place) {
            faults.push(format!("glsl/{shader}: the library has no module of the folder's name"));
        } else if !files.any(|(path, _)| is_common || path.starts_with(&place)) {
            faults.push(format!("glsl/{shader}: no file of the module of that name uses it"));
        }
    }
    faults
}

/// Files of a package that name a shader of the library.
fn naming(shaders: &[String], package: &Package) -> Vec<String> {
    let is_shader = |token: &Token| matches!(token, Token::Text(text) if shaders.contains(text));
    let modules = package.0.values().filter(|module| module.tokens.iter().any(is_shader));
    modules.map(|module| module.file.clone()).collect()
}

fn shaders() -> Vec<String> {
    let files = files_below("glsl", &SHADERS);
    files.iter().map(|file| file.strip_prefix("glsl").unwrap().to_str().unwrap().to_owned()).collect()
}

#[test]
fn shaders_stand_where_their_modules_do() {
    assert_none(&faults(&shaders(), &Package::of("src")));
}

#[test]
fn the_library_alone_names_its_shaders() {
    for sources in ["lab/src", "cli/src"] {
        assert_none(&naming(&shaders(), &Package::of(sources)));
    }
}

#[test]
fn a_shader_out_of_place_or_out_of_use_is_seen() {
    let package = Package::planted(&[
        ("light/mod.rs", "// glsl!(\"light/unused.frag\")\nfn f() { glsl!(\"gbuffer/plane.glsl\") }"),
        ("light/splat.rs", "fn f() { (glsl!(\"light/splat/spread.frag\"), glsl!(\"common/mask.glsl\")) }"),
        ("maps.rs", "fn f() { glsl!(\"light/density.frag\") }"),
    ]);
    let of = |shader: &str| faults(&[shader.to_owned()], &package).join("");
    assert_eq!(of("light/splat/spread.frag"), "");
    assert_eq!(of("common/mask.glsl"), "");
    for unused in ["light/unused.frag", "light/density.frag", "common/photon.glsl"] {
        assert!(of(unused).ends_with("uses it"), "{unused}");
    }
    assert!(of("gbuffer/plane.glsl").ends_with("no module of the folder's name"));
    assert_eq!(naming(&["light/density.frag".to_owned()], &package), ["src/maps.rs"]);
}
