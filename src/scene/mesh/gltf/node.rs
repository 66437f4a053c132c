//! Nodes: where each of them stands, and which are drawn.

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};
use gltf_json::{Node, Value};

use super::document::Document;
use super::{Problem, problem};

const REMEDY: &str = "export the mesh again";

/// All nodes of a file.
pub(super) struct Nodes {
    /// From each node to the mesh's coordinates.
    pub(super) to_world: Vec<DAffine3>,
    /// Indices of those that are drawn, parents before children.
    pub(super) drawn: Vec<usize>,
}

impl Nodes {
    /// Places all nodes, and lists those of the scene to be shown: the file's default, else its first, else
    /// everything.
    ///
    /// # Errors
    /// If the nodes are no trees, or a transform holds numbers that are not finite.
    pub(super) fn new(document: &Document<'_>) -> Result<Self, Problem> {
        let nodes = &document.root.nodes;
        let mut parents = vec![None; nodes.len()];
        for (index, node) in nodes.iter().enumerate() {
            for &child in node.children.iter().flatten() {
                let place = || format!("nodes[{index}].children");
                document.find(child, "node", place())?;
                if let Some(other) = parents[child.value()].replace(index) {
                    let reason = format!("node {child} is a child of node {other} as well");
                    return Err(problem(place(), reason, "give each node one parent"));
                }
            }
        }
        // Those without parents first, then always the children of those that are placed.
        let mut order: Vec<usize> = (0..nodes.len()).filter(|&index| parents[index].is_none()).collect();
        let roots = order.len();
        let mut to_world = vec![DAffine3::IDENTITY; nodes.len()];
        let mut next = 0;
        while let Some(&index) = order.get(next) {
            let above = parents[index].map_or(DAffine3::IDENTITY, |parent: usize| to_world[parent]);
            to_world[index] = above * to_parent(&nodes[index], index)?;
            if !to_world[index].is_finite() {
                let reason = "with those above it, its transform is past all numbers";
                return Err(problem(format!("nodes[{index}]"), reason, "scale the nodes down"));
            }
            order.extend(nodes[index].children.iter().flatten().map(gltf_json::Index::value));
            next += 1;
        }
        let mut placed = vec![false; nodes.len()];
        for &index in &order {
            placed[index] = true;
        }
        if let Some(ring) = placed.iter().position(|placed| !placed) {
            return Err(problem(
                format!("nodes[{ring}]"),
                "the node is below itself",
                "give each node one parent",
            ));
        }
        order.truncate(roots);
        let drawn = drawn(document, order)?;
        Ok(Self { to_world, drawn })
    }
}

/// The nodes of the scene to be shown that are not hidden.
fn drawn(document: &Document<'_>, roots: Vec<usize>) -> Result<Vec<usize>, Problem> {
    let root = &document.root;
    let scene = match root.scene {
        Some(index) => Some(document.find(index, "scene", "scene")?),
        None => root.scenes.first(),
    };
    let mut seen = vec![false; root.nodes.len()];
    let mut drawn = match scene {
        Some(scene) => {
            for &node in &scene.nodes {
                document.find(node, "node", "scenes: nodes")?;
            }
            scene.nodes.iter().map(gltf_json::Index::value).collect()
        }
        None => roots,
    };
    drawn.retain(|&index| !std::mem::replace(&mut seen[index], true) && is_visible(&root.nodes[index]));
    let mut next = 0;
    while let Some(&index) = drawn.get(next) {
        for child in root.nodes[index].children.iter().flatten().map(gltf_json::Index::value) {
            if !std::mem::replace(&mut seen[child], true) && is_visible(&root.nodes[child]) {
                drawn.push(child);
            }
        }
        next += 1;
    }
    Ok(drawn)
}

/// KHR_node_visibility, for the node and all below it.
fn is_visible(node: &Node) -> bool {
    let others = node.extensions.as_ref().map(|extensions| &extensions.others);
    let visible =
        others.and_then(|others| others.get("KHR_node_visibility")).and_then(|own| own.get("visible"));
    visible.and_then(Value::as_bool).unwrap_or(true)
}

/// A node's own transform.
fn to_parent(node: &Node, index: usize) -> Result<DAffine3, Problem> {
    let wrong = |what: &str, reason: &str| Err(problem(format!("nodes[{index}].{what}"), reason, REMEDY));
    if let Some(matrix) = node.matrix {
        let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        return if matrix.is_finite() {
            Ok(DAffine3::from_mat4(matrix))
        } else {
            wrong("matrix", "every number must be finite")
        };
    }
    let translation = DVec3::from(node.translation.unwrap_or_default().map(f64::from));
    let scale = DVec3::from(node.scale.unwrap_or([1.0; 3]).map(f64::from));
    let rotation = node.rotation.unwrap_or_default().0.map(f64::from);
    if !(translation.is_finite() && scale.is_finite()) {
        return wrong("translation", "every number of it and of the scale must be finite");
    }
    match unit(rotation) {
        Some(rotation) => Ok(DAffine3::from_scale_rotation_translation(scale, rotation, translation)),
        None => wrong("rotation", "it is no quaternion of length 1"),
    }
}

/// A rotation, of length 1 as well as it can be.
pub(super) fn unit(quaternion: [f64; 4]) -> Option<DQuat> {
    let quaternion = DQuat::from_array(quaternion);
    let length = quaternion.length();
    (length.is_finite() && length > 0.0).then(|| quaternion * (1.0 / length))
}

/// The matrix by which normals turn, whatever the transform does to lengths: that of the cofactors, with the
/// sign of the mirrored side.
pub(super) fn normal_matrix(to_world: DMat3) -> DMat3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = to_world;
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if to_world.determinant() < 0.0 { cofactors * -1.0 } else { cofactors }
}
