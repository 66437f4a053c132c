//! What a picture needs before any photon: what its pixels show, and direct light there.

use super::antialias::{EdgeSamples, Middles};
use super::direct::DirectRays;
use super::sight::{Place, Sight};
use super::{Progress, add, rgb};
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
    pub(super) edges: EdgeSamples,
}

impl Prepared {
    /// Whether photons are gathered around places: those in mirrors and behind glass, and at edges those that no
    /// pixel's middle shows.
    pub(super) fn gathers(&self) -> bool {
        !self.bent.is_empty() || !self.edges.places().is_empty()
    }

    pub(super) fn new(
        gl: &Gl,
        scene: &Scene,
        settings: &PictureSettings,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Self> {
        let view = scene.view(settings.size);
        let mut surfaces = SurfaceStage::new(gl)?.draw(scene, view)?;
        progress(Progress { stage: "direct light", done: 0.0 });
        let sight = Sight::new(scene, &view, settings.antialias > 1);
        sight.paint(&mut surfaces)?;
        #[expect(clippy::cast_precision_loss, reason = "a share")]
        let straight = sight.straight.len() as f64 / (sight.straight.len() + sight.bent.len()).max(1) as f64;
        // Straight places come first, then bent ones.
        let mut show = |done: f64| progress(Progress { stage: "direct light", done: straight * done });
        let mut direct = Image::filled(settings.size, [0.0; 4]);
        let rays = DirectRays { scene, samples: settings.light_samples, seed: settings.seed };
        let found = match settings.direct {
            DirectLight::Traced => rays.reflected(settings.size, &sight.straight, &mut show),
            DirectLight::ShadowMap => {
                let maps = &mut ShadowMaps::new(gl, scene, settings.size)?;
                maps.reflected(scene, &surfaces, &sight.straight, settings, &mut show)?
            }
        };
        // Places in mirrors and behind glass have seeds of their own.
        let rays = DirectRays { seed: settings.seed.wrapping_add(1 << 32), ..rays };
        let through = rays.reflected(settings.size, &sight.bent, &mut |done| {
            progress(Progress { stage: "direct light", done: straight + (1.0 - straight) * done });
        });
        for (place, radiance) in sight.straight.iter().zip(found).chain(sight.bent.iter().zip(through)) {
            add(&mut direct, place.pixel, radiance);
        }
        for place in &sight.straight {
            let (x, y) = (place.pixel % settings.size.x, place.pixel / settings.size.x);
            let [red, green, blue, _] = direct.at(x, y);
            direct.set(x, y, [red, green, blue, 1.0]);
        }
        let mut emitted = Image::filled(settings.size, [0.0; 4]);
        for &(pixel, radiance) in &sight.lights {
            add(&mut emitted, pixel, radiance.as_dvec3());
        }
        let middles = Middles { emitted: emitted.map(rgb), reflected: direct.map(rgb) };
        let direct = Image::from_fn(settings.size, |x, y| {
            let ([red, green, blue, shows], light) = (direct.at(x, y), middles.emitted.at(x, y));
            [red + light[0], green + light[1], blue + light[2], shows]
        });
        progress(Progress { stage: "edges", done: 0.0 });
        let rays = DirectRays { seed: settings.seed.wrapping_add(1 << 33), ..rays };
        let edges = EdgeSamples::new(&rays, &view, &sight, &direct, middles, settings);
        let seen_through = Image::filled(settings.size, [0.0; 4]);
        Ok(Self { surfaces, traced: TracedLight { direct, seen_through }, bent: sight.bent, edges })
    }
}
