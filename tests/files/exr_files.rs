//! EXR files of several layers, sample types and encodings, made by the `exr` crate.

use std::fs;
use std::io::Cursor;

use exr::math::RoundingMode;
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Compression, Encoding, FlatImage, FlatSamples,
    ImageAttributes, Layer, LayerAttributes, Levels, LineOrder, MetaData, Text, Vec2, WritableImage, f16,
};
use tempfile::TempDir;
use varikernel::image::{Attribute, ReadOptions, write_counts};

use crate::{assert_refused, read, read_bytes, small_map, written};

type FlatLayer = Layer<AnyChannels<FlatSamples>>;

/// The size of [`small_map`].
const SIZE: (usize, usize) = (4, 3);

pub(crate) const LINES: Encoding = Encoding {
    compression: Compression::ZIP16,
    blocks: Blocks::ScanLines,
    line_order: LineOrder::Increasing,
};

/// [`small_map`] times `factor`, as f32.
fn floats(factor: f32) -> FlatSamples {
    let level = |&value: &u32| f32::from(u16::try_from(value).unwrap()) * factor;
    FlatSamples::F32(small_map().values().iter().map(level).collect())
}

pub(crate) fn layer(name: Option<&str>, encoding: Encoding, channels: &[(&str, FlatSamples)]) -> FlatLayer {
    let attributes = LayerAttributes { layer_name: name.map(Text::from), ..LayerAttributes::default() };
    let channels = channels.iter().map(|(name, samples)| AnyChannel::new(*name, samples.clone())).collect();
    Layer::new(SIZE, attributes, encoding, AnyChannels::sort(channels))
}

pub(crate) fn file(layers: Vec<FlatLayer>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    FlatImage::from_layers(ImageAttributes::with_size(SIZE), layers).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

fn one_channel(samples: FlatSamples) -> Vec<u8> {
    file(vec![layer(None, LINES, &[("photons", samples)])])
}

fn named(channel: &str) -> ReadOptions<'_> {
    ReadOptions { channel: Some(channel), ..ReadOptions::default() }
}

/// The file with `old` replaced by `new`, which has to be there once.
fn patched(bytes: &[u8], old: &[u8], new: &[u8]) -> Vec<u8> {
    let places: Vec<_> = (0..bytes.len()).filter(|&at| bytes[at..].starts_with(old)).collect();
    let &[at] = places.as_slice() else { panic!("{old:?} is at {places:?}") };
    [&bytes[..at], new, &bytes[at + old.len()..]].concat()
}

/// A map's file whose data window claims `width` x `height` pixels.
fn claiming(width: i32, height: i32) -> Vec<u8> {
    let window = |right: i32, bottom: i32| {
        let mut bytes = b"dataWindow\0box2i\0\x10\0\0\0\0\0\0\0\0\0\0\0".to_vec();
        bytes.extend(right.to_le_bytes());
        bytes.extend(bottom.to_le_bytes());
        bytes
    };
    // `exr` compares this number with the window only where it is there.
    let uncounted = patched(&written("map.exr", &small_map()), b"chunkCount\0", b"chunkKount\0");
    patched(&uncounted, &window(3, 2), &window(width - 1, height - 1))
}

#[test]
fn every_sample_type() {
    let halves = small_map().values().iter().map(|&value| f16::from_f64(f64::from(value))).collect();
    for samples in [FlatSamples::F16(halves), floats(1.0), FlatSamples::U32(small_map().values().to_vec())] {
        assert_eq!(read("map.exr", &one_channel(samples.clone())).unwrap(), small_map(), "{samples:?}");
    }
}

#[test]
fn every_lossless_encoding() {
    let tiles = Blocks::Tiles(Vec2(2, 2));
    for blocks in [Blocks::ScanLines, tiles] {
        for compression in [
            Compression::Uncompressed,
            Compression::RLE,
            Compression::ZIP1,
            Compression::ZIP16,
            Compression::PIZ,
        ] {
            for line_order in [LineOrder::Increasing, LineOrder::Decreasing] {
                let encoding = Encoding { compression, blocks, line_order };
                let bytes = file(vec![layer(None, encoding, &[("photons", floats(1.0))])]);
                assert_eq!(read("map.exr", &bytes).unwrap(), small_map(), "{encoding:?}");
            }
        }
    }
}

