//! glTF 2.0, as .gltf with .bin files or as .glb, its JSON parsed by `gltf-json`.
//!
//! Nothing in a file is trusted: each index and each range is checked where it is used, and memory is taken
//! only for what the buffers can fill. What the picture will lack is collected, and reported in one warning.

mod accessor;
mod attributes;
mod buffer;
mod compression;
mod container;
mod document;
mod extensions;
mod instances;
mod left_out;
mod light;
mod material;
mod node;
mod primitive;
mod skin;
mod texture;
mod uri;

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt::Display;

use super::{Mesh, Part, Problem};
use crate::scene::source::Files;
use document::Document;
use glam::{DAffine3, DMat3};
use left_out::LeftOut;
use material::Materials;
use node::Nodes;
use primitive::{Placing, Shop};

/// Reads a glTF file named `name`, whose buffers and images are inside it, in data URIs or beside it. Where
/// no materials are needed, nothing of them is read: no images, no colours of vertices.
///
/// # Errors
/// The place in the file, what is wrong there, and what to do about it.
pub(super) fn read(
    content: &[u8],
    files: &Files,
    name: &str,
    needs_materials: bool,
) -> Result<Mesh, Problem> {
    let mut left_out = LeftOut::default();
    let document = Document::new(content, files, name, &mut left_out)?;
    let nodes = Nodes::new(&document)?;
    let materials = needs_materials.then(|| Materials::new(&document));
    let mut shop = Shop { document: &document, materials, left_out };
    let mut mesh = Mesh::default();
    let mut skins = HashMap::new();
    for &index in &nodes.drawn {
        let node = &document.root.nodes[index];
        let to_world = nodes.to_world[index];
        mesh.lights.extend(light::light(&document, node, to_world, &mut shop.left_out)?);
        let Some(own) = node.mesh else {
            continue;
        };
        let place = format!("nodes[{index}]");
        let entry = document.find(own, "mesh", format!("{place}.mesh"))?;
        let joints = match node.skin.map(|skin| (skin, skins.entry(skin.value()))) {
            Some((_, Entry::Occupied(known))) => Some(&*known.into_mut()),
            Some((skin, Entry::Vacant(new))) => {
                Some(&*new.insert(skin::joints(&document, &nodes, skin, &format!("{place}.skin"))?))
            }
            None => None,
        };
        let places = match joints {
            // The joints alone say where a skinned mesh is.
            Some(_) => vec![DAffine3::IDENTITY],
            None => instances::places(&document, node, index)?,
        };
        let weights = node.weights.as_ref().or(entry.weights.as_ref()).map_or(&[][..], Vec::as_slice);
        for own_place in places {
            let to_world = to_world * own_place;
            // A node that is squeezed to a line or a point is a way to hide it.
            if joints.is_none() && node::normal_matrix(to_world.matrix3) == DMat3::ZERO {
                continue;
            }
            let placing = joints.map_or(Placing::Node(to_world), |joints| Placing::Skin(joints));
            for (number, primitive) in entry.primitives.iter().enumerate() {
                let place = format!("meshes[{own}].primitives[{number}]");
                mesh.parts.extend(shop.part(primitive, weights, placing, &place)?);
            }
        }
    }
    mesh.materials = shop.materials.map(|materials| materials.made).unwrap_or_default();
    mesh.left_out = shop.left_out.words();
    Ok(mesh)
}

/// What is wrong at a place of the file.
fn problem(place: impl Display, reason: impl Display, remedy: &'static str) -> Problem {
    (format!("{place}: {reason}"), remedy)
}
