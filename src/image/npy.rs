//! NPY, the array file of NumPy: a header in Python's notation, then the samples.
//!
//! Read and written here and not by a crate: the header of a hostile file must cause neither an arithmetic
//! overflow nor deep recursion nor a large allocation, and all that is needed of the format is this page. The
//! format: <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>

use std::io::{self, ErrorKind, Read, Write};

use exr::prelude::f16;
use glam::UVec2;

use super::Image;
use super::counts::{Counts, Meaning, Problem, ReadOptions, Sample};

/// The first bytes of every NPY file.
pub(super) const SIGNATURE: &[u8] = b"\x93NUMPY";

/// The longest header that is read, in bytes; NumPy itself stops at 10000.
const MAX_HEADER: u64 = 1 << 16;

const DTYPES: &str = "save it as one of u1, u2, u4, u8, i1, i2, i4, i8, f2, f4 and f8, for example \
                      numpy.save(path, a.astype(\"u4\"))";

/// The header's fields.
struct Header {
    /// `b`, `i`, `u` or `f`, and the bytes of one sample.
    kind: char,
    sample_bytes: u64,
    big_endian: bool,
    fortran_order: bool,
    shape: Vec<u64>,
}

/// Reads a 2-D array of counts from a file of `length` bytes; its first row is row 0.
pub(super) fn read(
    mut file: impl Read,
    length: u64,
    options: &ReadOptions<'_>,
    meaning: Meaning,
) -> Result<Image<u32>, Problem> {
    options.refuse_channel("an NPY file")?;
    let (header, header_bytes) = read_header(&mut file, length)?;
    let &[height, width] = header.shape.as_slice() else {
        return Err(Problem::new(
            format!("an array of {} dimensions, {}, not of 2", header.shape.len(), tuple(&header.shape)),
            "save one 2-D array, of shape (rows, columns)",
        ));
    };
    let size = options.check_size(width, height)?;

    // The product has at most 32 + 32 bits from the check, and eight times that is beyond any `max_pixels`.
    let claimed = (width * height).saturating_mul(header.sample_bytes);
    let present = length - header_bytes;
    if present < claimed {
        return Err(Problem::damaged(format!(
            "truncated: the header claims {claimed} bytes of data, the file has {present}"
        )));
    }
    // More bytes are allowed: NumPy writes several arrays one after the other in a file, and reads the first.

    let mut counts = Counts::new(size, meaning)?;
    read_samples(file, &header, size, &mut counts)
        .map_err(|error| Problem::damaged(format!("the samples could not be read: {error}")))?;
    counts.finish()
}

/// The header and the number of bytes up to its end.
fn read_header(file: &mut impl Read, length: u64) -> Result<(Header, u64), Problem> {
    let ended = |error: io::Error| match error.kind() {
        ErrorKind::UnexpectedEof => Problem::damaged("truncated: the file ends inside its header"),
        _ => Problem::damaged(format!("the header could not be read: {error}")),
    };
    let mut start = [0; 8];
    file.read_exact(&mut start).map_err(ended)?;
    let (text_bytes, before_text) = match start[6] {
        1 => {
            let mut bytes = [0; 2];
            file.read_exact(&mut bytes).map_err(ended)?;
            (u64::from(u16::from_le_bytes(bytes)), 10)
        }
        2 | 3 => {
            let mut bytes = [0; 4];
            file.read_exact(&mut bytes).map_err(ended)?;
            (u64::from(u32::from_le_bytes(bytes)), 12)
        }
        version => {
            return Err(Problem::new(
                format!("version {version} of the NPY format is not known"),
                "save the array again with numpy.save",
            ));
        }
    };
    if text_bytes > MAX_HEADER {
        return Err(Problem::damaged(format!("the header claims a length of {text_bytes} bytes")));
    }
    if text_bytes > length.saturating_sub(before_text) {
        return Err(Problem::damaged("truncated: the file ends inside its header"));
    }
    let mut text = String::new();
    file.take(text_bytes).read_to_string(&mut text).map_err(ended)?;
    Ok((parse_header(&text)?, before_text + text_bytes))
}

fn parse_header(text: &str) -> Result<Header, Problem> {
    let (kind, sample_bytes, big_endian) = parse_dtype(entry(text, "descr")?)?;

    let fortran_order = match entry(text, "fortran_order")? {
        value if value.starts_with("True") => true,
        value if value.starts_with("False") => false,
        _ => return Err(no_entry("fortran_order")),
    };

    let sides = entry(text, "shape")?.strip_prefix('(').and_then(|rest| rest.split_once(')'));
    let (sides, _) = sides.ok_or_else(|| no_entry("shape"))?;
    let shape = sides
        .split(',')
        .map(str::trim)
        .filter(|side| !side.is_empty())
        // Python 2 marks its long numbers: 41L.
        .map(|side| side.strip_suffix(['L', 'l']).unwrap_or(side).parse().map_err(|_| no_entry("shape")))
        .collect::<Result<_, _>>()?;
    Ok(Header { kind, sample_bytes, big_endian, fortran_order, shape })
}

