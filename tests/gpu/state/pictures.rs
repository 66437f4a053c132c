//! Every public call around pictures.

use std::sync::Arc;

use glam::UVec2;
use varikernel::photon::{Emission, TraceSettings};
use varikernel::render::{Live, LiveSettings, Renderer, first_hits};
use varikernel::scene::Scene;
use varikernel::settings::{DirectLight, Estimate, KernelRadius, PictureSettings};
use varikernel::{Gl, Image};

use super::Watch;
use super::host::fail_at_each;

fn beauty(gl: &Gl, settings: &PictureSettings, after: &dyn Fn(&str)) -> Image<[f32; 3]> {
    let scene = Scene::shipped("cornell-glass").unwrap();
    let photons = crate::stage::traced(&scene, 500, 1);
    let mut renderer = Renderer::with_photons(gl, &scene, settings, &photons).unwrap();
    after("Renderer::with_photons");
    let (layers, _) = renderer.picture(settings).unwrap();
    after("Renderer::picture");
    renderer.surfaces().read_albedo().unwrap();
    after("SurfaceMaps::read_albedo");
    layers.beauty
}

pub(super) fn all(watch: &Watch<'_>) {
    let usual = PictureSettings { size: UVec2::splat(20), light_samples: 1, ..PictureSettings::default() };
    // A picture under the host's state is that of an untouched context, and leaves that state alone.
    for settings in [
        usual,
        PictureSettings {
            estimate: Estimate::Gather { count_correction: false },
            radius: KernelRadius::Fixed(2),
            direct: DirectLight::ShadowMap,
            ..usual
        },
    ] {
        // A context is current on its own thread alone.
        let untouched = std::thread::spawn(move || beauty(&crate::support::egl(), &settings, &|_| ()));
        let untouched = untouched.join().unwrap();
        let found = beauty(&watch.gl, &settings, &|call| watch.unchanged(call));
        let error = crate::support::rmse(&found, &untouched);
        assert!(error < 1e-5, "{settings:?} under the host's state: {error:?}");
    }
    let scene = Scene::shipped("cornell-glass").unwrap();
    let trace = TraceSettings { photons: 300, ..Default::default() };
    let emission = Emission::new(&scene, &trace).unwrap();
    first_hits(&watch.gl, &scene, &emission).unwrap();
    watch.unchanged("first_hits");
    stages(watch, &scene, &usual);
    live(watch, &Arc::new(scene.clone()));

    let photons = crate::stage::traced(&scene, 100, 1);
    let small = PictureSettings { size: UVec2::splat(8), ..usual };
    let failures = fail_at_each(
        || {
            let mut renderer = Renderer::with_photons(&watch.gl, &scene, &small, &photons)?;
            renderer.picture(&small).map(drop)
        },
        |failure| watch.unchanged(&format!("a picture's failure {failure}")),
    );
    assert!(failures >= 12, "{failures}");
}

/// The stages of a picture apart.
fn stages(watch: &Watch<'_>, scene: &Scene, settings: &PictureSettings) {
    let photons = crate::stage::traced(scene, 300, 1);
    let mut renderer = Renderer::with_photons(&watch.gl, scene, settings, &photons).unwrap();
    renderer.warm_up(settings).unwrap();
    watch.unchanged("Renderer::warm_up");
    renderer.count().unwrap();
    watch.unchanged("Renderer::count");
    renderer.search().unwrap();
    watch.unchanged("Renderer::search");
    for radius in [KernelRadius::Variable, KernelRadius::Fixed(2)] {
        for estimate in [Estimate::Splat, Estimate::Gather { count_correction: false }, Estimate::Tables] {
            let settings = PictureSettings { radius, estimate, ..*settings };
            renderer.change(&settings).unwrap();
            watch.unchanged("Renderer::change");
            let irradiance = renderer.spread().unwrap().read().unwrap();
            watch.unchanged("Renderer::spread");
            renderer.account(&irradiance).unwrap();
            watch.unchanged("Renderer::account");
        }
    }
    renderer.surfaces().read_position().unwrap();
    renderer.surfaces().read_normal().unwrap();
    watch.unchanged("SurfaceMaps::read_normal");
}

/// A picture in the making.
fn live(watch: &Watch<'_>, scene: &Arc<Scene>) {
    let settings = LiveSettings { size: UVec2::splat(16), photons_per_step: 200, ..LiveSettings::new(scene) };
    let mut live = Live::new(&watch.gl, Arc::clone(scene), settings).unwrap();
    watch.unchanged("Live::new");
    live.step().unwrap();
    watch.unchanged("Live::step");
    live.inspect(UVec2::splat(3)).unwrap();
    watch.unchanged("Live::inspect");
    live.read().unwrap();
    watch.unchanged("Live::read");
    let mut moved = settings;
    moved.camera.position.x += 1.0;
    moved.irradiance.radius = KernelRadius::Fixed(2);
    live.change(moved).unwrap();
    live.step().unwrap();
    watch.unchanged("Live::change");
    moved.irradiance.radius = KernelRadius::Fixed(0);
    live.change(moved).unwrap_err();
    watch.unchanged("Live::change that fails");
}
