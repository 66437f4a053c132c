//! Direct light that gets better: some shadow rays a step, the mean of all so far.

use glam::{DVec3, UVec2, Vec3};
use rayon::prelude::*;

use crate::image::Image;
use crate::render::add;
use crate::render::direct::{Dice, reflected};
use crate::render::sight::{Place, Sight};
use crate::scene::Scene;

/// Samples of each place after which the mean is good enough.
const ENOUGH: u32 = 1024;

/// The light at all places that the pixels see.
#[derive(Debug)]
pub(super) struct ProgressiveDirect {
    size: UVec2,
    seed: u64,
    /// Straight places first.
    places: Vec<Place>,
    straight: usize,
    lights: Vec<(u32, Vec3)>,
    /// Radiance of each place, added up.
    sums: Vec<DVec3>,
    /// Samples of every place, and how many places have one more.
    rounds: u32,
    done: usize,
}

impl ProgressiveDirect {
    pub(super) fn new(size: UVec2, sight: Sight, seed: u64) -> Self {
        let Sight { straight: mut places, bent, lights, .. } = sight;
        let straight = places.len();
        places.extend(bent);
        let sums = vec![DVec3::ZERO; places.len()];
        Self { size, seed, places, straight, lights, sums, rounds: 0, done: 0 }
    }

    /// Samples as many places as given, all of them the first time.
    pub(super) fn step(&mut self, scene: &Scene, samples: u32) {
        let mut left = if self.rounds == 0 { self.places.len() } else { samples as usize };
        while left > 0 && self.rounds < ENOUGH && !self.places.is_empty() {
            let end = self.places.len().min(self.done + left);
            // Each round has seeds of its own.
            let seed = self.seed.wrapping_add(u64::from(self.rounds) << 40);
            let places = self.places[self.done..end].par_iter();
            let sums = self.sums[self.done..end].par_iter_mut();
            let done = self.done;
            places.zip(sums).enumerate().for_each(|(index, (place, sum))| {
                let number = u32::try_from(done + index).expect("fewer than 2^32 places");
                *sum += reflected(scene, place, 1, &mut Dice::new(seed, number));
            });
            left -= end - self.done;
            self.done = end;
            if self.done == self.places.len() {
                self.rounds += 1;
                self.done = 0;
            }
        }
    }

    /// Radiance of lights, and of what they light; the fourth value is 1 where a pixel shows a diffuse
    /// surface, else 0.
    pub(super) fn image(&self) -> Image<[f32; 4]> {
        let mut image = Image::filled(self.size, [0.0; 4]);
        for &(pixel, radiance) in &self.lights {
            add(&mut image, pixel, radiance.as_dvec3());
        }
        for (index, (place, sum)) in self.places.iter().zip(&self.sums).enumerate() {
            let samples = self.rounds + u32::from(index < self.done);
            add(&mut image, place.pixel, *sum / f64::from(samples.max(1)));
        }
        for place in &self.places[..self.straight] {
            let (x, y) = (place.pixel % self.size.x, place.pixel / self.size.x);
            let [red, green, blue, _] = image.at(x, y);
            image.set(x, y, [red, green, blue, 1.0]);
        }
        image
    }
}
