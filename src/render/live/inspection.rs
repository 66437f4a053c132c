//! What a pixel of a picture in the making holds, for people to look at.

use glam::UVec2;

use crate::error::{Error, Result};
use crate::image::Image;
use crate::irradiance::IrradiancePipeline;
use crate::scene::Scene;
use crate::settings::RadiusChoice;
use crate::view::View;

/// What a pixel holds, and why its radius is what it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inspection {
    /// Photons of the pixel itself.
    pub photons: u64,
    /// R: the radius of its photons' kernels, in pixels.
    pub radius: u32,
    /// N(R): photons in the box of radius R, as far as it is inside of the picture.
    pub within: u64,
    /// N(R - 1): photons in the next smaller box; nothing for R = 1.
    pub within_smaller: Option<u64>,
    /// Name of the surface that the pixel shows first, mirrors and glass too.
    pub surface: Option<String>,
}

/// Maps as they were after a step.
#[derive(Debug, Default)]
pub(super) struct Inspector {
    maps: Option<(Image<f32>, Option<Image<u32>>)>,
}

impl Inspector {
    /// The maps have changed.
    pub(super) fn forget(&mut self) {
        self.maps = None;
    }

    pub(super) fn inspect(
        &mut self,
        scene: &Scene,
        view: &View,
        pipeline: &IrradiancePipeline,
        pixel: UVec2,
    ) -> Result<Inspection> {
        let size = view.size();
        if pixel.cmpge(size).any() {
            return Err(Error::Setting {
                name: "pixel",
                value: pixel.to_string(),
                reason: format!("the picture has {} x {} pixels", size.x, size.y),
            });
        }
        let maps = if let Some(maps) = self.maps.take() {
            maps
        } else {
            let radii = pipeline.radii().filter(|_| pipeline.density_stage().drawn() > 0);
            (pipeline.density_stage().read_counts()?, radii.map(crate::RadiusMap::read).transpose()?)
        };
        let (counts, radii) = self.maps.insert(maps);
        let radius = match (pipeline.settings().radius, radii) {
            (RadiusChoice::Fixed(radius), _) => radius,
            (RadiusChoice::Variable, Some(radii)) => radii.at(pixel.x, pixel.y),
            (RadiusChoice::Variable, None) => pipeline.settings().search.search.max_radius,
        };
        let hit = scene.cast(&view.ray(pixel.x, pixel.y));
        Ok(Inspection {
            photons: within(counts, pixel, 0),
            radius,
            within: within(counts, pixel, radius),
            within_smaller: (radius > 1).then(|| within(counts, pixel, radius - 1)),
            surface: hit.map(|hit| scene.geometry().surfaces[hit.surface as usize].clone()),
        })
    }
}

/// Photons in the box of a radius, as far as it is inside of the map.
fn within(counts: &Image<f32>, pixel: UVec2, radius: u32) -> u64 {
    let first = pixel.saturating_sub(UVec2::splat(radius));
    let end = (pixel + radius + 1).min(counts.size());
    let of_row = |y| (first.x..end.x).map(move |x| f64::from(counts.at(x, y)));
    let sum: f64 = (first.y..end.y).flat_map(of_row).sum();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a sum of counts")]
    let sum = sum as u64;
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_cut_at_the_borders() {
        // 0 1 2 / 3 4 5
        let mut counts = Image::filled(UVec2::new(3, 2), 0.0);
        for (value, (x, y)) in
            [0.0, 1.0, 2.0, 3.0, 4.0, 5.0].into_iter().zip([(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)])
        {
            counts.set(x, y, value);
        }
        assert_eq!(within(&counts, UVec2::new(1, 0), 0), 1);
        assert_eq!(within(&counts, UVec2::new(0, 0), 1), 8);
        assert_eq!(within(&counts, UVec2::new(2, 1), 5), 15);
    }
}
