//! Light from tables by its definition: sums in whole numbers, quotients in f64 ([`TablesStage`]).
//!
//! [`TablesStage`]: crate::TablesStage

mod area;
mod face;

pub use area::Areas;
pub use face::extents;

use glam::UVec2;

use super::{Inside, Table};
use crate::image::Image;
use crate::view::View;

/// Radii of the boxes, in pixels; the last is 64.
pub const RADII: [u32; 8] = [0, 1, 2, 4, 8, 16, 32, 64];
/// The most that a squared difference counts, in its variances.
const MOST: f64 = 6.0;
/// Ratios so far from 1 decide all.
const SOFT: f64 = 0.4;
/// The least that the picture's noise counts as, of that of photons that fall by chance.
const NOISE_FLOOR: f64 = 0.75;
/// So many tests that find noise alone are pooled with those of a box: at the ends of faces it holds few.
const SUPPOSED: f64 = 2.0;
/// Tests are pooled over boxes so many times as wide.
const POOL: u32 = 2;
/// The widest box that light is smoothed over, by its radius in pixels.
const MOST_SMOOTH: u32 = 16;
/// Light up to so many times what the picture's photons give its pixels in the mean is smoothed.
const BRIGHTEST: f64 = 256.0;
/// What is darker than this share of that is not.
const DARKEST: f64 = 32.0 * 33.0 * 33.0 / 4_294_967_295.0;
/// Units of the usual area of a pixel.
const MEAN_AREA: f64 = 8192.0;
/// Ratios are summed in whole numbers of this.
const RATIO_UNIT: f64 = 1.0 / 8192.0;

/// What light is gathered from, of every pixel.
#[derive(Clone, Debug)]
pub struct Tables {
    /// Area in units; 0 where none counts.
    pub areas: Image<u32>,
    /// Whether photons can land on what the pixel shows.
    pub lit: Image<bool>,
    /// Flux in units: red, green, blue and squares of their sum.
    pub flux: Image<[u32; 4]>,
    /// Pixels that the face goes on to the left, to the right, down (to lower rows) and up.
    pub extents: Image<[u8; 4]>,
    /// The unit of squares over the square of that of power.
    pub square_unit: f64,
    /// Square of a photon's power in the mean, in units of squares.
    pub usual_square: f64,
}

impl Tables {
    /// What light is gathered from where a view shows `position` and `normal`, as
    /// [`SurfaceMaps`](crate::SurfaceMaps) hold them, and `flux` lies on the pixels: in units, of the power
    /// and the root of squares that are given, of photons with this mean square of their power. Beside it
    /// one unit of light, as irradiance.
    #[must_use]
    pub fn of(
        view: &View,
        [position, normal]: [&Image<[f32; 4]>; 2],
        flux: &Image<[u64; 4]>,
        [power, square_root]: [f64; 2],
        mean_square: f64,
    ) -> (Self, f64) {
        let areas = Areas::of(view, position, normal);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "less than 2^32"
        )]
        let weighed = |x, y| {
            let weight = areas.weights.at(x, y);
            let [red, green, blue, squares] = flux.at(x, y).map(|units| units as f64);
            [red * weight, green * weight, blue * weight, squares * weight * weight]
                .map(|units| (units + 0.5) as u32)
        };
        let square = square_root * square_root;
        let given = Self {
            flux: Image::from_fn(flux.size(), weighed),
            lit: normal.map(|[.., number]| number > 0.0),
            extents: extents(position, normal),
            square_unit: square / (power * power),
            usual_square: mean_square / square,
            areas: areas.units,
        };
        (given, power / areas.unit)
    }
}

/// Light of a pixel, in units of power over those of area, and the radius that it came from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gathered {
    /// Red, green and blue.
    pub light: [f64; 3],
    /// In pixels, between two of [`RADII`] where light is mixed.
    pub radius: f64,
}

/// What a box holds.
#[derive(Clone, Copy, Debug, Default)]
struct Held {
    flux: [f64; 3],
    squares: f64,
    area: f64,
}

impl Tables {
    /// Light of every pixel.
    #[must_use]
    pub fn gather(&self) -> Image<Gathered> {
        let size = self.areas.size();
        let sums = Sums::of(self);
        let ratios: Vec<Table> =
            (1..RADII.len()).map(|level| Table::new(&self.ratios_of(level, &sums))).collect();
        let shares = self.shares(&ratios, self.share_of_noise(&sums));
        self.smooth(&Image::from_fn(size, |x, y| self.gather_at(x, y, &sums, &shares)))
    }

