//! Pictures from files: radiance from EXR, colours of a screen from PNG.

use std::io::{BufRead, Seek};
use std::path::Path;

use glam::UVec2;
use image::{ImageFormat, ImageReader, Limits};

use super::counts::{Problem, ReadOptions};
use super::files::{Format, check_signature, open_file};
use super::{Image, exr, png};
use crate::error::{Error, Result};

const RGB: [&str; 3] = ["R", "G", "B"];

/// A picture as its file holds it. Row 0 is the first row of the file.
#[derive(Clone, Debug, PartialEq)]
pub enum Colours {
    /// Linear RGB radiance: the channels `R`, `G` and `B` of an EXR file.
    Radiance(Image<[f32; 3]>),
    /// Colours encoded as sRGB, 8 bits each, of a PNG file; transparency is left out.
    Encoded(Image<[u8; 3]>),
}

impl Colours {
    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        match self {
            Self::Radiance(image) => image.size(),
            Self::Encoded(image) => image.size(),
        }
    }
}

/// Reads a picture: EXR with `R`, `G` and `B` in f16, f32 or u32, or PNG of any kind.
///
/// # Errors
/// [`Error::File`] if there is no such file, it is not what its extension says, has no such channels, is
/// damaged, or larger than [`ReadOptions::default`] allows for maps.
pub fn read_colours(path: &Path) -> Result<Colours> {
    let format = Format::of(path)?;
    if format == Format::Npy {
        return Err(Error::file(path, "an NPY file holds a map, not a picture", "give an EXR or PNG file"));
    }
    let (mut file, length) = open_file(path)?;
    let found = check_signature(&mut file, format).and_then(|()| match format {
        Format::Exr => exr::read_channels(file, length, RGB, &ReadOptions::default()).map(Colours::Radiance),
        _ => read_png(file, length).map(Colours::Encoded),
    });
    found.map_err(|problem| Error::file(path, problem.what, problem.remedy))
}

/// Reads channels of an EXR file by their names, as [`LayerFile`](super::LayerFile) writes them:
/// `["direct.R", "direct.G", "direct.B"]`, or `["depth.Y"]`. They are f16, f32 or u32.
///
/// # Errors
/// [`Error::File`] if there is no such file, it is no EXR, has no layer with all of them, is damaged, or larger
/// than [`ReadOptions::default`] allows for maps.
pub fn read_channels<const COUNT: usize>(path: &Path, names: [&str; COUNT]) -> Result<Image<[f32; COUNT]>> {
    let format = Format::of(path)?;
    if format != Format::Exr {
        return Err(Error::file(path, "only EXR files have named channels", "give an EXR file"));
    }
    let (mut file, length) = open_file(path)?;
    check_signature(&mut file, format)
        .and_then(|()| exr::read_channels(file, length, names, &ReadOptions::default()))
        .map_err(|problem| Error::file(path, problem.what, problem.remedy))
}

fn read_png(mut file: impl BufRead + Seek, length: u64) -> Result<Image<[u8; 3]>, Problem> {
    let options = ReadOptions::default();
    let unfinished = |error: std::io::Error| Problem::damaged(format!("truncated or damaged: {error}"));
    png::check_end(&mut file, length).and_then(|()| file.rewind()).map_err(unfinished)?;
    let mut reader = ImageReader::with_format(file, ImageFormat::Png);
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(options.max_side), Some(options.max_side));
    limits.max_alloc = Some(8 * options.max_pixels);
    reader.limits(limits);
    let decoded =
        reader.decode().map_err(|error| Problem::damaged(format!("damaged or too large: {error}")))?;
    let picture = decoded.into_rgb8();
    let size = UVec2::new(picture.width(), picture.height());
    Ok(Image::from_values(size, bytemuck::cast_slice(picture.as_raw()).to_vec()))
}

#[cfg(test)]
mod tests {
    use super::super::{LayerFile, write_colours};
    use super::*;

    #[test]
    fn pictures_come_back_as_they_were_written() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        let size = UVec2::new(3, 2);
        let radiance = Image::from_fn(size, |x, y| {
            [x, y, 7].map(|value| 0.5 * f32::from(u16::try_from(value).expect("small")))
        });
        let other = Image::filled(size, [9.0; 3]);
        let letters = ['R', 'G', 'B'];
        let file = LayerFile::new(size).colours("direct", letters, &other).colours("", letters, &radiance);
        file.write(&path("a.exr"), &[]).expect("written");
        assert_eq!(read_colours(&path("a.exr")).expect("read"), Colours::Radiance(radiance));
        let named = read_channels(&path("a.exr"), ["direct.R", "direct.G", "direct.B"]);
        assert_eq!(named.expect("read"), other);
        assert_eq!(read_channels(&path("a.exr"), ["direct.G"]).expect("read"), Image::filled(size, [9.0]));
        let encoded =
            Image::from_fn(size, |x, y| [x, y, 255].map(|value| u8::try_from(value).expect("small")));
        write_colours(&path("a.png"), &encoded).expect("written");
        assert_eq!(read_colours(&path("a.png")).expect("read"), Colours::Encoded(encoded));
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        let refused = |name: &str, words: &str| {
            let error = read_colours(&path(name)).expect_err(name).to_string();
            assert!(error.contains(words), "{name}: {error}");
        };
        refused("absent.png", "no such file");
        refused("a.npy", "holds a map");
        let size = UVec2::new(3, 2);
        let file = LayerFile::new(size).values("depth", &Image::filled(size, 1.0));
        file.write(&path("depth.exr"), &[]).expect("written");
        refused("depth.exr", "no channels R, G and B, but depth");
        let error = read_channels(&path("depth.exr"), ["normal.X"]).expect_err("no such").to_string();
        assert!(error.contains("no channel normal.X, but depth"), "{error}");
        assert!(read_channels(&path("a.png"), ["R"]).is_err(), "no EXR");
        let file = LayerFile::new(size).colours("", ['R', 'G', 'B'], &Image::filled(size, [1.0; 3]));
        file.write(&path("cut.exr"), &[]).expect("written");
        let bytes = std::fs::read(path("cut.exr")).expect("read");
        for length in [4, bytes.len() / 2, bytes.len() - 1] {
            std::fs::write(path("cut.exr"), &bytes[..length]).expect("written");
            refused("cut.exr", "help:");
        }
        std::fs::write(path("letter.png"), "Dear reader").expect("written");
        refused("letter.png", "the content is not PNG");
    }
}
