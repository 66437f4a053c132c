//! Numbers at their ends: areas that are capped, light that is much darker than the mean.

use glam::{UVec2, Vec3};
use varikernel::light::TablesStage;
use varikernel::photon::PhotonPoint;
use varikernel::render::draw_surfaces;
use varikernel::{DensityStage, Gl, Image, PhotonPoints, SurfaceMaps};

use super::{apart, definition};
use crate::stage::before_the_camera;
use crate::support::egl;

const SIZE: UVec2 = UVec2::new(400, 300);
/// The wall is seen in the columns from here on.
const WALL_FROM: u32 = 250;

/// A plate at distance 1 over the left of the picture, before a wall at distance `far`.
fn plate_and_wall(gl: &Gl, far: f32) -> SurfaceMaps {
    let side = 4.0 * far;
    let scene = before_the_camera(&format!(
        r#"
        [surfaces.a_wall]
        material = "white"
        quads = [[[-{side}, -{side}, -{far}], [{side}, -{side}, -{far}], [{side}, {side}, -{far}],
            [-{side}, {side}, -{far}]]]
        [surfaces.plate]
        material = "white"
        quads = [[[-4, -4, -1], [0.33, -4, -1], [0.33, 4, -1], [-4, 4, -1]]]
        "#
    ));
    draw_surfaces(gl, &scene, scene.view(SIZE)).unwrap()
}

/// A photon where each pixel looks, with a power that its column gives.
fn on_every_pixel(surfaces: &SurfaceMaps, power: impl Fn(u32) -> Vec3) -> Vec<PhotonPoint> {
    let (position, normal) = (surfaces.read_position().unwrap(), surfaces.read_normal().unwrap());
    (0..SIZE.element_product())
        .map(|index| {
            let (x, y) = (index % SIZE.x, index / SIZE.x);
            PhotonPoint {
                position: Vec3::from_slice(&position.at(x, y)[..3]),
                normal: Vec3::from_slice(&normal.at(x, y)[..3]),
                power: power(x),
                surface: normal.at(x, y)[3],
            }
        })
        .collect()
}

fn lit(gl: &Gl, surfaces: &SurfaceMaps, photons: &[PhotonPoint]) -> (DensityStage, Image<[f32; 4]>) {
    let mut points = PhotonPoints::new(gl);
    points.upload(photons).unwrap();
    let mut density = DensityStage::with_flux(gl, SIZE).unwrap();
    density.add(surfaces, &points).unwrap();
    let mut stage = TablesStage::new(gl, SIZE).unwrap();
    let found = stage.gather(surfaces, density.flux().unwrap()).unwrap().read().unwrap();
    (density, found)
}

#[test]
fn the_widest_box_of_the_largest_areas_is_summed() {
    let gl = egl();
    // 1600 times the area: more than counts, over 150 x 300 pixels.
    let surfaces = plate_and_wall(&gl, 40.0);
    let photons = on_every_pixel(&surfaces, |x| Vec3::splat(if x < WALL_FROM { 1e-3 } else { 1.0 }));
    let (density, found) = lit(&gl, &surfaces, &photons);
    let (given, _) = definition(&surfaces, &density);
    assert_eq!(given.areas.at(325, 150), 258_095, "capped");
    assert!(found.at(325, 150)[3] > 63.0, "{:?}", found.at(325, 150));
    let [light, radius] = apart(&surfaces, &density, &found);
    assert!(light < 2e-3 && radius < 2e-3, "{light} {radius}");
}

#[test]
fn dark_light_has_the_right_colours() {
    let gl = egl();
    let surfaces = plate_and_wall(&gl, 1.5);
    let faint = Vec3::new(1.0, 0.1, 0.5);
    // Up to 1/300 of the other side's light it is smoothed in steps, below not at all; both in the mean of a
    // face that is even, which any of its pixels has.
    for share in [1e-1, 1e-2, 2e-3, 3e-4] {
        let photons =
            on_every_pixel(
                &surfaces,
                |x| if x < WALL_FROM { 1e-2 * share * faint } else { 1e-2 * Vec3::ONE },
            );
        let (density, found) = lit(&gl, &surfaces, &photons);
        let (given, unit) = definition(&surfaces, &density);
        let expected = given.gather();
        for (x, y) in [(30, 40), (100, 150), (200, 280)] {
            for (found, expected) in found.at(x, y).into_iter().zip(expected.at(x, y).light) {
                let off = f64::from(found) / (unit * expected) - 1.0;
                assert!(off.abs() < 0.02, "{share}, ({x}, {y}): {found} for {}", unit * expected);
            }
        }
    }
}
