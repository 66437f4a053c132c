//! Photons of no power, of powers far apart, all in one place; scenes that show nothing that is lit.

use glam::Vec3;
use varikernel::light::TablesStage;
use varikernel::maps::{FluxUnits, PhotonTotals};
use varikernel::photon::PhotonPoint;
use varikernel::render::draw_surfaces;
use varikernel::{DensityStage, Error, Gl, Image, PhotonPoints, SurfaceMaps};

use super::{SIZE, apart, counted, on_pixels, surfaces};
use crate::stage::before_the_camera;
use crate::support::egl;

fn gathered(gl: &Gl, surfaces: &SurfaceMaps, photons: &[PhotonPoint]) -> (DensityStage, Image<[f32; 4]>) {
    let density = counted(gl, surfaces, &[photons]);
    let mut stage = TablesStage::new(gl, SIZE).unwrap();
    let found = stage.gather(surfaces, density.flux().unwrap()).unwrap().read().unwrap();
    assert!(found.values().iter().flatten().all(|value| value.is_finite()));
    (density, found)
}

fn photons(surfaces: &SurfaceMaps, count: u32) -> Vec<PhotonPoint> {
    on_pixels(surfaces, FluxUnits { power: 1.0, square_root: 1.0 }, count).0
}

#[test]
fn powers_that_span_twelve_decades_give_the_light_of_the_strong_ones() {
    let gl = egl();
    let surfaces = surfaces(&gl, "cornell-boxes");
    let mut photons = photons(&surfaces, 4000);
    for (index, photon) in photons.iter_mut().enumerate() {
        photon.power = Vec3::splat(if index % 2 == 0 { 1e6 } else { 1e-6 });
    }
    let (density, found) = gathered(&gl, &surfaces, &photons);
    let [light, radius] = apart(&surfaces, &density, &found);
    assert!(light < 2e-3 && radius < 2e-3, "{light} {radius}");
    let strong: Vec<_> = photons.iter().copied().filter(|photon| photon.power.x > 1.0).collect();
    let (_, alone) = gathered(&gl, &surfaces, &strong);
    let sum = |light: &Image<[f32; 4]>| light.values().iter().map(|pixel| f64::from(pixel[0])).sum::<f64>();
    // Widths may differ a little, since a photon of the usual power is fainter now.
    assert!((sum(&found) / sum(&alone) - 1.0).abs() < 0.02, "{} for {}", sum(&found), sum(&alone));
}

#[test]
fn photons_of_no_power_and_none_at_all_are_dark() {
    let gl = egl();
    let surfaces = surfaces(&gl, "cornell-boxes");
    let mut photons = photons(&surfaces, 100);
    for photon in &mut photons {
        photon.power = Vec3::ZERO;
    }
    for photons in [&photons[..], &[]] {
        let (_, found) = gathered(&gl, &surfaces, photons);
        assert!(found.values().iter().all(|pixel| pixel.iter().all(|value| *value <= 0.0)));
    }
}

#[test]
fn a_scene_of_glass_alone_is_dark() {
    let gl = egl();
    let scene = before_the_camera(
        r#"
        [surfaces.ball]
        material = "glass"
        spheres = [{ centre = [0, 0, -3], radius = 1 }]
        "#,
    );
    let surfaces = draw_surfaces(&gl, &scene, scene.view(SIZE)).unwrap();
    let lost =
        PhotonPoint { position: Vec3::new(0.0, 0.0, -2.0), normal: Vec3::Z, power: Vec3::ONE, surface: 1.0 };
    let (_, found) = gathered(&gl, &surfaces, &[lost; 9]);
    assert!(found.values().iter().all(|pixel| pixel.iter().all(|value| *value <= 0.0)));
}

#[test]
fn more_power_than_numbers_hold_is_refused_before_anything_is_counted() {
    let gl = egl();
    let surfaces = surfaces(&gl, "cornell-boxes");
    let photons = photons(&surfaces, 3);
    let mut points = PhotonPoints::new(&gl);
    points.upload(&photons).unwrap();
    points.set_totals(PhotonTotals { power: [f64::INFINITY; 3], ..PhotonTotals::of(&photons) });
    let mut density = DensityStage::with_flux(&gl, SIZE).unwrap();
    let refused = density.add(&surfaces, &points).unwrap_err();
    assert!(matches!(refused, Error::Mismatch { .. }), "{refused}");
    assert_eq!(density.drawn(), 0);
}
