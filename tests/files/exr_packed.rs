//! u32 channels in compressions that alter other channels: they are stored as they are.

use std::io::Cursor;

use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatImage, FlatSamples, ImageAttributes, Layer,
    LayerAttributes, LineOrder, Vec2, WritableImage, f16,
};
use glam::UVec2;
use varikernel::image::{Image, ReadOptions};

use crate::{assert_refused, read, read_bytes};

const ALL: [Compression; 4] =
    [Compression::B44, Compression::B44A, Compression::DWAA(None), Compression::DWAB(None)];

/// Sides that are no multiples of the blocks of 4, 8 and 32 pixels.
const SIZE: UVec2 = UVec2::new(67, 41);

/// Counts in all 32 bits, and many zeros, so that packing pays.
fn counts() -> Image<u32> {
    Image::from_fn(SIZE, |x, y| if (x + y).is_multiple_of(5) { (x * 977 + y * 65_537) << (x % 8) } else { 0 })
}

fn encoded(compression: Compression, blocks: Blocks, channels: Vec<(&str, FlatSamples)>) -> Vec<u8> {
    let size = (SIZE.x as usize, SIZE.y as usize);
    let channels = channels.into_iter().map(|(name, samples)| AnyChannel::new(name, samples)).collect();
    let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
    let layer = Layer::new(size, LayerAttributes::default(), encoding, AnyChannels::sort(channels));
    let mut bytes = Cursor::new(Vec::new());
    FlatImage::from_layers(ImageAttributes::with_size(size), vec![layer])
        .write()
        .to_buffered(&mut bytes)
        .unwrap();
    bytes.into_inner()
}

fn whole() -> FlatSamples {
    FlatSamples::U32(counts().values().to_vec())
}

fn halves(seed: f32) -> FlatSamples {
    let smooth = |index: u16| f16::from_f32(seed + (f32::from(index) / 300.0).sin());
    FlatSamples::F16((0..67 * 41).map(smooth).collect())
}

/// A map beside the channels of a picture; the names decide how DWA packs them.
fn beside_a_picture(compression: Compression, blocks: Blocks) -> Vec<u8> {
    let depth = FlatSamples::F32((0..67 * 41_u16).map(f32::from).collect());
    let picture = [("A", halves(2.0)), ("B", halves(0.1)), ("G", halves(0.2)), ("R", halves(0.3))];
    let others = [("Z", depth), ("a", halves(1.0)), ("photons", whole()), ("w", halves(4.0))];
    encoded(compression, blocks, picture.into_iter().chain(others).collect())
}

#[test]
fn counts_come_back_whatever_is_beside_them() {
    for compression in ALL {
        for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(32, 32))] {
            let alone = encoded(compression, blocks, vec![("photons", whole())]);
            assert_eq!(read("a.exr", &alone).unwrap(), counts(), "{compression}");
            // DWA packs the channel A by run lengths.
            let runs = encoded(compression, blocks, vec![("A", whole())]);
            assert_eq!(read("a.exr", &runs).unwrap(), counts(), "{compression}");
            let options = ReadOptions { channel: Some("photons"), ..ReadOptions::default() };
            let beside = beside_a_picture(compression, blocks);
            assert_eq!(read_bytes("a.exr", &beside, &options).unwrap(), counts(), "{compression}");
            let lossy = ReadOptions { channel: Some("R"), ..ReadOptions::default() };
            assert_refused(read_bytes("a.exr", &beside, &lossy), &["f16 samples is lossy", "ZIP"]);
        }
    }
}

#[test]
fn f32_is_stored_as_it_is_by_b44_alone() {
    let values = || FlatSamples::F32((0..67 * 41_u16).map(f32::from).collect());
    for compression in ALL {
        let found = read("a.exr", &encoded(compression, Blocks::ScanLines, vec![("photons", values())]));
        if let Compression::B44 | Compression::B44A = compression {
            assert_eq!(found.unwrap().at(66, 40), 67 * 41 - 1);
        } else {
            assert_refused(found, &["f32 samples is lossy"]);
        }
    }
}

#[test]
fn damage_never_panics_nor_takes_all_memory() {
    let options = ReadOptions { channel: Some("photons"), ..ReadOptions::default() };
    let mut state = 1_u32;
    let mut random = move |below: usize| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as usize % below
    };
    for compression in ALL {
        let bytes = beside_a_picture(compression, Blocks::ScanLines);
        let mut refused = 0;
        for _ in 0..300 {
            let mut changed = bytes.clone();
            for _ in 0..=random(3) {
                let place = random(bytes.len());
                changed[place] = [0, 0x7f, 0x80, 0xff][random(4)];
            }
            refused += u32::from(read_bytes("a.exr", &changed, &options).is_err());
        }
        assert!(refused > 0, "{compression}: no change was noticed");
    }
}

#[test]
fn claims_out_of_proportion_are_refused() {
    let bytes = encoded(Compression::DWAA(None), Blocks::ScanLines, vec![("photons", whole())]);
    // A chunk begins with its row and length, and then eleven counters: version 2, and the bytes of 67 x 32
    // counts.
    let begin = [2_u64.to_le_bytes(), (67 * 32 * 4_u64).to_le_bytes()].concat();
    let chunk = bytes.windows(16).position(|window| window == begin).unwrap();
    for counter in [1, 6, 7, 8, 9] {
        let mut changed = bytes.clone();
        changed[chunk + 8 * counter..][..8].copy_from_slice(&(1_u64 << 62).to_le_bytes());
        assert_refused(read("a.exr", &changed), &["claims more samples than it has pixels"]);
    }
}

#[test]
fn htj2k_is_not_supported() {
    let mut bytes = encoded(Compression::ZIP16, Blocks::ScanLines, vec![("photons", whole())]);
    let attribute = b"compression\0compression\0\x01\0\0\0";
    let place = bytes.windows(attribute.len()).position(|window| window == attribute).unwrap();
    for method in [10, 11] {
        bytes[place + attribute.len()] = method;
        // The number of chunks follows from the compression; without it, nothing contradicts.
        let count = bytes.windows(11).position(|window| window == b"chunkCount\0");
        if let Some(count) = count {
            bytes[count] = b'C';
        }
        assert_refused(read("a.exr", &bytes), &["HTJ2K", "not supported", "ZIP"]);
    }
}

#[test]
fn what_follows_the_last_block_is_not_read() {
    let bytes = encoded(Compression::ZIP16, Blocks::ScanLines, vec![("photons", whole())]);
    assert_eq!(read("a.exr", &[bytes, vec![0xff; 1000]].concat()).unwrap(), counts());
}
