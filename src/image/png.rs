//! PNG in two meanings: grey levels that are counts, and colours to look at.

use std::io::{self, BufRead, Read, Seek, SeekFrom, Write};

use glam::UVec2;
use image::codecs::png::{CompressionType, FilterType, PngDecoder, PngEncoder};
use image::{ColorType, ExtendedColorType, ImageDecoder, ImageEncoder, ImageError};

use super::Image;
use super::counts::{Counts, Meaning, Problem, ReadOptions};

/// The first bytes of every PNG file.
pub(super) const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Deflate packs at most 1032 bytes into one.
const MAX_PACKING: u64 = 1032;

const REMEDY: &str =
    "save it as grey with 8 or 16 bits and without transparency, where a grey level is a count";

/// Reads 8- or 16-bit grey from a file of `length` bytes; a grey level is a count.
pub(super) fn read(
    mut file: impl BufRead + Seek,
    length: u64,
    options: &ReadOptions<'_>,
) -> Result<Image<u32>, Problem> {
    options.refuse_channel("a PNG file")?;
    let header = Header::read(&mut file).and_then(|header| header.refuse_colours().map(|()| header))?;
    let size = header.check(&mut file, length, options)?;
    let decoder = PngDecoder::new(&mut file).map_err(|error| damaged(&error))?;
    // The decoder turns a transparent grey level (chunk tRNS) into an alpha channel.
    if !matches!(decoder.color_type(), ColorType::L8 | ColorType::L16) {
        return Err(Problem::new("the grey levels have transparency", REMEDY));
    }

    let mut counts = Counts::new(size, Meaning::Counts)?;
    let wide = decoder.color_type() == ColorType::L16;
    let pixels = size.x as usize * size.y as usize;
    let mut bytes = vec![0; pixels * if wide { 2 } else { 1 }];
    decoder.read_image(&mut bytes).map_err(|error| damaged(&error))?;
    if wide {
        for (index, pair) in bytes.chunks_exact(2).enumerate() {
            counts.put(index, u16::from_ne_bytes([pair[0], pair[1]]));
        }
    } else {
        for (index, &level) in bytes.iter().enumerate() {
            counts.put(index, level);
        }
    }
    counts.finish()
}

/// Reads any PNG as a mask: 1 where a colour or grey level is not 0 and the pixel is not wholly transparent,
/// else 0.
pub(super) fn read_mask(
    mut file: impl BufRead + Seek,
    length: u64,
    options: &ReadOptions<'_>,
) -> Result<Image<u32>, Problem> {
    let size = Header::read(&mut file)?.check(&mut file, length, options)?;
    // Palettes come as their colours, and 1, 2 or 4 bits as 8.
    let decoder = PngDecoder::new(&mut file).map_err(|error| damaged(&error))?;
    let colours = decoder.color_type();
    let pixel = usize::from(colours.bytes_per_pixel());
    let alpha = if colours.has_alpha() { pixel / usize::from(colours.channel_count()) } else { 0 };
    let mut bytes = vec![0; size.x as usize * size.y as usize * pixel];
    decoder.read_image(&mut bytes).map_err(|error| damaged(&error))?;
    let is_any = |bytes: &[u8]| bytes.iter().any(|&byte| byte != 0);
    let is_set = |pixel: &[u8]| {
        let (levels, opacity) = pixel.split_at(pixel.len() - alpha);
        is_any(levels) && (opacity.is_empty() || is_any(opacity))
    };
    Ok(Image::from_values(size, bytes.chunks_exact(pixel).map(|pixel| u32::from(is_set(pixel))).collect()))
}

/// The header of a PNG.
///
/// The decoder hands out 1, 2 and 4 bits as rescaled 8 bits without reporting it; only the file's own header
/// has the number.
struct Header {
    width: u32,
    height: u32,
    /// Of each channel.
    bits: u8,
    colours: u8,
}

