//! Samples of chosen channels, at their largest resolution.

use std::collections::HashSet;
use std::io::{BufRead, Seek};

use exr::block::UncompressedBlock;
use exr::block::lines::LineRef;
use exr::block::reader::Reader;
use exr::math::Vec2;
use exr::meta::attribute::SampleType;
use exr::meta::header::Header;
use exr::prelude::f16;
use glam::UVec2;

use super::super::Image;
use super::super::counts::{Counts, Meaning, Problem, ReadOptions, Refusal, Sample};
use super::packed::{check_lossless, tame};
use super::problem;

/// Bytes of a block that are accepted in any file; larger blocks have to be plausible for `max_pixels`.
const USUAL_BLOCK: u64 = 64 << 20;

/// A sample of a channel.
#[derive(Clone, Copy)]
enum Value {
    F16(f16),
    F32(f32),
    U32(u32),
}

impl Value {
    fn is_zero(self) -> bool {
        match self {
            Self::F16(value) => value == f16::ZERO,
            Self::F32(value) => value == 0.0,
            Self::U32(value) => value == 0,
        }
    }
}

impl std::fmt::Debug for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::F16(value) => value.fmt(f),
            Self::F32(value) => value.fmt(f),
            Self::U32(value) => value.fmt(f),
        }
    }
}

impl Sample for Value {
    fn count(self) -> Result<u32, Refusal> {
        match self {
            Self::F16(value) => value.count(),
            Self::F32(value) => value.count(),
            Self::U32(value) => value.count(),
        }
    }
}

/// Channels of one layer.
struct Chosen {
    layer: usize,
    channels: Vec<usize>,
}

impl Chosen {
    fn sample_types<'a>(&'a self, header: &'a Header) -> impl Iterator<Item = SampleType> + 'a {
        self.channels.iter().map(|&channel| header.channels.list[channel].sample_type)
    }
}

/// Reads one channel from a file of `length` bytes.
pub(in crate::image) fn read(
    file: impl BufRead + Seek,
    length: u64,
    options: &ReadOptions<'_>,
) -> Result<Image<u32>, Problem> {
    let reader = open(file, length, options)?;
    let chosen = choose(reader.headers(), options.channel)?;
    let header = &reader.headers()[chosen.layer];
    chosen.sample_types(header).try_for_each(|samples| check_lossless(header.compression, samples))?;
    let mut counts = Counts::new(size_of(header, options)?, Meaning::Counts)?;
    for_each_sample(reader, &chosen, |_, index, value| counts.put(index, value))?;
    counts.finish()
}

/// Reads the channels of the first layer as one mask: 1 where any is not 0, and `A`, if there is one, is
/// neither.
pub(in crate::image) fn read_mask(
    file: impl BufRead + Seek,
    length: u64,
    options: &ReadOptions<'_>,
) -> Result<Image<u32>, Problem> {
    let reader = open(file, length, options)?;
    let Some(header) = reader.headers().first() else {
        return Err(Problem::damaged("damaged: there is no layer"));
    };
    let is_alpha: Vec<bool> = header.channels.list.iter().map(|channel| channel.name == *"A").collect();
    let has_levels = is_alpha.contains(&false);
    let chosen = Chosen { layer: 0, channels: (0..is_alpha.len()).collect() };
    chosen.sample_types(header).try_for_each(|samples| check_lossless(header.compression, samples))?;
    let size = size_of(header, options)?;
    let mut levels = Counts::new(size, Meaning::Mask)?;
    let mut opacity = Counts::new(size, Meaning::Mask)?;
    for_each_sample(reader, &chosen, |channel, index, value| {
        if is_alpha[channel] {
            opacity.put(index, value);
        } else if !value.is_zero() {
            levels.put(index, value);
        }
    })?;
    let (levels, opacity) = (levels.finish()?, opacity.finish()?);
    Ok(match (has_levels, is_alpha.contains(&true)) {
        (true, true) => Image::from_fn(size, |x, y| levels.at(x, y) * opacity.at(x, y)),
        (true, false) => levels,
        (false, _) => opacity,
    })
}

