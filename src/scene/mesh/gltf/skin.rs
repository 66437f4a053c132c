//! Skins at rest: each vertex goes where its joints take it, and its node's own transform does not count.

use glam::{DAffine3, DMat4};
use gltf_json::mesh::{Primitive, Semantic};
use gltf_json::validation::Checked;
use gltf_json::{Index, Skin};

use super::accessor::Whole;
use super::document::Document;
use super::node::Nodes;
use super::{Problem, problem};

const REMEDY: &str = "export the mesh again";

/// From the coordinates of the skinned mesh to the world, by each joint of a skin.
///
/// # Errors
/// If the joints are no nodes, or their matrices can't be read.
pub(super) fn joints(
    document: &Document<'_>,
    nodes: &Nodes,
    index: Index<Skin>,
    place: &str,
) -> Result<Vec<DAffine3>, Problem> {
    let skin = document.find(index, "skin", place)?;
    let place = format!("skins[{index}]");
    let from_bind = match skin.inverse_bind_matrices {
        Some(accessor) => {
            let matrices =
                document.floats::<16>(accessor, Whole::AsSaid, &format!("{place}.inverseBindMatrices"))?;
            matrices
                .iter()
                .map(|one| DAffine3::from_mat4(DMat4::from_cols_array(&one.map(f64::from))))
                .collect()
        }
        None => vec![DAffine3::IDENTITY; skin.joints.len()],
    };
    if from_bind.len() < skin.joints.len() {
        let reason = format!("there are {} matrices for {} joints", from_bind.len(), skin.joints.len());
        return Err(problem(format!("{place}.inverseBindMatrices"), reason, REMEDY));
    }
    let joint = |(&joint, from_bind): (&Index<_>, DAffine3)| {
        document.find(joint, "node", format!("{place}.joints"))?;
        Ok(nodes.to_world[joint.value()] * from_bind)
    };
    skin.joints.iter().zip(from_bind).map(joint).collect()
}

/// How much each joint moves each vertex of a primitive.
pub(super) struct Weights {
    sets: Vec<Set>,
}

/// Four joints a vertex, and how much each of them counts.
struct Set {
    joints: Vec<[u32; 4]>,
    weights: Vec<[f32; 4]>,
}

impl Weights {
    /// The weights of a primitive with `vertices` vertices; none where it has none.
    ///
    /// # Errors
    /// If they can't be read, or name a joint past the last of `joints`.
    pub(super) fn new(
        document: &Document<'_>,
        primitive: &Primitive,
        vertices: usize,
        joints: usize,
        place: &str,
    ) -> Result<Option<Self>, Problem> {
        let mut sets = Vec::new();
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        while let Ok(set) = u32::try_from(sets.len())
            && let Some(numbers) = attribute(Semantic::Joints(set))
            && let Some(weights) = attribute(Semantic::Weights(set))
        {
            let place = |name: &str| format!("{place}.attributes.{name}_{set}");
            let numbers = document.integers::<4>(numbers, &place("JOINTS"))?;
            let weights = document.floats::<4>(weights, Whole::Shares, &place("WEIGHTS"))?;
            if numbers.len() != vertices || weights.len() != vertices {
                let reason =
                    format!("there are {} of them for {vertices} vertices", numbers.len().min(weights.len()));
                return Err(problem(place("JOINTS"), reason, REMEDY));
            }
            let mut used = numbers.iter().flatten().zip(weights.iter().flatten());
            if let Some((joint, _)) =
                used.find(|&(&joint, &weight)| weight != 0.0 && joint as usize >= joints)
            {
                let reason = format!("joint {joint} is named, and the skin has {joints}");
                return Err(problem(place("JOINTS"), reason, REMEDY));
            }
            sets.push(Set { joints: numbers, weights });
        }
        Ok((!sets.is_empty()).then_some(Self { sets }))
    }

    /// From the mesh's coordinates to the world, at a vertex: the mean of its joints.
    pub(super) fn at(&self, vertex: usize, joints: &[DAffine3]) -> DAffine3 {
        let mut sum = DMat4::ZERO;
        let mut total = 0.0;
        for set in &self.sets {
            for (&joint, &weight) in
                set.joints[vertex].iter().zip(&set.weights[vertex]).filter(|(_, weight)| **weight != 0.0)
            {
                sum += DMat4::from(joints[joint as usize]) * f64::from(weight);
                total += f64::from(weight);
            }
        }
        if total == 0.0 {
            // Nothing holds the vertex: it stays where it was modelled.
            return DAffine3::IDENTITY;
        }
        DAffine3::from_mat4(sum * (1.0 / total))
    }
}
