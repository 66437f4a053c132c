//! Maps from and to files, by the file's extension.

use std::fmt;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Cursor, ErrorKind, Read as _, Seek};
use std::path::Path;

use super::atomic::write_atomically;
use super::attribute::Attribute;
use super::counts::{Meaning, Problem, ReadOptions};
use super::map_picture::{self, Picture};
use super::{Image, exr, npy, png};
use crate::error::{Error, Result};

/// The file formats, by extension in any case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// `.exr`, OpenEXR.
    Exr,
    /// `.npy`, an array of NumPy.
    Npy,
    /// `.png`.
    Png,
}

impl Format {
    const ALL: [Self; 3] = [Self::Exr, Self::Npy, Self::Png];

    /// The format by the extension of `path`.
    ///
    /// # Errors
    /// If the extension is none of the three, or missing.
    pub fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().unwrap_or_default();
        Self::ALL.into_iter().find(|format| extension.eq_ignore_ascii_case(format.extension())).ok_or_else(
            || {
                let problem = if extension.is_empty() {
                    "the file name has no extension, so that its format is not known".to_owned()
                } else {
                    format!("the extension .{} is not that of a known format", extension.display())
                };
                Error::file(path, problem, "use a file name that ends in .exr, .npy or .png")
            },
        )
    }

    /// The extension, in small letters and without a dot.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Exr => "exr",
            Self::Npy => "npy",
            Self::Png => "png",
        }
    }

    fn signature(self) -> &'static [u8] {
        match self {
            Self::Exr => exr::SIGNATURE,
            Self::Npy => npy::SIGNATURE,
            Self::Png => png::SIGNATURE,
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Exr => "EXR",
            Self::Npy => "NPY",
            Self::Png => "PNG",
        })
    }
}

/// Reads a map of counts: one channel of f16, f32 or u32 from EXR, a 2-D array of bool, integers, f16, f32 or
/// f64 from NPY, 8- or 16-bit grey levels from PNG. The first row of the file is row 0.
///
/// Sizes are checked before memory is taken for pixels. What follows the end of the image in a file is not
/// read.
///
/// # Errors
/// If there is no such file, it is not what its extension says, it is truncated or damaged, it holds several
/// channels and none is chosen, it is empty or larger than `options` allow, or a value is not a whole number
/// from 0 to 4294967295.
pub fn read_counts(path: &Path, options: &ReadOptions<'_>) -> Result<Image<u32>> {
    Format::of(path)?;
    let (file, length) = open_file(path)?;
    decode(path, file, length, options)
}

/// Reads a map of counts from the bytes of a file, as [`read_counts`] does from the file itself; the
/// extension of `name` is the format, and errors give the name.
///
/// # Errors
/// As [`read_counts`].
pub fn read_counts_of(name: &Path, bytes: &[u8], options: &ReadOptions<'_>) -> Result<Image<u32>> {
    decode(name, Cursor::new(bytes), bytes.len() as u64, options)
}

fn decode(
    path: &Path,
    mut file: impl BufRead + Seek,
    length: u64,
    options: &ReadOptions<'_>,
) -> Result<Image<u32>> {
    let format = Format::of(path)?;
    let found = check_signature(&mut file, format).and_then(|()| match format {
        Format::Exr => exr::read(file, length, options),
        Format::Npy => npy::read(file, length, options, Meaning::Counts),
        Format::Png => png::read(file, length, options),
    });
    found.map_err(|problem| file_error(path, problem))
}

/// Reads a mask: 1 for each pixel that is set in the file, else 0. Row 0 is the first row of the file.
///
/// A pixel is set where it is not 0: in an NPY of any kind that [`read_counts`] takes, and in the channels of
/// the first layer of an EXR, or where it is not black, in a PNG of any kind, 1 bit, colours and palettes
/// too. Where there is alpha (`A` in an EXR), pixels that are wholly transparent are not set. Values need not
/// be counts: fractions and negative numbers set.
///
/// # Errors
/// As [`read_counts`] for files; and if a value is not a number.
pub fn read_mask(path: &Path) -> Result<Image<u8>> {
    let format = Format::of(path)?;
    let (mut file, length) = open_file(path)?;
    let options = &ReadOptions::default();
    let found = check_signature(&mut file, format).and_then(|()| match format {
        Format::Exr => exr::read_mask(file, length, options),
        Format::Npy => npy::read(file, length, options, Meaning::Mask),
        Format::Png => png::read_mask(file, length, options),
    });
    let mask = found.map_err(|problem| file_error(path, problem))?;
    Ok(mask.map(|value| u8::from(value != 0)))
}

