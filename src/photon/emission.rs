//! Where photons start.
//!
//! Each light gets photons by its share of the power, so that all photons carry about the same. Their
//! starting points (for point lights: directions) are stratified: one in each cell of equal area, at random
//! inside it. A light that is far from everything else sends its photons towards that alone, each with its
//! part of the light that goes there.

use std::f64::consts::PI;

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

use super::TraceSettings;
use super::aim::Aim;
use super::direction::{Cone, cosine_around};
use super::random::{Purpose, Stream};
use crate::error::{Error, Result};
use crate::scene::{AreaLight, Light, LightSample, LightShape, Scene, cap_height};

/// By how much a photon starts before its light, as a share of the coordinates: twice what f32 loses.
const START_MARGIN: f64 = 2.5e-7;

/// A photon as it leaves its light.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct EmittedPhoton {
    /// On the light, in scene units; of a far light, on the way from there, before it comes to the rest of
    /// the scene.
    pub origin: Vec3,
    /// Of length 1.
    pub direction: Vec3,
    /// Linear RGB; all photons together carry the power of all lights, of a far one what goes towards the
    /// rest of the scene.
    pub power: Vec3,
    /// Its number, which decides its further way together with the seed.
    pub id: u32,
}

/// A photon and what it meets first, as rasterised from its light (thesis 2.6.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit {
    /// As it leaves the light.
    pub photon: EmittedPhoton,
    /// The first triangle (its index), or sphere (the number of triangles plus its index).
    ///
    /// The place is computed again from it, exactly; where the ray does not meet it, the ray is cast.
    pub primitive: u32,
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
    /// What a far light's photons are aimed at.
    aim: Option<Aim>,
}

impl<'a> Emission<'a> {
    /// Shares `settings.photons` among the lights of the scene by the power that they send; each gets at
    /// least one, however weak it is.
    ///
    /// # Errors
    /// [`Error::NoLight`]; [`Error::Setting`] for settings that are not possible, if there are fewer photons
    /// than lights, or if the power of a photon does not fit f32.
    pub fn new(scene: &'a Scene, settings: &TraceSettings) -> Result<Self> {
        settings.validate()?;
        let refuse = |reason: String| {
            Err(Error::Setting { name: "photons", value: settings.photons.to_string(), reason })
        };
        let shining: Vec<_> = scene.lights().iter().filter(|light| light.flux() != DVec3::ZERO).collect();
        if shining.is_empty() {
            return Err(Error::NoLight);
        }
        let aims: Vec<_> = shining.iter().map(|light| Aim::of(scene, light)).collect();
        let weights: Vec<f64> =
            shining.iter().zip(&aims).map(|(light, aim)| sent(light, aim.as_ref()).element_sum()).collect();
        let Some(counts) = counts(&weights, settings.photons) else {
            let lights = shining.len();
            return refuse(format!("each of the {lights} lights takes at least one; give {lights} or more"));
        };
        let (mut parts, mut first) = (Vec::new(), 0);
        for ((light, aim), count) in shining.iter().zip(aims).zip(counts) {
            if !(light.flux() / f64::from(count)).as_vec3().is_finite() {
                return refuse(format!("the light \"{}\" is brighter than f32 can hold", light.name));
            }
            parts.push(Part { shape: &light.shape, first, count, aim });
            first += count;
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
    pub(crate) fn light(&self, id: u32) -> usize {
        self.parts.partition_point(|part| part.first <= id) - 1
    }

    /// Whether the photons of one of the lights that shine start where they come near the scene, and not on
    /// the light.
    pub(crate) fn is_aimed(&self, light: usize) -> bool {
        self.parts[light].aim.is_some()
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
        let uv = stratum(id - part.first, part.count, &mut random);
        let leaving = match part.shape {
            LightShape::Area(light) => leave_area(light, part.aim.as_ref(), uv, &mut random),
            LightShape::Point { position, direction, half_angle, intensity } => {
                let cone = Cone::new(direction.as_dvec3(), cap_height(*half_angle));
                leave_point(position.as_dvec3(), &cone, intensity.as_dvec3(), part.aim.as_ref(), uv)
            }
        };
        let origin = match &part.aim {
            Some(aim) => aim.near(leaving.origin, leaving.direction),
            None => leaving.origin,
        };
        let power = (leaving.power / f64::from(part.count)).as_vec3();
        EmittedPhoton { origin: origin.as_vec3(), direction: leaving.direction.as_vec3(), power, id }
    }
}

/// The power that a light's photons carry, linear RGB: all of it, or of a far one what goes towards the rest
/// of the scene, by some samples.
fn sent(light: &Light, aim: Option<&Aim>) -> DVec3 {
    const SIDE: u32 = 8;
    let Some(aim) = aim else { return light.flux() };
    let middle = |step: u32| (f64::from(step) + 0.5) / f64::from(SIDE);
    let cells = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| [middle(row), middle(column)]));
    let sum: DVec3 = match &light.shape {
        LightShape::Area(area) => cells
            .map(|uv| {
                let LightSample { position, normal, intensity } = area.sample(uv);
                let cone = aim.cone(position);
                cone.solid_angle() * normal.dot(cone.axis).max(0.0) * intensity
            })
            .sum(),
        LightShape::Point { position, direction, half_angle, intensity } => {
            let cone = Cone::new(direction.as_dvec3(), cap_height(*half_angle));
            let (position, intensity) = (position.as_dvec3(), intensity.as_dvec3());
            cells.map(|uv| leave_point(position, &cone, intensity, Some(aim), uv).power).sum()
        }
    };
    sum / f64::from(SIDE * SIDE)
}

