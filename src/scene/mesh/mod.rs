//! Meshes by reference: OBJ and glTF 2.0.

mod gltf;
mod images;
mod obj;
mod smooth;

use glam::{Vec2, Vec3};

use super::fields::{MAX_COORDINATE, has_area};
use super::source::{self, Files};
use super::{Geometry, Light, Material, Scattering, Triangle, Vertex};

/// What is wrong with a mesh file, and what to do about it.
pub(super) type Problem = (String, &'static str);

/// What a mesh file holds.
#[derive(Default)]
pub(super) struct Mesh {
    pub(super) parts: Vec<Part>,
    pub(super) materials: Vec<Material>,
    /// Lights of the file that are no surfaces, in the coordinates of the parts.
    pub(super) lights: Vec<Light>,
    /// What the file holds and the picture will lack, each in a few words: `morph targets`, `texture
    /// "bark.webp" (WebP)`.
    pub(super) left_out: Vec<String>,
}

/// Triangles of one material.
#[derive(Default)]
pub(super) struct Part {
    pub(super) positions: Vec<Vec3>,
    /// One a position, or none at all.
    pub(super) normals: Vec<Vec3>,
    /// Linear RGB from 0 to 1, one a position, or none at all.
    pub(super) colours: Vec<Vec3>,
    /// Places in the material's reflectance texture and in its emission texture, one a position each, or none
    /// at all.
    pub(super) coordinates: [Vec<Vec2>; 2],
    /// Indices into the positions, inside them.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Index into the mesh's materials.
    pub(super) material: Option<u32>,
}

/// Reads a mesh file, by its extension. Where no materials are needed, faults in them are no errors.
pub(super) fn load(files: &Files, name: &str, needs_materials: bool) -> Result<Mesh, Problem> {
    let unreadable = |problem| (problem, "paths count from the scene's folder and stay inside it");
    let name = &source::normal_form(name).map_err(unreadable)?;
    let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension).to_ascii_lowercase();
    let mesh = match extension.as_str() {
        "obj" => obj::read(&files.read(name).map_err(unreadable)?, files, name, needs_materials)?,
        "gltf" | "glb" => gltf::read(&files.read(name).map_err(unreadable)?, files, name, needs_materials)?,
        _ => {
            let problem = "the extension is not that of a known mesh format".to_owned();
            return Err((problem, "use a mesh that ends in .obj, .gltf or .glb"));
        }
    };
    for part in &mesh.parts {
        check(part)?;
    }
    if mesh.lights.is_empty() && mesh.parts.iter().all(|part| part.triangles.is_empty()) {
        let left_out = match mesh.left_out.join("; ") {
            nothing if nothing.is_empty() => nothing,
            some => format!("; left out: {some}"),
        };
        return Err((format!("the mesh has no triangle{left_out}"), "export the mesh with its faces"));
    }
    Ok(mesh)
}

fn check(part: &Part) -> Result<(), Problem> {
    const REMEDY: &str = "export the mesh again; every number must be finite";
    let broken = |points: &[Vec3]| points.iter().position(|point| !point.is_finite());
    if let Some(number) = broken(&part.positions) {
        return Err((format!("the position of vertex {} is {}", number + 1, part.positions[number]), REMEDY));
    }
    if let Some(number) = broken(&part.normals) {
        return Err((format!("the normal of vertex {} is {}", number + 1, part.normals[number]), REMEDY));
    }
    if let Some(number) = part.colours.iter().position(|colour| !colour.is_finite()) {
        return Err((format!("the colour of vertex {} is {}", number + 1, part.colours[number]), REMEDY));
    }
    let vertices = part.positions.len();
    if part.triangles.iter().flatten().any(|&vertex| vertex as usize >= vertices) {
        return Err((format!("a face names a vertex past the last of {vertices}"), "export the mesh again"));
    }
    Ok(())
}

/// Whether a place is where scenes may be.
pub(super) fn is_possible(position: &Vec3) -> bool {
    position.is_finite() && f64::from(position.abs().max_element()) <= MAX_COORDINATE
}

/// Warns in one line of what a mesh file holds and the picture will lack.
pub(super) fn tell(name: &str, left_out: &[String]) {
    if !left_out.is_empty() {
        tracing::warn!("{name}: left out: {}", left_out.join("; "));
    }
}

