//! What a picture needs before any photon: what its pixels show, and direct light there.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use super::direct::{self, Dice};
use super::sight::{Place, Sight};
use super::{Progress, add};
use crate::error::Result;
use crate::gl::Gl;
use crate::image::Image;
use crate::maps::SurfaceMaps;
use crate::render::shade::TracedLight;
use crate::render::shadow_map::ShadowMaps;
use crate::render::surfaces::SurfaceStage;
use crate::scene::Scene;
use crate::settings::{DirectLight, PictureSettings};

/// All that needs no photons.
#[derive(Debug)]
pub(super) struct Prepared {
    pub(super) surfaces: SurfaceMaps,
    pub(super) traced: TracedLight,
    pub(super) bent: Vec<Place>,
}

impl Prepared {
    pub(super) fn new(
        gl: &Gl,
        scene: &Scene,
        settings: &PictureSettings,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Self> {
        let view = scene.view(settings.size);
        let mut surfaces = SurfaceStage::new(gl)?.draw(scene, view)?;
        progress(Progress { stage: "direct light", done: 0.0 });
        let sight = Sight::new(scene, &view);
        sight.paint(&mut surfaces)?;
        #[expect(clippy::cast_precision_loss, reason = "a share")]
        let straight = sight.straight.len() as f64 / (sight.straight.len() + sight.bent.len()).max(1) as f64;
        // Straight places come first, then bent ones.
        let mut show = |done: f64| progress(Progress { stage: "direct light", done: straight * done });
        let mut direct = Image::filled(settings.size, [0.0; 4]);
        for &(pixel, radiance) in &sight.lights {
            add(&mut direct, pixel, radiance.as_dvec3());
        }
        match settings.direct {
            DirectLight::Traced => {
                trace(scene, &sight.straight, settings, settings.seed, &mut direct, &mut show);
            }
            DirectLight::ShadowMap => {
                map(gl, scene, &surfaces, &sight.straight, settings, &mut direct, &mut show)?;
            }
        }
        // Places in mirrors and behind glass have seeds of their own.
        let mut show = |done: f64| {
            progress(Progress { stage: "direct light", done: straight + (1.0 - straight) * done });
        };
        trace(scene, &sight.bent, settings, settings.seed.wrapping_add(1 << 32), &mut direct, &mut show);
        for place in &sight.straight {
            let (x, y) = (place.pixel % settings.size.x, place.pixel / settings.size.x);
            let [red, green, blue, _] = direct.at(x, y);
            direct.set(x, y, [red, green, blue, 1.0]);
        }
        let seen_through = Image::filled(settings.size, [0.0; 4]);
        Ok(Self { surfaces, traced: TracedLight { direct, seen_through }, bent: sight.bent })
    }
}

/// Adds the light at places by shadow rays, in parts so that the progress can be told.
fn trace(
    scene: &Scene,
    places: &[Place],
    settings: &PictureSettings,
    seed: u64,
    direct: &mut Image<[f32; 4]>,
    show: &mut dyn FnMut(f64),
) {
    let mut done = 0;
    for (number, part) in (0..).zip(places.chunks(1 << 14)) {
        let found: Vec<DVec3> = part
            .par_iter()
            .enumerate()
            .map(|(index, place)| {
                let index = u32::try_from(index).expect("a part is small");
                let mut dice = Dice::new(seed, (number << 14) + index);
                let samples = settings.light_samples;
                direct::reflected(scene, place, samples, &mut dice)
            })
            .collect();
        for (place, radiance) in part.iter().zip(found) {
            add(direct, place.pixel, radiance);
        }
        done += part.len();
        #[expect(clippy::cast_precision_loss, reason = "a share")]
        show(done as f64 / places.len() as f64);
    }
}

/// Adds the light at places that are seen straight by shadow maps.
fn map(
    gl: &Gl,
    scene: &Scene,
    surfaces: &SurfaceMaps,
    places: &[Place],
    settings: &PictureSettings,
    direct: &mut Image<[f32; 4]>,
    show: &mut dyn FnMut(f64),
) -> Result<()> {
    let mut dice = Dice::new(settings.seed, 0);
    let mut number = || dice.number();
    let lights = scene.lights().iter();
    let lights: Vec<_> = lights.flat_map(|light| light.places(settings.light_samples, &mut number)).collect();
    let irradiance = ShadowMaps::new(gl, scene, surfaces.size())?.irradiance(surfaces, &lights, show)?;
    for place in places {
        let (x, y) = (place.pixel % settings.size.x, place.pixel / settings.size.x);
        let [red, green, blue, _] = irradiance.at(x, y).map(f64::from);
        add(direct, place.pixel, place.share.as_dvec3() * DVec3::new(red, green, blue) / PI);
    }
    Ok(())
}
