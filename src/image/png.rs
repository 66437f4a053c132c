//! PNG in two meanings: grey levels that are counts, and colours for people to look at.

use std::io::{self, BufRead, Read, Seek, SeekFrom, Write};

use glam::UVec2;
use image::codecs::png::{CompressionType, FilterType, PngDecoder, PngEncoder};
use image::{ColorType, ExtendedColorType, ImageDecoder, ImageEncoder, ImageError};

use super::Image;
use super::counts::{Counts, Problem, ReadOptions};

/// The first bytes of every PNG file.
pub(super) const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// The last bytes of every PNG file: the chunk IEND, without data, and its checksum.
const END: [u8; 12] = *b"\0\0\0\0IEND\xae\x42\x60\x82";

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
    let size = check_header(&mut file, length, options).map_err(|error| match error {
        HeaderError::Io(error) => damaged(&error),
        HeaderError::Problem(problem) => problem,
    })?;
    let decoder = PngDecoder::new(&mut file).map_err(|error| damaged(&error))?;
    // The decoder turns a transparent grey level (chunk tRNS) into an alpha channel.
    if !matches!(decoder.color_type(), ColorType::L8 | ColorType::L16) {
        return Err(Problem::new("the grey levels have transparency", REMEDY));
    }

    let mut counts = Counts::new(size)?;
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

enum HeaderError {
    Io(io::Error),
    Problem(Problem),
}

impl From<io::Error> for HeaderError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<Problem> for HeaderError {
    fn from(problem: Problem) -> Self {
        Self::Problem(problem)
    }
}

/// The size, after all that can be refused before pixels are decoded. Leaves the file at its start.
///
/// The decoder hands out 1, 2 and 4 bits as rescaled 8 bits without saying so; only the file's own header tells.
fn check_header(
    file: &mut (impl Read + Seek),
    length: u64,
    options: &ReadOptions<'_>,
) -> Result<UVec2, HeaderError> {
    // Signature, length and name of the first chunk; then width, height, bits, colour type.
    let mut header = [0; 26];
    file.read_exact(&mut header)?;
    if &header[12..16] != b"IHDR" {
        return Err(Problem::damaged("not a proper PNG file: it does not begin with its header").into());
    }
    let number = |at: usize| u32::from_be_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]);
    let (width, height, bits) = (number(16), number(20), header[24]);
    let found = match (header[25], bits) {
        (0, 8 | 16) => None,
        (0, _) => Some("grey"),
        (2, _) => Some("RGB colour"),
        (3, _) => Some("colour from a palette"),
        (4, _) => Some("grey with transparency"),
        (6, _) => Some("RGB colour with transparency"),
        _ => Some("a colour type that PNG does not have,"),
    };
    if let Some(found) = found {
        let problem = format!("{found} with {bits} bits a channel, not grey with 8 or 16");
        return Err(Problem::new(problem, REMEDY).into());
    }
    let size = options.check_size(width.into(), height.into())?;

    let raw = u64::from(width) * u64::from(height) * u64::from(bits / 8);
    if length.saturating_mul(MAX_PACKING) < raw {
        return Err(Problem::damaged(format!(
            "truncated: {width} x {height} pixels can't be packed into the file's {length} bytes"
        ))
        .into());
    }
    // The decoder stops after the last pixel.
    let mut end = [0; END.len()];
    file.seek(SeekFrom::End(-12))?;
    file.read_exact(&mut end)?;
    if end != END {
        return Err(Problem::damaged("truncated: the file does not end with the chunk IEND").into());
    }
    file.rewind()?;
    Ok(size)
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
                "a PNG holds counts to 65535, and the count at ({x}, {y}) is {count}; {} of {} pixels are above it",
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
