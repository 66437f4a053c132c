//! Materials: what transmits is glass, polished metal a mirror, and all else diffuse.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec3;
use gltf_json::extensions::material::Volume;
use gltf_json::material::AlphaMode;
use gltf_json::texture::Info;
use gltf_json::validation::Checked;
use gltf_json::{Index, Material as Entry};

use super::document::Document;
use super::left_out::{Kind, LeftOut};
use super::texture::Textures;
use super::{super::checked, Problem};
use crate::scene::{Material, Scattering, Texture};

const BASE_TEXTURE: Kind = (
    "base colour texture (the base colour alone counts)",
    "base colour textures (the base colours alone count)",
);
const EMISSIVE_TEXTURE: Kind =
    ("emissive texture (nothing shines in its place)", "emissive textures (nothing shines in their place)");
const NORMAL_TEXTURE: Kind = ("normal texture", "normal textures");
const OCCLUSION_TEXTURE: Kind = ("occlusion texture", "occlusion textures");
const METAL_TEXTURE: Kind = ("metallic-roughness texture", "metallic-roughness textures");
const TRANSMISSION_TEXTURE: Kind = ("transmission texture", "transmission textures");
const MASK: Kind = ("alpha mask (drawn opaque)", "alpha masks (drawn opaque)");
const BLEND: Kind = ("alpha blend (drawn opaque)", "alpha blends (drawn opaque)");
const SHARE: Kind = (
    "transmission between 0 and 1 (taken as the nearer)",
    "transmissions between 0 and 1 (taken as the nearer)",
);
const METAL_GLASS: Kind = ("metallic part of glass", "metallic parts of glass");
const ROUGH_GLASS: Kind = ("roughness of glass", "roughnesses of glass");
const TINT: Kind = ("colour of solid glass", "colours of solid glass");
const BACK: Kind =
    ("light from the back of a double-sided surface", "lights from the backs of double-sided surfaces");

/// The format's default for primitives without a material.
const DEFAULT_NAME: &str = "default material";

/// The materials of primitives, each made when first used.
pub(super) struct Materials<'a> {
    document: &'a Document<'a>,
    textures: Textures<'a>,
    /// By index in the file, and by whether there are coordinates for the two textures.
    known: HashMap<(Option<u32>, [bool; 2]), u32>,
    pub(super) made: Vec<Material>,
}

/// The textures that count for a material: that of its base colour, and that of its emission.
pub(super) fn textures<'a>(
    document: &'a Document<'_>,
    index: Option<Index<Entry>>,
    place: &str,
) -> Result<[Option<&'a Info>; 2], Problem> {
    let Some(index) = index else {
        return Ok([None, None]);
    };
    let entry = document.find(index, "material", format!("{place}.material"))?;
    Ok(of(entry))
}

fn of(entry: &Entry) -> [Option<&Info>; 2] {
    let base = entry.pbr_metallic_roughness.base_color_texture.as_ref().filter(|_| !is_solid(entry));
    let emissive =
        entry.emissive_texture.as_ref().filter(|_| Vec3::from(entry.emissive_factor.0) != Vec3::ZERO);
    [base, emissive]
}

impl<'a> Materials<'a> {
    pub(super) fn new(document: &'a Document<'a>) -> Self {
        Self { document, textures: Textures::new(document), known: HashMap::new(), made: Vec::new() }
    }

    /// The index of a material among those made. Textures without coordinates (not `placed`) are left out.
    ///
    /// # Errors
    /// If there is no such material, or its numbers are not possible.
    pub(super) fn index(
        &mut self,
        index: Option<Index<Entry>>,
        placed: [bool; 2],
        left_out: &mut LeftOut,
    ) -> Result<u32, Problem> {
        let number = index.and_then(|index| u32::try_from(index.value()).ok());
        if let Some(&made) = self.known.get(&(number, placed)) {
            return Ok(made);
        }
        let material = match index {
            Some(index) => {
                let entry = self.document.find(index, "material", "meshes: material")?;
                // What a material lacks is reported once, though it may be made with and without coordinates.
                if !self.known.keys().any(|(known, _)| *known == number) {
                    tell(entry, left_out);
                }
                self.make(entry, index.value(), placed, left_out)?
            }
            None => Material::plain(DEFAULT_NAME.to_owned(), Scattering::Lambert(Vec3::ONE), Vec3::ZERO),
        };
        let made = u32::try_from(self.made.len()).expect("fewer than 2^32 materials fit into memory");
        self.made.push(material);
        self.known.insert((number, placed), made);
        Ok(made)
    }

