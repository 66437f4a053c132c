//! Places that stand for a light: what shadow rays and shadow maps start from.

use glam::DVec3;

use super::light::{Light, LightSample, LightShape};

/// A place that a light shines from.
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
    /// Whether all places are the same one.
    pub(crate) fn is_point(&self) -> bool {
        matches!(self.shape, LightShape::Point { .. })
    }

    /// Irradiance at `position`, on the side to which `normal` points, if nothing is between; nothing if only
    /// samples can tell.
    pub(crate) fn irradiance(&self, position: DVec3, normal: DVec3) -> Option<DVec3> {
        match &self.shape {
            LightShape::Point { .. } => Some(self.place([0.0; 2]).irradiance(position, normal)),
            LightShape::Area(area) => area.irradiance(position, normal),
        }
    }

    /// The point of a point light, or the place of an area light for a point of the unit square, by power. It
    /// stands for all of the light.
    pub(crate) fn place(&self, uv: [f64; 2]) -> LightPlace {
        match &self.shape {
            LightShape::Point { position, direction, half_angle, intensity } => LightPlace {
                position: position.as_dvec3(),
                axis: direction.as_dvec3(),
                half_angle: Some(*half_angle),
                intensity: intensity.as_dvec3(),
            },
            LightShape::Area(area) => {
                let LightSample { position, normal, intensity } = area.sample(uv);
                LightPlace { position, axis: normal, half_angle: None, intensity }
            }
        }
    }
}
