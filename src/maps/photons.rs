//! Photons on their way to the picture, and the radii of their kernels.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::RadiusMap;
use crate::error::Result;
use crate::gl::{Gl, StateGuard, Vertices};
use crate::photon::Photon;
use crate::view::View;

/// Photons in a buffer: as many as the table of their areas has entries.
pub(crate) const CHUNK: usize = 1 << 20;

/// What of a photon goes to the GPU.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PhotonPoint {
    /// In scene units.
    pub position: Vec3,
    /// Of the surface, on the side from which the photon came.
    pub normal: Vec3,
    /// Linear RGB.
    pub power: Vec3,
    /// Number of the surface: its index plus 1.
    pub surface: f32,
}

impl PhotonPoint {
    /// What the GPU needs of a photon.
    #[must_use]
    pub fn new(photon: &Photon) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "fewer than 2^24 surfaces")]
        let surface = (photon.surface + 1) as f32;
        Self { position: photon.position, normal: photon.normal, power: photon.power, surface }
    }

    /// Whether the picture can show it: inside of the frame, on the side of its surface that faces the camera.
    ///
    /// Others are never uploaded.
    #[must_use]
    pub fn may_be_seen(&self, view: &View) -> bool {
        self.normal.dot(view.position() - self.position) > 0.0 && view.pixel_of(self.position).is_some()
    }
}

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
    /// [`Error::Gl`](crate::Error::Gl) when memory runs out.
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
