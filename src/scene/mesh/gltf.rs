//! glTF 2.0, as .gltf with .bin files or as .glb, through `gltf`.

use ::gltf::accessor::{Accessor, DataType, Dimensions};
use ::gltf::mesh::Mode;
use ::gltf::{Gltf, Node, buffer};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use glam::{Mat3, Mat4, Vec3, Vec4Swizzles as _};

use super::{Mesh, Part, Problem};
use crate::scene::source::Files;
use crate::scene::{Material, Scattering};

/// Nodes below nodes; deeper than this is taken as a ring.
const MAX_DEPTH: u32 = 100;
/// More items or bytes than this are no mesh but an attack on the memory.
const MAX_ITEMS: usize = 1 << 30;

const REMEDY: &str = "export the mesh again as glTF 2.0, without compression";

/// Reads a glTF file named `name`, whose buffers are inside it, in data URIs or beside it.
pub(super) fn read(content: &[u8], files: &Files, name: &str) -> Result<Mesh, Problem> {
    let gltf = Gltf::from_slice(content).map_err(|error| (format!("not a glTF file: {error}"), REMEDY))?;
    let folder = name.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
    let buffers = gltf.buffers().map(|buffer| bytes(&buffer, gltf.blob.as_deref(), files, &folder));
    let buffers = buffers.collect::<Result<Vec<_>, _>>()?;
    let scene = gltf.default_scene().or_else(|| gltf.scenes().next());
    let scene = scene.ok_or_else(|| ("the file has no scene".to_owned(), REMEDY))?;
    let mut parts = Vec::new();
    for node in scene.nodes() {
        add_node(&node, Mat4::IDENTITY, 0, &buffers, &mut parts)?;
    }
    let materials = gltf.materials().map(|found| material(&found)).collect::<Result<_, _>>()?;
    Ok(Mesh { parts, materials, ..Mesh::default() })
}

fn bytes(
    buffer: &buffer::Buffer<'_>,
    blob: Option<&[u8]>,
    files: &Files,
    folder: &str,
) -> Result<Vec<u8>, Problem> {
    let content = match buffer.source() {
        buffer::Source::Bin => blob.map(<[u8]>::to_vec).ok_or_else(|| "its BIN part is missing".to_owned()),
        buffer::Source::Uri(uri) => {
            match uri.strip_prefix("data:").and_then(|rest| rest.split_once(";base64,")) {
                Some((_, text)) => {
                    STANDARD.decode(text).map_err(|error| format!("a data URI is damaged: {error}"))
                }
                None => percent_encoding::percent_decode_str(uri)
                    .decode_utf8()
                    .map_err(|error| error.to_string())
                    .and_then(|path| files.read(&format!("{folder}{path}")))
                    .map_err(|problem| format!("its buffer {uri}: {problem}")),
            }
        }
    };
    content.map_err(|problem| (problem, "keep the buffers beside the mesh, in the scene's folder"))
}

fn add_node(
    node: &Node<'_>,
    parent: Mat4,
    depth: u32,
    buffers: &[Vec<u8>],
    parts: &mut Vec<Part>,
) -> Result<(), Problem> {
    if depth > MAX_DEPTH {
        return Err(("its nodes are nested too deep".to_owned(), REMEDY));
    }
    let to_world = parent * Mat4::from_cols_array_2d(&node.transform().matrix());
    for primitive in node.mesh().iter().flat_map(::gltf::Mesh::primitives) {
        if matches!(primitive.mode(), Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            continue;
        }
        if primitive.mode() != Mode::Triangles {
            return Err(("it has strips or fans of triangles".to_owned(), "export it as plain triangles"));
        }
        parts.push(part(&primitive, to_world, buffers)?);
    }
    for child in node.children() {
        add_node(&child, to_world, depth + 1, buffers, parts)?;
    }
    Ok(())
}

