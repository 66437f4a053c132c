//! How far a picture is from its reference in each region.

use serde::{Deserialize, Serialize};
use varikernel::image::Image;

use super::regions::Region;

/// The error of some pixels, of green alone, so that a pixel counts once.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RegionError {
    /// Of which pixels.
    pub region: Region,
    /// How many.
    pub pixels: usize,
    /// Root of the mean squared difference, over the mean of the whole reference.
    pub rmse: f64,
    /// Median of the difference over the reference, where that is not 0; 0 where it is everywhere.
    pub median: f64,
    /// Mean difference, over the mean of the whole reference.
    pub bias: f64,
}

/// What pictures of a scene are compared with: the mean of references, and how far off that is by itself.
#[derive(Debug)]
pub(super) struct Reference {
    green: Vec<f64>,
    /// The variance of each pixel's mean; with one reference, nobody knows.
    variance: Option<Vec<f64>>,
    mean: f64,
    /// Pixels of each region that there is.
    regions: Vec<(Region, Vec<usize>)>,
}

impl Reference {
    /// From pictures of one size, and the region of each pixel if that is known.
    pub(super) fn new(pictures: &[Image<[f32; 3]>], regions: Option<&Image<Region>>) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "a few")]
        let count = pictures.len() as f64;
        let pixels = pictures[0].values().len();
        let of = |picture: &Image<[f32; 3]>, pixel: usize| f64::from(picture.values()[pixel][1]);
        let mean_of = |pixel: usize| pictures.iter().map(|picture| of(picture, pixel)).sum::<f64>() / count;
        let green: Vec<f64> = (0..pixels).map(mean_of).collect();
        let variance = (pictures.len() > 1).then(|| {
            let of_pixel = |pixel: usize| {
                let squares: f64 =
                    pictures.iter().map(|picture| (of(picture, pixel) - green[pixel]).powi(2)).sum();
                squares / (count - 1.0) / count
            };
            (0..pixels).map(of_pixel).collect()
        });
        let mut all = vec![(Region::Whole, (0..pixels).collect())];
        for region in Region::ALL.into_iter().skip(1) {
            let is_in = |pixel: &usize| regions.is_some_and(|regions| regions.values()[*pixel].is_in(region));
            let inside: Vec<usize> = (0..pixels).filter(is_in).collect();
            // Where no lamp is seen, all but lamps are the whole again.
            let is_whole = region == Region::AllButLamps && inside.len() == pixels;
            if !inside.is_empty() && !is_whole {
                all.push((region, inside));
            }
        }
        let mean = mean(green.iter().copied());
        Self { green, variance, mean, regions: all }
    }

    /// The errors of a picture of the same size, region by region.
    pub(super) fn errors(&self, picture: &Image<[f32; 3]>) -> Vec<RegionError> {
        let of = |(region, pixels): &(Region, Vec<usize>)| {
            let difference = |&pixel: &usize| f64::from(picture.values()[pixel][1]) - self.green[pixel];
            let relative = |pixel: &usize| {
                (self.green[*pixel] > 0.0).then(|| difference(pixel).abs() / self.green[*pixel])
            };
            RegionError {
                region: *region,
                pixels: pixels.len(),
                rmse: self.in_means(mean(pixels.iter().map(|pixel| difference(pixel).powi(2))).sqrt()),
                median: median(pixels.iter().filter_map(relative).collect()),
                bias: self.in_means(mean(pixels.iter().map(difference))),
            }
        };
        self.regions.iter().map(of).collect()
    }

    /// The RMSE of the reference itself in each region, as far as its pictures tell.
    pub(super) fn noise(&self) -> Vec<(Region, f64)> {
        let Some(variance) = &self.variance else { return Vec::new() };
        let of = |(region, pixels): &(Region, Vec<usize>)| {
            (*region, self.in_means(mean(pixels.iter().map(|&pixel| variance[pixel])).sqrt()))
        };
        self.regions.iter().map(of).collect()
    }

    fn in_means(&self, light: f64) -> f64 {
        if light == 0.0 { 0.0 } else { light / self.mean }
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "fewer than 2^52 pixels")]
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

