//! Numbers of a scene file, checked: places, directions, colours, quads.

use std::ops::Range;

use glam::{DVec3, Vec3};
use toml::Spanned;

use super::area;
use super::entries::Triple;
use super::source::Text;
use crate::error::Result;

/// The largest coordinate, in scene units: its square and cube fit f32 with room.
pub(super) const MAX_COORDINATE: f64 = 1e9;

/// A triangle has an area if it is more than this share of its longest edge squared.
const LEAST_SHARE: f64 = 1e-12;

impl Text<'_> {
    /// The two halves of a quad: corners 0, 1, 2 and 0, 2, 3.
    pub(super) fn quad(&self, quad: &Spanned<[Triple; 4]>, field: &str) -> Result<[[Vec3; 3]; 2]> {
        let mut corners = [Vec3::ZERO; 4];
        for (corner, &numbers) in corners.iter_mut().zip(quad.get_ref()) {
            *corner = self.place(quad.span(), numbers, field)?;
        }
        let [a, b, c, d] = corners;
        let halves = [[a, b, c], [a, c, d]];
        let remedy = "give four corners in a row around the quad";
        if !halves.iter().all(has_area) {
            return Err(self.error(&quad.span(), field, "the quad, or half of it, has no area", remedy));
        }
        let normal = |[a, b, c]: [Vec3; 3]| (b - a).as_dvec3().cross((c - a).as_dvec3());
        if normal(halves[0]).dot(normal(halves[1])) <= 0.0 {
            return Err(self.error(&quad.span(), field, "the quad is folded or dented", remedy));
        }
        Ok(halves)
    }

    /// A place; its own span, as it may be one of several in an array.
    pub(super) fn place(&self, span: Range<usize>, numbers: Triple, field: &str) -> Result<Vec3> {
        if !numbers.iter().all(|number| number.abs() <= MAX_COORDINATE) {
            let problem = format!("{numbers:?} is not a place");
            let remedy = format!("coordinates go from -{MAX_COORDINATE:e} to {MAX_COORDINATE:e}");
            return Err(self.error(&span, field, problem, remedy));
        }
        Ok(single(numbers))
    }

    /// Of length 1.
    pub(super) fn direction(&self, numbers: &Spanned<Triple>, field: &str) -> Result<Vec3> {
        let direction = self.place(numbers.span(), *numbers.get_ref(), field)?.as_dvec3();
        let unit = direction.try_normalize().ok_or_else(|| {
            self.error(&numbers.span(), field, "it has no length", "give a direction, such as [0, 0, 1]")
        })?;
        Ok(unit.as_vec3())
    }

    /// Linear RGB from 0 to `most`.
    pub(super) fn colour(&self, numbers: &Spanned<Triple>, field: &str, most: f64) -> Result<Vec3> {
        if !numbers.get_ref().iter().all(|number| (0.0..=most).contains(number)) {
            let problem = format!("{:?} is not possible", numbers.get_ref());
            let remedy = format!("give red, green and blue from 0 to {most:e}");
            return Err(self.error(&numbers.span(), field, problem, remedy));
        }
        Ok(single(*numbers.get_ref()))
    }

    /// A number in a range, both ends included.
    pub(super) fn number(&self, number: &Spanned<f64>, field: &str, least: f64, most: f64) -> Result<f32> {
        let value = *number.get_ref();
        if !(least..=most).contains(&value) {
            let remedy = format!("it goes from {least} to {most}");
            return Err(self.error(&number.span(), field, format!("{value} is not possible"), remedy));
        }
        #[expect(clippy::cast_possible_truncation, reason = "rounded to the precision of the scene")]
        let single = value as f32;
        Ok(single)
    }
}

/// Whether a triangle is more than a line or a point.
pub(super) fn has_area(corners: &[Vec3; 3]) -> bool {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    area(corners) > LEAST_SHARE * longest
}

fn single(numbers: Triple) -> Vec3 {
    DVec3::from_array(numbers).as_vec3()
}
