//! Regions whose errors are given separately: a picture's caustics, and its walls.

use serde::Serialize;
use varikernel::Image;
use varikernel_lab::{LightError, caustic_and_walls};

/// The errors of a picture in each region; none where the region is empty.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct RegionErrors {
    pub(super) caustic: Option<LightError>,
    pub(super) walls: Option<LightError>,
}

/// Pixels on diffuse surfaces, by the reference's indirect irradiance.
#[derive(Clone, Debug)]
pub(super) struct Regions {
    caustic: Vec<usize>,
    walls: Vec<usize>,
}

impl Regions {
    /// For indirect irradiance that arrives at surfaces of some albedo, which is 0 where they are not
    /// diffuse.
    pub(super) fn new(albedo: &Image<[f32; 3]>, irradiance: &Image<[f32; 3]>) -> Self {
        let [caustic, walls] = caustic_and_walls(albedo, irradiance);
        Self { caustic, walls }
    }

    /// Pixels of the caustics, and of the walls.
    pub(super) fn sizes(&self) -> [usize; 2] {
        [self.caustic.len(), self.walls.len()]
    }

    pub(super) fn errors(&self, picture: &Image<[f32; 3]>, reference: &Image<[f32; 3]>) -> RegionErrors {
        let of = |pixels: &[usize]| {
            let taken = |image: &Image<[f32; 3]>| -> Vec<[f32; 3]> {
                pixels.iter().map(|&index| image.values()[index]).collect()
            };
            (!pixels.is_empty()).then(|| LightError::between(&taken(picture), &taken(reference)))
        };
        RegionErrors { caustic: of(&self.caustic), walls: of(&self.walls) }
    }

    /// The noise of the mean of two pictures, from how far they are apart: half of that.
    pub(super) fn noise(&self, halves: [&Image<[f32; 3]>; 2]) -> RegionErrors {
        let of =
            |error: LightError| LightError { rmse: error.rmse / 2.0, relative_mse: error.relative_mse / 4.0 };
        let RegionErrors { caustic, walls } = self.errors(halves[0], halves[1]);
        RegionErrors { caustic: caustic.map(of), walls: walls.map(of) }
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    #[test]
    fn a_bright_pixel_is_a_caustic_and_a_lamp_is_neither() {
        let size = UVec2::new(5, 1);
        let grey = |values: [f32; 5]| Image::from_values(size, values.map(|value| [value; 3]).to_vec());
        // The last pixel is not diffuse; of the others, the median is 2.
        let regions = Regions::new(&grey([0.5, 0.5, 0.5, 0.5, 0.0]), &grey([1.0, 2.0, 7.0, 1.0, 99.0]));
        assert_eq!(regions.sizes(), [1, 3]);
        let (picture, reference) = (grey([1.0, 2.0, 5.0, 1.0, 0.0]), grey([1.0, 2.0, 7.0, 4.0, 9.0]));
        let RegionErrors { caustic, walls } = regions.errors(&picture, &reference);
        assert!((caustic.map_or(0.0, |error| error.rmse) - 2.0).abs() < 1e-12);
        assert!((walls.map_or(0.0, |error| error.rmse) - 3.0_f64.sqrt()).abs() < 1e-12);
        // Half as far apart: 1, and half of the root of 3.
        let RegionErrors { caustic, walls } = regions.noise([&picture, &reference]);
        assert!((caustic.map_or(0.0, |error| error.rmse) - 1.0).abs() < 1e-12);
        assert!((walls.map_or(0.0, |error| error.rmse) - 0.75_f64.sqrt()).abs() < 1e-12);
        // Where most is dark, there are no regions.
        let dark = Regions::new(&grey([0.5; 5]), &grey([0.0, 0.0, 0.0, 1.0, 9.0]));
        assert_eq!(dark.sizes(), [0, 0]);
        assert_eq!(dark.errors(&picture, &reference), RegionErrors { caustic: None, walls: None });
        // Without a caustic there is no error of it.
        let even = Regions::new(&grey([0.5; 5]), &grey([1.0; 5]));
        assert_eq!((even.sizes(), even.errors(&picture, &reference).caustic), ([0, 5], None));
    }
}