impl Header {
    /// From the start of a file.
    fn read(file: &mut impl Read) -> Result<Self, Problem> {
        // Signature, length and name of the first chunk; then width, height, bits, colour type.
        let mut header = [0; 26];
        file.read_exact(&mut header).map_err(|error| damaged(&error))?;
        if &header[12..16] != b"IHDR" {
            return Err(Problem::damaged("not a proper PNG file: it does not begin with its header"));
        }
        let number =
            |at: usize| u32::from_be_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]);
        Ok(Self { width: number(16), height: number(20), bits: header[24], colours: header[25] })
    }

    /// An error where a grey level would be no count.
    fn refuse_colours(&self) -> Result<(), Problem> {
        let bits = self.bits;
        let found = match (self.colours, bits) {
            (0, 8 | 16) => return Ok(()),
            (0, _) => "grey",
            (2, _) => "RGB colour",
            (3, _) => "colour from a palette",
            (4, _) => "grey with transparency",
            (6, _) => "RGB colour with transparency",
            _ => "a colour type that PNG does not have,",
        };
        let unit = if bits == 1 { "bit" } else { "bits" };
        Err(Problem::new(format!("{found} with {bits} {unit} a channel, not grey with 8 or 16"), REMEDY))
    }

    /// The size, after all that can be refused before pixels are decoded. Leaves the file at its start.
    fn check(
        &self,
        file: &mut (impl Read + Seek),
        length: u64,
        options: &ReadOptions<'_>,
    ) -> Result<UVec2, Problem> {
        let (width, height) = (self.width, self.height);
        let size = options.check_size(width.into(), height.into())?;
        // Of 1 bit there are 8 pixels to a byte.
        let raw = u64::from(width) * u64::from(height) * u64::from(self.bits) / 8;
        if length.saturating_mul(MAX_PACKING) < raw {
            return Err(Problem::damaged(format!(
                "truncated: {width} x {height} pixels can't be packed into the file's {length} bytes"
            )));
        }
        check_end(file, length).map_err(|error| damaged(&error))?;
        file.rewind().map_err(|error| damaged(&error))?;
        Ok(size)
    }
}

/// An error where the last chunk is missing: the decoder stops after the last pixel. What follows that chunk
/// is ignored.
pub(super) fn check_end(file: &mut (impl Read + Seek), length: u64) -> io::Result<()> {
    let mut place = SIGNATURE.len() as u64;
    file.seek(SeekFrom::Start(place))?;
    loop {
        let mut start = [0; 8];
        let missing = |_| io::Error::other("the file does not end with the chunk IEND");
        file.read_exact(&mut start).map_err(missing)?;
        let bytes = u32::from_be_bytes([start[0], start[1], start[2], start[3]]);
        // Length and name before the data, the checksum after it.
        place += 12 + u64::from(bytes);
        if place > length {
            return Err(io::Error::other("the file ends inside a chunk"));
        }
        if &start[4..] == b"IEND" {
            return Ok(());
        }
        file.seek_relative(4 + i64::from(bytes))?;
    }
}

fn damaged(error: &dyn std::error::Error) -> Problem {
    Problem::damaged(format!("truncated or damaged: {error}"))
}

/// The counts as 16-bit grey levels, or what hinders that.
pub(super) fn grey_levels(image: &Image<u32>) -> Result<Vec<u16>, Problem> {
    let too_large: Vec<_> =
        image.values().iter().enumerate().filter(|&(_, &count)| count > u32::from(u16::MAX)).collect();
    if let Some((index, count)) = too_large.first() {
        let width = image.size().x as usize;
        let (x, y) = (index % width, index / width);
        return Err(Problem::new(
            format!(
                "a PNG holds counts to 65535, and the count at ({x}, {y}) is {count}; {} of {} \
                 pixels are above it",
                too_large.len(),
                image.values().len()
            ),
            "write the counts to a file that ends in .exr or .npy",
        ));
    }
    Ok(image.values().iter().map(|&count| u16::try_from(count).expect("tested above")).collect())
}

/// Writes 16-bit grey, row after row.
pub(super) fn write_grey(file: impl Write, size: UVec2, levels: &[u16]) -> io::Result<()> {
    write(file, size, bytemuck::cast_slice(levels), ExtendedColorType::L16)
}

/// Writes 8-bit RGB.
pub(super) fn write_colours(file: impl Write, picture: &Image<[u8; 3]>) -> io::Result<()> {
    write(file, picture.size(), bytemuck::cast_slice(picture.values()), ExtendedColorType::Rgb8)
}

fn write(file: impl Write, size: UVec2, bytes: &[u8], colours: ExtendedColorType) -> io::Result<()> {
    PngEncoder::new_with_quality(file, CompressionType::Default, FilterType::Adaptive)
        .write_image(bytes, size.x, size.y, colours)
        .map_err(|error| match error {
            ImageError::IoError(error) => error,
            other => io::Error::other(other),
        })
}
