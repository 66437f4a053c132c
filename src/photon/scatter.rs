//! What mirrors and glass do with light.

use glam::DVec3;

use crate::scene::{Hit, Ray};

/// The mirror image of a direction at a surface.
#[must_use]
pub fn reflect(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - 2.0 * direction.dot(normal) * normal
}

/// The direction after a mirror that is met from the side whose sign is `side`, at the smooth normal where it
/// stays before the surface.
pub(crate) fn mirrored(ray: &Ray, hit: &Hit, side: f64) -> DVec3 {
    let smooth = reflect(ray.direction, side * hit.smooth_normal);
    if side * smooth.dot(hit.normal) > 0.0 { smooth } else { reflect(ray.direction, hit.normal) }
}

/// The direction behind a surface by Snell's law, and the share of light that is reflected instead by
/// Fresnel's equations for unpolarised light; nothing where all of it is.
///
/// `normal` points against `direction`, both of length 1; `ratio` is the index of refraction before the
/// surface over the one behind it.
#[must_use]
pub fn refract(direction: DVec3, normal: DVec3, ratio: f64) -> Option<(DVec3, f64)> {
    let cos_before = -direction.dot(normal);
    let sin_squared = ratio * ratio * (1.0 - cos_before * cos_before).max(0.0);
    if sin_squared >= 1.0 {
        return None;
    }
    let cos_behind = (1.0 - sin_squared).sqrt();
    let refracted = ratio * direction + (ratio * cos_before - cos_behind) * normal;
    let across = (ratio * cos_before - cos_behind) / (ratio * cos_before + cos_behind);
    let along = (cos_before - ratio * cos_behind) / (cos_before + ratio * cos_behind);
    Some((refracted.normalize(), f64::midpoint(across * across, along * along)))
}

/// The share of unpolarised light that a thin pane reflects, with all that goes to and fro between its faces:
/// 2 R / (1 + R) where one face reflects R.
///
/// `cos` is that of the angle between the light and the pane's normal; `index` is the pane's index of
/// refraction over that around it.
#[must_use]
pub fn reflected_by_pane(cos: f64, index: f32) -> f64 {
    let direction = DVec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, -cos);
    let one_face =
        refract(direction, DVec3::Z, 1.0 / f64::from(index)).map_or(1.0, |(_, reflected)| reflected);
    2.0 * one_face / (1.0 + one_face)
}
