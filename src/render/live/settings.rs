//! What is asked of a picture in the making.

use glam::UVec2;

use crate::error::{Error, Result};
use crate::photon::{Emission, TraceSettings};
use crate::scene::Scene;
use crate::settings::{Estimate, IrradianceSettings};
use crate::view::{Camera, View};

/// What a [`Live`](super::Live) picture depends on beside its scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiveSettings {
    /// Columns and rows.
    pub size: UVec2,
    /// Where the picture is taken from.
    pub camera: Camera,
    /// How photons become irradiance.
    pub irradiance: IrradianceSettings,
    /// Diffuse landings after which a photon is followed no further, at least 1; without a number, it is
    /// followed to its end, as [`TraceSettings::bounces`] says.
    pub bounces: Option<u32>,
    /// Photons that leave the lights in a step, at least as many as there are lights.
    pub photons_per_step: u32,
    /// Places at which direct light is sampled in a step, each with one ray to each light; 0 for none after
    /// the first step.
    pub shadow_rays_per_step: u32,
    /// Landings of the latest steps that are kept, 40 bytes each, and counted again where the camera, the size or
    /// the way to light change; 0 to start anew. Nothing is kept for splats, which would all be drawn again.
    pub landings_kept: u32,
    /// The same seed and the same steps give the same picture.
    pub seed: u64,
}

impl LiveSettings {
    /// 512 x 512 pixels as the scene's camera sees it, radii as in [`IrradianceSettings::default`] with the
    /// plane of limited pixels, 20,000 photons and 65,536 shadow rays a step, 524,288 landings kept.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let mut irradiance = IrradianceSettings::default();
        irradiance.radii.limited_mask = true;
        Self {
            size: UVec2::splat(512),
            camera: scene.camera,
            irradiance,
            bounces: TraceSettings::default().bounces,
            photons_per_step: 20_000,
            shadow_rays_per_step: 65_536,
            landings_kept: 1 << 19,
            seed: 1,
        }
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`Error::Setting`] with the field's name.
    pub fn validate(&self, scene: &Scene) -> Result<()> {
        self.irradiance.validate()?;
        if self.size.min_element() == 0 {
            return Err(Error::Setting {
                name: "size",
                value: format!("{} x {}", self.size.x, self.size.y),
                reason: "a picture has at least one pixel".to_owned(),
            });
        }
        Emission::new(scene, &self.trace(0)).map(drop)
    }

    /// Whether landings are kept for other views.
    pub(super) fn keeps_landings(&self) -> bool {
        self.landings_kept > 0 && self.irradiance.estimate != Estimate::Splat
    }

    /// The photons of a step, counted from 0.
    pub(super) fn trace(&self, step: u32) -> TraceSettings {
        TraceSettings {
            photons: self.photons_per_step,
            bounces: self.bounces,
            // Seeds of steps lie far apart, so that another picture's do not meet them.
            seed: self.seed.wrapping_add(u64::from(step) << 32),
            russian_roulette: false,
        }
    }

    pub(super) fn view(&self, scene: &Scene) -> View {
        let (min, max) = scene.bounds();
        View::new(&self.camera, self.camera.depth_range(min, max), self.size)
    }
}
