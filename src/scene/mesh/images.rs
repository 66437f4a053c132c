//! Images of mesh files: PNG and JPEG.

use std::io::Cursor;

use ::image::{DynamicImage, ImageDecoder as _, ImageError, ImageFormat, ImageReader, Limits, guess_format};
use glam::UVec2;

/// The longest side of an image.
const MAX_SIDE: u32 = 16384;
/// The most texels of all images of a mesh together.
const MAX_TEXELS: u64 = 1 << 28;
/// The most bytes that a decoder may take.
const MAX_ALLOC: u64 = 1 << 30;

/// Decodes the images of a mesh, up to as many texels as a mesh may have.
#[derive(Default)]
pub(super) struct Images {
    texels: u64,
}

impl Images {
    /// Size and sRGB texels of an image, whose memory is taken only once its size is known to be possible.
    ///
    /// # Errors
    /// Why it can't be read.
    pub(super) fn decode(&mut self, bytes: &[u8]) -> Result<(UVec2, Vec<[u8; 3]>), String> {
        let damaged = |error: ImageError| format!("it is damaged: {error}");
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
        self.texels += texels;
        if self.texels > MAX_TEXELS {
            return Err(format!("with its {width} x {height} texels the images are more than {MAX_TEXELS}"));
        }
        let pixels = DynamicImage::from_decoder(decoder).map_err(damaged)?.into_rgb8();
        Ok((UVec2::new(width, height), pixels.pixels().map(|pixel| pixel.0).collect()))
    }
}

/// The format by the content; what the file calls it may be wrong.
fn format(bytes: &[u8]) -> Result<ImageFormat, String> {
    if bytes.starts_with(b"\xabKTX 20\xbb") {
        return Err("it is KTX2, and only PNG and JPEG are supported".to_owned());
    }
    match guess_format(bytes) {
        Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => Ok(format),
        Ok(other) => Err(format!("it is {}, and only PNG and JPEG are supported", other.to_mime_type())),
        Err(_) => Err("it is neither PNG nor JPEG".to_owned()),
    }
}
