//! Images of a glTF file: PNG and JPEG, in the file or beside it.

use std::collections::HashMap;
use std::io::Cursor;
use std::sync::Arc;

use glam::UVec2;
use gltf_json::texture::{MagFilter, Sampler, Texture as Entry, WrappingMode};
use gltf_json::validation::Checked;
use gltf_json::{Image, Index};
use image::{DynamicImage, ImageDecoder as _, ImageFormat, ImageReader, Limits};

use super::document::Document;
use super::uri;
use crate::scene::{Texture, Wrap};

/// The longest side of an image.
const MAX_SIDE: u32 = 16384;
/// The most texels of all images together.
const MAX_TEXELS: u64 = 1 << 28;
/// The most bytes that a decoder may take.
const MAX_ALLOC: u64 = 1 << 30;

/// Extensions that bring images in formats which are not read.
const OTHER_FORMATS: &[&str] =
    &["KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds"];

/// An image's index, the wrap across and down, and whether texels are blended.
type Key = (usize, [u8; 2], bool);

/// Images that were read, and why others were not.
pub(super) struct Textures<'a> {
    document: &'a Document<'a>,
    known: HashMap<Key, Result<Arc<Texture>, String>>,
    /// Texels that may still be read.
    left: u64,
}

impl<'a> Textures<'a> {
    pub(super) fn new(document: &'a Document<'a>) -> Self {
        Self { document, known: HashMap::new(), left: MAX_TEXELS }
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
            .and_then(|bytes| self.decode(&bytes))
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

    /// Size and sRGB texels of an image, whose memory is taken only once its size is known to be possible.
    fn decode(&mut self, bytes: &[u8]) -> Result<(UVec2, Vec<[u8; 3]>), String> {
        let damaged = |error: image::ImageError| format!("it is damaged: {error}");
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format(bytes)?);
        let mut limits = Limits::default();
        limits.max_image_width = Some(MAX_SIDE);
        limits.max_image_height = Some(MAX_SIDE);
        limits.max_alloc = Some(MAX_ALLOC);
        reader.limits(limits);
        let decoder = reader.into_decoder().map_err(damaged)?;
        let (width, height) = decoder.dimensions();
        let texels = u64::from(width) * u64::from(height);
        if texels == 0 || width > MAX_SIDE || height > MAX_SIDE {
            return Err(format!("its size is {width} x {height}, and sides go from 1 to {MAX_SIDE}"));
        }
        self.left = self.left.checked_sub(texels).ok_or_else(|| {
            format!("with its {width} x {height} texels the images are more than {MAX_TEXELS}")
        })?;
        let pixels = DynamicImage::from_decoder(decoder).map_err(damaged)?.into_rgb8();
        Ok((UVec2::new(width, height), pixels.pixels().map(|pixel| pixel.0).collect()))
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

/// The format by the content; what the file calls it may be wrong.
fn format(bytes: &[u8]) -> Result<ImageFormat, String> {
    if bytes.starts_with(b"\xabKTX 20\xbb") {
        return Err("it is KTX2, and only PNG and JPEG are supported".to_owned());
    }
    match image::guess_format(bytes) {
        Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => Ok(format),
        Ok(other) => Err(format!("it is {other:?}, and only PNG and JPEG are supported")),
        Err(_) => Err("it is neither PNG nor JPEG".to_owned()),
    }
}
