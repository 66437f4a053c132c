//! Indirect light in mirrors and through glass that gets better: photons are put in order anew each time their
//! number has doubled, and gathered then and where the camera has moved.

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
    /// Whether photons are taken in for other views, though this one sees no mirror and no glass.
    keeps: bool,
    photons: Photons,
    /// Whether the light is that of the photons in order.
    gathered: bool,
    image: Image<[f32; 4]>,
}

/// Photons in the scene, whatever the view.
#[derive(Debug, Default)]
struct Photons {
    all: Vec<PhotonPoint>,
    /// Photons that left the lights for them.
    emitted: u64,
    /// Some of them in order: how many landings, and of how many photons that left the lights.
    landed: Option<(Landed, usize, u64)>,
}

impl ProgressiveThrough {
    pub(super) fn new(view: View, bent: Vec<Place>, keeps: bool) -> Self {
        let image = Image::filled(view.size(), [0.0; 4]);
        Self { view, bent, keeps, photons: Photons::default(), gathered: false, image }
    }

    /// Forgets all photons.
    pub(super) fn clear(&mut self) {
        *self = Self::new(self.view, std::mem::take(&mut self.bent), self.keeps);
    }

    /// Goes on with those of another view.
    pub(super) fn take_photons(&mut self, other: &mut Self) {
        self.photons = std::mem::take(&mut other.photons);
        self.gathered = false;
    }

    /// Gathers the photons that are there again with the next ones: the way to light has changed.
    pub(super) fn gather_again(&mut self) {
        self.gathered = false;
    }

    /// Takes in the landings of so many photons that left the lights; their powers are in units of
    /// [`UNIT`](super::UNIT) photons.
    pub(super) fn step(&mut self, landings: Vec<PhotonPoint>, emitted: u32, settings: &IrradianceSettings) {
        if self.bent.is_empty() && !self.keeps {
            return;
        }
        let photons = &mut self.photons;
        if photons.all.len() < MOST {
            photons.all.extend(landings);
            photons.emitted += u64::from(emitted);
        }
        if self.bent.is_empty() || photons.all.is_empty() {
            return;
        }
        let wanted = Wanted::of(settings);
        let in_order = photons.landed.as_ref().map_or(0, |(_, landings, _)| *landings);
        if photons.all.len() >= 2 * in_order {
            let landed = Landed::new(&photons.all, wanted);
            photons.landed = Some((landed, photons.all.len(), photons.emitted));
            self.gathered = false;
        }
        let Some((landed, _, emitted)) = photons.landed.as_mut().filter(|_| !self.gathered) else { return };
        #[expect(clippy::cast_precision_loss, reason = "a factor for f32 light")]
        let scale = super::UNIT / *emitted as f32;
        let (_, light) = seen_through(&self.view, &self.bent, Some(landed), wanted, settings.kernel);
        self.image = light.map(|[red, green, blue, alpha]| [scale * red, scale * green, scale * blue, alpha]);
        self.gathered = true;
    }

    /// Radiance, linear RGB.
    pub(super) fn image(&self) -> &Image<[f32; 4]> {
        &self.image
    }
}
