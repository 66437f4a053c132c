//! OpenEXR: one channel of f16, f32 or u32 in, channels of f32 and u32 with attributes out.

use std::collections::HashSet;
use std::io::{self, BufRead, Seek, Write};

use exr::block::chunk::Chunk;
use exr::block::{UncompressedBlock, enumerate_ordered_header_block_indices};
use exr::error::Error as ExrError;
use exr::math::Vec2;
use exr::meta::attribute::{
    self, AttributeValue as ExrValue, ChannelDescription, Compression, LineOrder, SampleType, Text,
};
use exr::meta::header::{Header, LayerAttributes};
use exr::meta::{BlockDescription, MetaData, magic_number, sequence_end};
use exr::prelude::f16;
use glam::UVec2;

use super::Image;
use super::attribute::{Attribute, AttributeValue};
use super::counts::{Counts, Problem, ReadOptions};

/// The first bytes of every EXR file.
pub(super) const SIGNATURE: &[u8] = &magic_number::BYTES;

/// Bytes of a block that are accepted in any file; larger blocks have to be plausible for `max_pixels`.
const USUAL_BLOCK: u64 = 64 << 20;

/// Refuses what is larger than `options` allow, or claims more than its `length` in bytes can hold; leaves `file` at its start.
#[cfg(feature = "render")]
pub(super) fn check_sizes(
    file: &mut (impl BufRead + Seek),
    length: u64,
    options: &ReadOptions<'_>,
) -> Result<(), Problem> {
    let meta_data = MetaData::read_from_buffered(&mut *file, false).map_err(problem)?;
    check_headers(&meta_data.headers, length, options)?;
    file.rewind().map_err(|error| problem(error.into()))
}

/// Reads one channel, at its largest resolution, from a file of `length` bytes.
pub(super) fn read(
    file: impl BufRead + Seek,
    length: u64,
    options: &ReadOptions<'_>,
) -> Result<Image<u32>, Problem> {
    let reader = exr::block::read(file, false).map_err(problem)?;
    check_headers(reader.headers(), length, options)?;
    let (layer, channel) = choose(reader.headers(), options.channel)?;

    let meta_data = reader.meta_data().clone();
    let header = &meta_data.headers[layer];
    let sample_type = header.channels.list[channel].sample_type;
    check_lossless(header.compression, sample_type)?;
    let Vec2(width, height) = header.layer_size;
    let mut counts = Counts::new(options.check_size(width as u64, height as u64)?)?;
    let mut blocks = HashSet::new();
    let mut pixels = 0;
    for chunk in reader.all_chunks(false).map_err(problem)? {
        let chunk = chunk.map_err(problem)?;
        if chunk.layer_index != layer || !is_largest(header, &chunk)? {
            continue;
        }
        let block = UncompressedBlock::decompress_chunk(chunk, &meta_data, false).map_err(problem)?;
        if !blocks.insert(block.index.pixel_position) {
            return Err(Problem::damaged("damaged: a block of pixels occurs twice"));
        }
        pixels += block.index.pixel_size.area();
        for line in block.lines(&header.channels).filter(|line| line.location.channel == channel) {
            let Vec2(x, y) = line.location.position;
            let start = y * width + x;
            match sample_type {
                SampleType::U32 => {
                    for (index, sample) in (start..).zip(line.read_samples::<u32>()) {
                        counts.put(index, sample.map_err(problem)?);
                    }
                }
                SampleType::F32 => {
                    for (index, sample) in (start..).zip(line.read_samples::<f32>()) {
                        counts.put(index, sample.map_err(problem)?);
                    }
                }
                SampleType::F16 => {
                    for (index, sample) in (start..).zip(line.read_samples::<f16>()) {
                        counts.put(index, sample.map_err(problem)?.to_f32());
                    }
                }
            }
        }
    }
    if pixels != width * height {
        return Err(Problem::damaged(format!("damaged: {pixels} of {} pixels are there", width * height)));
    }
    counts.finish()
}