fn part(primitive: &::gltf::Primitive<'_>, to_world: Mat4, buffers: &[Vec<u8>]) -> Result<Part, Problem> {
    let broken = |what: &str| (format!("the {what} of a mesh can't be read"), REMEDY);
    let is_vec3 = |accessor: &Accessor<'_>| {
        accessor.data_type() == DataType::F32
            && accessor.dimensions() == Dimensions::Vec3
            && is_plain(accessor)
    };
    let is_index = |accessor: &Accessor<'_>| {
        matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32)
            && accessor.dimensions() == Dimensions::Scalar
            && is_plain(accessor)
    };
    let positions = primitive.get(&::gltf::Semantic::Positions);
    let normals = primitive.get(&::gltf::Semantic::Normals);
    if !positions.as_ref().is_some_and(is_vec3) || !normals.as_ref().is_none_or(is_vec3) {
        return Err(broken("positions or normals"));
    }
    if !primitive.indices().as_ref().is_none_or(is_index) {
        return Err(broken("faces"));
    }

    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    let positions: Vec<_> = reader.read_positions().ok_or_else(|| broken("positions"))?.collect();
    let normals: Vec<_> = match normals {
        Some(_) => reader.read_normals().ok_or_else(|| broken("normals"))?.collect(),
        None => Vec::new(),
    };
    let indices: Vec<u32> = match primitive.indices() {
        Some(_) => reader.read_indices().ok_or_else(|| broken("faces"))?.into_u32().collect(),
        None => (0..u32::try_from(positions.len()).map_err(|_| broken("faces"))?).collect(),
    };
    if !normals.is_empty() && normals.len() != positions.len() {
        return Err(broken("normals"));
    }

    let mut triangles = indices.as_chunks::<3>().0.to_vec();
    // A mirrored copy has its corners the other way round.
    if to_world.determinant() < 0.0 {
        for triangle in &mut triangles {
            triangle.swap(1, 2);
        }
    }
    let turn = Mat3::from_mat4(to_world).inverse().transpose();
    Ok(Part {
        positions: positions.iter().map(|&at| (to_world * Vec3::from(at).extend(1.0)).xyz()).collect(),
        normals: normals.iter().map(|&normal| turn * Vec3::from(normal)).collect(),
        triangles,
        material: primitive.material().index().and_then(|index| u32::try_from(index).ok()),
        ..Part::default()
    })
}

/// Whether an accessor can be read: not sparse, its items not overlapping, and its numbers not absurd.
fn is_plain(accessor: &Accessor<'_>) -> bool {
    let possible = |number: usize| number <= MAX_ITEMS;
    accessor.sparse().is_none()
        && (1..=MAX_ITEMS).contains(&accessor.count())
        && possible(accessor.offset())
        && accessor.view().is_some_and(|view| {
            possible(view.offset())
                && possible(view.length())
                && view.stride().is_none_or(|stride| (accessor.size()..=255).contains(&stride))
        })
}

/// What transmits (KHR_materials_transmission) is glass, polished metal a mirror, and all else diffuse.
fn material(found: &::gltf::Material<'_>) -> Result<Material, Problem> {
    let name = found
        .name()
        .map_or_else(|| format!("material {}", found.index().map_or(0, |index| index + 1)), str::to_owned);
    let surface = found.pbr_metallic_roughness();
    let [red, green, blue, _] = surface.base_color_factor();
    let colour = Vec3::new(red, green, blue);
    if surface.base_color_texture().is_some() {
        tracing::warn!(material = name, "the texture is left out; the base colour alone counts");
    }
    let scattering = if found.transmission().is_some_and(|glass| glass.transmission_factor() >= 0.5) {
        Scattering::Dielectric { index: found.ior().unwrap_or(1.5) }
    } else if surface.metallic_factor() >= 0.5 && surface.roughness_factor() <= 0.1 {
        Scattering::Mirror(colour)
    } else {
        Scattering::Lambert(colour)
    };
    let emission = Vec3::from(found.emissive_factor()) * found.emissive_strength().unwrap_or(1.0);
    super::checked(Material::plain(name, scattering, emission))
}
