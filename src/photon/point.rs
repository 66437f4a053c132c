//! A photon as a picture needs it: the vertex of every stage that draws photons.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

#[cfg(feature = "scene")]
use super::Photon;
use crate::view::View;

/// A photon's landing (a hit or deposit) as a vertex: 40 bytes, ten f32 without gaps.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PhotonPoint {
    /// In scene units.
    pub position: Vec3,
    /// Of the surface, of length 1, on the side from which the photon came.
    pub normal: Vec3,
    /// Linear RGB: the photon's share of the power of all lights, so that all photons together carry it.
    pub power: Vec3,
    /// Number of the surface, as [`SurfaceMaps`](crate::SurfaceMaps) show it: of a scene's surfaces the index
    /// plus 1; 1 for all where a host does not number its surfaces.
    pub surface: f32,
}

impl PhotonPoint {
    /// What the GPU needs of a photon.
    #[cfg(feature = "scene")]
    #[must_use]
    pub fn new(photon: &Photon) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "fewer than 2^24 surfaces")]
        let surface = (photon.surface + 1) as f32;
        Self { position: photon.position, normal: photon.normal, power: photon.power, surface }
    }

    /// Components of the attributes: position, normal, power, surface.
    pub(crate) const ATTRIBUTES: [u8; 4] = [3, 3, 3, 1];

    /// Whether the picture can show it: inside of the frame, on the side of its surface that faces the
    /// camera.
    ///
    /// Others need not be uploaded.
    #[must_use]
    pub fn may_be_seen(&self, view: &View) -> bool {
        self.normal.dot(view.position() - self.position) > 0.0 && view.pixel_of(self.position).is_some()
    }
}
