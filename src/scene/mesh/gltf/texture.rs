//! Images of a glTF file: PNG and JPEG, in the file or beside it.

use std::collections::HashMap;
use std::sync::Arc;

use gltf_json::texture::{MagFilter, Sampler, Texture as Entry, WrappingMode};
use gltf_json::validation::Checked;
use gltf_json::{Image, Index};

use super::document::Document;
use super::uri;
use crate::scene::mesh::images::Images;
use crate::scene::{Texture, Wrap};

/// Extensions that bring images in formats which are not read.
const OTHER_FORMATS: &[&str] =
    &["KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds"];

/// An image's index, the wrap across and down, and whether texels are blended.
type Key = (usize, [u8; 2], bool);

/// Images that were read, and why others were not.
pub(super) struct Textures<'a> {
    document: &'a Document<'a>,
    known: HashMap<Key, Result<Arc<Texture>, String>>,
    images: Images,
}

impl<'a> Textures<'a> {
    pub(super) fn new(document: &'a Document<'a>) -> Self {
        Self { document, known: HashMap::new(), images: Images::default() }
    }

    /// What messages call a texture.
    pub(super) fn name(&self, index: Index<Entry>) -> String {
        let image = self.document.root.get(index).and_then(|texture| self.document.root.get(texture.source));
        image.map_or_else(|| format!("textures[{index}]"), |image| name(image, index.value()))
    }

    /// A texture of the file.
    ///
    /// # Errors
    /// Its name and why it can't be read.
    pub(super) fn texture(&mut self, index: Index<Entry>) -> Result<Arc<Texture>, String> {
        let named = |reason: &str| format!("{}: {reason}", self.name(index));
        let root = &self.document.root;
        let texture = root.get(index).ok_or_else(|| named("there is no such texture"))?;
        let Some(image) = root.get(texture.source) else {
            let others = texture.extensions.as_ref().map(|extensions| &extensions.others);
            let needs =
                OTHER_FORMATS.iter().find(|name| others.is_some_and(|others| others.contains_key(**name)));
            return Err(named(&match needs {
                Some(name) => format!("{name} is not supported, and there is no PNG or JPEG beside it"),
                None => "it has no image".to_owned(),
            }));
        };
        let sampler = texture.sampler.and_then(|index| root.get(index));
        let (wrap, blended) = sampler.map_or(([Wrap::Repeat; 2], true), sampling);
        let key = (texture.source.value(), wrap.map(|wrap| wrap as u8), blended);
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let name = self.name(index);
        let read = self
            .bytes(image)
            .and_then(|bytes| self.images.decode(&bytes))
            .map_err(|reason| format!("{name}: {reason}"));
        let read = read.map(|(size, texels)| Arc::new(Texture::new(name, size, texels, wrap, blended)));
        self.known.insert(key, read.clone());
        read
    }

    /// The file of an image.
    fn bytes(&self, image: &Image) -> Result<Vec<u8>, String> {
        let document = self.document;
        match (&image.uri, image.buffer_view) {
            (Some(uri), _) => uri::read(uri, &document.folder, document.files),
            (None, Some(view)) => document
                .view(view, "bufferView")
                .map(|(bytes, _)| bytes.to_vec())
                .map_err(|(reason, _)| reason),
            (None, None) => Err("it has neither uri nor bufferView".to_owned()),
        }
    }
}

fn name(image: &Image, index: usize) -> String {
    match (&image.uri, &image.name) {
        (Some(uri), _) if !uri.starts_with("data:") => uri::shown(uri),
        (_, Some(name)) => name.clone(),
        _ => format!("textures[{index}]"),
    }
}

fn sampling(sampler: &Sampler) -> ([Wrap; 2], bool) {
    let wrap = |mode| match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => Wrap::Repeat,
    };
    let blended = sampler.mag_filter != Some(Checked::Valid(MagFilter::Nearest));
    ([wrap(sampler.wrap_s), wrap(sampler.wrap_t)], blended)
}
