//! Indirect light in mirrors and through glass that gets better: photons are gathered anew each time their
//! number has doubled.

use crate::image::Image;
use crate::photon::PhotonPoint;
use crate::render::landed::{Landed, Wanted};
use crate::render::seen_through::seen_through;
use crate::render::sight::Place;
use crate::settings::IrradianceSettings;
use crate::view::View;

/// Landings that are kept, 40 bytes each; with more, this light stays as it is.
const MOST: usize = 1 << 22;

/// The light at the places that are seen in mirrors and through glass.
#[derive(Debug)]
pub(super) struct ProgressiveThrough {
    view: View,
    bent: Vec<Place>,
    photons: Vec<PhotonPoint>,
    /// Landings when they were gathered last.
    gathered: usize,
    image: Image<[f32; 4]>,
}

impl ProgressiveThrough {
    pub(super) fn new(view: View, bent: Vec<Place>) -> Self {
        let image = Image::filled(view.size(), [0.0; 4]);
        Self { view, bent, photons: Vec::new(), gathered: 0, image }
    }

    /// Forgets all photons.
    pub(super) fn clear(&mut self) {
        self.photons.clear();
        self.gathered = 0;
        self.image = Image::filled(self.view.size(), [0.0; 4]);
    }

    /// Takes in photons, whose powers times `scale` are those of all photons so far.
    pub(super) fn step(&mut self, photons: Vec<PhotonPoint>, settings: &IrradianceSettings, scale: f32) {
        if self.bent.is_empty() || self.photons.len() >= MOST {
            return;
        }
        self.photons.extend(photons);
        if self.photons.len() < 2 * self.gathered || self.photons.is_empty() {
            return;
        }
        self.gathered = self.photons.len();
        let wanted = Wanted::of(settings);
        let mut landed = Landed::new(&self.photons, wanted);
        let (_, light) = seen_through(&self.view, &self.bent, Some(&mut landed), wanted, settings.kernel);
        self.image = light.map(|[red, green, blue, alpha]| [scale * red, scale * green, scale * blue, alpha]);
    }

    /// Radiance, linear RGB.
    pub(super) fn image(&self) -> &Image<[f32; 4]> {
        &self.image
    }
}
