//! From a landing to what a picture needs of it.

use super::Photon;
use crate::photon_point::PhotonPoint;

impl PhotonPoint {
    /// What the GPU needs of a photon.
    #[must_use]
    pub fn new(photon: &Photon) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "fewer than 2^24 surfaces")]
        let surface = (photon.surface + 1) as f32;
        Self { position: photon.position, normal: photon.normal, power: photon.power, surface }
    }
}