/// Refuses what would take memory out of proportion, in any layer: the blocks of all of them are passed through.
fn check_headers(headers: &[Header], length: u64, options: &ReadOptions<'_>) -> Result<(), Problem> {
    let mut least_length = 0;
    for header in headers {
        let Vec2(width, height) = header.layer_size;
        options.check_size(width as u64, height as u64)?;

        let Vec2(block_width, block_height) = header.max_block_pixel_size();
        let block_bytes =
            (block_width as u64 * block_height as u64).saturating_mul(header.channels.bytes_per_pixel as u64);
        let limit = options.max_pixels.saturating_mul(4).max(USUAL_BLOCK);
        if block_bytes > limit {
            return Err(Problem::new(
                format!(
                    "the header claims blocks of {block_width} x {block_height} pixels, more than {limit} bytes"
                ),
                "save it with scan lines or smaller tiles",
            ));
        }
        // Each block has at least 8 bytes in the table of offsets and 8 bytes of place and length.
        least_length += header.chunk_count as u64 * 16;
    }
    if length < least_length {
        return Err(Problem::damaged(format!(
            "truncated: the header claims blocks that take at least {least_length} bytes, the file has {length}"
        )));
    }
    Ok(())
}

/// The indices of the layer and of the channel that are named, or of the only channel.
fn choose(headers: &[Header], name: Option<&str>) -> Result<(usize, usize), Problem> {
    let channels: Vec<_> = headers
        .iter()
        .enumerate()
        .flat_map(|(layer, header)| {
            header.channels.list.iter().enumerate().map(move |(index, channel)| {
                let short = channel.name.to_string();
                let full = match &header.own_attributes.layer_name {
                    Some(layer_name) => format!("{layer_name}.{short}"),
                    None => short.clone(),
                };
                (short, full, (layer, index))
            })
        })
        .collect();
    let list = || channels.iter().map(|(_, full, _)| full.as_str()).collect::<Vec<_>>().join(", ");
    let remedy = || format!("name one of these channels: {}", list());
    let Some(name) = name else {
        return match channels.as_slice() {
            [(_, _, only)] => Ok(*only),
            _ => Err(Problem::new(format!("{} channels and no choice among them", channels.len()), remedy())),
        };
    };
    let mut matching = channels.iter().filter(|(short, full, _)| name == short || name == full);
    match (matching.next(), matching.next()) {
        (Some(&(_, _, found)), None) => Ok(found),
        (Some(_), Some(_)) => {
            Err(Problem::new(format!("several layers have a channel \"{name}\""), remedy()))
        }
        (None, _) => Err(Problem::new(format!("no channel is named \"{name}\""), remedy())),
    }
}

/// Refuses compressions that alter counts; the decoders of B44 and DWA also fall over damaged files.
fn check_lossless(compression: Compression, sample_type: SampleType) -> Result<(), Problem> {
    match (compression, sample_type) {
        (
            Compression::Uncompressed
            | Compression::RLE
            | Compression::ZIP1
            | Compression::ZIP16
            | Compression::PIZ,
            _,
        )
        | (Compression::PXR24, SampleType::F16 | SampleType::U32) => Ok(()),
        _ => Err(Problem::new(
            format!("{compression} of {sample_type:?} samples is lossy, so that the counts may be altered"),
            "save it with ZIP compression",
        )),
    }
}

fn is_largest(header: &Header, chunk: &Chunk) -> Result<bool, Problem> {
    let place = header.get_block_data_indices(&chunk.compressed_block).map_err(problem)?;
    Ok(place.level_index == Vec2(0, 0))
}

pub(super) fn problem(error: ExrError) -> Problem {
    match error {
        ExrError::NotSupported(what) => Problem::new(
            format!("an EXR file of a kind that can't be read here: {what}"),
            "save it as flat scan lines with ZIP compression",
        ),
        ExrError::Invalid(what) => Problem::damaged(format!("truncated or damaged: {what}")),
        ExrError::Io(error) => Problem::damaged(format!("could not be read: {error}")),
        ExrError::Aborted => unreachable!("nothing here stops a reader early"),
    }
}

/// Writes one channel of u32; see [`write_channels`].
pub(super) fn write(
    file: &mut impl Write,
    channel: &str,
    image: &Image<u32>,
    attributes: &[Attribute],
) -> io::Result<()> {
    write_channels(file, image.size(), &[(channel.to_owned(), Samples::U32(image.values()))], attributes)
}

