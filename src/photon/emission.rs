//! Where photons start.
//!
//! Each light gets photons by its share of the power, so that all photons carry about the same. Their starting points
//! (for point lights: directions) are stratified: one in each cell of equal area, at random inside it.

use std::f64::consts::TAU;

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

use super::TraceSettings;
use super::random::{Purpose, Stream};
use crate::scene::{LightShape, Scene, area, cap_height};
use crate::{Error, Result};

/// By how much a photon starts before its light, as a share of the coordinates: twice what f32 loses.
const START_MARGIN: f64 = 2.5e-7;

/// A photon as it leaves its light.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct EmittedPhoton {
    /// On the light, in scene units.
    pub origin: Vec3,
    /// Of length 1.
    pub direction: Vec3,
    /// Linear RGB; all photons together carry the power of all lights.
    pub power: Vec3,
    /// Its number, which decides its further way together with the seed.
    pub id: u32,
}

/// What leaves the lights of a scene.
#[derive(Clone, Debug)]
pub struct Emission<'a> {
    parts: Vec<Part<'a>>,
    flux: DVec3,
    settings: TraceSettings,
}

/// The photons of one light.
#[derive(Clone, Debug)]
struct Part<'a> {
    shape: &'a LightShape,
    first: u32,
    count: u32,
    power: Vec3,
    /// For an area light, the areas of the triangles up to each, as shares of all.
    cumulative: Vec<f64>,
}

impl<'a> Emission<'a> {
    /// Shares `settings.photons` among the lights of the scene.
    ///
    /// # Errors
    /// [`Error::Setting`] for settings that are not possible, if no light shines, if there are too few photons for each
    /// light to get one, or if the power of a photon does not fit f32.
    pub fn new(scene: &'a Scene, settings: &TraceSettings) -> Result<Self> {
        settings.validate()?;
        let refuse = |reason: String| {
            Err(Error::Setting { name: "photons", value: settings.photons.to_string(), reason })
        };
        let shining: Vec<_> = scene.lights().iter().filter(|light| light.flux() != DVec3::ZERO).collect();
        let weights = shining.iter().map(|light| light.flux().element_sum());
        let total: f64 = weights.clone().sum();
        if shining.is_empty() {
            return refuse("the scene has no light that shines".to_owned());
        }
        let (mut parts, mut sum, mut first) = (Vec::new(), 0.0, 0);
        for (light, weight) in shining.iter().zip(weights) {
            sum += weight;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to the u32")]
            let end = (sum / total * f64::from(settings.photons)).round() as u32;
            let end = if parts.len() + 1 == shining.len() { settings.photons } else { end };
            let count = end.saturating_sub(first);
            let name = &light.name;
            if count == 0 {
                return refuse(format!(
                    "too few for the light \"{name}\", whose share of the power is small"
                ));
            }
            let power = (light.flux() / f64::from(count)).as_vec3();
            if !power.is_finite() {
                return refuse(format!("the light \"{name}\" is brighter than f32 can tell"));
            }
            parts.push(Part {
                shape: &light.shape,
                first,
                count,
                power,
                cumulative: cumulative(&light.shape),
            });
            first = end;
        }
        let flux = shining.iter().map(|light| light.flux()).sum();
        Ok(Self { parts, flux, settings: *settings })
    }

    /// The power of all lights, linear RGB.
    #[must_use]
    pub fn flux(&self) -> DVec3 {
        self.flux
    }

    /// What was asked for.
    #[must_use]
    pub fn settings(&self) -> &TraceSettings {
        &self.settings
    }

    /// Which of the lights that shine a photon leaves, counted from 0 in the order of the scene.
    #[cfg(feature = "render")]
    pub(crate) fn light(&self, id: u32) -> usize {
        self.parts.partition_point(|part| part.first <= id) - 1
    }

    /// The photon of a number from 0 to less than `settings().photons`.
    ///
    /// # Panics
    /// If the number is past that.
    #[must_use]
    pub fn photon(&self, id: u32) -> EmittedPhoton {
        assert!(id < self.settings.photons, "photon {id} of {}", self.settings.photons);
        let part = &self.parts[self.parts.partition_point(|part| part.first <= id) - 1];
        let mut random = Stream::new(self.settings.seed, id, Purpose::Emission);
        let [u, v] = stratum(id - part.first, part.count, &mut random);
        let (origin, direction) = match part.shape {
            LightShape::Area { triangles, .. } => {
                leave_area(triangles, &part.cumulative, [u, v], &mut random)
            }
            LightShape::Point { position, direction, half_angle, .. } => {
                let cos = 1.0 - u * cap_height(*half_angle);
                (*position, around(direction.as_dvec3(), cos, v).as_vec3())
            }
        };
        EmittedPhoton { origin, direction, power: part.power, id }
    }
}

/// A point of the unit square in cell `index` of `count` cells of the same area, which lie in about √`count` rows.
fn stratum(index: u32, count: u32, random: &mut Stream) -> [f64; 2] {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 65536")]
    let rows = f64::from(count).sqrt().round().max(1.0) as u64;
    let (index, count) = (u64::from(index), u64::from(count));
    let row = index * rows / count;
    // Rows differ by one cell where their number does not divide the count; their heights differ likewise.
    let [begin, end] = [row, row + 1].map(|row| (row * count).div_ceil(rows));
    #[expect(clippy::cast_precision_loss, reason = "all are below 2^32")]
    let [cell, begin, cells, count] = [index - begin, begin, end - begin, count].map(|number| number as f64);
    [(cell + random.number()) / cells, (begin + cells * random.number()) / count]
}

fn cumulative(shape: &LightShape) -> Vec<f64> {
    let LightShape::Area { triangles, .. } = shape else { return Vec::new() };
    let total: f64 = triangles.iter().map(area).sum();
    let mut sum = 0.0;
    let sums = triangles.iter().map(|triangle| {
        sum += area(triangle) / total;
        sum
    });
    sums.collect()
}

/// A point on the triangles for a point (u, v) of the unit square, and a direction from there by Lambert's law.
fn leave_area(
    triangles: &[[Vec3; 3]],
    cumulative: &[f64],
    [u, v]: [f64; 2],
    random: &mut Stream,
) -> (Vec3, Vec3) {
    let index = cumulative.partition_point(|&sum| sum <= u).min(triangles.len() - 1);
    let before = if index == 0 { 0.0 } else { cumulative[index - 1] };
    let share = ((u - before) / (cumulative[index] - before)).clamp(0.0, 1.0);
    let [corner, second, third] = triangles[index].map(Vec3::as_dvec3);
    let across = v * (third - second);
    let position = corner + share.sqrt() * (second - corner + across);
    let normal = (second - corner).cross(third - corner).normalize();
    let start = position + START_MARGIN * position.abs().max_element() * normal;
    (start.as_vec3(), cosine_around(normal, random).as_vec3())
}

/// A direction around `normal` by Lambert's law: as likely as the cosine of its angle to the normal.
pub(super) fn cosine_around(normal: DVec3, random: &mut Stream) -> DVec3 {
    around(normal, (1.0 - random.number()).sqrt(), random.number())
}

/// The direction at an angle of the given cosine from `axis`, `turn` of the way around it.
fn around(axis: DVec3, cos: f64, turn: f64) -> DVec3 {
    let (side, other) = axis.any_orthonormal_pair();
    let (sin_turn, cos_turn) = (TAU * turn).sin_cos();
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    sin * (cos_turn * side + sin_turn * other) + cos * axis
}
