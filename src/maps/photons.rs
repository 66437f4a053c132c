//! Photons on their way to the picture, and the radii of their kernels.

use super::RadiusMap;
use crate::error::Result;
use crate::gl::{Gl, StateGuard, Vertices};
use crate::photon::PhotonPoint;

/// Photons in a buffer: as many as the table of their areas has entries, and few enough that sums of one buffer's kernels
/// stay exact to about 2^-9 (see `splat`).
pub(crate) const CHUNK: usize = 1 << 16;

/// Photons on the GPU.
#[derive(Debug)]
pub struct PhotonPoints {
    gl: Gl,
    chunks: Vec<Vertices>,
}

impl PhotonPoints {
    /// None yet.
    #[must_use]
    pub fn new(gl: &Gl) -> Self {
        Self { gl: gl.clone(), chunks: Vec::new() }
    }

    /// Adds photons; best many at once.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`](crate::Error::OutOfMemory).
    pub fn upload(&mut self, photons: &[PhotonPoint]) -> Result<()> {
        let _state = StateGuard::new(&self.gl);
        for chunk in photons.chunks(CHUNK) {
            self.chunks.push(Vertices::upload(&self.gl, chunk, &[3, 3, 3, 1])?);
        }
        Ok(())
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.chunks.iter().map(|chunk| u64::from(chunk.count())).sum()
    }

    pub(crate) fn chunks(&self) -> &[Vertices] {
        &self.chunks
    }
}

/// Where the radii of kernels come from.
#[derive(Clone, Copy, Debug)]
pub enum ChosenRadius<'a> {
    /// Each pixel's own.
    Map(&'a RadiusMap),
    /// The same for all, in pixels.
    Fixed(u32),
}
