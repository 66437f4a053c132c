//! What the pictures of a scene are compared with: photons of many seeds, counted where they land.
//!
//! A pixel at the edge of a face sees a part of it, and counts the photons of that part alone: it would be
//! too dark by as much. So its light is divided by the share that it sees ([`Coverage`]). In mirrors and
//! glass photons are counted around each place, and edges that are seen there stay dark.

use std::f32::consts::PI;

use serde::{Deserialize, Serialize};

use super::coverage::Coverage;
use super::{PictureStudy, Way};
use crate::BOUNCES;
use crate::picture::{LightError, PictureError};
use varikernel::error::Result;
use varikernel::gl::Gl;
use varikernel::image::Image;
use varikernel::photon::TraceSettings;
use varikernel::render::{Layers, Reference};
use varikernel::scene::Scene;

/// Seeds of references begin here, beyond those of pictures.
const REFERENCE_SEED: u64 = 1 << 32;

/// What the pictures of a scene are compared with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneReference {
    /// The scene's name.
    pub scene: String,
    /// Photons of all seeds.
    pub photons: u64,
    /// Its own noise: RMSE and relative MSE of the mean over the seeds, which are taken away from those of
    /// pictures; SSIM and FLIP of two halves of the seeds against each other, which are not.
    pub noise: PictureError,
    /// The share of the picture's pixels that are inside of faces.
    pub inside_share: f64,
}

/// A scene's reference, pixel by pixel.
#[derive(Debug)]
pub(super) struct Target {
    pub(super) coverage: Coverage,
    /// Indirect light of each seed.
    pub(super) seeds: Vec<Image<[f32; 3]>>,
    indirect: Image<[f32; 3]>,
    beauty: Image<[f32; 3]>,
    /// Of the mean over the seeds.
    variances: Image<[f64; 3]>,
}

impl Target {
    /// Traces the seeds; `observe` is called after each.
    pub(super) fn new(
        gl: &Gl,
        scene: &Scene,
        study: &PictureStudy,
        observe: &mut dyn FnMut() -> Result<()>,
    ) -> Result<Self> {
        let settings = study.settings(Way::Fixed { radius: 1 }, study.kernels[0]);
        let coverage = Coverage::of(gl, scene, settings.size)?;
        let mut seeds = Vec::new();
        let mut direct = Image::filled(settings.size, [0.0; 3]);
        for number in 0..study.reference_seeds {
            let trace = TraceSettings {
                photons: study.reference_photons,
                bounces: Some(BOUNCES),
                seed: REFERENCE_SEED + u64::from(number),
                ..TraceSettings::default()
            };
            let mut reference = Reference::new(gl, scene, &settings, &mut |_| ())?;
            reference.add_seed(scene, &trace, &mut |_| ())?;
            let layers = reference.picture()?;
            seeds.push(whole_light(&layers, &coverage));
            direct = layers.direct;
            observe()?;
        }
        let all: Vec<&Image<[f32; 3]>> = seeds.iter().collect();
        let indirect = mean(&all);
        let variances = variances(&all, &indirect);
        Ok(Self { coverage, beauty: sum(&indirect, &direct), indirect, variances, seeds })
    }

    /// The error of a picture, and of its pixels inside of faces.
    pub(super) fn error(&self, layers: &Layers) -> (PictureError, LightError) {
        let seen = PictureError::between(&layers.beauty, &self.beauty);
        let of = |kept: &dyn Fn(usize) -> bool| {
            let places: Vec<usize> = (0..self.variances.values().len()).filter(|&at| kept(at)).collect();
            LightError::beyond_noise(
                &taken(&layers.indirect, &places),
                &taken(&self.indirect, &places),
                &taken(&self.variances, &places),
            )
        };
        let LightError { rmse, relative_mse } = of(&|_| true);
        let inside = self.coverage.inside.values();
        (PictureError { rmse, relative_mse, ..seen }, of(&|at| inside[at]))
    }

    /// What is said of it.
    pub(super) fn told(&self, scene: &str, study: &PictureStudy) -> SceneReference {
        let halves =
            [0, 1].map(|first: usize| mean(&self.seeds.iter().skip(first).step_by(2).collect::<Vec<_>>()));
        let direct = |light: &Image<[f32; 3]>| {
            // Both halves have the direct light of the whole.
            let pairs = self.beauty.values().iter().zip(self.indirect.values()).zip(light.values());
            let values = pairs.map(|((all, indirect), light)| {
                std::array::from_fn(|colour| all[colour] - indirect[colour] + light[colour])
            });
            Image::from_values(light.size(), values.collect())
        };
        let seen = PictureError::between(&direct(&halves[0]), &direct(&halves[1]));
        // No picture is as close as the reference is to itself; all that is left is its own noise.
        let offset: Vec<[f32; 3]> = self.deviated();
        let LightError { rmse, relative_mse } = LightError::between(&offset, self.indirect.values());
        let inside = self.coverage.inside.values();
        #[expect(clippy::cast_precision_loss, reason = "fewer than 2^53 pixels")]
        let inside_share = inside.iter().filter(|&&is_inside| is_inside).count() as f64 / inside.len() as f64;
        SceneReference {
            scene: scene.to_owned(),
            photons: u64::from(study.reference_seeds) * u64::from(study.reference_photons),
            noise: PictureError { rmse, relative_mse, ..seen },
            inside_share,
        }
    }