fn median(mut values: Vec<f64>) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    fn grey<const COUNT: usize>(values: [f32; COUNT]) -> Image<[f32; 3]> {
        let size = UVec2::new(u32::try_from(COUNT).unwrap(), 1);
        Image::from_values(size, values.map(|value| [0.0, value, 9.0]).to_vec())
    }

    #[test]
    fn errors_by_hand() {
        let regions = Image::from_values(
            UVec2::new(4, 1),
            vec![Region::Rest, Region::Rest, Region::Caustic, Region::Rest],
        );
        let reference = Reference::new(&[grey([1.0, 2.0, 5.0, 0.0])], Some(&regions));
        let errors = reference.errors(&grey([1.0, 2.5, 4.0, 0.0]));
        assert_eq!(errors.iter().map(|error| error.pixels).collect::<Vec<_>>(), [4, 1, 3]);
        // The mean is 2; squares of 0, 1/2, 1 and 0.
        let [whole, caustic, rest] = errors.as_slice() else { panic!("{errors:?}") };
        assert!((whole.rmse - (1.25_f64 / 4.0).sqrt() / 2.0).abs() < 1e-12);
        assert!((whole.bias + 0.5 / 4.0 / 2.0).abs() < 1e-12);
        assert!((whole.median - 0.2).abs() < 1e-12, "of 0, 1/4 and 1/5");
        assert!((caustic.rmse - 0.5).abs() < 1e-12 && (caustic.median - 0.2).abs() < 1e-12);
        assert!((rest.rmse - (0.25_f64 / 3.0).sqrt() / 2.0).abs() < 1e-12);
        assert_eq!(reference.noise(), [], "one picture does not know how far off it is");
    }

    #[test]
    fn lamps_are_left_out_of_all_but_them() {
        let regions = Image::from_values(UVec2::new(2, 1), vec![Region::Lamps, Region::Rest]);
        let reference = Reference::new(&[grey([7.0, 1.0])], Some(&regions));
        let errors = reference.errors(&grey([0.0, 1.0]));
        let wrong: Vec<_> = errors.iter().map(|error| (error.region, error.rmse > 0.0)).collect();
        let lamps = [Region::Whole, Region::Lamps].map(|region| (region, true));
        let others = [Region::AllButLamps, Region::Rest].map(|region| (region, false));
        assert_eq!(wrong, [lamps[0], others[0], lamps[1], others[1]]);
    }

    #[test]
    fn references_tell_their_own_noise() {
        let reference = Reference::new(&[grey([1.0, 3.0]), grey([3.0, 3.0])], None);
        // Means of 2 and 3, 2.5 in all; the first has a variance of 2 / 2.
        let [(region, noise)] = reference.noise()[..] else { panic!("the whole picture") };
        assert_eq!(region, Region::Whole);
        assert!((noise - 0.5_f64.sqrt() / 2.5).abs() < 1e-12);
        let [whole] = reference.errors(&grey([2.0, 3.0]))[..] else { panic!("the whole picture") };
        assert_eq!((whole.rmse, whole.median, whole.bias), (0.0, 0.0, 0.0));
    }

    #[test]
    fn a_black_reference_gives_numbers() {
        let reference = Reference::new(&[grey([0.0, 0.0])], None);
        let [same] = reference.errors(&grey([0.0, 0.0]))[..] else { panic!("the whole picture") };
        assert_eq!((same.rmse, same.median, same.bias), (0.0, 0.0, 0.0));
        let [lit] = reference.errors(&grey([1.0, 0.0]))[..] else { panic!("the whole picture") };
        assert!(lit.rmse.is_infinite());
    }
}
