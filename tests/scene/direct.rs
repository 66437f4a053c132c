//! Direct light by its definition, by hand, and by the closed form and rays of pictures.

use std::f64::consts::PI;

use varikernel::glam::{DVec3, Vec3};
use varikernel::reference;
use varikernel::scene::{LightShape, Scene, irradiance_of_triangle};

use crate::load;

/// A lamp of 2 by 2 and radiance 3 at height 2 that shines down on a floor, and something else.
fn lamp(other: &str) -> Scene {
    load(&format!(
        "
[camera]
position = [0, 1, 5]
direction = [0, 0, -1]
up = [0, 1, 0]
vertical_fov_degrees = 40
[materials]
grey = {{ lambert = [0.5, 0.5, 0.5] }}
glow = {{ lambert = [0, 0, 0], emission = [3, 1.5, 0] }}
[surfaces.floor]
material = \"grey\"
quads = [[[-5, 0, 5], [5, 0, 5], [5, 0, -5], [-5, 0, -5]]]
[surfaces.lamp]
material = \"glow\"
quads = [[[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]]]
{other}"
    ))
    .unwrap()
}

fn unblocked(scene: &Scene, position: DVec3, normal: DVec3) -> DVec3 {
    let LightShape::Area(light) = &scene.lights()[0].shape else { unreachable!("a surface that shines") };
    light.irradiance(position, normal).unwrap()
}

#[test]
fn under_the_middle_of_a_square_lamp_it_is_that_of_the_catalogue() {
    // Four squares of side 1 with a corner above, at height 2: a = b = 1/2.
    let part = 0.5 / 1.25_f64.sqrt() * (0.5 / 1.25_f64.sqrt()).atan();
    let known = 3.0 * 4.0 * part;
    let scene = lamp("");
    assert!((unblocked(&scene, DVec3::ZERO, DVec3::Y).x / known - 1.0).abs() < 1e-9);
    let found = reference::direct(&scene, DVec3::ZERO, DVec3::Y, 100);
    assert!((found.x / known - 1.0).abs() < 1e-4, "{found} {known}");
    assert_eq!((found.y / found.x, found.z), (0.5, 0.0));
}

#[test]
fn the_closed_form_is_the_definition_where_nothing_is_between() {
    let scene = lamp("");
    let places = [
        (DVec3::new(0.3, 0.0, 0.2), DVec3::Y),
        (DVec3::new(4.0, 0.5, -3.0), DVec3::Y),
        (DVec3::new(1.0, 1.9, 0.0), DVec3::new(-1.0, 1.0, 0.0).normalize()),
        // The horizon cuts the lamp.
        (DVec3::new(0.5, 1.0, 0.25), DVec3::X),
        (DVec3::new(-0.9, 0.5, 0.9), DVec3::new(-1.0, 0.1, 0.3).normalize()),
        (DVec3::new(0.0, 0.5, 0.0), DVec3::NEG_Y),
    ];
    for (position, normal) in places {
        let (closed, summed) =
            (unblocked(&scene, position, normal), reference::direct(&scene, position, normal, 400));
        assert!((closed - summed).length() <= 2e-3 * summed.length(), "{position}: {closed} {summed}");
    }
}

#[test]
fn half_a_lamp_is_covered_by_a_board_close_to_it() {
    // Everything with x below 0, as seen from a place below the middle.
    let board = "[surfaces.board]\nmaterial = \"grey\"\n\
                 quads = [[[-3, 1.9, -3], [0, 1.9, -3], [0, 1.9, 3], [-3, 1.9, 3]]]";
    let scene = lamp(board);
    let found = reference::direct(&scene, DVec3::ZERO, DVec3::Y, 100);
    let whole = reference::direct(&lamp(""), DVec3::ZERO, DVec3::Y, 100);
    assert!((found.x / whole.x - 0.5).abs() < 0.01, "{found} {whole}");
    // The board takes nothing away from what rays see beside it, all of it from what they see through it.
    let under = reference::direct(&scene, DVec3::new(-0.5, 1.0, 0.0), DVec3::NEG_X, 50);
    assert_eq!(under, DVec3::ZERO);
}

#[test]
fn a_place_in_a_corner_of_a_lit_box_sees_a_quarter_of_the_lamp_above() {
    // A lamp without end fills the half space; from the corner of a floor and two walls a quarter of it is
    // seen, each part as bright as its neighbour.
    let wide = 1e6;
    let [a, b, c, d] =
        [[-wide, -wide], [wide, -wide], [wide, wide], [-wide, wide]].map(|[x, z]| Vec3::new(x, 2.0, z));
    let sum = |cut: f32| -> f64 {
        let cut = |corner: Vec3| corner.max(Vec3::new(cut, 2.0, cut));
        let triangles = [[a, b, c], [a, c, d]].map(|corners| corners.map(cut));
        triangles.iter().map(|corners| irradiance_of_triangle(corners, DVec3::ZERO, DVec3::Y)).sum()
    };
    assert!((sum(-wide) - PI).abs() < 1e-4 && (sum(0.0) - PI / 4.0).abs() < 1e-4);
}

#[test]
fn a_ray_is_blocked_by_what_is_before_its_end_alone() {
    let scene = lamp("");
    let ray = varikernel::scene::Ray { origin: DVec3::new(0.5, 1.0, 0.5), direction: DVec3::Y };
    assert!(!scene.is_blocked(&ray, 0.999) && scene.is_blocked(&ray, 1.001));
    let beside = varikernel::scene::Ray { origin: DVec3::new(1.5, 1.0, 0.5), ..ray };
    assert!(!scene.is_blocked(&beside, f64::INFINITY));
}
