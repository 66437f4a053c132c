//! From samples to pixels, by a filter.

use glam::{DVec2, UVec2, Vec3};
use rayon::prelude::*;

use crate::image::Image;
use crate::settings::PixelFilter;

/// Pictures of two kinds of light, side by side.
type Both = [Vec3; 2];

/// Pixels from what their middles show and, where `edges` are, from as many samples for `each`, by their
/// places from the pixel's corner. A pixel inside of a face counts as if it had as many in its middle.
pub(super) fn reconstruction(
    filter: PixelFilter,
    middles: [&Image<[f32; 3]>; 2],
    edges: &[u32],
    samples: &[(DVec2, Both)],
    each: usize,
) -> [Image<[f32; 3]>; 2] {
    let size = middles[0].size();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few pixels")]
    let reach = filter.reach().ceil() as u32;
    let middle = |pixel: usize| middles.map(|image| Vec3::from_array(image.values()[pixel]));
    let of_pixel =
        |pixel: u32| edges.binary_search(&pixel).ok().map(|index| &samples[each * index..each * (index + 1)]);
    // What the middle weighs that stands for all samples, in a pixel so far away.
    #[expect(clippy::cast_precision_loss, reason = "at most 1024")]
    let all = each as f32;
    let usual = Image::from_fn(UVec2::splat(2 * reach + 1), |x, y| {
        all * weight(filter, UVec2::new(x, y).as_dvec2() - f64::from(reach))
    });
    let found: Vec<Both> = (0..size.element_product())
        .into_par_iter()
        .map(|pixel| {
            if filter == PixelFilter::Box {
                let Some(samples) = of_pixel(pixel) else { return middle(pixel as usize) };
                #[expect(clippy::cast_precision_loss, reason = "a few")]
                let count = samples.len() as f32;
                return [0, 1]
                    .map(|kind: usize| samples.iter().map(|(_, light)| light[kind]).sum::<Vec3>() / count);
            }
            let mut sum = Sum::default();
            let home = UVec2::new(pixel % size.x, pixel / size.x);
            let (lo, hi) = (home.saturating_sub(UVec2::splat(reach)), (home + reach).min(size - 1));
            for y in lo.y..=hi.y {
                for x in lo.x..=hi.x {
                    let away = UVec2::new(x, y) + reach - home;
                    let other = y * size.x + x;
                    if let Some(samples) = of_pixel(other) {
                        let corner = away.as_dvec2() - f64::from(reach) - 0.5;
                        for &(at, light) in samples {
                            sum.add(weight(filter, corner + at), light);
                        }
                    } else {
                        sum.add(usual.at(away.x, away.y), middle(other as usize));
                    }
                }
            }
            sum.mean()
        })
        .collect();
    [0, 1].map(|kind: usize| {
        let values = found.iter().map(|both| both[kind].to_array()).collect();
        Image::from_values(size, values)
    })
}

/// Of light so far away from the middle of a pixel.
fn weight(filter: PixelFilter, away: DVec2) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "a weight")]
    let weight = (filter.weight(away.x) * filter.weight(away.y)) as f32;
    weight
}

#[derive(Default)]
struct Sum {
    light: Both,
    weight: f32,
}

impl Sum {
    fn add(&mut self, weight: f32, light: Both) {
        self.light = [0, 1].map(|kind: usize| self.light[kind] + weight * light[kind]);
        self.weight += weight;
    }

    /// Never less than nothing, where a filter goes below.
    fn mean(&self) -> Both {
        self.light.map(|light| (light / self.weight).max(Vec3::ZERO))
    }
}