#[test]
fn only_the_largest_of_several_resolutions_is_read() {
    let smaller = |pixels: usize| FlatSamples::F32(vec![0.5; pixels]);
    let levels = Levels::Mip {
        rounding_mode: RoundingMode::Down,
        level_data: vec![floats(1.0), smaller(2), smaller(1)],
    };
    let channels = AnyChannels::sort(std::iter::once(AnyChannel::new("photons", levels)).collect());
    let encoding = Encoding { blocks: Blocks::Tiles(Vec2(2, 2)), ..LINES };
    let image = exr::prelude::Image::from_encoded_channels(SIZE, encoding, channels);
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).unwrap();
    assert_eq!(read("map.exr", bytes.get_ref()).unwrap(), small_map());
}

#[test]
fn the_data_window_may_lie_anywhere() {
    let mut moved = layer(None, LINES, &[("photons", floats(1.0))]);
    moved.attributes.layer_position = Vec2(-5, 70);
    assert_eq!(read("map.exr", &file(vec![moved])).unwrap(), small_map());
}

#[test]
fn a_channel_is_chosen_by_its_name() {
    let two = file(vec![layer(None, LINES, &[("photons", floats(1.0)), ("zeros", floats(0.0))])]);
    assert_eq!(read_bytes("map.exr", &two, &named("photons")).unwrap(), small_map());
    assert_eq!(read_bytes("map.exr", &two, &named("zeros")).unwrap(), small_map().map(|_| 0));
    assert_refused(
        read("map.exr", &two),
        &["2 channels and no choice", "photons, zeros", "--channel", "ReadOptions::channel"],
    );
    assert_refused(
        read_bytes("map.exr", &two, &named("R")),
        &["no channel is named \"R\"", "photons, zeros"],
    );
}

#[test]
fn a_channel_is_chosen_by_its_layer_and_name() {
    let layers = file(vec![
        layer(Some("first"), LINES, &[("n", floats(1.0))]),
        layer(Some("second"), LINES, &[("n", floats(2.0)), ("only", floats(3.0))]),
    ]);
    assert_eq!(read_bytes("map.exr", &layers, &named("first.n")).unwrap(), small_map());
    assert_eq!(read_bytes("map.exr", &layers, &named("second.n")).unwrap(), small_map().map(|n| 2 * n));
    assert_eq!(read_bytes("map.exr", &layers, &named("only")).unwrap(), small_map().map(|n| 3 * n));
    let list = "first.n, second.n, second.only";
    assert_refused(read("map.exr", &layers), &["3 channels", list]);
    assert_refused(read_bytes("map.exr", &layers, &named("n")), &["several layers", "\"n\"", list]);
}

#[test]
fn a_value_that_is_no_count_in_another_channel_does_not_matter() {
    let two = file(vec![layer(None, LINES, &[("photons", floats(1.0)), ("weights", floats(-0.5))])]);
    assert_eq!(read_bytes("map.exr", &two, &named("photons")).unwrap(), small_map());
    assert_refused(read_bytes("map.exr", &two, &named("weights")), &["(1, 0)", "-0.5, negative", "11 of 12"]);
}

#[test]
fn values_that_are_no_counts() {
    let with = |value: f32| {
        let mut values = vec![1.0; 12];
        values[6] = value;
        read("map.exr", &one_channel(FlatSamples::F32(values)))
    };
    assert_refused(with(0.25), &["(2, 1)", "0.25, not a whole number", "1 of 12"]);
    assert_refused(with(f32::NAN), &["(2, 1)", "NaN"]);
    assert_refused(with(f32::NEG_INFINITY), &["(2, 1)", "-inf, infinite"]);
    assert_refused(with(4_294_967_296.0), &["(2, 1)", "above 4294967295"]);
    let halves = FlatSamples::F16(vec![f16::from_f32(1.5); 12]);
    assert_refused(read("map.exr", &one_channel(halves)), &["(0, 0)", "1.5", "12 of 12"]);
}

#[test]
fn headers_that_claim_too_much() {
    assert_refused(read("map.exr", &claiming(1_000_000_000, 1_000_000_000)), &["1000000000", "65536 a side"]);
    assert_refused(read("map.exr", &claiming(16384, 16385)), &["16384 x 16385", "268435456 in all"]);
    assert_refused(read("map.exr", &claiming(16384, 16384)), &["truncated", "at least 16384 bytes"]);
    let tiles = Encoding { blocks: Blocks::Tiles(Vec2(1 << 20, 1 << 20)), ..LINES };
    let bytes = file(vec![layer(None, tiles, &[("photons", floats(1.0))])]);
    assert_refused(read("map.exr", &bytes), &["blocks of 1048576 x 1048576", "smaller tiles"]);
}

