//! Irradiance from a triangle that is seen whole, in closed form.

use glam::{DVec3, Vec3};

/// Irradiance at `position`, on the side to which `normal` points, from the front of a triangle of radiance
/// 1, if nothing is between: from 0 to π.
///
/// The boundary integral of J. H. Lambert ("Photometria", 1760; P. Heckbert and J. Winget, "Finite element
/// methods for global illumination", 1991, with its clipping at the horizon): for each edge, the angle that
/// it spans times the cosine of `normal` with the normal of the plane through the edge and the place. Off by
/// about 1e-16 of the distance over the triangle's size.
#[must_use]
pub fn irradiance_of_triangle(triangle: &[Vec3; 3], position: DVec3, normal: DVec3) -> f64 {
    let corners = triangle.map(|corner| corner.as_dvec3() - position);
    let [a, b, c] = corners;
    if (b - a).cross(c - a).dot(a) >= 0.0 {
        return 0.0;
    }
    let heights = corners.map(|corner| corner.dot(normal));
    // What is left above the horizon: up to four corners.
    let (mut above, mut count) = ([DVec3::ZERO; 4], 0);
    for index in 0..3 {
        let next = (index + 1) % 3;
        if heights[index] >= 0.0 {
            above[count] = corners[index];
            count += 1;
        }
        if (heights[index] >= 0.0) != (heights[next] >= 0.0) {
            let share = heights[index] / (heights[index] - heights[next]);
            above[count] = corners[index] + share * (corners[next] - corners[index]);
            count += 1;
        }
    }
    let above = &above[..count];
    let edges = above.iter().zip(above.iter().cycle().skip(1));
    let sum: f64 = edges.map(|(&from, &to)| of_edge(from, to, normal)).sum();
    (-sum / 2.0).max(0.0)
}

/// The angle of an edge times the cosine of its plane's normal. Nothing if the place lies in line with it:
/// then the place is in the light's plane, or the edge is a point.
fn of_edge(from: DVec3, to: DVec3, normal: DVec3) -> f64 {
    // The same as with `to` itself, where less is lost if the edge is far away.
    let across = from.cross(to - from);
    let sine = across.length();
    if sine == 0.0 { 0.0 } else { sine.atan2(from.dot(to)) / sine * across.dot(normal) }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "what is dark is 0")]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Two triangles of a rectangle at y = `height` above the origin, shining down.
    fn rectangle(x: [f32; 2], height: f32, z: [f32; 2]) -> [[Vec3; 3]; 2] {
        let corner = |i: usize, j: usize| Vec3::new(x[i], height, z[j]);
        let (first, last) = (corner(0, 0), corner(1, 1));
        [[first, corner(1, 0), last], [first, last, corner(0, 1)]]
    }

    fn irradiance(triangles: &[[Vec3; 3]], position: DVec3, normal: DVec3) -> f64 {
        triangles.iter().map(|triangle| irradiance_of_triangle(triangle, position, normal)).sum()
    }

    /// The form factor of a rectangle a by b whose corner is above the place, at height 1 (J. Howell, "A
    /// catalog of radiation heat transfer configuration factors", C-2), times π.
    fn of_corner(a: f64, b: f64) -> f64 {
        let part = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
        0.5 * (part(a, b) + part(b, a))
    }

    #[test]
    fn a_rectangle_above_its_corner_is_that_of_the_catalogue() {
        for (a, b) in [(1.0_f32, 1.0_f32), (3.0, 0.25), (0.001, 0.002), (1000.0, 2000.0)] {
            let found = irradiance(&rectangle([0.0, a], 1.0, [0.0, b]), DVec3::ZERO, DVec3::Y);
            let known = of_corner(a.into(), b.into());
            assert!((found / known - 1.0).abs() < 1e-9, "{a} x {b}: {found} {known}");
        }
    }

    #[test]
    fn a_plane_without_end_fills_the_half_space_and_half_of_it_half() {
        let wide = 1e7;
        let all = irradiance(&rectangle([-wide, wide], 1.0, [-wide, wide]), DVec3::ZERO, DVec3::Y);
        assert!((all - PI).abs() < 1e-5, "{all}");
        let half = irradiance(&rectangle([0.0, wide], 1.0, [-wide, wide]), DVec3::ZERO, DVec3::Y);
        assert!((half - PI / 2.0).abs() < 1e-5, "{half}");
    }

    #[test]
    fn the_part_below_the_horizon_does_not_count() {
        // Facing along x, only the part of the light with x above 0 is seen.
        let whole = irradiance(&rectangle([-2.0, 1.0], 1.0, [-1.0, 1.0]), DVec3::ZERO, DVec3::X);
        let part = irradiance(&rectangle([0.0, 1.0], 1.0, [-1.0, 1.0]), DVec3::ZERO, DVec3::X);
        assert!((whole - part).abs() < 1e-12 && part > 0.0, "{whole} {part}");
        assert_eq!(irradiance(&rectangle([-2.0, -1.0], 1.0, [-1.0, 1.0]), DVec3::ZERO, DVec3::X), 0.0);
        assert_eq!(irradiance(&rectangle([-1.0, 1.0], 1.0, [-1.0, 1.0]), DVec3::ZERO, DVec3::NEG_Y), 0.0);
    }

    #[test]
    fn the_back_does_not_shine_nor_does_the_light_in_its_own_plane() {
        let light = rectangle([-1.0, 1.0], 1.0, [-1.0, 1.0]);
        assert_eq!(irradiance(&light, DVec3::new(0.0, 2.0, 0.0), DVec3::NEG_Y), 0.0);
        assert_eq!(irradiance(&light, DVec3::new(0.5, 1.0, 0.2), DVec3::Y), 0.0);
        assert_eq!(irradiance(&light, DVec3::new(5.0, 1.0, 0.0), DVec3::X), 0.0);
    }

    #[test]
    fn far_away_it_is_that_of_a_point() {
        let light = rectangle([-0.5, 0.5], 1e4, [-0.5, 0.5]);
        let found = irradiance(&light, DVec3::ZERO, DVec3::Y);
        assert!((found * 1e8 - 1.0).abs() < 1e-7, "{found}");
    }
}
