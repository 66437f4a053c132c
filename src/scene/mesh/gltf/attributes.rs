//! The attributes of a primitive's vertices, as they are in the file.

use glam::{Vec2, Vec3};
use gltf_json::mesh::{Primitive, Semantic};
use gltf_json::texture::Info;
use gltf_json::validation::Checked;
use gltf_json::{Accessor, Index};

use super::accessor::Whole;
use super::document::Document;
use super::left_out::{Kind, LeftOut};
use super::{Problem, problem};

const REMEDY: &str = "export the mesh again";

const MORE_COLOURS: Kind = ("second set of vertex colours", "second sets of vertex colours");
const BEYOND: Kind = (
    "primitive whose vertex colours leave 0 to 1 (cut there)",
    "primitives whose vertex colours leave 0 to 1 (cut there)",
);

/// A primitive, and where it stands in the file.
pub(super) struct Attributes<'a> {
    pub(super) document: &'a Document<'a>,
    pub(super) primitive: &'a Primitive,
    pub(super) place: &'a str,
}

impl Attributes<'_> {
    fn accessor(&self, semantic: Semantic) -> Option<Index<Accessor>> {
        self.primitive.attributes.get(&Checked::Valid(semantic)).copied()
    }

    fn named(&self, name: &str) -> String {
        format!("{}.attributes.{name}", self.place)
    }

    /// Positions, moved by the morph targets; none where the primitive has none.
    pub(super) fn positions(&self, weights: &[f32]) -> Result<Option<Vec<Vec3>>, Problem> {
        let Some(accessor) = self.accessor(Semantic::Positions) else {
            return Ok(None);
        };
        let items = self.document.floats::<3>(accessor, Whole::AsSaid, &self.named("POSITION"))?;
        let mut positions: Vec<_> = items.into_iter().map(Vec3::from).collect();
        self.morph(&mut positions, weights, "POSITION")?;
        Ok(Some(positions))
    }

    /// Normals, turned by the morph targets; empty where the primitive has none.
    pub(super) fn normals(&self, vertices: usize, weights: &[f32]) -> Result<Vec<Vec3>, Problem> {
        let Some(accessor) = self.accessor(Semantic::Normals) else {
            return Ok(Vec::new());
        };
        let place = self.named("NORMAL");
        let items = self.document.floats::<3>(accessor, Whole::AsSaid, &place)?;
        let mut normals: Vec<_> = items.into_iter().map(Vec3::from).collect();
        as_many(normals.len(), vertices, &place)?;
        self.morph(&mut normals, weights, "NORMAL")?;
        Ok(normals)
    }

    /// Adds the offsets of the morph targets, by their weights.
    fn morph(&self, vectors: &mut [Vec3], weights: &[f32], name: &str) -> Result<(), Problem> {
        let targets = self.primitive.targets.iter().flatten().zip(weights).enumerate();
        for (number, (target, &weight)) in targets.filter(|(_, (_, weight))| **weight != 0.0) {
            let accessor = if name == "POSITION" { target.positions } else { target.normals };
            if let Some(accessor) = accessor {
                let place = format!("{}.targets[{number}].{name}", self.place);
                let offsets = self.document.floats::<3>(accessor, Whole::AsSaid, &place)?;
                as_many(offsets.len(), vectors.len(), &place)?;
                for (vector, offset) in vectors.iter_mut().zip(offsets) {
                    *vector += weight * Vec3::from(offset);
                }
            }
        }
        Ok(())
    }

    /// Linear RGB from 0 to 1; empty where the primitive has none.
    pub(super) fn colours(&self, vertices: usize, left_out: &mut LeftOut) -> Result<Vec<Vec3>, Problem> {
        left_out.add(MORE_COLOURS, usize::from(self.accessor(Semantic::Colors(1)).is_some()));
        let Some(accessor) = self.accessor(Semantic::Colors(0)) else {
            return Ok(Vec::new());
        };
        let place = self.named("COLOR_0");
        let colours: Vec<Vec3> = if self.document.width(accessor, &place)? == 4 {
            let items = self.document.floats::<4>(accessor, Whole::Shares, &place)?;
            items.into_iter().map(|[red, green, blue, _]| Vec3::new(red, green, blue)).collect()
        } else {
            self.document.floats::<3>(accessor, Whole::Shares, &place)?.into_iter().map(Vec3::from).collect()
        };
        as_many(colours.len(), vertices, &place)?;
        let inside: Vec<_> = colours.iter().map(|colour| colour.clamp(Vec3::ZERO, Vec3::ONE)).collect();
        left_out.add(BEYOND, usize::from(inside != colours));
        Ok(inside)
    }

    /// Places in a texture, as KHR_texture_transform moves them; none where the primitive lacks the set that
    /// they count in.
    pub(super) fn coordinates(&self, info: &Info, vertices: usize) -> Result<Option<Vec<Vec2>>, Problem> {
        let transform = info.extensions.as_ref().and_then(|extensions| extensions.texture_transform.as_ref());
        let set = transform.and_then(|transform| transform.tex_coord).unwrap_or(info.tex_coord);
        let Some(accessor) = self.accessor(Semantic::TexCoords(set)) else {
            return Ok(None);
        };
        let place = self.named(&format!("TEXCOORD_{set}"));
        let items = self.document.floats::<2>(accessor, Whole::AsSaid, &place)?;
        as_many(items.len(), vertices, &place)?;
        let mut coordinates: Vec<_> = items.into_iter().map(Vec2::from).collect();
        if let Some(transform) = transform {
            let (sin, cos) = transform.rotation.0.sin_cos();
            let (scale, offset) = (Vec2::from(transform.scale.0), Vec2::from(transform.offset.0));
            for one in &mut coordinates {
                let Vec2 { x, y } = *one * scale;
                // Counter-clockwise as seen, with the second coordinate downwards.
                *one = Vec2::new(cos * x + sin * y, cos * y - sin * x) + offset;
            }
        }
        Ok(Some(coordinates))
    }

    /// Faces of three vertices each, from lists, strips and fans.
    pub(super) fn triangles(&self, mode: Faces, vertices: usize) -> Result<Vec<[u32; 3]>, Problem> {
        let place = format!("{}.indices", self.place);
        let indices: Vec<u32> = match self.primitive.indices {
            Some(accessor) => {
                self.document.integers::<1>(accessor, &place)?.into_iter().map(|[one]| one).collect()
            }
            None => (0..u32::try_from(vertices).map_err(|_| problem(&place, "too many vertices", REMEDY))?)
                .collect(),
        };
        if let Some(number) = indices.iter().position(|&index| index as usize >= vertices) {
            let reason =
                format!("item {} is {}, and there are {vertices} vertices", number + 1, indices[number]);
            return Err(problem(place, reason, REMEDY));
        }
        let corners = indices.windows(3).enumerate();
        Ok(match mode {
            Faces::List => indices.as_chunks::<3>().0.to_vec(),
            // Every other face of a strip runs the other way round.
            Faces::Strip => corners
                .map(|(number, three)| match number % 2 {
                    0 => [three[0], three[1], three[2]],
                    _ => [three[0], three[2], three[1]],
                })
                .collect(),
            Faces::Fan => indices.windows(2).skip(1).map(|two| [two[0], two[1], indices[0]]).collect(),
        })
    }
}

/// How indices make faces.
#[derive(Clone, Copy)]
pub(super) enum Faces {
    List,
    Strip,
    Fan,
}

fn as_many(found: usize, vertices: usize, place: &str) -> Result<(), Problem> {
    if found == vertices {
        return Ok(());
    }
    Err(problem(place, format!("there are {found} of them for {vertices} vertices"), REMEDY))
}
