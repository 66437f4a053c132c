//! OpenEXR: channels of f16, f32 or u32 in, channels of f32 and u32 with attributes out.

mod packed;
mod read;
mod write;

use exr::error::Error as ExrError;
use exr::meta::magic_number;

use super::counts::Problem;

#[cfg(feature = "scene")]
pub(super) use read::read_channels;
pub(super) use read::{read, read_mask};
pub(super) use write::write;
#[cfg(feature = "scene")]
pub(super) use write::{Samples, write_channels};

/// The first bytes of every EXR file.
pub(super) const SIGNATURE: &[u8] = &magic_number::BYTES;

fn problem(error: ExrError) -> Problem {
    match error {
        ExrError::NotSupported(what) => Problem::new(
            format!("an EXR file of a kind that can't be read here: {what}"),
            "save it as flat scan lines with ZIP compression",
        ),
        ExrError::Invalid(what) => Problem::damaged(format!("truncated or damaged: {what}")),
        ExrError::Io(error) => Problem::damaged(format!("could not be read: {error}")),
        ExrError::Aborted => unreachable!("nothing here stops a reader early"),
    }
}
