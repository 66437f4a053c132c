//! Many photons at once, on all threads of the current rayon pool.
//!
//! Each photon has random numbers of its own, and parts are put together in the order of the photons'
//! numbers, so that the result is the same, bit for bit, whatever the number of threads.

use rayon::prelude::*;

use super::path::follow;
use super::{Emission, EmittedPhoton, FirstHit, Photon, Tally, TraceSettings};
use crate::scene::Scene;

/// Photons that one thread follows at a time.
const CHUNK: u32 = 1 << 11;
/// Photons whose landings are in memory at a time, 64 bytes each.
const BATCH: u32 = 1 << 16;

/// Landings of consecutive photons.
#[derive(Default)]
struct Part {
    photons: Vec<Photon>,
    tally: Tally,
}

/// Follows all photons of `emission`, and gives their landings to `each` in the order of their numbers, as
/// they come: the slices are those of consecutive photons, each photon's landings in the order of its way.
/// The number is that of the photons followed so far.
///
/// # Errors
/// Those of `each`.
pub fn trace_in_batches<E>(
    scene: &Scene,
    emission: &Emission<'_>,
    mut each: impl FnMut(&[Photon], u32) -> Result<(), E>,
) -> Result<Tally, E> {
    let settings = emission.settings();
    let mut tally = Tally::default();
    let mut begin = 0;
    while begin < settings.photons {
        let end = settings.photons.min(begin.saturating_add(BATCH));
        let parts = in_parallel(begin, end, |id, part| {
            follow(scene, settings, &emission.photon(id), None, &mut part.photons, &mut part.tally);
        });
        for part in &parts {
            each(&part.photons, end)?;
            tally.merge(&part.tally);
        }
        begin = end;
    }
    Ok(tally)
}

/// Follows all photons of `emission`: all landings, and their statistics.
#[must_use]
pub fn trace(scene: &Scene, emission: &Emission<'_>) -> (Vec<Photon>, Tally) {
    let mut photons = Vec::new();
    let traced = trace_in_batches(scene, emission, |landings, _| {
        photons.extend_from_slice(landings);
        Ok::<_, std::convert::Infallible>(())
    });
    let Ok(tally) = traced;
    (photons, tally)
}

/// Follows photons that start where the caller says; [`Emission::photon`] makes such ones.
///
/// # Panics
/// If there are more than `u32::MAX` photons.
#[must_use]
pub fn trace_from(
    scene: &Scene,
    settings: &TraceSettings,
    photons: &[EmittedPhoton],
) -> (Vec<Photon>, Tally) {
    let end = u32::try_from(photons.len()).expect("fewer than 2^32 photons");
    gather(in_parallel(0, end, |index, part| {
        follow(scene, settings, &photons[index as usize], None, &mut part.photons, &mut part.tally);
    }))
}

/// Goes on with photons whose first surface is known, as from a bounce map (thesis 2.6.1): the same as
/// [`trace_from`] where that is right, without casting the first ray.
///
/// # Panics
/// If there are more than `u32::MAX` photons.
#[must_use]
pub fn trace_from_hits(scene: &Scene, settings: &TraceSettings, hits: &[FirstHit]) -> (Vec<Photon>, Tally) {
    let end = u32::try_from(hits.len()).expect("fewer than 2^32 photons");
    gather(in_parallel(0, end, |index, part| {
        let FirstHit { photon, primitive } = &hits[index as usize];
        follow(scene, settings, photon, Some(*primitive), &mut part.photons, &mut part.tally);
    }))
}

fn in_parallel(begin: u32, end: u32, follow: impl Fn(u32, &mut Part) + Sync) -> Vec<Part> {
    let chunks = (begin..end).step_by(CHUNK as usize).collect::<Vec<_>>();
    let one = |begin: u32| {
        let mut part = Part::default();
        for index in begin..end.min(begin.saturating_add(CHUNK)) {
            follow(index, &mut part);
        }
        part
    };
    chunks.into_par_iter().map(one).collect()
}

fn gather(parts: Vec<Part>) -> (Vec<Photon>, Tally) {
    let mut tally = Tally::default();
    let mut photons = Vec::with_capacity(parts.iter().map(|part| part.photons.len()).sum());
    for part in parts {
        photons.extend(part.photons);
        tally.merge(&part.tally);
    }
    (photons, tally)
}
