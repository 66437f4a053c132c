//! Direct light with soft shadows: what arrives if nothing is between, in closed form, times the share that
//! shadow rays see, on the CPU.
//!
//! - A few rays from each place tell whether it sees all of a light, nothing or a part. Where places around
//!   see all or nothing alike, so does this one, and there is no noise. Elsewhere there is penumbra, which
//!   gets twice the rays again and again, until their share is known well enough. Where these find a part,
//!   the places around are looked at in the same way, until no more are found.
//! - Places on a light are spread evenly by its power; glass casts a hard shadow, since photons bring the
//!   light that passes it.
//! - Where many lights shine, those that bring the most get rays one by one, and the others together.
//! - A light with a texture or many triangles has no closed form: its samples say how bright it is, and it
//!   gets as many rays as penumbras do.

mod samples;
mod shadow_rays;
mod shining;

pub(super) use samples::Samples;
pub(super) use shadow_rays::{Receiver, ShadowRays};

use std::f64::consts::PI;
use std::ops::Range;

use glam::{DVec3, IVec2, UVec2, Vec3};
use rayon::prelude::*;

use super::neighbours::Neighbours;
use super::rings::mean;
use super::sight::Place;
use crate::scene::Scene;
use shining::{Source, shining};

/// Rays of each place to each light, at first.
const FIRST: u32 = 4;
/// Places so many pixels away, along rows and columns, see the same, or there is penumbra.
const AROUND: i32 = 2;
/// A penumbra gets so many times its first rays at the most.
const MOST_DOUBLINGS: u32 = 4;
/// Rays are enough where the error of a light's share is this part of all direct light.
const TOLERANCE: f64 = 0.02;
/// Or of this part of what would arrive if nothing were between: what is nearly dark needs no more.
const DARK: f64 = 0.25;
/// Samples where no other could shine on the place: far behind those that any place takes.
const LAST_RESORT: [Range<u32>; 3] = [
    samples::MOST - 1024..samples::MOST - 960,
    samples::MOST - 960..samples::MOST - 704,
    samples::MOST - 704..samples::MOST,
];
/// A place with fewer others around, itself included, gets as many rays as a penumbra.
const ENOUGH_AROUND: u32 = 9;
/// Parts of the work, so that progress can be told.
const PART: usize = 1 << 14;

/// Shadow rays of a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct DirectRays<'a> {
    pub(super) scene: &'a Scene,
    /// Rays of a place in penumbra to each light, at first.
    pub(super) samples: u32,
    pub(super) seed: u64,
}

/// What the rays of a place saw so far. Lights are bits, by their number modulo 64.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    irradiance: DVec3,
    unblocked: DVec3,
    /// Lights that were seen by every ray, by none, and by some or without a closed form.
    whole: u64,
    dark: u64,
    open: u64,
}

impl Seen {
    fn add(&mut self, source: &Source<'_>, rays: &ShadowRays) {
        let unblocked = source.unblocked();
        let irradiance = rays.irradiance(unblocked);
        self.irradiance += irradiance;
        self.unblocked += unblocked.unwrap_or(irradiance);
        if !source.is_point() {
            let kind = if rays.is_mixed() || unblocked.is_none() {
                &mut self.open
            } else if rays.sees_all() {
                &mut self.whole
            } else {
                &mut self.dark
            };
            *kind |= source.bit();
        }
    }
}