/// Writes counts: to EXR as one u32 channel named `channel` with `attributes`, to NPY as a 2-D array of u32,
/// to PNG as 16-bit grey levels. [`read_counts`] gets the same map back. NPY and PNG have no place for the
/// names.
///
/// # Errors
/// As [`write_atomically`], if the extension is unknown, or if a count is above 65535 for PNG.
///
/// # Panics
/// If `channel` or the name of an attribute is empty, longer than 255 bytes or not ASCII, or if an attribute
/// has the name of another or of one that is in every EXR file, such as `channels`.
pub fn write_counts(path: &Path, channel: &str, image: &Image<u32>, attributes: &[Attribute]) -> Result<()> {
    match Format::of(path)? {
        Format::Exr => write_atomically(path, |file| exr::write(file, channel, image, attributes)),
        Format::Npy => write_atomically(path, |file| npy::write(file, image)),
        Format::Png => {
            let levels = png::grey_levels(image).map_err(|problem| file_error(path, problem))?;
            write_atomically(path, |file| png::write_grey(file, image.size(), &levels))
        }
    }
}

/// Writes a colour-mapped PNG with a legend below; see [`Picture`].
///
/// # Errors
/// As [`write_atomically`], and if the extension is not `png`.
pub fn write_picture(path: &Path, image: &Image<u32>, picture: &Picture<'_>) -> Result<()> {
    let format = Format::of(path)?;
    if format != Format::Png {
        return Err(Error::file(
            path,
            format!("a picture is written as PNG, not as {format}"),
            "use a file name that ends in .png",
        ));
    }
    let drawn = map_picture::draw(image, picture);
    write_atomically(path, |file| png::write_colours(file, &drawn))
}

/// The file, and its length in bytes.
///
/// # Errors
/// If there is no such file, it is a folder, a device or a pipe, or may not be read.
pub(crate) fn open_file(path: &Path) -> Result<(BufReader<File>, u64)> {
    let failed = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => {
            Error::file(path, "there is no such file", "check the path; it counts from the current folder")
        }
        ErrorKind::PermissionDenied => {
            Error::file(path, "no permission to read it", "ask for the permission, or copy the file")
        }
        _ => Error::file(path, format!("could not be opened: {error}"), "check the path"),
    };
    // Checked first: to open a pipe would wait for its other end.
    let metadata = fs::metadata(path).map_err(failed)?;
    if metadata.is_dir() {
        return Err(Error::file(path, "is a folder", "name a file in it"));
    }
    if !metadata.is_file() {
        return Err(Error::file(
            path,
            "is a device or a pipe, not a file",
            "save its content to a file first",
        ));
    }
    let file = File::open(path).map_err(failed)?;
    Ok((BufReader::new(file), metadata.len()))
}

/// Leaves the file at its start.
pub(super) fn check_signature(file: &mut (impl BufRead + Seek), format: Format) -> Result<(), Problem> {
    let unreadable = |error| Problem::damaged(format!("could not be read: {error}"));
    let mut start = Vec::new();
    file.by_ref().take(8).read_to_end(&mut start).map_err(unreadable)?;
    file.rewind().map_err(unreadable)?;
    if start.starts_with(format.signature()) {
        return Ok(());
    }
    if start.is_empty() {
        return Err(Problem::damaged("the file is empty"));
    }
    if format.signature().starts_with(&start) {
        return Err(Problem::damaged("truncated: the file ends inside its signature"));
    }
    Err(match Format::ALL.into_iter().find(|other| start.starts_with(other.signature())) {
        Some(other) => Problem::new(
            format!("the content is {other}, not {format}"),
            format!("rename it to end in .{}", other.extension()),
        ),
        None => Problem::new(
            format!("the content is not {format}, nor another format that can be read"),
            "give an EXR, NPY or PNG file, with the extension that fits",
        ),
    })
}

fn file_error(path: &Path, problem: Problem) -> Error {
    Error::file(path, problem.what, problem.remedy)
}
