//! The JSON of a glTF file, without what this program does not use.

use std::cell::{Cell, OnceCell};
use std::collections::BTreeMap;
use std::fmt::Display;

use gltf_json::root::Get;
use gltf_json::{Index, Root, Value};

use super::left_out::{Kind, LeftOut};
use super::{Problem, container, extensions, problem};
use crate::scene::source::Files;

const REMEDY: &str = "export the mesh again as glTF 2.0";

/// Bytes of numbers that a file may bring without buffers to hold them: by repetition, or as zeros that are
/// told and not stored.
const ALLOWANCE: u64 = 1 << 28;

const CAMERAS: Kind = ("camera", "cameras");
const ANIMATIONS: Kind = ("animation (shown at rest)", "animations (shown at rest)");

/// A glTF file, and what its buffers hold.
pub(super) struct Document<'a> {
    pub(super) root: Root,
    pub(super) files: &'a Files,
    /// Empty, or ends in `/`.
    pub(super) folder: String,
    /// The bytes that a GLB brings.
    pub(super) blob: Option<&'a [u8]>,
    /// Of each buffer, once it was used.
    pub(super) contents: Vec<OnceCell<Vec<u8>>>,
    /// Bytes that may still be made of the file.
    pub(super) allowance: Cell<u64>,
}

/// What is recorded of the JSON before it is parsed.
#[derive(Default)]
struct Census {
    cameras: usize,
    animations: usize,
    /// How often each extension is used.
    extensions: BTreeMap<String, usize>,
}

impl<'a> Document<'a> {
    /// Parses a file named `name`.
    ///
    /// # Errors
    /// If it is no glTF 2.0, or needs an extension that is not supported.
    pub(super) fn new(
        content: &'a [u8],
        files: &'a Files,
        name: &str,
        left_out: &mut LeftOut,
    ) -> Result<Self, Problem> {
        let (json, blob) = container::split(content)?;
        let (root, census) = parse(json)?;
        let version = &root.asset.version;
        let newer = root.asset.min_version.as_deref().is_some_and(|least| least != "2.0");
        if !version.starts_with("2.") || newer {
            let least = root.asset.min_version.as_deref().unwrap_or(version);
            let reason = format!("it is glTF {least}, and only 2.0 is supported");
            return Err(problem("asset.version", reason, REMEDY));
        }
        let mut used = census.extensions;
        for name in root.extensions_used.iter().chain(&root.extensions_required) {
            used.entry(name.clone()).or_insert(1);
        }
        extensions::check(&root.extensions_required, &used, left_out)?;
        left_out.add(CAMERAS, census.cameras);
        left_out.add(ANIMATIONS, census.animations);
        let contents = root.buffers.iter().map(|_| OnceCell::new()).collect();
        let folder = name.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
        Ok(Self { root, files, folder, blob, contents, allowance: Cell::new(ALLOWANCE) })
    }

    /// What an index names.
    ///
    /// # Errors
    /// If there is no such `what`, with the place of the index.
    pub(super) fn find<T>(&self, index: Index<T>, what: &str, place: impl Display) -> Result<&T, Problem>
    where
        Root: Get<T>,
    {
        self.root
            .get(index)
            .ok_or_else(|| problem(place, format!("there is no {what} {index}"), "export the mesh again"))
    }
}

/// The JSON as far as it concerns pictures.
fn parse(json: &[u8]) -> Result<(Root, Census), Problem> {
    let refused = |place: String, error: &gltf_json::Error| {
        let place = if place == "." { String::new() } else { format!("{place}: ") };
        problem("not a glTF file", format!("{place}{error}"), REMEDY)
    };
    let mut value: Value =
        gltf_json::deserialize::from_slice(json).map_err(|error| refused(".".to_owned(), &error))?;
    let mut census = Census::default();
    if let Some(root) = value.as_object_mut() {
        let mut take = |name: &str| root.remove(name).and_then(|list| list.as_array().map(Vec::len));
        census.cameras = take("cameras").unwrap_or(0);
        census.animations = take("animations").unwrap_or(0);
        // A scene may do without nodes.
        for scene in root.get_mut("scenes").and_then(Value::as_array_mut).into_iter().flatten() {
            if let Some(scene) = scene.as_object_mut() {
                scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
            }
        }
    }
    census.visit(&mut value);
    let root = serde_path_to_error::deserialize::<_, Root>(value)
        .map_err(|error| refused(error.path().to_string(), error.inner()))?;
    Ok((root, census))
}

impl Census {
    /// Counts extensions, and removes data of applications (`extras`).
    ///
    /// The depth is bounded by that of the JSON, which its reader limits.
    fn visit(&mut self, value: &mut Value) {
        match value {
            Value::Object(fields) => {
                fields.remove("extras");
                if let Some(Value::Object(extensions)) = fields.get("extensions") {
                    for name in extensions.keys() {
                        *self.extensions.entry(name.clone()).or_default() += 1;
                    }
                }
                for field in fields.values_mut() {
                    self.visit(field);
                }
            }
            Value::Array(items) => {
                for item in items {
                    self.visit(item);
                }
            }
            _ => {}
        }
    }
}