    /// The reference, off by a standard error everywhere.
    fn deviated(&self) -> Vec<[f32; 3]> {
        let pairs = self.indirect.values().iter().zip(self.variances.values());
        #[expect(clippy::cast_possible_truncation, reason = "a standard error")]
        let off = |(light, variance): (&[f32; 3], &[f64; 3])| {
            std::array::from_fn(|colour| light[colour] + variance[colour].sqrt() as f32)
        };
        pairs.map(off).collect()
    }
}

/// Indirect light as if each pixel saw the whole of its face.
fn whole_light(layers: &Layers, coverage: &Coverage) -> Image<[f32; 3]> {
    let size = layers.indirect.size();
    Image::from_fn(size, |x, y| {
        let share = coverage.shares.at(x, y);
        let (indirect, arrives) = (layers.indirect.at(x, y), layers.irradiance.at(x, y));
        if share <= 0.0 {
            return indirect;
        }
        #[expect(clippy::cast_possible_truncation, reason = "a factor of up to 25")]
        let more = (1.0 / share - 1.0) as f32;
        let albedo = layers.albedo.at(x, y);
        std::array::from_fn(|colour| indirect[colour] + more * albedo[colour] * arrives[colour] / PI)
    })
}

fn sum(first: &Image<[f32; 3]>, second: &Image<[f32; 3]>) -> Image<[f32; 3]> {
    let pairs = first.values().iter().zip(second.values());
    let values = pairs.map(|(a, b)| std::array::from_fn(|colour| a[colour] + b[colour]));
    Image::from_values(first.size(), values.collect())
}

/// The values of some pixels, by their places.
pub(super) fn taken<T: Copy>(image: &Image<T>, places: &[usize]) -> Vec<T> {
    places.iter().map(|&place| image.values()[place]).collect()
}

/// The mean of at least one picture.
#[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "a mean of f32")]
fn mean(seeds: &[&Image<[f32; 3]>]) -> Image<[f32; 3]> {
    let of = |place: usize, colour: usize| {
        let all: f64 = seeds.iter().map(|seed| f64::from(seed.values()[place][colour])).sum();
        (all / seeds.len() as f64) as f32
    };
    let places = 0..seeds[0].values().len();
    let values = places.map(|place| std::array::from_fn(|colour| of(place, colour)));
    Image::from_values(seeds[0].size(), values.collect())
}

/// Variances of the mean of at least two pictures.
#[expect(clippy::cast_precision_loss, reason = "a few seeds")]
fn variances(seeds: &[&Image<[f32; 3]>], mean: &Image<[f32; 3]>) -> Image<[f64; 3]> {
    let count = seeds.len() as f64;
    let of = |place: usize, colour: usize| {
        let mean = f64::from(mean.values()[place][colour]);
        let off = |seed: &&Image<[f32; 3]>| (f64::from(seed.values()[place][colour]) - mean).powi(2);
        seeds.iter().map(off).sum::<f64>() / (count - 1.0) / count
    };
    let places = 0..mean.values().len();
    let values = places.map(|place| std::array::from_fn(|colour| of(place, colour)));
    Image::from_values(mean.size(), values.collect())
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    #[test]
    fn mean_and_variance_of_three_seeds_by_hand() {
        let of = |value: f32| Image::filled(UVec2::new(2, 1), [value, 2.0 * value, 0.0]);
        let seeds = [of(1.0), of(2.0), of(6.0)];
        let all: Vec<_> = seeds.iter().collect();
        let found = mean(&all);
        let [red, green, blue] = found.at(1, 0);
        assert!((red - 3.0).abs() < 1e-6 && (green - 6.0).abs() < 1e-6 && blue.abs() < 1e-6);
        // 4 + 1 + 9 = 14: a variance of 7, and of a third of that for the mean.
        let [red, green, blue] = variances(&all, &found).at(0, 0);
        assert!((red - 7.0 / 3.0).abs() < 1e-12 && (green - 28.0 / 3.0).abs() < 1e-12 && blue.abs() < 1e-12);
    }
}
