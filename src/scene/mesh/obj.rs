//! OBJ with its MTL, through `tobj`.

use std::io::Cursor;

use glam::Vec3;
use tobj::{LoadError, LoadOptions};

use super::{Mesh, Part, Problem};
use crate::scene::source::Files;
use crate::scene::{Material, Scattering};

/// Reads an OBJ file named `name`, whose MTL file is beside it.
pub(super) fn read(content: &[u8], files: &Files, name: &str) -> Result<Mesh, Problem> {
    let options =
        LoadOptions { triangulate: true, single_index: true, ignore_points: true, ignore_lines: true };
    let folder = name.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
    let (models, materials) = tobj::load_obj_buf(&mut Cursor::new(content), &options, |library| {
        let content = library.to_str().and_then(|library| files.read(&format!("{folder}{library}")).ok());
        tobj::load_mtl_buf(&mut Cursor::new(content.ok_or(LoadError::OpenFileFailed)?))
    })
    .map_err(|error| (format!("not an OBJ file: {error}"), "export the mesh again as OBJ"))?;

    let remedy = "put the MTL file beside the OBJ file, or name none and give the surface a material";
    let materials = materials.map_err(|error| (format!("its materials: {error}"), remedy))?;
    let parts = models.into_iter().map(|model| {
        let mesh = model.mesh;
        let points =
            |numbers: &[f32]| numbers.as_chunks::<3>().0.iter().copied().map(Vec3::from_array).collect();
        Part {
            positions: points(&mesh.positions),
            normals: if mesh.normals.len() == mesh.positions.len() {
                points(&mesh.normals)
            } else {
                Vec::new()
            },
            triangles: mesh.indices.as_chunks::<3>().0.to_vec(),
            material: mesh.material_id.and_then(|material| u32::try_from(material).ok()),
            ..Part::default()
        }
    });
    let parts = parts.collect();
    let materials = materials.into_iter().map(material).collect::<Result<_, _>>()?;
    Ok(Mesh { parts, materials, ..Mesh::default() })
}

/// Illumination models 4, 6, 7 and 9 are glass, 3, 5 and 8 mirrors, and others diffuse
/// (<https://paulbourke.net/dataformats/mtl/>).
fn material(found: tobj::Material) -> Result<Material, Problem> {
    let colour = |colour: Option<[f32; 3]>| Vec3::from_array(colour.unwrap_or_default());
    let scattering = match found.illumination_model {
        Some(4 | 6 | 7 | 9) => Scattering::Dielectric { index: found.optical_density.unwrap_or(1.5) },
        Some(3 | 5 | 8) => Scattering::Mirror(colour(found.specular)),
        _ => Scattering::Lambert(colour(found.diffuse)),
    };
    super::checked(Material::plain(found.name, scattering, colour(found.emissive)))
}
