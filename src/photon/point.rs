//! What a picture needs of a photon.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::Photon;
use crate::view::View;

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
