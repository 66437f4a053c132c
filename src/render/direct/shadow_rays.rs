//! Rays from a place to one light, and the light that they let through.

use std::ops::Range;

use glam::DVec3;

use super::samples::Samples;
use crate::render::rings::mean;
use crate::scene::{Light, Ray, Scene};

/// A shadow ray ends this share of its length before the light, which may itself be a surface.
const BEFORE_LIGHT: f64 = 1e-6;

/// A place that light arrives at.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Receiver {
    pub(in crate::render) position: DVec3,
    /// On the side that is lit.
    pub(in crate::render) normal: DVec3,
    /// Where rays start.
    start: DVec3,
}

impl Receiver {
    pub(in crate::render) fn new(scene: &Scene, position: DVec3, normal: DVec3) -> Self {
        Self { position, normal, start: scene.start(position, normal) }
    }

    /// Irradiance from a place on a light, as if that were all of it, and whether it is seen; nothing if it
    /// does not shine here.
    pub(in crate::render) fn sample(
        &self,
        scene: &Scene,
        light: &Light,
        uv: [f64; 2],
    ) -> Option<(DVec3, bool)> {
        let place = light.place(uv);
        let arrives = place.irradiance(self.position, self.normal);
        let away = place.position - self.start;
        let distance = away.length();
        let ray = Ray { origin: self.start, direction: away / distance };
        (arrives != DVec3::ZERO).then(|| (arrives, !scene.is_blocked(&ray, distance * (1.0 - BEFORE_LIGHT))))
    }
}

/// What the rays of a place to a light have found.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::render) struct ShadowRays {
    /// Samples that were taken: those of them that could shine on the place took a ray, and some of these saw
    /// the light.
    taken: u32,
    cast: u32,
    seen: u32,
    /// Irradiance of samples, as if each were all of the light: of those that were seen, and of all.
    of_seen: DVec3,
    of_all: DVec3,
    /// Squares of their means over the colours.
    squares_of_seen: f64,
    squares_of_all: f64,
}

impl ShadowRays {
    /// Takes the samples of some numbers, all new ones; `sample` is as [`Receiver::sample`].
    pub(in crate::render) fn take(
        &mut self,
        samples: Samples,
        numbers: Range<u32>,
        sample: impl Fn([f64; 2]) -> Option<(DVec3, bool)>,
    ) {
        self.taken += numbers.end - numbers.start;
        for index in numbers {
            if let Some((arrives, is_seen)) = sample(samples.at(index)) {
                let square = mean(arrives).powi(2);
                self.cast += 1;
                self.of_all += arrives;
                self.squares_of_all += square;
                if is_seen {
                    self.seen += 1;
                    self.of_seen += arrives;
                    self.squares_of_seen += square;
                }
            }
        }
    }

    /// Irradiance: the share of `unblocked` light that was seen, so that all noise is that of the share
    /// (E. Heitz, S. Hill, M. McGuire, "Combining analytic direct illumination and stochastic shadows",
    /// 2018). Without `unblocked`, what the samples say.
    pub(in crate::render) fn irradiance(&self, unblocked: Option<DVec3>) -> DVec3 {
        match unblocked {
            // Less of the light is above the horizon than any sample met.
            Some(_) if self.cast == 0 => DVec3::ZERO,
            // By colour: lights that are looked at together may have other colours.
            Some(whole) => whole * (self.of_seen / self.of_all.max(DVec3::splat(f64::MIN_POSITIVE))),
            None => self.of_seen / f64::from(self.taken.max(1)),
        }
    }

    /// Whether some samples were seen and others not.
    pub(in crate::render) fn is_mixed(&self) -> bool {
        0 < self.seen && self.seen < self.cast
    }

    pub(in crate::render) fn sees_all(&self) -> bool {
        self.seen == self.cast
    }

    /// Whether no sample could shine on the place.
    pub(in crate::render) fn met_nothing(&self) -> bool {
        self.cast == 0
    }

    /// About how far off the irradiance is, in the mean over the colours.
    ///
    /// By chance, a share p of n alike samples would be off by the root of p (1 - p) / n; points that are
    /// spread evenly come nearer to the area of a shape by another root of the root of n. But what is smaller
    /// than the part of a sample may be missed. Samples that differ count as fewer: the square of their sum
    /// over the sum of their squares. Without `unblocked`, it is the light itself that varies, and not its
    /// share.
    pub(in crate::render) fn error(&self, unblocked: Option<DVec3>) -> f64 {
        let alike = |sum: DVec3, squares: f64| if squares > 0.0 { mean(sum).powi(2) / squares } else { 1.0 };
        let light = mean(self.irradiance(unblocked));
        let Some(whole) = unblocked.map(mean) else {
            let taken = f64::from(self.taken.max(1));
            let varies = (taken / alike(self.of_seen, self.squares_of_seen) - 1.0).max(0.0).sqrt();
            return light * (varies / taken.powf(0.75)).max(1.0 / taken);
        };
        let count = alike(self.of_all, self.squares_of_all);
        let share = if whole > 0.0 { light / whole } else { 0.0 };
        whole * ((share * (1.0 - share)).max(0.0).sqrt() / count.powf(0.75)).max(1.0 / count)
    }
}