/// Reads channels by their names, with or without that of their layer, from the first layer that has them all.
#[cfg(feature = "scene")]
pub(in crate::image) fn read_channels<const COUNT: usize>(
    file: impl BufRead + Seek,
    length: u64,
    named: [&str; COUNT],
    options: &ReadOptions<'_>,
) -> Result<Image<[f32; COUNT]>, Problem> {
    let reader = open(file, length, options)?;
    let all = names(reader.headers());
    let of_layer = |layer: usize| -> Option<Chosen> {
        let of = |name: &&str| {
            let found = all.iter().find(|(short, full, (of, _))| {
                *of == layer && (short.as_str() == *name || full.as_str() == *name)
            });
            found.map(|&(_, _, (_, channel))| channel)
        };
        Some(Chosen { layer, channels: named.iter().map(of).collect::<Option<_>>()? })
    };
    let chosen = (0..reader.headers().len()).find_map(of_layer).ok_or_else(|| {
        let have: Vec<_> = all.iter().map(|(_, full, _)| full.as_str()).collect();
        let and = |names: &[&str]| match names {
            [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
            _ => names.concat(),
        };
        let (noun, wanted) = (if COUNT == 1 { "channel" } else { "channels" }, and(&named));
        let problem = format!("no {noun} {wanted}, but {}", have.join(", "));
        Problem::new(problem, format!("give a picture that has them, or name its {noun} {wanted}"))
    })?;
    let header = &reader.headers()[chosen.layer];
    let compression = header.compression;
    chosen.sample_types(header).try_for_each(|one| super::packed::check_decodable(compression, one))?;
    let mut picture = Image::filled(size_of(header, options)?, [0.0; COUNT]);
    for_each_sample(reader, &chosen, |channel, index, value| {
        #[expect(clippy::cast_precision_loss, reason = "radiance; whole numbers of that size are none")]
        let value = match value {
            Value::F16(value) => value.to_f32(),
            Value::F32(value) => value,
            Value::U32(value) => value as f32,
        };
        picture.values_mut()[index][channel] = value;
    })?;
    Ok(picture)
}

/// The file's headers, if none claims more than `options` allow or than `length` bytes can hold.
fn open<R: BufRead + Seek>(file: R, length: u64, options: &ReadOptions<'_>) -> Result<Reader<R>, Problem> {
    let reader = exr::block::read(file, false).map_err(problem)?;
    check_headers(reader.headers(), length, options)?;
    Ok(reader)
}

fn size_of(header: &Header, options: &ReadOptions<'_>) -> Result<UVec2, Problem> {
    let Vec2(width, height) = header.layer_size;
    options.check_size(width as u64, height as u64)
}

/// Hands out every sample at the largest resolution: which of the chosen channels it is of, its pixel,
/// counted row after row, and its value.
fn for_each_sample<R: BufRead + Seek>(
    reader: Reader<R>,
    chosen: &Chosen,
    mut put: impl FnMut(usize, usize, Value),
) -> Result<(), Problem> {
    let meta_data = reader.meta_data().clone();
    let header = &meta_data.headers[chosen.layer];
    let Vec2(width, height) = header.layer_size;
    let mut blocks = HashSet::new();
    let mut pixels = 0;
    for chunk in reader.all_chunks(false).map_err(problem)? {
        let mut chunk = chunk.map_err(problem)?;
        if chunk.layer_index != chosen.layer {
            continue;
        }
        let place = header.get_block_data_indices(&chunk.compressed_block).map_err(problem)?;
        if place.level_index != Vec2(0, 0) {
            continue;
        }
        tame(header, &mut chunk)?;
        let block = UncompressedBlock::decompress_chunk(chunk, &meta_data, false).map_err(problem)?;
        if !blocks.insert(block.index.pixel_position) {
            return Err(Problem::damaged("damaged: a block of pixels occurs twice"));
        }
        pixels += block.index.pixel_size.area();
        for line in block.lines(&header.channels) {
            let Some(channel) = chosen.channels.iter().position(|&one| one == line.location.channel) else {
                continue;
            };
            let Vec2(x, y) = line.location.position;
            let samples = header.channels.list[line.location.channel].sample_type;
            put_line(&line, samples, |offset, value| put(channel, y * width + x + offset, value))?;
        }
    }
    if pixels != width * height {
        return Err(Problem::damaged(format!("damaged: {pixels} of {} pixels are there", width * height)));
    }
    Ok(())
}

fn put_line(
    line: &LineRef<'_>,
    samples: SampleType,
    mut put: impl FnMut(usize, Value),
) -> Result<(), Problem> {
    match samples {
        SampleType::F16 => {
            for (index, sample) in line.read_samples::<f16>().enumerate() {
                put(index, Value::F16(sample.map_err(problem)?));
            }
        }
        SampleType::F32 => {
            for (index, sample) in line.read_samples::<f32>().enumerate() {
                put(index, Value::F32(sample.map_err(problem)?));
            }
        }
        SampleType::U32 => {
            for (index, sample) in line.read_samples::<u32>().enumerate() {
                put(index, Value::U32(sample.map_err(problem)?));
            }
        }
    }
    Ok(())
}

/// Refuses what would take memory out of proportion, in any layer: the blocks of all of them are passed
/// through.
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
                    "the header claims blocks of {block_width} x {block_height} pixels, more \
                     than {limit} bytes"
                ),
                "save it with scan lines or smaller tiles",
            ));
        }
        // Each block has at least 8 bytes in the table of offsets and 8 bytes of place and length.
        least_length += header.chunk_count as u64 * 16;
    }
    if length < least_length {
        return Err(Problem::damaged(format!(
            "truncated: the header claims blocks that take at least {least_length} bytes, the \
             file has {length}"
        )));
    }
    Ok(())
}

