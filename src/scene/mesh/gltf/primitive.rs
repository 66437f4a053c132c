//! One primitive of a mesh: its faces where its node or its skin puts them.

use glam::DAffine3;
use gltf_json::Accessor;
use gltf_json::mesh::{Mode, Primitive};
use gltf_json::validation::Checked;

use super::attributes::{Attributes, Faces};
use super::compression::{COMPRESSIONS, compressed};
use super::left_out::{Kind, LeftOut};
use super::material::{self, Materials};
use super::node::normal_matrix;
use super::skin::Weights;
use super::{Document, Part, Problem, problem};

/// Bytes of memory that a primitive takes besides its numbers, as a rough bound.
const OVERHEAD: u64 = 1024;

const POINTS: Kind = ("primitive of points", "primitives of points");
const LINES: Kind = ("primitive of lines", "primitives of lines");
const WITHOUT_POSITIONS: Kind = ("primitive without positions", "primitives without positions");
const WITHOUT_WEIGHTS: Kind = (
    "skin of a primitive without weights (drawn as modelled)",
    "skins of primitives without weights (drawn as modelled)",
);

/// Where a mesh is put.
#[derive(Clone, Copy)]
pub(super) enum Placing<'a> {
    /// By the transform of its node.
    Node(DAffine3),
    /// By the joints of a skin, each from the mesh's coordinates to the world.
    Skin(&'a [DAffine3]),
}

/// The context of reading primitives, and where their data goes.
pub(super) struct Shop<'a> {
    pub(super) document: &'a Document<'a>,
    /// None where they are not needed.
    pub(super) materials: Option<Materials<'a>>,
    pub(super) left_out: LeftOut,
}

impl Shop<'_> {
    /// The triangles of a primitive at `place` in the file; none where it has none.
    ///
    /// # Errors
    /// If its numbers can't be read, or don't fit together.
    pub(super) fn part(
        &mut self,
        primitive: &Primitive,
        weights: &[f32],
        placing: Placing<'_>,
        place: &str,
    ) -> Result<Option<Part>, Problem> {
        let document = self.document;
        document.spend(OVERHEAD, place)?;
        let Some(faces) = self.faces(primitive, place)? else {
            return Ok(None);
        };
        let attributes = Attributes { document, primitive, place };
        uncompressed(document, primitive, place)?;
        let Some(positions) = attributes.positions(weights)? else {
            self.left_out.add(WITHOUT_POSITIONS, 1);
            return Ok(None);
        };
        let vertices = positions.len();
        let normals = attributes.normals(vertices, weights)?;
        let triangles = attributes.triangles(faces, vertices)?;
        let mut part = Part { positions, normals, triangles, ..Part::default() };
        if let Some(materials) = &mut self.materials {
            let textures = material::textures(document, primitive.material, place)?;
            let mut coordinates = [None, None];
            for (coordinates, info) in coordinates.iter_mut().zip(textures) {
                if let Some(info) = info {
                    *coordinates = attributes.coordinates(info, vertices)?;
                }
            }
            let placed = [0, 1].map(|kind: usize| coordinates[kind].is_some());
            part.material = Some(materials.index(primitive.material, placed, &mut self.left_out)?);
            part.coordinates = coordinates.map(Option::unwrap_or_default);
            part.colours = attributes.colours(vertices, &mut self.left_out)?;
        }
        match placing {
            Placing::Node(to_world) => put(&mut part, |_| to_world),
            Placing::Skin(joints) => {
                match Weights::new(document, primitive, vertices, joints.len(), place)? {
                    Some(weights) => put(&mut part, |vertex| weights.at(vertex, joints)),
                    None => self.left_out.add(WITHOUT_WEIGHTS, 1),
                }
            }
        }
        Ok(Some(part))
    }

    /// How the primitive's indices make faces, if they do.
    fn faces(&mut self, primitive: &Primitive, place: &str) -> Result<Option<Faces>, Problem> {
        let kind = match primitive.mode {
            Checked::Valid(Mode::Triangles) => return Ok(Some(Faces::List)),
            Checked::Valid(Mode::TriangleStrip) => return Ok(Some(Faces::Strip)),
            Checked::Valid(Mode::TriangleFan) => return Ok(Some(Faces::Fan)),
            Checked::Valid(Mode::Points) => POINTS,
            Checked::Valid(Mode::Lines | Mode::LineLoop | Mode::LineStrip) => LINES,
            Checked::Invalid => {
                return Err(problem(
                    format!("{place}.mode"),
                    "it is no kind of primitive",
                    "modes go from 0 to 6; export the mesh again",
                ));
            }
        };
        self.left_out.add(kind, 1);
        Ok(None)
    }
}

/// Moves a part from the coordinates of its mesh, each vertex by a transform of its own.
fn put(part: &mut Part, to_world: impl Fn(usize) -> DAffine3) {
    // What a transform mirrors has its corners the other way round.
    for triangle in &mut part.triangles {
        if to_world(triangle[0] as usize).matrix3.determinant() < 0.0 {
            triangle.swap(1, 2);
        }
    }
    for (vertex, position) in part.positions.iter_mut().enumerate() {
        *position = to_world(vertex).transform_point3(position.as_dvec3()).as_vec3();
    }
    for (vertex, normal) in part.normals.iter_mut().enumerate() {
        let turned = normal_matrix(to_world(vertex).matrix3) * normal.as_dvec3();
        *normal = turned.try_normalize().unwrap_or_default().as_vec3();
    }
}

/// Whether the vertices of a primitive are there without compression as well.
///
/// # Errors
/// If they are not.
fn uncompressed(document: &Document<'_>, primitive: &Primitive, place: &str) -> Result<(), Problem> {
    let others = primitive.extensions.as_ref().map(|extensions| &extensions.others);
    let Some(name) =
        COMPRESSIONS.iter().find(|name| others.is_some_and(|others| others.contains_key(**name)))
    else {
        return Ok(());
    };
    let is_empty = |index| document.root.get(index).is_some_and(|one: &Accessor| one.buffer_view.is_none());
    if primitive.attributes.values().chain(&primitive.indices).copied().any(is_empty) {
        return Err(compressed(place, name));
    }
    Ok(())
}
