//! Channels of f32 and u32 with attributes, scan lines in ZIP compression.

use std::io::{self, Write};

use exr::block::{UncompressedBlock, enumerate_ordered_header_block_indices};
use exr::error::Error as ExrError;
use exr::meta::attribute::{
    self, AttributeValue as ExrValue, ChannelDescription, Compression, LineOrder, SampleType, Text,
};
use exr::meta::header::{Header, LayerAttributes};
use exr::meta::{BlockDescription, MetaData, magic_number, sequence_end};
use glam::UVec2;

use super::super::Image;
use super::super::attribute::{Attribute, AttributeValue};

/// Writes one channel of u32; see [`write_channels`].
pub(in crate::image) fn write(
    file: &mut impl Write,
    channel: &str,
    image: &Image<u32>,
    attributes: &[Attribute],
) -> io::Result<()> {
    write_channels(file, image.size(), &[(channel.to_owned(), Samples::U32(image.values()))], attributes)
}

/// The values of a channel, row after row.
#[derive(Clone, Debug)]
pub(in crate::image) enum Samples<'a> {
    U32(&'a [u32]),
    #[cfg_attr(not(feature = "scene"), expect(dead_code, reason = "only pictures have such channels"))]
    F32(Vec<f32>),
}

/// Writes channels of an image of `size`, scan lines, ZIP compression. The same input gives the same bytes.
///
/// # Panics
/// If a name is empty, too long, not ASCII, or in the file already, or if samples do not fill the image.
pub(in crate::image) fn write_channels(
    file: &mut impl Write,
    size: UVec2,
    channels: &[(String, Samples<'_>)],
    attributes: &[Attribute],
) -> io::Result<()> {
    let fits = |name: &str| name.is_ascii() && (1..=255).contains(&name.len());
    let (width, height) = (size.x as usize, size.y as usize);
    // The format requires them sorted.
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