/// The values of a channel, row after row.
#[derive(Clone, Debug)]
pub(super) enum Samples<'a> {
    U32(&'a [u32]),
    #[cfg_attr(not(feature = "render"), expect(dead_code, reason = "only pictures have such channels"))]
    F32(Vec<f32>),
}

/// Writes channels of an image of `size`, scan lines, ZIP compression. The same input gives the same bytes.
///
/// # Panics
/// If a name is empty, too long, not ASCII, or in the file already, or if samples do not fill the image.
pub(super) fn write_channels(
    file: &mut impl Write,
    size: UVec2,
    channels: &[(String, Samples<'_>)],
    attributes: &[Attribute],
) -> io::Result<()> {
    let fits = |name: &str| name.is_ascii() && (1..=255).contains(&name.len());
    let (width, height) = (size.x as usize, size.y as usize);
    // The format wants them sorted.
    let mut channels: Vec<_> = channels.iter().collect();
    channels.sort_by(|(a, _), (b, _)| a.as_bytes().cmp(b.as_bytes()));
    let describe = |(name, samples): &&(String, Samples<'_>)| {
        assert!(fits(name), "\"{name}\" can't name a channel");
        let (kind, count) = match samples {
            Samples::U32(values) => (SampleType::U32, values.len()),
            Samples::F32(values) => (SampleType::F32, values.len()),
        };
        assert_eq!(count, width * height, "samples of channel \"{name}\"");
        ChannelDescription::named(Text::from(name.as_str()), kind)
    };
    let header = Header::new(Text::default(), (width, height), channels.iter().map(describe).collect())
        .with_encoding(Compression::ZIP16, BlockDescription::ScanLines, LineOrder::Increasing)
        .with_attributes(LayerAttributes::default());
    let headers = std::slice::from_ref(&header);
    let mut requirements = MetaData::validate(headers, true).map_err(io_error)?;

    // `exr` would write them in the order of a hash map, which differs from run to run.
    let mut all: Vec<_> = header.all_named_attributes().map(|(name, value)| (name.to_vec(), value)).collect();
    for attribute in attributes {
        assert!(fits(&attribute.name), "\"{}\" can't name an attribute", attribute.name);
        requirements.has_long_names |= attribute.name.len() > 31;
        all.push((attribute.name.clone().into_bytes(), exr_value(&attribute.value)));
    }
    all.sort_by(|(a, _), (b, _)| a.cmp(b));
    assert!(all.windows(2).all(|pair| pair[0].0 != pair[1].0), "two attributes have one name");

    let mut start = Vec::new();
    magic_number::write(&mut start).map_err(io_error)?;
    requirements.write(&mut start).map_err(io_error)?;
    for (name, value) in &all {
        attribute::write(name, value, &mut start).map_err(io_error)?;
    }
    sequence_end::write(&mut start).map_err(io_error)?;

    let mut chunks = Vec::new();
    let mut offsets = Vec::new();
    let first_chunk = start.len() + header.chunk_count * size_of::<u64>();
    for (_, place) in enumerate_ordered_header_block_indices(headers) {
        let block = UncompressedBlock::from_lines(&header.channels, place, |line| {
            let start = line.location.position.y() * width;
            match &channels[line.location.channel].1 {
                Samples::U32(values) => line.write_samples_from_slice(&values[start..start + width]),
                Samples::F32(values) => line.write_samples_from_slice(&values[start..start + width]),
            }
            .expect("a line of the block has room for a row");
        });
        offsets.push((first_chunk + chunks.len()) as u64);
        let chunk = block.compress_to_chunk(headers).map_err(io_error)?;
        chunk.write(&mut chunks, 1).map_err(io_error)?;
    }

    file.write_all(&start)?;
    for offset in offsets {
        file.write_all(&offset.to_le_bytes())?;
    }
    file.write_all(&chunks)
}

fn exr_value(value: &AttributeValue) -> ExrValue {
    let text = |text: &str| ExrValue::Text(Text::from_slice_unchecked(text.as_bytes()));
    match value {
        AttributeValue::Text(value) => text(value),
        AttributeValue::Integer(number) => {
            i32::try_from(*number).map_or_else(|_| text(&number.to_string()), ExrValue::I32)
        }
    }
}

fn io_error(error: ExrError) -> io::Error {
    match error {
        ExrError::Io(error) => error,
        other => io::Error::other(other.to_string()),
    }
}
