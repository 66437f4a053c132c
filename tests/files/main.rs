//! The file formats of maps: what is written comes back, and bad input is a clear error.

#![expect(clippy::unwrap_used, reason = "in the helpers of tests too, a panic is the report")]

mod exr_files;
mod exr_packed;
mod links;
mod masks;
mod npy_files;
mod output;
mod picture;
mod png_files;

use std::fs;
use std::path::Path;

use glam::UVec2;
use proptest::prelude::*;
use tempfile::TempDir;
use varikernel::Result;
use varikernel::image::{Image, ReadOptions, read_counts, write_counts};

/// Puts `bytes` into a file of its own and reads that.
fn read_bytes(name: &str, bytes: &[u8], options: &ReadOptions<'_>) -> Result<Image<u32>> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    read_counts(&path, options)
}

fn read(name: &str, bytes: &[u8]) -> Result<Image<u32>> {
    read_bytes(name, bytes, &ReadOptions::default())
}

/// The message of the error, which has to hold all `words` and some help.
#[track_caller]
fn assert_refused<T: std::fmt::Debug>(result: Result<T>, words: &[&str]) {
    let message = result.unwrap_err().to_string();
    for word in words.iter().chain(&["\nhelp: "]) {
        assert!(message.contains(word), "{word:?} is not in: {message}");
    }
}

/// The map as a file, in bytes.
fn written(name: &str, image: &Image<u32>) -> Vec<u8> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    write_counts(&path, "count", image, &[]).unwrap();
    fs::read(path).unwrap()
}

/// The names in a folder, sorted.
fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// 4 x 3 values that differ, so that a wrong order of rows or columns shows.
fn small_map() -> Image<u32> {
    Image::from_fn(UVec2::new(4, 3), |x, y| 10 * y + x)
}

#[test]
fn each_format_returns_what_was_written() {
    for name in ["map.exr", "map.npy", "map.png", "MAP.EXR", "MAP.Npy", "map.PNG"] {
        for size in [UVec2::ONE, UVec2::new(1, 6), UVec2::new(6, 1), UVec2::new(37, 20), UVec2::new(49, 2)] {
            let image = Image::from_fn(size, |x, y| x * 1000 + y);
            assert_eq!(read(name, &written(name, &image)).unwrap(), image, "{name} at {size}");
        }
    }
}

#[test]
fn the_largest_counts_come_back() {
    for (name, largest) in [("map.exr", u32::MAX), ("map.npy", u32::MAX), ("map.png", 65535)] {
        let image = Image::from_values(UVec2::new(3, 1), vec![0, largest - 1, largest]);
        assert_eq!(read(name, &written(name, &image)).unwrap(), image, "{name}");
    }
}

#[test]
fn the_same_map_gives_the_same_bytes() {
    for name in ["map.exr", "map.npy", "map.png"] {
        assert_eq!(written(name, &small_map()), written(name, &small_map()), "{name}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn random_maps_come_back(
        image in (1_u32..20, 1_u32..40).prop_flat_map(|(x, y)| {
            prop::collection::vec(any::<u32>(), (x * y) as usize)
                .prop_map(move |values| Image::from_values(UVec2::new(x, y), values))
        })
    ) {
        for name in ["map.exr", "map.npy"] {
            prop_assert_eq!(&read(name, &written(name, &image)).unwrap(), &image);
        }
    }
}

#[test]
fn a_file_cut_anywhere_is_refused() {
    for name in ["map.exr", "map.npy", "map.png"] {
        let bytes = written(name, &small_map());
        assert_eq!(read(name, &bytes).unwrap(), small_map(), "{name} as a whole");
        for length in 0..bytes.len() {
            let message = read(name, &bytes[..length]).unwrap_err().to_string();
            assert!(
                ["truncated", "empty", "damaged"].iter().any(|word| message.contains(word)),
                "{name}, first {length} bytes: {message}"
            );
        }
    }
}

#[test]
fn a_file_with_any_byte_changed_never_panics() {
    for name in ["map.exr", "map.npy", "map.png"] {
        let bytes = written(name, &small_map());
        let mut refused = 0;
        for place in 0..bytes.len() {
            for change in [0x01, 0x20, 0x80, 0xff] {
                let mut changed = bytes.clone();
                changed[place] ^= change;
                refused += u32::from(read(name, &changed).is_err());
            }
        }
        assert!(refused > 100, "{name}: only {refused} changes were noticed");
    }
}

#[test]
fn sizes_past_the_limits_are_refused() {
    let options = ReadOptions { max_side: 3, ..ReadOptions::default() };
    for name in ["map.exr", "map.npy", "map.png"] {
        let bytes = written(name, &small_map());
        assert_refused(read_bytes(name, &bytes, &options), &["4 x 3", "3 a side"]);
        let pixels = |max_pixels| ReadOptions { max_pixels, ..ReadOptions::default() };
        assert_refused(read_bytes(name, &bytes, &pixels(11)), &["4 x 3", "11 in all"]);
        assert_eq!(read_bytes(name, &bytes, &pixels(12)).unwrap(), small_map());
    }
}

#[test]
fn what_is_no_map_is_refused() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    let options = ReadOptions::default();
    fs::create_dir(path("folder.exr")).unwrap();

    assert_refused(read_counts(&path("absent.exr"), &options), &["absent.exr", "no such file"]);
    assert_refused(read_counts(&path("folder.exr"), &options), &["is a folder"]);
    assert_refused(read_counts(&path("map.tiff"), &options), &[".tiff", ".exr", ".npy", ".png"]);
    assert_refused(read_counts(&path("map"), &options), &["no extension", ".exr", ".npy", ".png"]);
    for name in ["map.exr", "map.npy", "map.png"] {
        assert_refused(read(name, b""), &["empty"]);
        assert_refused(read(name, b"Dear reader, this is a letter."), &["the content is not"]);
    }
    let png = written("map.png", &small_map());
    assert_refused(read("map.exr", &png), &["the content is PNG, not EXR", "rename it to end in .png"]);
    let npy = written("map.npy", &small_map());
    assert_refused(read("map.png", &npy), &["the content is NPY, not PNG", "rename it to end in .npy"]);
}

#[cfg(unix)]
#[test]
fn a_device_is_not_read() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("map.npy");
    std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
    assert_refused(read_counts(&path, &ReadOptions::default()), &["is a device or a pipe"]);
}

#[test]
fn a_channel_of_a_format_without_names_is_refused() {
    let options = ReadOptions { channel: Some("count"), ..ReadOptions::default() };
    for name in ["map.npy", "map.png"] {
        let bytes = written(name, &small_map());
        assert_refused(read_bytes(name, &bytes, &options), &["\"count\"", "one unnamed channel"]);
    }
}
