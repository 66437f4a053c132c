//! Bytes of a glTF file: buffers, read when first used, and views of them.

use std::fmt::Display;

use gltf_json::buffer::View;
use gltf_json::{Index, Value};

use super::compression::{COMPRESSIONS, compressed};
use super::document::Document;
use super::{Problem, problem, uri};

/// Bytes of numbers that each byte of a buffer may become besides: a number of one byte becomes one of four.
const GROWTH: u64 = 4;

impl Document<'_> {
    /// The bytes of a view, and the distance between items in it where it is given.
    ///
    /// # Errors
    /// If the view reaches past its buffer, or the buffer can't be read.
    pub(super) fn view(
        &self,
        index: Index<View>,
        place: impl Display,
    ) -> Result<(&[u8], Option<usize>), Problem> {
        let view = self.find(index, "buffer view", place)?;
        let place = format!("bufferViews[{index}]");
        let buffer = self.find(view.buffer, "buffer", format!("{place}.buffer"))?;
        let others = view.extensions.as_ref().map(|extensions| &extensions.others);
        let compression =
            COMPRESSIONS.iter().find(|name| others.is_some_and(|others| others.contains_key(**name)));
        if let (Some(name), None) = (compression, &buffer.uri) {
            // Where the buffer is a mere placeholder, the bytes are in another one, compressed.
            let is_blob = view.buffer.value() == 0 && self.blob.is_some();
            let fallback = |value: &Value| value.get("fallback").is_some_and(|value| value == true);
            let placeholder = buffer.extensions.as_ref().is_some_and(|own| own.others.values().any(fallback));
            if placeholder || !is_blob {
                return Err(compressed(&place, name));
            }
        }
        let bytes = self.buffer(view.buffer.value(), buffer.uri.as_deref())?;
        let start = view.byte_offset.unwrap_or_default().0;
        let bytes = range(start, view.byte_length.0)
            .and_then(|range| bytes.get(range))
            .ok_or_else(|| past(&place, start, view.byte_length.0, bytes.len()))?;
        Ok((bytes, view.byte_stride.map(|stride| stride.0).filter(|&stride| stride > 0)))
    }

    /// All of a buffer.
    fn buffer(&self, index: usize, from: Option<&str>) -> Result<&[u8], Problem> {
        let place = format!("buffers[{index}]");
        let Some(from) = from else {
            return match (index, self.blob) {
                (0, Some(blob)) => Ok(blob),
                _ => Err(problem(
                    place,
                    "it has no uri, and the file holds no bytes for it (a BIN part)",
                    "export the mesh again",
                )),
            };
        };
        let cell = &self.contents[index];
        if let Some(bytes) = cell.get() {
            return Ok(bytes);
        }
        let bytes = uri::read(from, &self.folder, self.files).map_err(|reason| {
            let reason = format!("its buffer {}: {reason}", uri::shown(from));
            problem(place, reason, "keep the buffers beside the mesh, in the scene's folder")
        })?;
        let grown = GROWTH.saturating_mul(bytes.len() as u64);
        self.allowance.set(self.allowance.get().saturating_add(grown));
        Ok(cell.get_or_init(|| bytes))
    }

    /// Accounts for memory before it is allocated.
    ///
    /// # Errors
    /// If the file makes more of itself than its size allows.
    pub(super) fn spend(&self, bytes: u64, place: impl Display) -> Result<(), Problem> {
        let left = self.allowance.get().checked_sub(bytes).ok_or_else(|| {
            let reason = "the mesh becomes too large here, for what its buffers hold";
            problem(place, reason, "repeat meshes less often, or give the parts files of their own")
        })?;
        self.allowance.set(left);
        Ok(())
    }
}

fn range(start: u64, length: u64) -> Option<std::ops::Range<usize>> {
    let end = usize::try_from(start.checked_add(length)?).ok()?;
    Some(usize::try_from(start).ok()?..end)
}

fn past(place: &str, start: u64, length: u64, available: usize) -> Problem {
    let reason =
        format!("{length} bytes from byte {start} on are past the end of its buffer, which has {available}");
    problem(place, reason, "copy or export the files of the mesh again")
}