/// How many photons each light gets: by its weight, and at least one; nothing if there are too few.
fn counts(weights: &[f64], photons: u32) -> Option<Vec<u32>> {
    if weights.len() as u64 > u64::from(photons) {
        return None;
    }
    let total: f64 = weights.iter().sum();
    let (mut sum, mut first) = (0.0, 0);
    let by_weight = weights.iter().enumerate().map(|(index, weight)| {
        sum += weight;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to the u32")]
        let end = (sum / total * f64::from(photons)).round() as u32;
        let end = if index + 1 == weights.len() { photons } else { end };
        let count = end.saturating_sub(first);
        first += count;
        count
    });
    let mut counts: Vec<u32> = by_weight.collect();
    let mut missing = 0;
    for count in counts.iter_mut().filter(|count| **count == 0) {
        *count = 1;
        missing += 1;
    }
    // The strong ones give what the weak ones lack.
    let mut order: Vec<usize> = (0..counts.len()).collect();
    order.sort_by_key(|&index| std::cmp::Reverse(counts[index]));
    for index in order {
        let given = missing.min(counts[index] - 1);
        counts[index] -= given;
        missing -= given;
    }
    Some(counts)
}

/// A photon on its light.
struct Leaving {
    origin: DVec3,
    direction: DVec3,
    /// Times the number of the light's photons.
    power: DVec3,
}

fn leave_point(position: DVec3, cone: &Cone, intensity: DVec3, aim: Option<&Aim>, uv: [f64; 2]) -> Leaving {
    let aimed = aim.map(|aim| aim.cone(position)).filter(|aimed| aimed.height < cone.height);
    let chosen = aimed.as_ref().unwrap_or(cone);
    let direction = chosen.direction(uv);
    let power =
        if cone.holds(direction) || aimed.is_none() { chosen.solid_angle() * intensity } else { DVec3::ZERO };
    Leaving { origin: position, direction, power }
}

/// From a place on the light, by Lambert's law or towards what the light is aimed at.
fn leave_area(light: &AreaLight, aim: Option<&Aim>, uv: [f64; 2], random: &mut Stream) -> Leaving {
    let LightSample { position, normal, intensity } = light.sample(uv);
    let start = position + START_MARGIN * position.abs().max_element() * normal;
    match aim {
        None => Leaving { origin: start, direction: cosine_around(normal, random), power: PI * intensity },
        Some(aim) => {
            let cone = aim.cone(position);
            let direction = cone.direction([random.number(), random.number()]);
            let cos = normal.dot(direction).max(0.0);
            Leaving { origin: start, direction, power: cone.solid_angle() * cos * intensity }
        }
    }
}

/// A point of the unit square in cell `index` of `count` cells of the same area, which lie in about √`count`
/// rows.
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
