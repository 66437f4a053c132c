//! PNG files of every colour type, made here chunk by chunk.

use glam::UVec2;
use varikernel::image::Image;

use crate::{assert_refused, read, small_map, written};

pub(crate) const GREY: u8 = 0;

/// A chunk with its checksum.
pub(crate) fn chunk(name: [u8; 4], data: &[u8]) -> Vec<u8> {
    let content = [name.as_slice(), data].concat();
    let checksum = !content.iter().fold(u32::MAX, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| (sum >> 1) ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 })
    });
    let length = u32::try_from(data.len()).unwrap();
    [length.to_be_bytes().as_slice(), &content, &checksum.to_be_bytes()].concat()
}

/// Bytes as zlib stores them without packing.
fn stored(bytes: &[u8]) -> Vec<u8> {
    let length = u16::try_from(bytes.len()).unwrap();
    let (low, high) = bytes
        .iter()
        .fold((1, 0), |(a, b), &byte| ((a + u32::from(byte)) % 65521, (b + a + u32::from(byte)) % 65521));
    let checksum = (high << 16 | low).to_be_bytes();
    [&[0x78, 1, 1], length.to_le_bytes().as_slice(), &(!length).to_le_bytes(), bytes, &checksum].concat()
}

/// A PNG of `size` with `bits` and colour type; each row begins with its filter, 0. `extra` comes before the
/// pixels.
pub(crate) fn png(size: (u32, u32), bits: u8, colours: u8, rows: &[u8], extra: &[u8]) -> Vec<u8> {
    let header = [size.0.to_be_bytes().as_slice(), &size.1.to_be_bytes(), &[bits, colours, 0, 0, 0]].concat();
    [
        b"\x89PNG\r\n\x1a\n",
        chunk(*b"IHDR", &header).as_slice(),
        extra,
        &chunk(*b"IDAT", &stored(rows)),
        &chunk(*b"IEND", b""),
    ]
    .concat()
}

#[test]
fn grey_levels_are_counts() {
    let two = Image::from_values(UVec2::new(2, 1), vec![3, 255]);
    assert_eq!(read("a.png", &png((2, 1), 8, GREY, &[0, 3, 255], &[])).unwrap(), two);
    let two = Image::from_values(UVec2::new(2, 1), vec![258, 65535]);
    assert_eq!(read("a.png", &png((2, 1), 16, GREY, &[0, 1, 2, 255, 255], &[])).unwrap(), two);
    let rows = Image::from_values(UVec2::new(1, 2), vec![5, 6]);
    assert_eq!(read("a.png", &png((1, 2), 8, GREY, &[0, 5, 0, 6], &[])).unwrap(), rows);
}

#[test]
fn fewer_bits_are_refused_and_not_rescaled() {
    for bits in [1, 2, 4] {
        let refused = read("a.png", &png((2, 1), bits, GREY, &[0, 0x50], &[]));
        assert_refused(refused, &[&format!("grey with {bits} bit"), "8 or 16 bits"]);
    }
}

#[test]
fn colours_and_transparency_are_refused() {
    let pixel = [0; 9];
    for bits in [8, 16] {
        for (colours, samples, words) in [
            (2, 3, "RGB colour with"),
            (4, 2, "grey with transparency"),
            (6, 4, "RGB colour with transparency"),
        ] {
            let row = &pixel[..=samples * usize::from(bits / 8)];
            assert_refused(
                read("a.png", &png((1, 1), bits, colours, row, &[])),
                &[words, "without transparency"],
            );
        }
    }
    let palette = chunk(*b"PLTE", &[9, 9, 9]);
    assert_refused(read("a.png", &png((1, 1), 8, 3, &[0, 0], &palette)), &["palette", "8 or 16 bits"]);
    let transparent_level = chunk(*b"tRNS", &[0, 7]);
    let refused = read("a.png", &png((1, 1), 8, GREY, &[0, 7], &transparent_level));
    assert_refused(refused, &["transparency", "8 or 16 bits"]);
    assert_refused(read("a.png", &png((1, 1), 8, 5, &[0, 0], &[])), &["colour type"]);
}

#[test]
fn headers_that_claim_too_much() {
    let claims = |width, height| read("a.png", &png((width, height), 16, GREY, &[0, 0, 0], &[]));
    assert_refused(claims(1_000_000_000, 1_000_000_000), &["1000000000 x 1000000000", "65536 a side"]);
    assert_refused(claims(16384, 16385), &["16384 x 16385", "268435456 in all"]);
    assert_refused(claims(16384, 16384), &["truncated", "16384 x 16384", "bytes"]);
    assert_refused(claims(0, 4), &["no pixels"]);
}

#[test]
fn what_follows_the_end_is_not_read() {
    let whole = png((2, 1), 8, GREY, &[0, 3, 255], &[]);
    let two = Image::from_values(UVec2::new(2, 1), vec![3, 255]);
    for tail in [b"\0".as_slice(), b"more", "long".repeat(20_000).as_bytes(), &chunk(*b"IDAT", &[0; 40])] {
        assert_eq!(read("a.png", &[&whole, tail].concat()).unwrap(), two);
    }
    // An unknown chunk may come before the end, and be of any length.
    let note = chunk(*b"teXt", "long".repeat(5000).as_bytes());
    assert_eq!(read("a.png", &png((2, 1), 8, GREY, &[0, 3, 255], &note)).unwrap(), two);
}

#[test]
fn damaged_files_are_refused() {
    let whole = png((2, 1), 8, GREY, &[0, 3, 255], &[]);
    let mut wrong_pixel = whole.clone();
    let data = whole.windows(4).position(|bytes| bytes == b"IDAT").unwrap();
    wrong_pixel[data + 13] ^= 1;
    assert_refused(read("a.png", &wrong_pixel), &["damaged"]);
    assert_refused(read("a.png", &png((2, 2), 8, GREY, &[0, 3, 255], &[])), &["damaged"]);
    for length in [whole.len() - 1, whole.len() - 11, whole.len() - 12, whole.len() - 20] {
        assert_refused(read("a.png", &whole[..length]), &["truncated"]);
    }
    let other_first = [&whole[..8], &chunk(*b"tEXt", b"Title\0density map"), &whole[8..]].concat();
    assert_refused(read("a.png", &other_first), &["begin with its header"]);
}

#[test]
fn counts_are_written_as_16_bits() {
    let bytes = written("a.png", &small_map());
    assert_eq!(bytes[24..26], [16, GREY]);
}
