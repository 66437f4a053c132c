//! Areas of pixels in whole units.

use glam::Vec3;

use super::face::links;
use crate::image::Image;
use crate::view::View;

/// The geometric mean of all areas is 2 to this, in units.
const MEAN_EXPONENT: i32 = 13;
/// The most units that an area counts as: the widest box of such pixels, 129 x 129, holds less than 2^32.
const MOST_UNITS: f64 = 258_095.0;
/// The least cosine between a surface's normal and the line of sight.
const LEAST_COSINE: f64 = 1e-3;

/// Areas that pixels see.
#[derive(Clone, Debug)]
pub struct Areas {
    /// In squares of a scene unit; a power of two.
    pub unit: f64,
    /// In units; 0 where nothing is lit.
    pub units: Image<u32>,
    /// What flux is multiplied with so that it stays that of the true area.
    pub weights: Image<f64>,
}

impl Areas {
    /// Of what [`SurfaceMaps`](crate::SurfaceMaps) hold.
    #[must_use]
    pub fn of(view: &View, position: &Image<[f32; 4]>, normal: &Image<[f32; 4]>) -> Self {
        let area = Image::from_fn(position.size(), |x, y| {
            let [facing_x, facing_y, facing_z, number] = normal.at(x, y);
            let [place_x, place_y, place_z, depth] = position.at(x, y);
            (number > 0.0).then(|| {
                let sight = Vec3::new(place_x, place_y, place_z).as_dvec3() - view.position().as_dvec3();
                let cosine = Vec3::new(facing_x, facing_y, facing_z).as_dvec3().dot(sight).abs();
                let slant = cosine.max(LEAST_COSINE * sight.length());
                f64::from(view.pixel_side()).powi(2) * f64::from(depth).powi(3) / slant
            })
        });
        let logarithms: Vec<f64> = area.values().iter().flatten().map(|area| area.log2()).collect();
        #[expect(clippy::cast_precision_loss, reason = "a number of pixels")]
        let mean = logarithms.iter().sum::<f64>() / logarithms.len().max(1) as f64;
        let unit = ((mean + 0.5).floor() - f64::from(MEAN_EXPONENT)).exp2();
        let links = links(position, normal);
        let is_at_an_edge = |x: u32, y: u32| links.at(x, y).contains(&Some(false));
        let has_an_inside = |x: u32, y: u32| {
            let [left, right, down, up] = links.at(x, y).map(|linked| linked == Some(true));
            (left && !is_at_an_edge(x - 1, y))
                || (right && !is_at_an_edge(x + 1, y))
                || (down && !is_at_an_edge(x, y - 1))
                || (up && !is_at_an_edge(x, y + 1))
        };
        // A pixel at the edge of a face sees less of it than its area says.
        let counts = |x, y| !(is_at_an_edge(x, y) && has_an_inside(x, y));
        let exact = Image::from_fn(area.size(), |x, y| {
            area.at(x, y).filter(|_| counts(x, y)).map_or(0.0, |area| area / unit)
        });
        let whole = |exact: f64| {
            if 3.0 * exact >= 2.0 { (exact + 0.5).floor().min(MOST_UNITS) } else { 0.0 }
        };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 2^18")]
        let units = exact.map(|exact| whole(exact) as u32);
        let weights = exact.map(|exact| if whole(exact) > 0.0 { whole(exact) / exact } else { 0.0 });
        Self { unit, units, weights }
    }
}
