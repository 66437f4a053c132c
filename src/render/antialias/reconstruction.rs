//! From samples to pixels, by a filter.

use glam::{DVec2, UVec2, Vec3};
use rayon::prelude::*;

use crate::image::Image;
use crate::settings::PixelFilter;

/// Samples of some pixels: each with its place from its pixel's corner, and its light.
#[derive(Debug, Default)]
pub(super) struct PixelSamples {
    /// Where the samples of each pixel end.
    ends: Vec<usize>,
    values: Vec<(DVec2, Vec3)>,
}

impl PixelSamples {
    /// As many samples, `each`, of every pixel.
    pub(super) fn of_as_many(each: usize, values: Vec<(DVec2, Vec3)>) -> Self {
        Self { ends: (1..=values.len() / each).map(|pixel| each * pixel).collect(), values }
    }

    /// Adds those of one more pixel.
    pub(super) fn push(&mut self, samples: Vec<(DVec2, Vec3)>) {
        self.values.extend(samples);
        self.ends.push(self.values.len());
    }

    fn of(&self, index: usize) -> &[(DVec2, Vec3)] {
        let begin = if index == 0 { 0 } else { self.ends[index - 1] };
        &self.values[begin..self.ends[index]]
    }
}

/// Pixels from what their middles show and, where `edges` are, from samples of their areas. All samples of a
/// pixel together count as much as the middle of one that is inside of a face.
pub(super) fn reconstruction(
    filter: PixelFilter,
    middles: &Image<[f32; 3]>,
    edges: &[u32],
    samples: &PixelSamples,
) -> Image<[f32; 3]> {
    let size = middles.size();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few pixels")]
    let reach = filter.reach().ceil() as u32;
    let of_pixel = |pixel: u32| edges.binary_search(&pixel).ok().map(|index| samples.of(index));
    // What the middle of a pixel so far away weighs.
    let usual = Image::from_fn(UVec2::splat(2 * reach + 1), |x, y| {
        weight(filter, UVec2::new(x, y).as_dvec2() - f64::from(reach))
    });
    let found = (0..size.element_product())
        .into_par_iter()
        .map(|pixel| {
            if filter == PixelFilter::Box {
                let Some(samples) = of_pixel(pixel) else { return middles.values()[pixel as usize] };
                let light: Vec3 = samples.iter().map(|&(_, light)| light).sum();
                return (light / count(samples)).to_array();
            }
            let mut sum = Sum::default();
            let home = UVec2::new(pixel % size.x, pixel / size.x);
            let (lo, hi) = (home.saturating_sub(UVec2::splat(reach)), (home + reach).min(size - 1));
            for y in lo.y..=hi.y {
                for x in lo.x..=hi.x {
                    let away = UVec2::new(x, y) + reach - home;
                    if let Some(samples) = of_pixel(y * size.x + x) {
                        let corner = away.as_dvec2() - f64::from(reach) - 0.5;
                        let part = 1.0 / count(samples);
                        for &(at, light) in samples {
                            sum.add(part * weight(filter, corner + at), light);
                        }
                    } else {
                        sum.add(usual.at(away.x, away.y), Vec3::from_array(middles.at(x, y)));
                    }
                }
            }
            sum.mean()
        })
        .collect();
    Image::from_values(size, found)
}

#[expect(clippy::cast_precision_loss, reason = "at most thousands")]
fn count(samples: &[(DVec2, Vec3)]) -> f32 {
    samples.len() as f32
}

/// Of light so far away from the middle of a pixel.
fn weight(filter: PixelFilter, away: DVec2) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "a weight")]
    let weight = (filter.weight(away.x) * filter.weight(away.y)) as f32;
    weight
}

#[derive(Default)]
struct Sum {
    light: Vec3,
    weight: f32,
}

impl Sum {
    fn add(&mut self, weight: f32, light: Vec3) {
        self.light += weight * light;
        self.weight += weight;
    }

    /// Never less than nothing, where a filter goes below.
    fn mean(&self) -> [f32; 3] {
        (self.light / self.weight).max(Vec3::ZERO).to_array()
    }
}