/// Adds a mesh to the geometry as one surface, without the triangles that have no area, whose number it
/// gives.
///
/// # Errors
/// If no triangle is left, or a coordinate is too large after scaling.
pub(super) fn add(
    mesh: &Mesh,
    geometry: &mut Geometry,
    smooth: bool,
    surface: u32,
    material: impl Fn(Option<u32>) -> u32,
) -> Result<usize, Problem> {
    let mut dropped = 0;
    let mut whole = Vec::with_capacity(mesh.parts.len());
    for part in &mesh.parts {
        if !part.positions.iter().all(is_possible) {
            return Err((format!("a coordinate is past {MAX_COORDINATE:e}"), "scale the mesh down"));
        }
        let (with_area, flat): (Vec<[u32; 3]>, Vec<_>) =
            part.triangles.iter().partition(|triangle| has_area(&part.corners(triangle)));
        dropped += flat.len();
        whole.push(with_area);
    }
    let added: usize = whole.iter().map(Vec::len).sum();
    let normals = if smooth { smooth::normals(&mesh.parts, &whole) } else { Vec::new() };
    for (number, (part, triangles)) in mesh.parts.iter().zip(whole).enumerate() {
        let material = material(part.material);
        let Some(normals) = normals.get(number) else {
            for triangle in triangles {
                geometry.push_flat(part.corners(&triangle), surface, material);
                let first = geometry.vertices.len() - 3;
                for (vertex, index) in geometry.vertices[first..].iter_mut().zip(triangle) {
                    part.dress(index, vertex);
                }
            }
            continue;
        };
        let first = u32::try_from(geometry.vertices.len()).expect("fewer than 2^32 vertices fit into memory");
        for (index, (&position, &normal)) in (0..).zip(part.positions.iter().zip(normals)) {
            let mut vertex = Vertex::plain(position, normal);
            part.dress(index, &mut vertex);
            geometry.vertices.push(vertex);
        }
        geometry.triangles.extend(triangles.into_iter().map(|triangle| Triangle {
            vertices: triangle.map(|vertex| first + vertex),
            surface,
            material,
            smooth: true,
        }));
    }
    if added == 0 && mesh.lights.is_empty() {
        return Err(("no triangle of the mesh has an area".to_owned(), "export the mesh again"));
    }
    Ok(dropped)
}

impl Part {
    /// Where the corners of a triangle are.
    fn corners(&self, triangle: &[u32; 3]) -> [Vec3; 3] {
        triangle.map(|vertex| self.positions[vertex as usize])
    }

    /// Gives a vertex the colour and the texture coordinates of a position.
    fn dress(&self, index: u32, vertex: &mut Vertex) {
        let index = index as usize;
        vertex.colour = self.colours.get(index).copied().unwrap_or(Vec3::ONE);
        vertex.coordinates =
            [0, 1].map(|kind: usize| self.coordinates[kind].get(index).copied().unwrap_or_default());
    }
}

/// The material, if its numbers are possible.
fn checked(material: Material) -> Result<Material, Problem> {
    let name = &material.name;
    let share = |colour: Vec3| (Vec3::ZERO.cmple(colour) & colour.cmple(Vec3::ONE)).all();
    match material.scattering {
        Scattering::Lambert(reflectance) | Scattering::Mirror(reflectance) if !share(reflectance) => {
            Err((format!("the reflectance of material \"{name}\" is {reflectance}"), "it goes from 0 to 1"))
        }
        Scattering::Dielectric { index } if !(0.1..=10.0).contains(&index) => Err((
            format!("the index of refraction of material \"{name}\" is {index}"),
            "it goes from 0.1 to 10",
        )),
        Scattering::ThinDielectric { index, transmittance }
            if !(0.1..=10.0).contains(&index) || !share(transmittance) =>
        {
            Err((
                format!(
                    "the index {index} or transmittance {transmittance} of material \
                     \"{name}\" is not possible"
                ),
                "the index goes from 0.1 to 10, the transmittance from 0 to 1",
            ))
        }
        _ if !(material.emission.is_finite() && material.emission.min_element() >= 0.0) => {
            Err((format!("the emission of material \"{name}\" is {}", material.emission), "it starts at 0"))
        }
        _ => Ok(material),
    }
}
