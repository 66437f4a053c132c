//! Where light comes from.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, Vec2, Vec3};

use super::texture::PlacedTexture;
use super::triangle_light::irradiance_of_triangle;

/// A light with its name in the scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Its name; for a surface that shines, the surface's.
    pub name: String,
    /// Indices of the surface and the material that shine; none for a light without a body.
    pub of: Option<[u32; 2]>,
    /// Where the light leaves.
    pub shape: LightShape,
}

/// Where and how light leaves. Power is in watts when lengths are in metres; any unit will do, as only shares
/// matter.
#[derive(Clone, Debug, PartialEq)]
pub enum LightShape {
    /// Triangles that shine by Lambert's law on their front side, where the corners run counter-clockwise.
    Area(AreaLight),
    /// A point that shines evenly in a cone; all around with an angle of 180 degrees.
    Point {
        /// In scene units.
        position: Vec3,
        /// The cone's axis, of length 1.
        direction: Vec3,
        /// Between the cone's axis and its edge, in radians, more than 0 and up to π (all around).
        half_angle: f32,
        /// Power per solid angle, linear RGB.
        intensity: Vec3,
    },
}

/// Triangles that shine, with what it takes to choose places on them by their power: a search in as many
/// steps as the logarithm of their number.
#[derive(Clone, Debug, PartialEq)]
pub struct AreaLight {
    triangles: Vec<[Vec3; 3]>,
    radiance: Vec3,
    texture: Option<PlacedTexture>,
    /// By triangle, the chance that a place is on it or on one before.
    cumulative: Vec<f64>,
    /// In square scene units.
    area: f64,
    /// Power, linear RGB.
    flux: DVec3,
}

/// A place on a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// In scene units.
    pub position: DVec3,
    /// Of length 1, on the side that shines.
    pub normal: DVec3,
    /// Radiance there over the density of places there: power per solid angle along the normal of all of the
    /// light, if all of it were as here. Linear RGB.
    pub intensity: DVec3,
}

/// Samples along each side of a triangle that find its mean radiance: as many as it has texels there, within
/// these limits.
const MEAN_STEPS: [f64; 2] = [8.0, 256.0];
/// Samples of all triangles of a light, more or less.
const MEAN_SAMPLES: f64 = 4e6;
/// With more triangles than this it is cheaper to sample a light, by some 64 rays, than to add them all up.
const MOST_ADDED_UP: usize = 512;
/// Each triangle gets places, and the light power, as if its mean radiance were at least this share of that
/// of the whole image: a bright texel that no sample of the mean met is found all the same.
const LEAST_RADIANCE: f64 = 0.05;

impl AreaLight {
    /// Triangles that shine with `radiance` (power per area and solid angle, linear RGB), times a texture.
    ///
    /// # Panics
    /// Unless the texture has coordinates for each triangle, and there is a triangle.
    #[must_use]
    pub fn new(triangles: Vec<[Vec3; 3]>, radiance: Vec3, texture: Option<PlacedTexture>) -> Self {
        assert!(!triangles.is_empty(), "a light has a triangle");
        assert!(
            texture.as_ref().is_none_or(|texture| texture.coordinates.len() == triangles.len()),
            "a light's texture lies on each of its triangles"
        );
        let areas: Vec<f64> = triangles.iter().map(area).collect();
        let whole: f64 = areas.iter().sum();
        let least = texture.as_ref().map_or(DVec3::ZERO, |texture| LEAST_RADIANCE * texture.texture.mean());
        let means: Vec<DVec3> = match &texture {
            None => Vec::new(),
            Some(texture) => (0..triangles.len()).map(|index| texture.mean(index)).collect(),
        };
        let sum: DVec3 = means.iter().zip(&areas).map(|(&mean, &area)| mean * area).sum();
        let mean = if texture.is_none() {
            DVec3::ONE
        } else if sum == DVec3::ZERO {
            // A texture that no sample met is at least distinguished from a black one.
            least
        } else {
            sum / whole
        };
        let weight = |index: usize| {
            let Some(own) = means.get(index) else { return areas[index] };
            areas[index] * (*own + least).dot(radiance.as_dvec3()).max(f64::MIN_POSITIVE)
        };
        let weights: f64 = (0..areas.len()).map(weight).sum();
        let mut sum = 0.0;
        let cumulative = (0..areas.len()).map(|index| {
            sum += weight(index) / weights;
            sum
        });
        Self {
            cumulative: cumulative.collect(),
            area: whole,
            flux: PI * whole * radiance.as_dvec3() * mean,
            triangles,
            radiance,
            texture,
        }
    }

