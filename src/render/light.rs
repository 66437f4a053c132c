//! What a picture needs before any photon: what its pixels show, and direct light there.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use super::direct::{self, Dice};
use super::sight::{Place, Sight};
use super::{Progress, add};
use crate::error::Result;
use crate::gbuffer::SurfaceStage;
use crate::gl::Gl;
use crate::image::Image;
use crate::maps::SurfaceMaps;
use crate::scene::Scene;
use crate::settings::PictureSettings;
use crate::shade::TracedLight;
use crate::view::View;

/// All that needs no photons.
#[derive(Debug)]
pub(super) struct Light {
    pub(super) surfaces: SurfaceMaps,
    pub(super) traced: TracedLight,
    pub(super) bent: Vec<Place>,
}

impl Light {
    pub(super) fn new(
        gl: &Gl,
        scene: &Scene,
        settings: &PictureSettings,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Self> {
        let view = View::new(scene, settings.size);
        let surfaces = SurfaceStage::new(gl)?.draw(scene, view)?;
        progress(Progress { stage: "direct light", done: 0.0 });
        let sight = Sight::new(scene, &view);
        let light = direct_light(scene, &view, &sight, settings, progress);
        Ok(Self { surfaces, traced: light, bent: sight.bent })
    }
}

/// Direct light at every place that is seen, in rows so that the progress can be told.
fn direct_light(
    scene: &Scene,
    view: &View,
    sight: &Sight,
    settings: &PictureSettings,
    progress: &mut dyn FnMut(Progress),
) -> TracedLight {
    let mut direct = Image::filled(view.size(), [0.0; 4]);
    for &(pixel, radiance) in &sight.lights {
        add(&mut direct, pixel, radiance.as_dvec3());
    }
    let places = sight.straight.len() + sight.bent.len();
    let mut done = 0;
    for (list, seed) in [(&sight.straight, settings.seed), (&sight.bent, settings.seed.wrapping_add(1 << 32))]
    {
        for (number, part) in (0..).zip(list.chunks(1 << 14)) {
            let found: Vec<DVec3> = part
                .par_iter()
                .enumerate()
                .map(|(index, place)| {
                    let index = u32::try_from(index).expect("a part is small");
                    let mut dice = Dice::new(seed, (number << 14) + index);
                    let samples = settings.light_samples;
                    let arrives = direct::irradiance(scene, place.position, place.normal, samples, &mut dice);
                    place.share.as_dvec3() * arrives / PI
                })
                .collect();
            for (place, radiance) in part.iter().zip(found) {
                add(&mut direct, place.pixel, radiance);
            }
            done += part.len();
            #[expect(clippy::cast_precision_loss, reason = "a share")]
            progress(Progress { stage: "direct light", done: done as f64 / places as f64 });
        }
    }
    for place in &sight.straight {
        let (x, y) = (place.pixel % view.size().x, place.pixel / view.size().x);
        let [red, green, blue, _] = direct.at(x, y);
        direct.set(x, y, [red, green, blue, 1.0]);
    }
    TracedLight { direct, seen_through: Image::filled(view.size(), [0.0; 4]) }
}
