//! Which compressions are read, and what their decoders must not be given.
//!
//! Some compressions pack channels of some sample types with a loss, and store others as they are: B44 alters
//! f16 alone, PXR24 f32 alone, and DWA f16 and f32 by their channels' names; u32 is never altered.

use exr::block::chunk::{Chunk, CompressedBlock};
use exr::math::Vec2;
use exr::meta::attribute::{ChannelList, Compression, SampleType};
use exr::meta::header::Header;

use super::super::counts::Problem;
use super::problem;

const REMEDY: &str = "save it with ZIP compression";

/// Refuses compressions that alter samples of a channel, whose counts would not be those that were saved.
pub(super) fn check_lossless(compression: Compression, sample_type: SampleType) -> Result<(), Problem> {
    use Compression::{B44, B44A, DWAA, DWAB, PXR24};
    let is_lossy = match compression {
        PXR24 => sample_type == SampleType::F32,
        B44 | B44A => sample_type == SampleType::F16,
        DWAA(_) | DWAB(_) => sample_type != SampleType::U32,
        _ => false,
    };
    if is_lossy {
        let samples = match sample_type {
            SampleType::F16 => "f16",
            SampleType::F32 => "f32",
            SampleType::U32 => "u32",
        };
        let problem = format!("{compression} of {samples} samples is lossy, so that values may be altered");
        return Err(Problem::new(problem, REMEDY));
    }
    check_supported(compression)
}

/// Refuses what can't be decoded.
pub(super) fn check_supported(compression: Compression) -> Result<(), Problem> {
    match compression {
        Compression::HTJ2K32 | Compression::HTJ2K256 => {
            Err(Problem::new("HTJ2K compression is not supported", REMEDY))
        }
        _ => Ok(()),
    }
}

/// Refuses f16 channels in B44 whose samples are wanted: the decoder overflows on some blocks.
#[cfg(feature = "scene")]
pub(super) fn check_decodable(compression: Compression, sample_type: SampleType) -> Result<(), Problem> {
    match (compression, sample_type) {
        (Compression::B44 | Compression::B44A, SampleType::F16) => {
            Err(Problem::new(format!("{compression} of F16 samples is not supported"), REMEDY))
        }
        _ => check_supported(compression),
    }
}

/// Makes a chunk safe for its decoder: channels that are not wanted are blanked, and implausible sizes are
/// refused.
pub(super) fn tame(header: &Header, chunk: &mut Chunk) -> Result<(), Problem> {
    let place = header.get_block_data_indices(&chunk.compressed_block).map_err(problem)?;
    let Vec2(width, height) = header.get_absolute_block_pixel_coordinates(place).map_err(problem)?.size;
    let bytes = match &mut chunk.compressed_block {
        CompressedBlock::ScanLine(block) => &mut block.compressed_pixels_le,
        CompressedBlock::Tile(block) => &mut block.compressed_pixels_le,
        // Deep data was refused with the header.
        _ => return Ok(()),
    };
    let pixels = (width as u64).saturating_mul(height as u64);
    if bytes.len() as u64 == pixels.saturating_mul(header.channels.bytes_per_pixel as u64) {
        // Not packed at all.
        return Ok(());
    }
    match header.compression {
        Compression::B44 | Compression::B44A => blank_halves(&header.channels, [width, height], bytes),
        Compression::DWAA(_) | Compression::DWAB(_) => {
            return check_claims(&header.channels, [width as u64, height as u64], bytes);
        }
        _ => {}
    }
    Ok(())
}

/// Replaces the packed blocks of f16 channels in B44 by blocks of the same length on which the decoder does
/// not overflow.
fn blank_halves(channels: &ChannelList, [width, height]: [usize; 2], bytes: &mut [u8]) {
    // The third byte distinguishes blocks of one value from blocks of 16, as in OpenEXR and `exr`.
    const SHORT: usize = 3;
    const LONG: [u8; 14] = [0x80, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    const FIRST_SHORT: u8 = 13 << 2;

    let mut place = 0_usize;
    for channel in &channels.list {
        if channel.sample_type != SampleType::F16 {
            place = place.saturating_add(width * height * channel.sample_type.bytes_per_sample());
            continue;
        }
        for _ in 0..width.div_ceil(4) * height.div_ceil(4) {
            let rest = bytes.get_mut(place..).unwrap_or_default();
            if rest.get(2).is_some_and(|&third| third >= FIRST_SHORT) {
                place += SHORT;
            } else if let Some(block) = rest.get_mut(..LONG.len()) {
                block.copy_from_slice(&LONG);
                place += LONG.len();
            } else {
                // Too short, which the decoder reports.
                return;
            }
        }
    }
}

/// Refuses a DWA chunk whose counters ask for more memory than its pixels take: the decoder allocates as
/// much.
fn check_claims(channels: &ChannelList, size: [u64; 2], bytes: &[u8]) -> Result<(), Problem> {
    // Eleven numbers of 8 bytes begin a chunk: version; bytes of the plain channels, unpacked and packed;
    // packed bytes of the coefficients AC and DC; bytes of run lengths, packed, unpacked and as pixels; the
    // numbers of AC and of DC; a method.
    const PLAIN: usize = 1;
    const RUNS: usize = 6;
    const RUN_PIXELS: usize = 7;
    const AC: usize = 8;
    const DC: usize = 9;
    let counter = |index: usize| {
        let number = bytes.get(8 * index..8 * (index + 1))?;
        Some(u64::from_le_bytes(number.try_into().ok()?))
    };
    // Coefficients come in blocks of 8 x 8 pixels.
    let [width, height] = size.map(|side| side.next_multiple_of(8));
    let samples = width.saturating_mul(height).saturating_mul(channels.list.len() as u64);
    let most = [
        (PLAIN, samples.saturating_mul(4)),
        // At worst a run takes two bytes for one.
        (RUNS, samples.saturating_mul(8)),
        (RUN_PIXELS, samples.saturating_mul(4)),
        (AC, samples),
        (DC, samples),
    ];
    // A chunk without all counters is refused by the decoder.
    if most.into_iter().any(|(index, most)| counter(index).is_some_and(|claimed| claimed > most)) {
        return Err(Problem::damaged("damaged: a block claims more samples than it has pixels"));
    }
    Ok(())
}