impl DirectRays<'_> {
    /// Radiance of direct light that each place sends to the camera, for a picture of `size`; places are in
    /// the order of their pixels. `show` is told the done share.
    pub(super) fn reflected(&self, size: UVec2, places: &[Place], show: &mut dyn FnMut(f64)) -> Vec<DVec3> {
        let mut seen =
            in_parts(places.len(), |index| self.first(number(index), &places[index]), &mut |done| {
                show(0.5 * done);
            });
        let around = Neighbours::new(size, places);
        let mut is_refined = vec![false; places.len()];
        let mut front: Vec<usize> = (0..places.len()).collect();
        let mut left = 0.5;
        loop {
            let is_due = |index: &usize| !is_refined[*index] && open(&around, &seen, *index) != 0;
            let due: Vec<usize> = front.into_par_iter().filter(is_due).collect();
            if due.is_empty() {
                break;
            }
            let refined = |at: usize| {
                let index = due[at];
                self.refined(number(index), &places[index], &seen[index], open(&around, &seen, index))
            };
            let found = in_parts(due.len(), refined, &mut |done| show(1.0 - left + 0.5 * left * done));
            for (&index, found) in due.iter().zip(found) {
                (seen[index], is_refined[index]) = (found, true);
            }
            front = due.par_iter().flat_map_iter(|&index| beside(&around, index)).collect();
            front.par_sort_unstable();
            front.dedup();
            left *= 0.5;
        }
        let radiance = |(place, seen): (&Place, &Seen)| place.share.as_dvec3() * seen.irradiance / PI;
        places.iter().zip(&seen).map(radiance).collect()
    }

    /// Radiance that one place sends to the camera, by some samples of each light out of those that a number
    /// has.
    pub(super) fn radiance(&self, number: u32, place: &Place, samples: Range<u32>) -> DVec3 {
        if place.share == Vec3::ZERO {
            return DVec3::ZERO;
        }
        let receiver = Receiver::new(self.scene, place.position, place.normal);
        let of = |source: Source<'_>| {
            self.rays(number, &source, &receiver, samples.clone()).irradiance(source.unblocked())
        };
        let sources = shining(self.scene, place.position, place.normal);
        place.share.as_dvec3() * sources.into_iter().map(of).sum::<DVec3>() / PI
    }

    /// What a place sees by its first rays.
    fn first(&self, index: u32, place: &Place) -> Seen {
        // What reflects nothing, as most lights, needs no shadow rays.
        if place.share == Vec3::ZERO { Seen::default() } else { self.look(index, place, 0, f64::INFINITY) }
    }

    /// The same with more rays to the lights that are open.
    fn refined(&self, index: u32, place: &Place, first: &Seen, open: u64) -> Seen {
        // The errors of several lights add up as those of chance do.
        let share = TOLERANCE / f64::from(open.count_ones().max(1)).sqrt();
        let enough = share * mean(first.irradiance).max(DARK * mean(first.unblocked));
        self.look(index, place, open, enough)
    }

    /// What a place sees by a few rays to each light, and to those that are open by as many as it takes until
    /// irradiance is off by no more than `enough`.
    fn look(&self, index: u32, place: &Place, open: u64, enough: f64) -> Seen {
        let receiver = Receiver::new(self.scene, place.position, place.normal);
        let mut seen = Seen::default();
        for source in shining(self.scene, place.position, place.normal) {
            let is_open = open & source.bit() != 0 && !source.is_point();
            let first = if is_open { self.samples } else { FIRST.min(self.samples) };
            let mut rays = self.rays(index, &source, &receiver, 0..first);
            for doubling in 1..=if is_open { MOST_DOUBLINGS } else { 0 } {
                if rays.error(source.unblocked()) <= enough {
                    break;
                }
                let [from, to] = [doubling - 1, doubling]
                    .map(|doublings| self.samples.saturating_mul(1 << doublings).min(samples::MOST));
                let spread = self.samples_of(index, &source);
                rays.take(spread, from..to, |uv| source.sample(self.scene, &receiver, uv));
            }
            seen.add(&source, &rays);
        }
        seen
    }

    fn rays(&self, index: u32, source: &Source<'_>, receiver: &Receiver, samples: Range<u32>) -> ShadowRays {
        let mut rays = ShadowRays::default();
        let spread = self.samples_of(index, source);
        let sample = |uv| source.sample(self.scene, receiver, uv);
        if source.is_point() {
            rays.take(spread, 0..1, sample);
            return rays;
        }
        rays.take(spread, samples, sample);
        // Of a light that is mostly behind the place, those before do not count.
        for more in LAST_RESORT {
            if !rays.met_nothing() {
                break;
            }
            rays.take(spread, more, sample);
        }
        rays
    }

    fn samples_of(&self, index: u32, source: &Source<'_>) -> Samples {
        Samples::new(self.seed, index, source.number())
    }
}

/// Lights that a place sees otherwise than those around it, or in part, as one of these may.
fn open(around: &Neighbours<'_>, seen: &[Seen], index: usize) -> u64 {
    let own = seen[index];
    let mut open = own.open;
    let mut count = 0;
    for other in beside(around, index) {
        let other = seen[other];
        count += 1;
        open |= other.open | own.whole & other.dark | own.dark & other.whole;
    }
    if count < ENOUGH_AROUND {
        open = u64::MAX;
    }
    // Lights of one bit may differ among themselves.
    (open | own.whole & own.dark) & (own.whole | own.dark | own.open)
}

/// A place, and those of its surface that are [`AROUND`] it.
fn beside(around: &Neighbours<'_>, index: usize) -> impl Iterator<Item = usize> {
    let aways = (-AROUND..=AROUND).flat_map(|y| (-AROUND..=AROUND).map(move |x| IVec2::new(x, y)));
    aways.flat_map(move |away| around.of(&around.places[index], away))
}

/// A value for each number below `count`, on all threads.
fn in_parts<T: Send>(count: usize, of: impl Fn(usize) -> T + Sync, show: &mut dyn FnMut(f64)) -> Vec<T> {
    let mut all = Vec::with_capacity(count);
    while all.len() < count {
        let end = count.min(all.len() + PART);
        all.par_extend((all.len()..end).into_par_iter().map(&of));
        #[expect(clippy::cast_precision_loss, reason = "a share")]
        show(all.len() as f64 / count as f64);
    }
    all
}

fn number(index: usize) -> u32 {
    u32::try_from(index).expect("fewer than 2^32 places")
}