    /// Light averaged over half of each pixel's width, over those that are lit, unless one is too bright or
    /// all are too dark for the steps that light is summed in.
    #[must_use]
    pub fn smooth(&self, gathered: &Image<Gathered>) -> Image<Gathered> {
        let all =
            |channel: usize| self.flux.values().iter().map(|flux| u64::from(flux[channel])).sum::<u64>();
        let most = [0, 1, 2].map(all).into_iter().fold(0, u64::max);
        let pixels = f64::from(self.flux.size().element_product());
        #[expect(clippy::cast_precision_loss, reason = "less than 2^53")]
        let brightest = BRIGHTEST * most as f64 / (pixels * MEAN_AREA);
        Image::from_fn(gathered.size(), |x, y| {
            let home = gathered.at(x, y);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 64")]
            let radius = ((0.5 * home.radius) as u32).min(MOST_SMOOTH);
            if radius == 0 {
                return home;
            }
            let Inside { lo, hi } = self.box_at(x, y, radius);
            let (mut sum, mut count, mut is_too_bright) = ([0.0; 3], 0.0, false);
            for (x, y) in (lo.y..=hi.y).flat_map(|y| (lo.x..=hi.x).map(move |x| (x, y))) {
                if self.lit.at(x, y) {
                    count += 1.0;
                    for (sum, light) in sum.iter_mut().zip(gathered.at(x, y).light) {
                        *sum += light;
                        is_too_bright |= light > brightest;
                    }
                }
            }
            let light = sum.map(|sum| sum / count);
            let is_too_dark = light.into_iter().fold(0.0, f64::max) < DARKEST * brightest;
            if is_too_bright || is_too_dark { home } else { Gathered { light, ..home } }
        })
    }

    /// The test of noise of a level at each of its places: each pixel up to radius 4, from there on every
    /// second of every second row; in 2^-13.
    #[must_use]
    pub fn ratios(&self, level: usize) -> Image<u32> {
        self.ratios_of(level, &Sums::of(self))
    }

    fn ratios_of(&self, level: usize, sums: &Sums) -> Image<u32> {
        let step = step_of(level);
        let size = self.areas.size().map(|side| side.div_ceil(step));
        Image::from_fn(size, |x, y| self.ratio(step * x, step * y, level, sums))
    }

