//! Photons as files: NPY, CSV and PLY.
//!
//! Written as the photons come, so that a file may be larger than the memory; the number of landings is known
//! at the end alone, and its place in the header is kept free until then.

use std::io::{Seek as _, SeekFrom, Write as _};
use std::path::Path;

use super::file_format::PhotonFormat;
use super::records::Records;
use super::{Emission, Tally, trace_in_batches};
use crate::error::Result;
use crate::image::write_atomically;
use crate::scene::Scene;

/// Traces all photons of `emission` and writes their landings, in the order of [`trace_in_batches`];
/// `progress` gets the number of photons followed so far.
///
/// # Errors
/// If the extension is unknown, or as [`write_atomically`].
pub fn write(
    path: &Path,
    scene: &Scene,
    emission: &Emission<'_>,
    mut progress: impl FnMut(u32),
) -> Result<Tally> {
    let format = PhotonFormat::of(path)?;
    let mut tally = Tally::default();
    write_atomically(path, |file| {
        let records = Records::new(format, scene);
        file.write_all(&records.header(0)?)?;
        let mut buffer = Vec::new();
        tally = trace_in_batches(scene, emission, |photons, followed| {
            progress(followed);
            buffer.clear();
            records.put(photons, &mut buffer)?;
            file.write_all(&buffer)
        })?;
        // As long as the first one.
        file.seek(SeekFrom::Start(0))?;
        file.write_all(&records.header(tally.total())?)
    })?;
    Ok(tally)
}
