//! The two wrappings of glTF: JSON alone, or JSON and bytes in the chunks of a GLB.

use super::{Problem, problem};

/// Of the header, and of a chunk before its content.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

const REMEDY: &str = "copy or export the file again";

/// The JSON of a file, and the bytes that a GLB brings with it.
///
/// # Errors
/// If a GLB is cut short, or its chunks are not what they say.
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
    // Bytes after the length that the header tells mean nothing.
    let content = content.get(..length).ok_or_else(|| cut("the file", length, content.len()))?;
    let (first, json, mut rest) = chunk(content.get(HEADER..).unwrap_or_default())?;
    if first != *b"JSON" {
        return Err(problem("GLB", "its first chunk is not JSON", REMEDY));
    }
    // Chunks of other kinds may stand before and after the bytes, and are passed over.
    while rest.len() >= CHUNK_HEADER {
        let (kind, bytes, after) = chunk(rest)?;
        if kind == *b"BIN\0" {
            return Ok((json, Some(bytes)));
        }
        rest = after;
    }
    Ok((json, None))
}

/// Kind and content of the first chunk, and what comes after.
fn chunk(bytes: &[u8]) -> Result<([u8; 4], &[u8], &[u8]), Problem> {
    let (Some(length), Some(kind)) = (word(bytes, 0), bytes.get(4..CHUNK_HEADER)) else {
        return Err(cut("the header of a chunk", CHUNK_HEADER, bytes.len()));
    };
    let rest = &bytes[CHUNK_HEADER..];
    let (content, after) = rest.split_at_checked(length).ok_or_else(|| cut("a chunk", length, rest.len()))?;
    Ok(([kind[0], kind[1], kind[2], kind[3]], content, after))
}

/// Four bytes as a number.
fn word(bytes: &[u8], at: usize) -> Option<usize> {
    let word = bytes.get(at..)?.first_chunk::<4>()?;
    usize::try_from(u32::from_le_bytes(*word)).ok()
}

fn cut(what: &str, told: usize, left: usize) -> Problem {
    problem("GLB", format!("{what} should have {told} bytes, and {left} are left"), REMEDY)
}