/// Each channel: its own name, its name with that of its layer, and the numbers of the layer and of the
/// channel.
fn names(headers: &[Header]) -> Vec<(String, String, (usize, usize))> {
    let of_layer = |(layer, header): (usize, &Header)| {
        let prefix =
            header.own_attributes.layer_name.as_ref().map_or_else(String::new, |name| format!("{name}."));
        let named = header.channels.list.iter().enumerate().map(|(index, channel)| {
            let short = channel.name.to_string();
            let full = format!("{prefix}{short}");
            (short, full, (layer, index))
        });
        named.collect::<Vec<_>>()
    };
    headers.iter().enumerate().flat_map(of_layer).collect()
}

/// The channel that is named, or the only one.
fn choose(headers: &[Header], name: Option<&str>) -> Result<Chosen, Problem> {
    let channels = names(headers);
    let refused = |what: String| {
        let list: Vec<_> = channels.iter().map(|(_, full, _)| full.as_str()).collect();
        let how = "with `--channel` of the verbs radius, compare and bench, or `ReadOptions::channel`";
        Problem::new(what, format!("choose one of these channels, {how}: {}", list.join(", ")))
    };
    let chosen = |&(_, _, (layer, channel)): &(_, _, _)| Chosen { layer, channels: vec![channel] };
    let Some(name) = name else {
        return match channels.as_slice() {
            [only] => Ok(chosen(only)),
            _ => Err(refused(format!("{} channels and no choice among them", channels.len()))),
        };
    };
    let mut matching = channels.iter().filter(|(short, full, _)| name == short || name == full);
    match (matching.next(), matching.next()) {
        (Some(found), None) => Ok(chosen(found)),
        (Some(_), Some(_)) => Err(refused(format!("several layers have a channel \"{name}\""))),
        (None, _) => Err(refused(format!("no channel is named \"{name}\""))),
    }
}