#[test]
fn lossy_compression_is_refused() {
    let with = |compression, samples| {
        let encoding = Encoding { compression, ..LINES };
        read("map.exr", &file(vec![layer(None, encoding, &[("photons", samples)])]))
    };
    let whole = FlatSamples::U32(small_map().values().to_vec());
    assert_eq!(with(Compression::PXR24, whole.clone()).unwrap(), small_map());
    assert_refused(with(Compression::PXR24, floats(1.0)), &["pxr24", "f32", "lossy", "ZIP"]);
    let halves = FlatSamples::F16(vec![f16::from_f32(2.0); 12]);
    for compression in [Compression::B44, Compression::B44A, Compression::DWAA(None), Compression::DWAB(None)]
    {
        assert_refused(with(compression, halves.clone()), &["f16", "lossy", "ZIP"]);
        assert_eq!(with(compression, whole.clone()).unwrap(), small_map(), "u32 in {compression}");
    }
}

#[test]
fn deep_data_is_refused() {
    let flat = written("map.exr", &small_map());
    let mut deep =
        patched(&flat, b"type\0string\0\x0d\0\0\0scanlineimage", b"type\0string\0\x0c\0\0\0deepscanline");
    deep[5] |= 8;
    assert_refused(read("map.exr", &deep), &["can't be read here", "deep", "flat scan lines"]);
}

#[test]
fn a_block_that_occurs_twice_is_refused() {
    // Uncompressed: each of the three rows is a block of 8 + 16 bytes, the last ones of the file.
    let encoding = Encoding { compression: Compression::Uncompressed, ..LINES };
    let mut bytes = file(vec![layer(None, encoding, &[("photons", floats(1.0))])]);
    let first = bytes.len() - 3 * 24;
    bytes.copy_within(first..first + 24, first + 24);
    assert_refused(read("map.exr", &bytes), &["a block of pixels occurs twice"]);
}

#[test]
fn a_block_that_is_missing_is_refused() {
    // Of two layers with three blocks of 12 + 16 bytes each, the first block says that it is of the other
    // layer.
    let encoding = Encoding { compression: Compression::Uncompressed, ..LINES };
    let channel = ("n", floats(1.0));
    let mut bytes =
        file(["a", "b"].map(|name| layer(Some(name), encoding, std::slice::from_ref(&channel))).into());
    assert_eq!(read_bytes("map.exr", &bytes, &named("a.n")).unwrap(), small_map());
    let first = bytes.len() - 6 * 28;
    bytes[first] = 1;
    assert_refused(read_bytes("map.exr", &bytes, &named("a.n")), &["8 of 12 pixels are there"]);
}

#[test]
fn attributes_are_written_and_the_channel_is_named() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("radius.exr");
    let attributes = [
        Attribute::text("renderer", "llvmpipe \u{b7} é"),
        Attribute::integer("minPhotons", 25_u32),
        Attribute::integer("totalPhotons", i64::from(i32::MAX) + 1),
        Attribute::text("anAttributeWithANameOfMoreThan31Letters", ""),
    ];
    write_counts(&path, "radius", &small_map(), &attributes).unwrap();

    let options = named("radius");
    let bytes = fs::read(&path).unwrap();
    assert_eq!(read_bytes("map.exr", &bytes, &options).unwrap(), small_map());
    // Pedantic: what other readers stumble over is an error.
    let meta_data = MetaData::read_from_file(&path, true).unwrap();
    MetaData::validate(&meta_data.headers, true).unwrap();
    let header = &meta_data.headers[0];
    assert!(meta_data.requirements.has_long_names);
    assert_eq!(header.compression, Compression::ZIP16);
    assert_eq!(header.channels.list[0].sample_type, exr::prelude::SampleType::U32);
    let text = |text: &str| AttributeValue::Text(Text::from_slice_unchecked(text.as_bytes()));
    let found = |name: &str| header.own_attributes.other[&Text::from(name)].clone();
    assert_eq!(found("renderer"), text("llvmpipe \u{b7} é"));
    assert_eq!(found("minPhotons"), AttributeValue::I32(25));
    assert_eq!(found("totalPhotons"), text("2147483648"));
    assert_eq!(found("anAttributeWithANameOfMoreThan31Letters"), text(""));

    let again = folder.path().join("again.exr");
    write_counts(&again, "radius", &small_map(), &attributes).unwrap();
    assert_eq!(fs::read(&again).unwrap(), bytes, "the order of the attributes is fixed");
}

#[test]
#[should_panic(expected = "two attributes have one name")]
fn an_attribute_may_not_replace_one_of_the_format() {
    let folder = TempDir::new().unwrap();
    let attributes = [Attribute::text("channels", "")];
    let _ = write_counts(&folder.path().join("a.exr"), "radius", &small_map(), &attributes);
}