    fn make(
        &mut self,
        entry: &Entry,
        index: usize,
        placed: [bool; 2],
        left_out: &mut LeftOut,
    ) -> Result<Material, Problem> {
        let name = entry.name.clone().unwrap_or_else(|| format!("material {}", index + 1));
        let [base, emissive] = of(entry);
        let reflectance_texture = self.texture(base, placed[0], BASE_TEXTURE, left_out);
        let emission_texture = self.texture(emissive, placed[1], EMISSIVE_TEXTURE, left_out);
        // A texture mostly keeps a surface dark: without it the factor would make a lamp of the whole.
        let emission =
            if emissive.is_some() && emission_texture.is_none() { Vec3::ZERO } else { emission(entry) };
        let plain = checked(Material::plain(name, scattering(entry), emission))?;
        Ok(Material { reflectance_texture, emission_texture, ..plain })
    }

    fn texture(
        &mut self,
        info: Option<&Info>,
        placed: bool,
        kind: Kind,
        left_out: &mut LeftOut,
    ) -> Option<Arc<Texture>> {
        let info = info?;
        let texture = if placed {
            self.textures.texture(info.index)
        } else {
            Err(format!("{}: a primitive has no coordinates for it", self.textures.name(info.index)))
        };
        texture.map_err(|reason| left_out.name(kind, reason)).ok()
    }
}

fn transmission(entry: &Entry) -> f32 {
    let own = entry.extensions.as_ref().and_then(|extensions| extensions.transmission.as_ref());
    own.map_or(0.0, |own| own.transmission_factor.0)
}

fn volume(entry: &Entry) -> Option<&Volume> {
    let own = entry.extensions.as_ref().and_then(|extensions| extensions.volume.as_ref());
    own.filter(|own| own.thickness_factor.0 > 0.0)
}

/// Whether light goes through, and not through a thin wall but a body.
fn is_solid(entry: &Entry) -> bool {
    transmission(entry) >= 0.5 && volume(entry).is_some()
}

fn base_colour(entry: &Entry) -> Vec3 {
    let [red, green, blue, _] = entry.pbr_metallic_roughness.base_color_factor.0;
    Vec3::new(red, green, blue)
}

fn scattering(entry: &Entry) -> Scattering {
    let surface = &entry.pbr_metallic_roughness;
    let colour = base_colour(entry);
    let own = entry.extensions.as_ref().and_then(|extensions| extensions.ior.as_ref());
    let index = own.map_or(1.5, |own| own.ior.0);
    if transmission(entry) >= 0.5 {
        return match index {
            // In the format this is an infinite index, at which everything is reflected.
            0.0 => Scattering::Mirror(Vec3::ONE),
            _ if volume(entry).is_some() => Scattering::Dielectric { index },
            _ => Scattering::ThinDielectric { index, transmittance: colour },
        };
    }
    if surface.metallic_factor.0 >= 0.5 && surface.roughness_factor.0 <= 0.1 {
        Scattering::Mirror(colour)
    } else {
        Scattering::Lambert(colour)
    }
}

fn emission(entry: &Entry) -> Vec3 {
    let own = entry.extensions.as_ref().and_then(|extensions| extensions.emissive_strength.as_ref());
    Vec3::from(entry.emissive_factor.0) * own.map_or(1.0, |own| own.emissive_strength.0)
}

/// What of a material the picture will lack, but for textures that can't be read.
fn tell(entry: &Entry, left_out: &mut LeftOut) {
    let surface = &entry.pbr_metallic_roughness;
    let extensions = entry.extensions.as_ref();
    let glass = transmission(entry) >= 0.5;
    let transmission_texture = extensions
        .and_then(|all| all.transmission.as_ref())
        .is_some_and(|own| own.transmission_texture.is_some());
    let attenuates = volume(entry).is_some_and(|own| {
        own.attenuation_distance.0.is_finite() && Vec3::from(own.attenuation_color.0) != Vec3::ONE
    });
    let tinted = surface.base_color_texture.is_some() || base_colour(entry) != Vec3::ONE;
    let translucent = surface.base_color_factor.0[3] < 1.0 || surface.base_color_texture.is_some();
    for (kind, is_lacking) in [
        (NORMAL_TEXTURE, entry.normal_texture.is_some()),
        (OCCLUSION_TEXTURE, entry.occlusion_texture.is_some()),
        (METAL_TEXTURE, surface.metallic_roughness_texture.is_some()),
        (TRANSMISSION_TEXTURE, transmission_texture),
        (SHARE, !matches!(transmission(entry), 0.0 | 1.0)),
        (METAL_GLASS, glass && surface.metallic_factor.0 > 0.0),
        (ROUGH_GLASS, glass && surface.roughness_factor.0 > 0.1),
        (TINT, is_solid(entry) && (attenuates || tinted)),
        (MASK, translucent && entry.alpha_mode == Checked::Valid(AlphaMode::Mask)),
        (BLEND, translucent && entry.alpha_mode == Checked::Valid(AlphaMode::Blend)),
        (BACK, entry.double_sided && emission(entry) != Vec3::ZERO),
    ] {
        left_out.add(kind, usize::from(is_lacking));
    }
}
