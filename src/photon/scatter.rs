//! What mirrors and glass do with light.

use glam::DVec3;

/// The mirror image of a direction at a surface.
#[must_use]
pub fn reflect(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - 2.0 * direction.dot(normal) * normal
}

/// The direction behind a surface by Snell's law, and the share of light that is reflected instead by Fresnel's
/// equations for unpolarised light; nothing where all of it is.
///
/// `normal` points against `direction`, both of length 1; `ratio` is the index of refraction before the surface over the
/// one behind it.
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
