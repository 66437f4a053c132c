//! Rays against single shapes, worked by hand.

use glam::{DVec2, DVec3, Vec3};
use varikernel::scene::{Camera, Ray, Sphere, TriangleEdges, area, intersect_sphere};

fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
    Ray { origin: DVec3::from(origin), direction: DVec3::from(direction).normalize() }
}

/// Corners (0, 0, 0), (4, 0, 0) and (0, 2, 0).
const TRIANGLE: TriangleEdges =
    TriangleEdges { corner: DVec3::ZERO, edge1: DVec3::new(4.0, 0.0, 0.0), edge2: DVec3::new(0.0, 2.0, 0.0) };

#[test]
fn a_triangle_is_met_from_both_sides() {
    let expected = Some((3.0, DVec2::new(0.25, 0.25)));
    assert_eq!(TRIANGLE.intersect(&ray([1.0, 0.5, 3.0], [0.0, 0.0, -1.0])), expected);
    assert_eq!(TRIANGLE.intersect(&ray([1.0, 0.5, -3.0], [0.0, 0.0, 1.0])), expected);
    let (distance, shares) = TRIANGLE.intersect(&ray([1.0, 0.5, 3.0], [1.0, 0.0, -3.0])).unwrap();
    assert!((distance - 10.0_f64.sqrt()).abs() < 1e-12);
    assert!(shares.abs_diff_eq(DVec2::new(0.5, 0.25), 1e-12));
}

#[test]
fn a_triangle_is_missed_beside_behind_and_in_its_plane() {
    for (origin, direction) in [
        ([3.0, 1.0, 3.0], [0.0, 0.0, -1.0]),
        ([-0.1, 0.5, 3.0], [0.0, 0.0, -1.0]),
        ([1.0, -0.1, 3.0], [0.0, 0.0, -1.0]),
        ([1.0, 0.5, 3.0], [0.0, 0.0, 1.0]),
        ([-1.0, 0.5, 0.0], [1.0, 0.0, 0.0]),
        ([1.0, 0.5, 0.0], [0.0, 0.0, 1.0]),
    ] {
        assert_eq!(TRIANGLE.intersect(&ray(origin, direction)), None, "{origin:?} {direction:?}");
    }
}

#[test]
fn a_sphere_is_met_at_its_first_place_ahead() {
    let met = |origin, direction| intersect_sphere(&ray(origin, direction), DVec3::new(0.0, 0.0, 5.0), 2.0);
    assert_eq!(met([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]), Some(3.0), "from outside");
    assert_eq!(met([0.0, 0.0, 4.0], [0.0, 0.0, 1.0]), Some(3.0), "from inside");
    assert_eq!(met([0.0, 0.0, 8.0], [0.0, 0.0, 1.0]), None, "behind");
    assert_eq!(met([0.0, 2.1, 0.0], [0.0, 0.0, 1.0]), None, "beside");
    // 5² = 4² + 3²: a sphere of radius 5, met 3 beside its middle.
    let beside = intersect_sphere(&ray([0.0, 3.0, -10.0], [0.0, 0.0, 1.0]), DVec3::ZERO, 5.0);
    assert_eq!(beside, Some(6.0));
    // From far away the place is still right to a billionth of the radius.
    let far = intersect_sphere(&ray([0.0, 0.0, -1e6], [0.0, 0.0, 1.0]), DVec3::ZERO, 1.0).unwrap();
    assert!((far - (1e6 - 1.0)).abs() < 1e-9);
}

#[test]
fn a_sphere_of_triangles_faces_outward_and_has_its_area() {
    let sphere = Sphere { centre: Vec3::new(1.0, 2.0, 3.0), radius: 2.0, surface: 0, material: 0 };
    let (vertices, triangles) = sphere.tessellate(40);
    let mut total = 0.0;
    for triangle in &triangles {
        let corners = triangle.map(|index| vertices[index as usize].position);
        let [a, b, c] = corners;
        let outward = (b - a).cross(c - a).dot(a + b + c - 3.0 * sphere.centre);
        assert!(outward > 0.0, "{triangle:?} faces inward, or has no area");
        total += area(&corners);
    }
    let exact = 16.0 * std::f64::consts::PI;
    assert!((0.995..1.0).contains(&(total / exact)), "{total} of {exact}");
    for vertex in &vertices {
        assert!((vertex.position.distance(sphere.centre) - 2.0).abs() < 1e-5);
        assert!(vertex.normal.abs_diff_eq((vertex.position - sphere.centre) / 2.0, 1e-5));
    }
}

#[test]
fn the_camera_maps_its_view_to_the_picture() {
    let camera = Camera {
        position: Vec3::new(0.0, 0.0, -10.0),
        direction: Vec3::Z,
        up: Vec3::Y,
        vertical_fov_degrees: 90.0,
    };
    let (near, far) = camera.depth_range(Vec3::new(-1.0, -1.0, -5.0), Vec3::new(1.0, 1.0, 10.0));
    assert!((4.9..5.0).contains(&near) && (20.0..20.1).contains(&far), "{near} to {far}");
    let to_picture = camera.projection(2.0, near, far) * camera.view();
    // At depth 10 the upper edge is 10 above, the left edge 20 to the side; looking along z, x runs to the
    // left.
    for (world, picture) in
        [([0.0, 0.0, 0.0], [0.0, 0.0]), ([0.0, 10.0, 0.0], [0.0, 1.0]), ([20.0, 0.0, 0.0], [-1.0, 0.0])]
    {
        let at = to_picture.project_point3(Vec3::from(world));
        assert!(at.abs_diff_eq(Vec3::new(picture[0], picture[1], at.z), 1e-5), "{world:?}: {at}");
        assert!((-1.0..=1.0).contains(&at.z));
    }
}
