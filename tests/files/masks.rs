//! Masks: what is set in a file of any kind.

use std::fs;

use exr::prelude::{FlatSamples, f16};
use glam::UVec2;
use tempfile::TempDir;
use varikernel::Result;
use varikernel::image::{Image, read_mask, write_counts};

use crate::exr_files::{LINES, file, layer};
use crate::npy_files::array;
use crate::png_files::{GREY, chunk, png};
use crate::{assert_refused, small_map};

/// Colour types of PNG.
const RGB: u8 = 2;
const PALETTE: u8 = 3;
const GREY_ALPHA: u8 = 4;
const RGBA: u8 = 6;

fn mask_of(name: &str, bytes: &[u8]) -> Result<Image<u8>> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    read_mask(&path)
}

#[track_caller]
fn assert_mask(name: &str, bytes: &[u8], size: (u32, u32), expected: &[u8]) {
    let mask = mask_of(name, bytes).unwrap();
    assert_eq!((mask.size(), mask.values()), (UVec2::from(size), expected));
}

#[test]
fn grey_of_any_depth() {
    // The first bits of a row are its first pixels.
    assert_mask("a.png", &png((4, 1), 1, GREY, &[0, 0b1010_0000], &[]), (4, 1), &[1, 0, 1, 0]);
    assert_mask("a.png", &png((3, 1), 2, GREY, &[0, 0b00_01_11_00], &[]), (3, 1), &[0, 1, 1]);
    assert_mask("a.png", &png((2, 2), 4, GREY, &[0, 0x10, 0, 0x0f], &[]), (2, 2), &[1, 0, 0, 1]);
    assert_mask("a.png", &png((3, 1), 8, GREY, &[0, 0, 1, 255], &[]), (3, 1), &[0, 1, 1]);
    assert_mask("a.png", &png((3, 1), 16, GREY, &[0, 0, 0, 0, 1, 1, 0], &[]), (3, 1), &[0, 1, 1]);
}

#[test]
fn colours_that_are_not_black() {
    let row = [0, 0, 0, 0, 0, 0, 1, 9, 0, 0];
    assert_mask("a.png", &png((3, 1), 8, RGB, &row, &[]), (3, 1), &[0, 1, 1]);
    // The low byte of the middle channel alone.
    let row = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0];
    assert_mask("a.png", &png((2, 1), 16, RGB, &row, &[]), (2, 1), &[0, 1]);
    let colours = chunk(*b"PLTE", &[0, 0, 0, 0, 0, 7, 255, 255, 255]);
    assert_mask("a.png", &png((4, 1), 2, PALETTE, &[0, 0b00_01_10_00], &colours), (4, 1), &[0, 1, 1, 0]);
    assert_mask("a.png", &png((3, 1), 8, PALETTE, &[0, 2, 0, 1], &colours), (3, 1), &[1, 0, 1]);
}

#[test]
fn what_is_wholly_transparent_is_not_set() {
    let row = [0, 9, 0, 9, 1, 0, 255];
    assert_mask("a.png", &png((3, 1), 8, GREY_ALPHA, &row, &[]), (3, 1), &[0, 1, 0]);
    let row = [0, 9, 9, 9, 0, 0, 0, 9, 1, 0, 0, 0, 255];
    assert_mask("a.png", &png((3, 1), 8, RGBA, &row, &[]), (3, 1), &[0, 1, 0]);
    // One colour of a palette, and one grey level, that are transparent.
    let colours = [chunk(*b"PLTE", &[1, 1, 1, 2, 2, 2]), chunk(*b"tRNS", &[0])].concat();
    assert_mask("a.png", &png((2, 1), 8, PALETTE, &[0, 0, 1], &colours), (2, 1), &[0, 1]);
    let level = chunk(*b"tRNS", &[0, 7]);
    assert_mask("a.png", &png((3, 1), 8, GREY, &[0, 7, 8, 0], &level), (3, 1), &[0, 1, 0]);
}

#[test]
fn numbers_need_not_be_counts() {
    let values = [0.0_f32, -0.0, 0.5, -3.0, 1e30, f32::INFINITY].map(f32::to_le_bytes).concat();
    assert_mask("a.npy", &array("<f4", "(1, 6)", &values), (6, 1), &[0, 0, 1, 1, 1, 1]);
    assert_mask("a.npy", &array("|b1", "(2, 1)", &[1, 0]), (1, 2), &[1, 0]);
    assert_mask("a.npy", &array("<i8", "(1, 1)", &[0xff; 8]), (1, 1), &[1]);
    let values = [0.0_f32, f32::NAN].map(f32::to_le_bytes).concat();
    assert_refused(
        mask_of("a.npy", &array("<f4", "(1, 2)", &values)),
        &["(1, 0) is NaN", "1 of 2 pixels are not numbers", "give 0 where no radius is needed"],
    );
}

/// 12 samples, 0 but for the given ones.
fn samples(set: &[(usize, f32)]) -> FlatSamples {
    let mut values = vec![0.0; 12];
    for &(index, value) in set {
        values[index] = value;
    }
    FlatSamples::F32(values)
}

#[test]
fn any_channel_of_an_exr_sets() {
    let set = |bytes: &[u8]| -> Vec<usize> {
        let mask = mask_of("a.exr", bytes).unwrap();
        assert_eq!(mask.size(), UVec2::new(4, 3));
        (0..12).filter(|&index| mask.values()[index] == 1).collect()
    };
    let halves = (0..12).map(|index| if index == 5 { f16::from_f32(0.25) } else { f16::ZERO }).collect();
    assert_eq!(set(&file(vec![layer(None, LINES, &[("Y", FlatSamples::F16(halves))])])), [5]);
    let colours = [("B", samples(&[(1, 0.1)])), ("G", samples(&[])), ("R", samples(&[(2, -1.0), (7, 5.0)]))];
    assert_eq!(set(&file(vec![layer(None, LINES, &colours)])), [1, 2, 7]);
    let [b, g, r] = colours;
    let alpha = ("A", samples(&[(1, 1.0), (3, 1.0), (7, 0.5)]));
    assert_eq!(set(&file(vec![layer(None, LINES, &[alpha.clone(), b, g, r])])), [1, 7]);
    assert_eq!(set(&file(vec![layer(None, LINES, &[alpha])])), [1, 3, 7], "alpha alone");
}

#[test]
fn maps_are_masks() {
    let folder = TempDir::new().unwrap();
    for name in ["a.exr", "a.npy", "a.png"] {
        write_counts(&folder.path().join(name), "n", &small_map(), &[]).unwrap();
        let mask = read_mask(&folder.path().join(name)).unwrap();
        assert_eq!(mask, small_map().map(|count| u8::from(count != 0)), "{name}");
    }
}

#[test]
fn damaged_masks_are_refused() {
    let whole = png((2, 1), 1, GREY, &[0, 0x80], &[]);
    for length in 0..whole.len() {
        assert!(mask_of("a.png", &whole[..length]).is_err(), "{length} bytes");
    }
    assert_refused(mask_of("a.png", &png((2, 2), 1, GREY, &[0, 0x80], &[])), &["damaged"]);
    assert_refused(mask_of("a.png", &png((1, 1), 8, 5, &[0, 0], &[])), &["damaged"]);
    assert_refused(mask_of("a.png", &png((99_999, 1), 8, GREY, &[0, 0], &[])), &["65536 a side"]);
    assert_refused(mask_of("a.tif", &whole), &[".exr, .npy or .png"]);
}
