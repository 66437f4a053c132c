//! EXT_mesh_gpu_instancing: one mesh at many places of its node.

use glam::{DAffine3, DQuat, DVec3};
use gltf_json::{Accessor, Index, Node, Value};

use super::accessor::Whole;
use super::document::Document;
use super::node::unit;
use super::{Problem, problem};

const NAME: &str = "EXT_mesh_gpu_instancing";

/// Where a node's mesh stands, from the node's coordinates; once as it is without the extension.
///
/// # Errors
/// If the numbers can't be read, or are not as many for each part of the transforms.
pub(super) fn places(document: &Document<'_>, node: &Node, index: usize) -> Result<Vec<DAffine3>, Problem> {
    let others = node.extensions.as_ref().map(|extensions| &extensions.others);
    let Some(attributes) = others.and_then(|others| others.get(NAME)).and_then(|own| own.get("attributes"))
    else {
        return Ok(vec![DAffine3::IDENTITY]);
    };
    let place = |name: &str| format!("nodes[{index}].extensions.{NAME}.attributes.{name}");
    let translations = of::<3>(document, attributes, "TRANSLATION", &place("TRANSLATION"))?;
    let rotations = of::<4>(document, attributes, "ROTATION", &place("ROTATION"))?;
    let scales = of::<3>(document, attributes, "SCALE", &place("SCALE"))?;
    let counts = [
        translations.as_ref().map(Vec::len),
        rotations.as_ref().map(Vec::len),
        scales.as_ref().map(Vec::len),
    ];
    let count = counts.into_iter().flatten().next().unwrap_or(0);
    if counts.into_iter().flatten().any(|other| other != count) {
        return Err(problem(place("*"), "they have different counts", "export the mesh again"));
    }
    document.spend((count * size_of::<DAffine3>()) as u64, place("*"))?;
    let one = |number: usize| {
        let rotation = rotations.as_ref().map(|all| unit(all[number].map(f64::from)));
        let rotation = rotation.unwrap_or(Some(DQuat::IDENTITY)).ok_or_else(|| {
            let reason = format!("item {} is no quaternion of length 1", number + 1);
            problem(place("ROTATION"), reason, "export the mesh again")
        })?;
        let vector = |all: &Option<Vec<[f32; 3]>>, otherwise: DVec3| {
            all.as_ref().map_or(otherwise, |all| DVec3::from(all[number].map(f64::from)))
        };
        let (scale, translation) = (vector(&scales, DVec3::ONE), vector(&translations, DVec3::ZERO));
        Ok(DAffine3::from_scale_rotation_translation(scale, rotation, translation))
    };
    (0..count).map(one).collect()
}

fn of<const N: usize>(
    document: &Document<'_>,
    attributes: &Value,
    name: &str,
    place: &str,
) -> Result<Option<Vec<[f32; N]>>, Problem> {
    let Some(value) = attributes.get(name) else {
        return Ok(None);
    };
    let index = value.as_u64().and_then(|index| u32::try_from(index).ok()).ok_or_else(|| {
        problem(place, format!("{value} is no index of an accessor"), "export the mesh again")
    })?;
    document.floats(Index::<Accessor>::new(index), Whole::AsSaid, place).map(Some)
}