    fn ratio(&self, x: u32, y: u32, level: usize, sums: &Sums) -> u32 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 6 in 2^-13")]
        let whole = (self.difference(x, y, level, sums) / threshold(level) / RATIO_UNIT + 0.5) as u32;
        whole
    }

    /// The square of the difference between a level and the one before over what noise alone would make of
    /// it; its threshold where the wider box is no wider.
    fn difference(&self, x: u32, y: u32, level: usize, sums: &Sums) -> f64 {
        let [fine, coarse] = [level - 1, level].map(|level| sums.held(self.box_at(x, y, RADII[level])));
        if is_dark(coarse.flux) {
            0.0
        } else if coarse.area <= fine.area {
            threshold(level)
        } else if fine.area <= 0.0 {
            0.0
        } else {
            let mean = |held: Held| held.flux.iter().sum::<f64>() / held.area;
            let square = self.square_unit * (coarse.squares + self.usual_square);
            let variance = square / coarse.area * (1.0 / fine.area - 1.0 / coarse.area);
            ((mean(coarse) - mean(fine)).powi(2) / variance).min(MOST)
        }
    }

    /// The picture's noise over that of photons that fall by chance, from what differs between radii 1 and 2,
    /// weighed by the squares of power of each pixel.
    fn share_of_noise(&self, sums: &Sums) -> f64 {
        let (mut found, mut weights) = (0.0, 0.0);
        for (x, y) in (0..self.flux.size().x).flat_map(|x| (0..self.flux.size().y).map(move |y| (x, y))) {
            let weight = f64::from(self.flux.at(x, y)[3]);
            let has_all = self.extents.at(x, y).into_iter().all(|extent| extent >= 2);
            found += weight * if has_all { self.difference(x, y, 2, sums) } else { 1.0 };
            weights += weight;
        }
        if weights > 0.0 { (found / weights).clamp(NOISE_FLOOR, 1.0) } else { 1.0 }
    }

    /// How far each width's test lets light be mixed with it: of radii 1 to 64, from 0 to 1, none larger than
    /// the one before. That of radius 1 at each pixel; the others, pooled over wider boxes, at every second
    /// pixel of every second row.
    fn shares(&self, ratios: &[Table], noise: f64) -> Image<[f64; 7]> {
        let share = |x, y, level| {
            let ratio = self.pooled(x, y, level, &ratios[level - 1], noise);
            ((1.0 + SOFT - ratio) / (2.0 * SOFT)).clamp(0.0, 1.0)
        };
        let size = self.areas.size().map(|side| side.div_ceil(2));
        let cells = Image::from_fn(size, |x, y| -> [f64; 6] {
            std::array::from_fn(|index| share(2 * x, 2 * y, index + 2))
        });
        Image::from_fn(self.areas.size(), |x, y| {
            let [left, right, down, up] = self.extents.at(x, y);
            // The cell's pixel, or where that is on another face, the next one.
            let cell = |place: u32, before: u8, after: u8| {
                place / 2 + u32::from(place % 2 == 1 && before == 0 && after > 0)
            };
            let wider = cells.at(cell(x, left, right), cell(y, down, up));
            let mut least = share(x, y, 1);
            std::array::from_fn(|index| {
                least = if index == 0 { least } else { least.min(wider[index - 1]) };
                least
            })
        })
    }

    fn gather_at(&self, x: u32, y: u32, sums: &Sums, shares: &Image<[f64; 7]>) -> Gathered {
        if !self.lit.at(x, y) {
            return Gathered::default();
        }
        let light = |radius| {
            let held = sums.held(self.box_at(x, y, radius));
            (held.area > 0.0).then(|| held.flux.map(|flux| flux / held.area))
        };
        let mut found = Gathered { light: light(0).unwrap_or_default(), radius: 0.0 };
        let mut is_found = light(0).is_some();
        for (share, radius) in shares.at(x, y).into_iter().zip(&RADII[1..]) {
            if share == 0.0 {
                break;
            }
            let wider = light(*radius);
            // Where there is nothing, what is wider is all there is.
            let part = if is_found { share } else { 1.0 };
            found.radius += part * (f64::from(*radius) - found.radius);
            for (light, wider) in found.light.iter_mut().zip(wider.unwrap_or_default()) {
                *light += part * (wider - *light);
            }
            is_found |= wider.is_some();
        }
        if !is_found
            && let Some((radius, light)) = RADII.iter().find_map(|&radius| Some((radius, light(radius)?)))
        {
            found = Gathered { light, radius: radius.into() };
        }
        // Nothing is lit so far from photons.
        if is_dark(found.light) && is_dark(sums.held(self.box_at(x, y, RADII[7])).flux) {
            found.radius = 0.0;
        }
        found
    }

    /// The mean ratio of a level around a pixel, of an even column and row where tests are at every second.
    fn pooled(&self, x: u32, y: u32, level: usize, ratios: &Table, noise: f64) -> f64 {
        let step = step_of(level);
        let Inside { lo, hi } = self.box_at(x, y, POOL * RADII[level]);
        let places = Inside { lo: lo.map(|first| first.div_ceil(step)), hi: hi / step };
        #[expect(clippy::cast_precision_loss, reason = "less than 2^32")]
        let [sum, count] = [ratios.count(places) as f64 * RATIO_UNIT / noise, places.area() as f64];
        (sum + SUPPOSED / threshold(level)) / (count + SUPPOSED)
    }

    /// The box of a radius, as far as the pixel's face goes along its row and column.
    fn box_at(&self, x: u32, y: u32, radius: u32) -> Inside {
        let [left, right, down, up] = self.extents.at(x, y).map(|extent| u32::from(extent).min(radius));
        Inside { lo: UVec2::new(x - left, y - down), hi: UVec2::new(x + right, y + up) }
    }
}

/// Sums of all that is given.
struct Sums {
    area: Table,
    flux: [Table; 4],
}

impl Sums {
    fn of(given: &Tables) -> Self {
        let of_channel = |channel: usize| Table::new(&given.flux.map(|flux| flux[channel]));
        Self { area: Table::new(&given.areas), flux: [0, 1, 2, 3].map(of_channel) }
    }

    #[expect(clippy::cast_precision_loss, reason = "less than 2^53")]
    fn held(&self, inside: Inside) -> Held {
        let [red, green, blue, squares] =
            [0, 1, 2, 3].map(|index: usize| self.flux[index].count(inside) as f64);
        Held { flux: [red, green, blue], squares, area: self.area.count(inside) as f64 }
    }
}

/// What a level's test is held against: 1 by noise, and the bias of the wider box as far as it is known from
/// the difference.
fn threshold(level: usize) -> f64 {
    let [a, b] = [level - 1, level].map(|level| (f64::from(RADII[level]) + 0.5).powi(2));
    1.0 + (b - a) / (b + a)
}

fn is_dark(light: [f64; 3]) -> bool {
    light.into_iter().all(|channel| channel <= 0.0)
}

/// Pixels from one test to the next.
fn step_of(level: usize) -> u32 {
    if RADII[level] <= 4 { 1 } else { 2 }
}

#[cfg(test)]
mod tests;
