//! Images of MTL files: `map_Kd` for the reflectance, `map_Ke` for the emission.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec3;

use super::lines::shown;
use super::mtl::{DEFAULT_DIFFUSE, Entry, ImageName};
use crate::scene::mesh::images::Images;
use crate::scene::mesh::{Mesh, Part};
use crate::scene::source::{self, Files};
use crate::scene::{Material, Scattering, Texture, Wrap};

/// Images that were read, and why others were not, by path and by whether they are clamped.
pub(super) struct Pictures<'a> {
    files: &'a Files,
    images: Images,
    known: HashMap<(String, bool), Result<Arc<Texture>, String>>,
}

impl<'a> Pictures<'a> {
    pub(super) fn new(files: &'a Files) -> Self {
        Self { files, images: Images::default(), known: HashMap::new() }
    }

    /// Gives a material of the MTL file at `path` its images; `notes` gets what of them is left out.
    pub(super) fn hang(
        &mut self,
        path: &str,
        entry: &Entry<'_>,
        material: &mut Material,
        notes: &mut Vec<String>,
    ) {
        if let Some(image) = entry.image("map_Kd") {
            let texture = match &mut material.scattering {
                Scattering::Lambert(reflectance) => {
                    let texture = self.texture(path, &image);
                    // Some programs leave the colour black, as the image is all of it.
                    if texture.is_ok() && *reflectance == Vec3::ZERO {
                        notes.push("Kd 0 beside map_Kd, 1 is taken".to_owned());
                        *reflectance = Vec3::ONE;
                    }
                    texture
                }
                _ => Err("only diffuse materials have images".to_owned()),
            };
            material.reflectance_texture = told("map_Kd", &image, texture, notes);
            if let (Scattering::Lambert(reflectance), None) =
                (&mut material.scattering, &material.reflectance_texture)
                && !entry.has("Kd")
            {
                notes.push(format!("no Kd, {DEFAULT_DIFFUSE} is taken"));
                *reflectance = Vec3::splat(DEFAULT_DIFFUSE);
            }
        }
        if let Some(image) = entry.image("map_Ke") {
            let texture = self.texture(path, &image);
            material.emission_texture = told("map_Ke", &image, texture, notes);
            if material.emission_texture.is_none() {
                material.emission = Vec3::ZERO;
            } else if material.emission == Vec3::ZERO {
                notes.push("Ke 0 beside map_Ke, 1 is taken".to_owned());
                material.emission = Vec3::ONE;
            }
        }
    }

    fn texture(&mut self, path: &str, image: &ImageName) -> Result<Arc<Texture>, String> {
        let file = source::beside(path, &image.name)?;
        let key = (file, image.clamped);
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let wrap = if image.clamped { Wrap::Clamp } else { Wrap::Repeat };
        let read = self.files.read(&key.0).and_then(|bytes| self.images.decode(&bytes));
        let read = read
            .map(|(size, texels)| Arc::new(Texture::new(image.name.clone(), size, texels, [wrap; 2], true)));
        self.known.insert(key, read.clone());
        read
    }
}

/// The texture, or a note that says why it is left out.
fn told(
    field: &str,
    image: &ImageName,
    texture: Result<Arc<Texture>, String>,
    notes: &mut Vec<String>,
) -> Option<Arc<Texture>> {
    let name = shown(&image.name);
    if !image.options.is_empty() {
        notes.push(format!("{} of texture \"{name}\" ({field})", image.options.join(", ")));
    }
    match texture {
        Ok(texture) => Some(texture),
        Err(reason) => {
            notes.push(format!("texture \"{name}\" ({field}): {reason}"));
            None
        }
    }
}

/// Faces without texture coordinates get a copy of their material without its images.
pub(super) fn without_coordinates(mesh: &mut Mesh) {
    let mut copies: HashMap<u32, u32> = HashMap::new();
    let Mesh { parts, materials, left_out, .. } = mesh;
    for Part { material, coordinates, .. } in parts {
        let Some(number) = *material else { continue };
        let own = &materials[number as usize];
        let has_images = own.reflectance_texture.is_some() || own.emission_texture.is_some();
        if !has_images || !coordinates[0].is_empty() {
            continue;
        }
        *material = Some(*copies.entry(number).or_insert_with(|| {
            let mut copy = materials[number as usize].clone();
            left_out.push(format!("images of material \"{}\" on faces without vt", shown(&copy.name)));
            copy.reflectance_texture = None;
            if copy.emission_texture.take().is_some() {
                copy.emission = Vec3::ZERO;
            }
            materials.push(copy);
            u32::try_from(materials.len() - 1).expect("fewer than 2^32 materials fit into memory")
        }));
    }
}
