//! Direct light by quadrature, shadows by a loop over all triangles and spheres.

use glam::{DVec2, DVec3, Vec3};

use crate::scene::{AreaLight, LightShape, Ray, Scene};

/// What lies on the light itself is not between: the last millionth of the way does not count.
const BEFORE_LIGHT: f64 = 1e-6;

/// Irradiance at `position`, on the side to which `normal` points, from all lights of a scene: each triangle
/// of a light is cut into `steps`² equal ones, whose middles stand for them. Linear RGB.
#[must_use]
pub fn direct(scene: &Scene, position: DVec3, normal: DVec3, steps: u32) -> DVec3 {
    let start = scene.start(position, normal);
    let is_seen = |place: DVec3| {
        let away = place - start;
        let ray = Ray { origin: start, direction: away.normalize() };
        let geometry = scene.geometry();
        let primitives = (0_u32..).take(geometry.triangles.len() + geometry.spheres.len());
        let mut met = primitives.filter_map(|primitive| scene.cast_at(&ray, primitive));
        !met.any(|hit| hit.distance < away.length() * (1.0 - BEFORE_LIGHT))
    };
    let mut total = DVec3::ZERO;
    for light in scene.lights() {
        match &light.shape {
            LightShape::Point { position: place, direction, half_angle, intensity } => {
                let away = place.as_dvec3() - position;
                let cosine = away.normalize().dot(normal);
                let is_in_cone = (-away).angle_between(direction.as_dvec3()) <= f64::from(*half_angle);
                if cosine > 0.0 && is_in_cone && is_seen(place.as_dvec3()) {
                    total += intensity.as_dvec3() * cosine / away.length_squared();
                }
            }
            LightShape::Area(light) => {
                for part in parts(light, steps) {
                    let away = part.middle - position;
                    let cosines =
                        away.normalize().dot(normal).max(0.0) * (-away.normalize().dot(part.normal)).max(0.0);
                    if cosines > 0.0 && is_seen(part.middle) {
                        total += part.radiance * (cosines * part.area / away.length_squared());
                    }
                }
            }
        }
    }
    total
}

/// A part of a triangle that shines.
struct Part {
    middle: DVec3,
    normal: DVec3,
    area: f64,
    radiance: DVec3,
}

fn parts(light: &AreaLight, steps: u32) -> impl Iterator<Item = Part> {
    // Shares of the second and third corner: of small triangles that stand as the large one does, and of
    // those between them.
    let third = |whole: u32, thirds: f64| (f64::from(whole) + thirds / 3.0) / f64::from(steps);
    let upright = (0..steps).flat_map(move |i| (0..steps - i).map(move |j| [third(i, 1.0), third(j, 1.0)]));
    let turned =
        (1..steps).flat_map(move |i| (0..steps - i).map(move |j| [third(i - 1, 2.0), third(j, 2.0)]));
    let shares: Vec<_> = upright.chain(turned).map(DVec2::from_array).collect();
    light.triangles().iter().enumerate().flat_map(move |(index, corners)| {
        let [corner, second, third] = corners.map(Vec3::as_dvec3);
        let across = (second - corner).cross(third - corner);
        let area = across.length() / 2.0 / f64::from(steps * steps);
        let part = |&shares: &DVec2| Part {
            middle: corner + shares.x * (second - corner) + shares.y * (third - corner),
            normal: across.normalize(),
            area,
            radiance: light.radiance_at(index, shares),
        };
        shares.iter().map(part).collect::<Vec<_>>()
    })
}
