//! Extensions of the format: which are read, which are left out with a warning, and which a mesh can't be
//! read without.

use std::collections::BTreeMap;

use super::compression::{COMPRESSIONS, compressed};
use super::left_out::{Kind, LeftOut};
use super::{Problem, problem};

/// Read, or reported where an object that uses them is read.
const READ: &[&str] = &[
    "EXT_mesh_gpu_instancing",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "MSFT_texture_dds",
];

/// They change no picture of the file at rest.
const WITHOUT_EFFECT: &[&str] = &[
    "EXT_instance_features",
    "EXT_mesh_features",
    "EXT_structural_metadata",
    "FB_ngon_encoding",
    "KHR_animation_pointer",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_packing_normalRoughnessMetallic",
    "MSFT_packing_occlusionRoughnessMetallic",
];

/// Beginnings of names whose extensions change neither places nor numbers of what is read.
const HARMLESS: &[&str] = &[
    "ADOBE_materials_",
    "EXT_lights_",
    "EXT_materials_",
    "EXT_texture_",
    "KHR_lights_",
    "KHR_materials_",
    "KHR_node_",
    "KHR_techniques_webgl",
    "KHR_texture_",
    "MSFT_texture_",
];

const UNKNOWN: Kind = ("extension", "extensions");

/// Counts the extensions that are not read.
///
/// # Errors
/// If the file needs one that a mesh can't be read without.
pub(super) fn check(
    required: &[String],
    used: &BTreeMap<String, usize>,
    left_out: &mut LeftOut,
) -> Result<(), Problem> {
    for name in required.iter().map(String::as_str) {
        if COMPRESSIONS.contains(&name) {
            return Err(compressed("extensionsRequired", name));
        }
        let known = READ.contains(&name) || WITHOUT_EFFECT.contains(&name);
        if !known && !HARMLESS.iter().any(|beginning| name.starts_with(beginning)) {
            let reason = format!("it needs the extension {name}, which is not supported");
            return Err(problem("extensionsRequired", reason, "export the mesh without that extension"));
        }
    }
    for (name, &count) in used {
        let name = name.as_str();
        if ![READ, WITHOUT_EFFECT, COMPRESSIONS].iter().any(|list| list.contains(&name)) {
            let times = if count > 1 { format!("{name}, {count} times") } else { name.to_owned() };
            left_out.name(UNKNOWN, times);
        }
    }
    Ok(())
}