/// What follows `'key':` in the header, up to its end.
fn entry<'a>(text: &'a str, key: &str) -> Result<&'a str, Problem> {
    ["'", "\""]
        .iter()
        .find_map(|quote| text.split_once(&format!("{quote}{key}{quote}")))
        .and_then(|(_, rest)| rest.trim_start().strip_prefix(':'))
        .map(str::trim_start)
        .ok_or_else(|| no_entry(key))
}

fn no_entry(key: &str) -> Problem {
    Problem::damaged(format!("the header has no proper entry \"{key}\""))
}

/// The kind, the bytes of a sample, and whether they are big-endian.
fn parse_dtype(value: &str) -> Result<(char, u64, bool), Problem> {
    if value.starts_with('[') {
        return Err(Problem::new("the dtype is structured, not one number a pixel", DTYPES));
    }
    // Python 2 marks its texts in Unicode, and may mark the others: u'<u4', b'<u4'.
    let quoted = value.trim_start_matches(['u', 'b']).strip_prefix(['\'', '"']);
    let quoted = quoted.and_then(|rest| rest.split_once(['\'', '"']));
    let (dtype, _) = quoted.ok_or_else(|| no_entry("descr"))?;
    let wrong = || Problem::new(format!("the dtype \"{dtype}\" is not one of counts"), DTYPES);

    let mut letters = dtype.chars();
    let big_endian = match letters.next() {
        Some('<' | '|') => false,
        Some('>') => true,
        _ => return Err(wrong()),
    };
    let kind = letters.next().ok_or_else(wrong)?;
    let sample_bytes = letters.as_str().parse().map_err(|_| wrong())?;
    match (kind, sample_bytes) {
        ('b', 1) | ('u' | 'i', 1 | 2 | 4 | 8) | ('f', 2 | 4 | 8) => Ok((kind, sample_bytes, big_endian)),
        _ => Err(wrong()),
    }
}

fn read_samples(file: impl Read, header: &Header, size: UVec2, counts: &mut Counts) -> io::Result<()> {
    match (header.kind, header.sample_bytes) {
        ('i', 1) => fill(file, header, size, counts, i8::from_le_bytes),
        ('i', 2) => fill(file, header, size, counts, i16::from_le_bytes),
        ('i', 4) => fill(file, header, size, counts, i32::from_le_bytes),
        ('i', 8) => fill(file, header, size, counts, i64::from_le_bytes),
        ('f', 2) => fill(file, header, size, counts, f16::from_le_bytes),
        ('f', 4) => fill(file, header, size, counts, f32::from_le_bytes),
        ('f', 8) => fill(file, header, size, counts, f64::from_le_bytes),
        (_, 1) => fill(file, header, size, counts, u8::from_le_bytes),
        (_, 2) => fill(file, header, size, counts, u16::from_le_bytes),
        (_, 4) => fill(file, header, size, counts, u32::from_le_bytes),
        _ => fill(file, header, size, counts, u64::from_le_bytes),
    }
}

fn fill<const N: usize, S: Sample>(
    mut file: impl Read,
    header: &Header,
    size: UVec2,
    counts: &mut Counts,
    sample: fn([u8; N]) -> S,
) -> io::Result<()> {
    let (width, height) = (size.x as usize, size.y as usize);
    for stored in 0..width * height {
        let mut bytes = [0; N];
        file.read_exact(&mut bytes)?;
        if header.big_endian {
            bytes.reverse();
        }
        // Fortran's order is column after column.
        let index = if header.fortran_order { stored % height * width + stored / height } else { stored };
        counts.put(index, sample(bytes));
    }
    Ok(())
}

/// Writes a 2-D array of u32, little-endian, row after row.
pub(super) fn write(file: &mut impl Write, image: &Image<u32>) -> io::Result<()> {
    let shape = tuple(&[u64::from(image.size().y), u64::from(image.size().x)]);
    let text = format!("{{'descr': '<u4', 'fortran_order': False, 'shape': {shape}, }}");
    // Spaces and a newline, so that the data begins at a multiple of 64 bytes.
    let padded = (10 + text.len() + 1).next_multiple_of(64) - 10 - 1;
    let text = format!("{text:padded$}\n");
    // Two numbers of at most ten digits: always 118 bytes or so.
    let text_bytes = u16::try_from(text.len()).map_err(io::Error::other)?;

    file.write_all(SIGNATURE)?;
    file.write_all(&[1, 0])?;
    file.write_all(&text_bytes.to_le_bytes())?;
    file.write_all(text.as_bytes())?;
    for count in image.values() {
        file.write_all(&count.to_le_bytes())?;
    }
    Ok(())
}

/// The numbers as Python writes a tuple.
fn tuple(numbers: &[u64]) -> String {
    match numbers {
        [only] => format!("({only},)"),
        _ => format!("({})", numbers.iter().map(u64::to_string).collect::<Vec<_>>().join(", ")),
    }
}
