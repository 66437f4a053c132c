//! What light from tables does not do again, and where it does nothing.

#![expect(unsafe_code, reason = "OpenGL's commands are counted")]

use glam::{UVec2, Vec3};
use varikernel::light::TablesStage;
use varikernel::photon::PhotonPoint;
use varikernel::render::draw_surfaces;
use varikernel::scene::Scene;
use varikernel::settings::{Estimate, IrradianceSettings};
use varikernel::{DensityStage, Gl, IrradiancePipeline, PhotonPoints};

use super::{SIZE, apart, photons, surfaces};
use crate::calls::{Calls, counted};
use crate::driver;
use crate::support::egl;

const NAME: &str = "cornell-boxes";

#[test]
fn where_nothing_changed_nothing_is_drawn() {
    let mut calls = Calls::new();
    // SAFETY: a trampoline calls the command that it stands for.
    let gl: Gl = unsafe { driver::open_through(counted) };
    let surfaces = surfaces(&gl, NAME);
    let settings = IrradianceSettings { estimate: Estimate::Tables, ..IrradianceSettings::default() };
    let mut pipeline = IrradiancePipeline::new(&gl, SIZE, settings).unwrap();
    let mut points = PhotonPoints::new(&gl);
    points.upload(&photons(NAME, 2000)).unwrap();
    let light = pipeline.render(&surfaces, &points).unwrap().read().unwrap();
    let draws = |pipeline: &mut IrradiancePipeline, calls: &mut Calls| {
        calls.restart();
        let again = pipeline.spread(&surfaces, &points).unwrap().read().unwrap();
        (calls.of("glDrawArrays"), again)
    };
    assert!(draws(&mut pipeline, &mut calls) == (0, light.clone()));
    // Nor when no photon comes.
    let none = PhotonPoints::new(&gl);
    pipeline.count(&surfaces, &none).unwrap();
    assert!(draws(&mut pipeline, &mut calls) == (0, light.clone()));

    let (kept, again) = {
        pipeline.clear_light().unwrap();
        draws(&mut pipeline, &mut calls)
    };
    assert!(kept > 0, "{:?}", calls.all());
    assert!(again == light);
    let (anew, again) = {
        pipeline.forget_camera();
        draws(&mut pipeline, &mut calls)
    };
    assert!(anew > kept && again == light, "{anew} {kept}");
    let (added, twice) = {
        pipeline.count(&surfaces, &points).unwrap();
        draws(&mut pipeline, &mut calls)
    };
    assert!(added == kept && twice != light);
}

#[test]
fn tiles_out_of_reach_of_photons_are_dark_as_their_definition_is() {
    let gl = egl();
    let scene = Scene::shipped("cornell-empty").unwrap();
    let size = UVec2::new(330, 200);
    let surfaces = draw_surfaces(&gl, &scene, scene.view(size)).unwrap();
    let (position, normal) = (surfaces.read_position().unwrap(), surfaces.read_normal().unwrap());
    // A few photons where the pixels look that are in the middle of the picture's left side.
    let at = |x: u32, y: u32| PhotonPoint {
        position: Vec3::from_slice(&position.at(x, y)[..3]),
        normal: Vec3::from_slice(&normal.at(x, y)[..3]),
        power: Vec3::new(0.5, 0.25, 1.0),
        surface: normal.at(x, y)[3],
    };
    let lit: Vec<_> = (0..400).map(|index| at(90 + index % 7, 90 + index % 11)).collect();
    let mut points = PhotonPoints::new(&gl);
    points.upload(&lit).unwrap();
    let mut density = DensityStage::with_flux(&gl, size).unwrap();
    density.add(&surfaces, &points).unwrap();
    let mut stage = TablesStage::new(&gl, size).unwrap();
    let found = stage.gather(&surfaces, density.flux().unwrap()).unwrap().read().unwrap();
    let [light, radius] = apart(&surfaces, &density, &found);
    assert!(light < 2e-3 && radius < 2e-3, "{light} {radius}");
    let dark = found.values().iter().filter(|pixel| pixel.iter().all(|value| *value <= 0.0)).count();
    assert!(dark > 100 * 200, "{dark}");
    // What was lit before is dark when photons are elsewhere.
    density.clear().unwrap();
    let elsewhere: Vec<_> = (0..400).map(|index| at(240 + index % 7, 90 + index % 11)).collect();
    points.upload(&elsewhere).unwrap();
    density.add(&surfaces, &points).unwrap();
    let found = stage.gather(&surfaces, density.flux().unwrap()).unwrap().read().unwrap();
    let [light, radius] = apart(&surfaces, &density, &found);
    assert!(light < 2e-3 && radius < 2e-3, "{light} {radius}");
}
