//! What the library pulls in, and the Rust version that all dependencies need.

use std::collections::BTreeSet;
use std::process::Command;

use serde_json::{Value, json};

use crate::root;

fn cargo(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO")).args(arguments).current_dir(root()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The crates that the library itself pulls in without features.
#[test]
fn the_library_without_features_needs_only_small_crates() {
    let options =
        ["--no-default-features", "--edges", "normal", "--depth", "1", "--prefix", "none", "--locked"];
    let tree = cargo(&[["tree", "--package", "varikernel"].as_slice(), &options].concat());
    let direct: BTreeSet<_> = tree.lines().skip(1).filter_map(|line| line.split(' ').next()).collect();
    assert_eq!(direct, BTreeSet::from(["bytemuck", "glam", "glow", "thiserror", "tracing"]));
}

/// Packages that need a newer Rust than the library promises, of a workspace as `cargo metadata` describes
/// it.
fn newer(metadata: &Value) -> Vec<&str> {
    let version = |text: &str| {
        let mut parts = text.split('.').map(|part| part.parse::<u32>().unwrap());
        (parts.next().unwrap(), parts.next().unwrap_or(0))
    };
    let packages = metadata["packages"].as_array().unwrap();
    let promised = packages.iter().find(|package| package["name"] == "varikernel").unwrap();
    let promised = version(promised["rust_version"].as_str().unwrap());
    packages
        .iter()
        .filter(|package| package["rust_version"].as_str().is_some_and(|needed| version(needed) > promised))
        .map(|package| package["name"].as_str().unwrap())
        .collect()
}

#[test]
fn no_dependency_needs_a_newer_rust_than_the_manifest_promises() {
    let metadata: Value =
        serde_json::from_str(&cargo(&["metadata", "--format-version", "1", "--locked"])).unwrap();
    assert_eq!(newer(&metadata), [""; 0]);
    assert!(metadata["packages"].as_array().unwrap().len() > 50, "the list is read");
}

#[test]
fn a_dependency_that_needs_a_newer_rust_is_seen() {
    let package = |name, needed| json!({ "name": name, "rust_version": needed });
    let packages = [package("varikernel", "1.92"), package("glam", "1.68.2"), package("egui", "1.100")];
    assert_eq!(newer(&json!({ "packages": packages })), ["egui"]);
}