    /// The corners, in scene units.
    #[must_use]
    pub fn triangles(&self) -> &[[Vec3; 3]] {
        &self.triangles
    }

    /// Power per area and solid angle, linear RGB, before a texture.
    #[must_use]
    pub fn radiance(&self) -> Vec3 {
        self.radiance
    }

    /// Radiance at the shares of a triangle's second and third corner.
    #[must_use]
    pub fn radiance_at(&self, triangle: usize, shares: DVec2) -> DVec3 {
        let texel = self.texture.as_ref().map_or(DVec3::ONE, |texture| texture.at(triangle, shares));
        self.radiance.as_dvec3() * texel
    }

    /// Irradiance at `position`, on the side to which `normal` points, if nothing is between, the light itself
    /// neither: in closed form ([`irradiance_of_triangle`]), which a light with a texture or with many
    /// triangles has not.
    #[must_use]
    pub fn irradiance(&self, position: DVec3, normal: DVec3) -> Option<DVec3> {
        if self.texture.is_some() || self.triangles.len() > MOST_ADDED_UP {
            return None;
        }
        let of = |triangle| irradiance_of_triangle(triangle, position, normal);
        Some(self.radiance.as_dvec3() * self.triangles.iter().map(of).sum::<f64>())
    }

    /// The place for a point (u, v) of the unit square, by power among triangles and by area on each.
    #[must_use]
    pub fn sample(&self, [u, v]: [f64; 2]) -> LightSample {
        let index = self.cumulative.partition_point(|&sum| sum <= u).min(self.triangles.len() - 1);
        let before = if index == 0 { 0.0 } else { self.cumulative[index - 1] };
        let chance = self.cumulative[index] - before;
        let share = ((u - before) / chance).clamp(0.0, 1.0).sqrt();
        let [corner, second, third] = self.triangles[index].map(Vec3::as_dvec3);
        let position = corner + share * (second - corner + v * (third - second));
        let across = (second - corner).cross(third - corner);
        let intensity = match &self.texture {
            None => self.radiance.as_dvec3() * self.area,
            Some(texture) => {
                let texel = texture.at(index, DVec2::new(share * (1.0 - v), share * v));
                self.radiance.as_dvec3() * texel * (across.length() / 2.0 / chance)
            }
        };
        LightSample { position, normal: across.normalize(), intensity }
    }
}

impl PlacedTexture {
    /// Linear RGB on a triangle, at the shares of its second and third corner.
    pub(super) fn at(&self, triangle: usize, shares: DVec2) -> DVec3 {
        self.texture.between(self.coordinates[triangle], shares).as_dvec3()
    }

    /// Mean over a triangle.
    fn mean(&self, triangle: usize) -> DVec3 {
        let [corner, second, third] = self.coordinates[triangle].map(Vec2::as_dvec2);
        let size = self.texture.size().as_dvec2();
        let texels = ((second - corner) * size).length().max(((third - corner) * size).length());
        let [fewest, most] = MEAN_STEPS;
        #[expect(clippy::cast_precision_loss, reason = "fewer than 2^52 triangles")]
        let affordable = (MEAN_SAMPLES / self.coordinates.len() as f64).sqrt();
        let steps = texels.min(affordable).min(most).max(fewest).ceil();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 256")]
        let middles: Vec<f64> = (0..steps as u32).map(|step| (f64::from(step) + 0.5) / steps).collect();
        let mut sum = DVec3::ZERO;
        for &u in &middles {
            for &v in &middles {
                let share = u.sqrt();
                sum += self.at(triangle, DVec2::new(share * (1.0 - v), share * v));
            }
        }
        sum / (steps * steps)
    }
}

impl Light {
    /// All power that leaves the light, linear RGB: π · area · radiance, or solid angle · intensity. With a
    /// texture, as some samples of it say.
    #[must_use]
    pub fn flux(&self) -> DVec3 {
        match &self.shape {
            LightShape::Area(area) => area.flux,
            LightShape::Point { half_angle, intensity, .. } => {
                TAU * cap_height(*half_angle) * intensity.as_dvec3()
            }
        }
    }
}

/// 1 - cos of an angle in radians, without loss for small ones.
pub(crate) fn cap_height(half_angle: f32) -> f64 {
    2.0 * (f64::from(half_angle) / 2.0).sin().powi(2)
}

/// Area of a triangle, in square scene units.
#[must_use]
pub fn area(triangle: &[Vec3; 3]) -> f64 {
    let [a, b, c] = triangle.map(Vec3::as_dvec3);
    (b - a).cross(c - a).length() / 2.0
}
