//! The two wrappings of glTF: JSON alone, or JSON and bytes in the chunks of a GLB.

use super::{Problem, problem};

/// Of the header, and of a chunk before its content.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

const REMEDY: &str = "copy or export the file again";

/// The JSON of a file, and the bytes that a GLB brings with it.
///
/// # Errors
/// If a GLB is cut short, or its chunks are malformed.
pub(super) fn split(content: &[u8]) -> Result<(&[u8], Option<&[u8]>), Problem> {
    if !content.starts_with(b"glTF") {
        return Ok((content.strip_prefix(b"\xef\xbb\xbf").unwrap_or(content), None));
    }
    let (Some(version), Some(length)) = (word(content, 4), word(content, 8)) else {
        return Err(cut("the header", HEADER, content.len()));
    };
    if version != 2 {
        let reason = format!("it is version {version} of the format, and only 2 is supported");
        return Err(problem("GLB", reason, "export the mesh again as glTF 2.0"));
    }
    // Bytes after the length in the header are ignored.
    let content = content.get(..length).ok_or_else(|| cut("the file", length, content.len()))?;
    let json = Chunk::first(content.get(HEADER..).unwrap_or_default())?;
    if json.kind != b"JSON" {
        return Err(problem("GLB", "its first chunk is not JSON", REMEDY));
    }
    // Chunks of other kinds may stand before and after the bytes, and are passed over.
    let mut rest = json.after;
    while rest.len() >= CHUNK_HEADER {
        let chunk = Chunk::first(rest)?;
        if chunk.kind == b"BIN\0" {
            return Ok((json.content, Some(chunk.content)));
        }
        rest = chunk.after;
    }
    Ok((json.content, None))
}

/// A part of a GLB.
struct Chunk<'a> {
    kind: &'a [u8],
    content: &'a [u8],
    /// What comes behind it.
    after: &'a [u8],
}

impl<'a> Chunk<'a> {
    /// The one at the beginning of bytes.
    fn first(bytes: &'a [u8]) -> Result<Self, Problem> {
        let (Some(length), Some(kind)) = (word(bytes, 0), bytes.get(4..CHUNK_HEADER)) else {
            return Err(cut("the header of a chunk", CHUNK_HEADER, bytes.len()));
        };
        let rest = &bytes[CHUNK_HEADER..];
        let (content, after) =
            rest.split_at_checked(length).ok_or_else(|| cut("a chunk", length, rest.len()))?;
        Ok(Self { kind, content, after })
    }
}

/// Four bytes as a number.
fn word(bytes: &[u8], at: usize) -> Option<usize> {
    let word = bytes.get(at..)?.first_chunk::<4>()?;
    usize::try_from(u32::from_le_bytes(*word)).ok()
}

fn cut(what: &str, told: usize, left: usize) -> Problem {
    problem("GLB", format!("{what} should have {told} bytes, and {left} are left"), REMEDY)
}
