//! The tree of boxes against every shape, one after the other.

use glam::DVec3;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use varikernel::scene::{Ray, Scene};

/// The nearest primitive by trying all.
fn by_trying_all(scene: &Scene, ray: &Ray) -> Option<(u32, f64)> {
    let geometry = scene.geometry();
    let primitives = u32::try_from(geometry.triangles.len() + geometry.spheres.len()).unwrap();
    let hits =
        (0..primitives).filter_map(|primitive| Some((primitive, scene.cast_at(ray, primitive)?.distance)));
    hits.min_by(|a, b| a.1.total_cmp(&b.1))
}

#[test]
fn nothing_is_missed_from_near_or_far() {
    let mut random = Pcg64::seed_from_u64(3);
    let mut point =
        |radius: f64| DVec3::from_array(std::array::from_fn(|_| random.random_range(-radius..radius)));
    for (name, rays) in [("cornell-glass", 20_000), ("mirror-ring", 3000), ("water", 300)] {
        let scene = Scene::shipped(name).unwrap();
        let (min, max) = scene.bounds();
        let (centre, size) = ((min + max).as_dvec3() / 2.0, (max - min).as_dvec3());
        let mut met = 0;
        for number in 0..rays {
            let away = [0.6, 3.0, 1e5][number % 3];
            let origin = centre + size * point(away);
            let to = centre + size * point(0.5);
            let ray = Ray { origin, direction: (to - origin).normalize() };
            let expected = by_trying_all(&scene, &ray);
            let found = scene.cast(&ray);
            match (expected, found) {
                (None, None) => {}
                // Where two meet at an edge, either will do.
                (Some((primitive, distance)), Some(hit)) => {
                    met += 1;
                    let close = (hit.distance - distance).abs() < 1e-9 * distance.max(1.0);
                    assert!(hit.primitive == primitive || close, "{name}: {ray:?}: {hit:?}, not {primitive}");
                    assert!(close, "{name}: {ray:?}: {hit:?}, not at {distance}");
                }
                _ => panic!("{name}: {ray:?}: {found:?}, not {expected:?}"),
            }
        }
        assert!(met > rays / 3, "{name}: {met} of {rays} meet anything");
    }
}

#[test]
fn rays_along_the_axes_meet_walls_at_grazing_distance() {
    let scene = Scene::shipped("cornell-empty").unwrap();
    for height in [1e-9, 1e-6, 1e-3, 1.0, 548.0] {
        let ray = Ray { origin: DVec3::new(100.0, height, 100.0), direction: DVec3::Z };
        let hit = scene.cast(&ray).unwrap();
        assert_eq!(scene.geometry().surfaces[hit.surface as usize], "back", "{height}");
        assert!((hit.distance - (f64::from(559.2_f32) - 100.0)).abs() < 1e-9);
    }
}

/// A stray sphere, and a ground that is much larger than the rest, have boxes of their own; nothing is missed
/// from anywhere.
#[test]
fn nothing_is_missed_beside_what_is_far_or_large() {
    let far = "\n[surfaces.stray]\nmaterial = \"white\"\n\
               spheres = [{ centre = [-5e8, 2e8, 1e8], radius = 3 }]\n\
               [surfaces.ground]\nmaterial = \"white\"\n\
               quads = [[[-1e7, -1, 1e7], [1e7, -1, 1e7], [1e7, -1, -1e7], [-1e7, -1, -1e7]]]\n";
    let scene = crate::load(&(crate::shipped_text("cornell_boxes.toml") + far)).unwrap();
    let mut random = Pcg64::seed_from_u64(4);
    let mut point =
        |radius: f64| DVec3::from_array(std::array::from_fn(|_| random.random_range(-radius..radius)));
    let stray = DVec3::new(-5e8, 2e8, 1e8);
    let mut met = 0;
    for number in 0..20_000 {
        let room = DVec3::splat(278.0);
        let (origin, to) = match number % 4 {
            0 => (room + point(200.0), room + point(300.0)),
            1 => (room + point(200.0), stray + point(2.0)),
            2 => (stray + point(10.0), room + point(250.0)),
            _ => (room + point(1e5), room + point(300.0)),
        };
        let ray = Ray { origin, direction: (to - origin).normalize() };
        let (expected, found) = (by_trying_all(&scene, &ray), scene.cast(&ray));
        let apart = match (expected, found) {
            (None, None) => 0.0,
            (Some((_, distance)), Some(hit)) => {
                met += 1;
                (hit.distance - distance).abs() / distance
            }
            _ => f64::INFINITY,
        };
        assert!(apart < 1e-9, "{ray:?}: {found:?}, not {expected:?}");
    }
    assert!(met > 15_000, "{met}");
}

/// Copies of a triangle, as some exporters stack them, and triangles whose boxes lie one in the other.
#[test]
fn many_triangles_at_one_place_take_neither_long_nor_the_stack() {
    use std::fmt::Write as _;
    let mut same = "v 0 0 0\nv 1 0 0\nv 1 1 0\n".to_owned();
    same.push_str(&"f 1 2 3\n".repeat(60_000));
    let mut nested = "v 0 0 0\n".to_owned();
    for step in 1..3000 {
        writeln!(nested, "v {step} {} 0", step * step).unwrap();
    }
    for step in 1..2999 {
        writeln!(nested, "f 1 {} {}", step + 1, step + 2).unwrap();
    }
    for mesh in [same, nested] {
        let text =
            format!("{}[surfaces.mesh]\nmaterial = \"white\"\nmesh = {{ file = \"a.obj\" }}\n", crate::BARE);
        let scene = crate::load_with(&text, &[("a.obj", mesh.as_bytes())]).unwrap();
        let ray = Ray { origin: DVec3::new(0.9, 0.4, -5.0), direction: DVec3::Z };
        let expected = by_trying_all(&scene, &ray);
        assert_eq!(scene.cast(&ray).map(|hit| hit.distance), expected.map(|(_, distance)| distance));
    }
}
