//! Places that stand for a light: what shadow rays and shadow maps start from.

use glam::DVec3;

use super::light::{Light, LightSample, LightShape};

/// A place that a light shines from, with its part of the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightPlace {
    /// In scene units.
    pub(crate) position: DVec3,
    /// The light's normal there, or the axis of its cone; of length 1.
    pub(crate) axis: DVec3,
    /// The cone's half angle in radians; none for a surface, which shines by the cosine to its normal.
    pub(crate) half_angle: Option<f32>,
    /// Power per solid angle along the axis.
    pub(crate) intensity: DVec3,
}

impl LightPlace {
    /// Irradiance at `position`, on the side to which `normal` points, if nothing is between.
    pub(crate) fn irradiance(&self, position: DVec3, normal: DVec3) -> DVec3 {
        let away = self.position - position;
        let squared = away.length_squared();
        let to_light = away / squared.sqrt();
        let cos = normal.dot(to_light);
        let shines = match self.half_angle {
            Some(angle) if (-to_light).angle_between(self.axis) <= f64::from(angle) => 1.0,
            Some(_) => 0.0,
            None => -self.axis.dot(to_light),
        };
        if cos > 0.0 && shines > 0.0 { self.intensity * (shines * cos / squared) } else { DVec3::ZERO }
    }
}

impl Light {
    /// The point of a point light, or places spread over an area light by its power, one in each cell of a
    /// square grid; `number` draws from 0 to 1, twice for each.
    pub(crate) fn places(&self, samples: u32, number: &mut dyn FnMut() -> f64) -> Vec<LightPlace> {
        match &self.shape {
            LightShape::Point { position, direction, half_angle, intensity } => vec![LightPlace {
                position: position.as_dvec3(),
                axis: direction.as_dvec3(),
                half_angle: Some(*half_angle),
                intensity: intensity.as_dvec3(),
            }],
            LightShape::Area(area) => {
                let side = f64::from(samples).sqrt().floor().max(1.0);
                let place = |index| {
                    // What is left over after the square grid is taken at random.
                    let index = f64::from(index);
                    let (row, column) = ((index / side).floor(), index % side);
                    let (u, v) = (number(), number());
                    let uv = if row < side { [(column + u) / side, (row + v) / side] } else { [u, v] };
                    let LightSample { position, normal, intensity } = area.sample(uv);
                    LightPlace {
                        position,
                        axis: normal,
                        half_angle: None,
                        intensity: intensity / f64::from(samples),
                    }
                };
                (0..samples).map(place).collect()
            }
        }
    }
}
