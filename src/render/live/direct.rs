//! Direct light that gets better: some shadow rays a step, the share of all so far that saw their light.

use std::f32::consts::PI;

use glam::{DVec3, UVec2, Vec3};
use rayon::prelude::*;

use crate::image::Image;
use crate::render::add;
use crate::render::direct::{Receiver, Samples};
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
    /// Of each place.
    arrived: Vec<Arrived>,
    /// Samples of every place, and how many places have one more.
    rounds: u32,
    done: usize,
}

/// Irradiance at a place.
#[derive(Clone, Copy, Debug, Default)]
struct Arrived {
    /// Of all lights, if nothing is between; nothing if only samples can tell, or before the first.
    unblocked: Option<Vec3>,
    /// Of samples of all lights, added up: of those that were seen, and of all.
    of_seen: Vec3,
    of_all: Vec3,
}

impl Arrived {
    fn take(&mut self, scene: &Scene, place: &Place, seed: u64, number: u32, round: u32) {
        // What reflects nothing, as most lights, needs no shadow rays.
        if place.share == Vec3::ZERO {
            return;
        }
        let receiver = Receiver::new(scene, place.position, place.normal);
        if round == 0 {
            let mut each = scene.lights().iter().map(|light| light.irradiance(place.position, place.normal));
            self.unblocked =
                each.try_fold(DVec3::ZERO, |sum, one| Some(sum + one?)).map(|sum: DVec3| sum.as_vec3());
        }
        for (light_number, light) in (0..).zip(scene.lights()) {
            let uv = Samples::new(seed, number, light_number).at(round);
            if let Some((arrives, is_seen)) = receiver.sample(scene, light, uv) {
                self.of_all += arrives.as_vec3();
                self.of_seen += if is_seen { arrives.as_vec3() } else { Vec3::ZERO };
            }
        }
    }

    /// After so many samples of each light. The ratio of samples that were seen takes away all noise but
    /// that of shadows (E. Heitz, S. Hill, M. McGuire, "Combining analytic direct illumination and stochastic
    /// shadows", 2018).
    fn irradiance(&self, samples: u32) -> Vec3 {
        match self.unblocked {
            Some(whole) => whole * (self.of_seen / self.of_all.max(Vec3::splat(f32::MIN_POSITIVE))),
            #[expect(clippy::cast_precision_loss, reason = "a few")]
            None => self.of_seen / samples.max(1) as f32,
        }
    }
}

impl ProgressiveDirect {
    pub(super) fn new(size: UVec2, sight: Sight, seed: u64) -> Self {
        let Sight { straight: mut places, bent, lights, .. } = sight;
        let straight = places.len();
        places.extend(bent);
        let arrived = vec![Arrived::default(); places.len()];
        Self { size, seed, places, straight, lights, arrived, rounds: 0, done: 0 }
    }

    /// Samples as many places as given, all of them the first time.
    pub(super) fn step(&mut self, scene: &Scene, samples: u32) {
        let mut left = if self.rounds == 0 { self.places.len() } else { samples as usize };
        while left > 0 && self.rounds < ENOUGH && !self.places.is_empty() {
            let end = self.places.len().min(self.done + left);
            let places = self.places[self.done..end].par_iter();
            let arrived = self.arrived[self.done..end].par_iter_mut();
            let (done, seed, round) = (self.done, self.seed, self.rounds);
            places.zip(arrived).enumerate().for_each(|(index, (place, arrived))| {
                let number = u32::try_from(done + index).expect("fewer than 2^32 places");
                arrived.take(scene, place, seed, number, round);
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
        for (index, (place, arrived)) in self.places.iter().zip(&self.arrived).enumerate() {
            let samples = self.rounds + u32::from(index < self.done);
            let radiance = place.share * arrived.irradiance(samples) / PI;
            add(&mut image, place.pixel, radiance.as_dvec3());
        }
        for place in &self.places[..self.straight] {
            let (x, y) = (place.pixel % self.size.x, place.pixel / self.size.x);
            let [red, green, blue, _] = image.at(x, y);
            image.set(x, y, [red, green, blue, 1.0]);
        }
        image
    }
}
