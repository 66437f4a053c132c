//! What discs around a place hold, summed ring by ring from runs of photons.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use super::nearest::LEAST_AGREEMENT;
use super::sight::Place;
use crate::photon::PhotonPoint;

/// Discs around a place, each twice as wide as the one before.
pub(super) const DISCS: usize = 8;
/// A run is small where it reaches at most this share of its distance, or of half the narrowest radius.
const SMALL: f32 = 0.7;

/// What a disc holds, for each square of a scene unit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Held {
    /// Irradiance.
    pub(super) power: DVec3,
    /// Squares of photons' power, the mean of its three colours, in usual ones.
    pub(super) squares: f64,
}

/// What photons that are near to each other add up to.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Run {
    /// Mean position, by power as all means here.
    middle: Vec3,
    /// The farthest photon from the middle.
    reach: f32,
    normal: Vec3,
    /// Mean squared distance from the middle.
    spread: f32,
    power: Vec3,
    squares: f32,
}

/// How a run looks from a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Met {
    /// It is outside of all discs.
    Outside,
    /// It counts as one photon.
    Small,
    /// It has to be opened.
    Large,
}

/// The sums of the rings between discs around a place.
pub(super) struct Rings {
    position: Vec3,
    normal: Vec3,
    /// Squared radii of the discs.
    squared: [f32; DISCS],
    widest: f32,
    /// Power and squares, and both times the squared distance.
    sums: [[f64; 8]; DISCS],
}

/// The mean of three colours.
pub(super) fn mean(power: DVec3) -> f64 {
    power.element_sum() / 3.0
}

impl Run {
    pub(super) fn of(photon: &PhotonPoint, usual: f64) -> Self {
        let share = mean(photon.power.as_dvec3()) / usual.max(f64::MIN_POSITIVE);
        Self {
            middle: photon.position,
            reach: 0.0,
            normal: photon.normal,
            spread: 0.0,
            power: photon.power,
            squares: narrow(share * share),
        }
    }

    /// Of one or more.
    pub(super) fn sum(runs: &(impl Iterator<Item = Self> + Clone)) -> Self {
        // Without power, all count the same.
        let weighed = || runs.clone().map(|run| (mean(run.power.as_dvec3()) + f64::MIN_POSITIVE, run));
        let (mut whole, mut middle, mut normal) = (0.0, DVec3::ZERO, DVec3::ZERO);
        let (mut power, mut squares) = (DVec3::ZERO, 0.0);
        for (weight, run) in weighed() {
            whole += weight;
            middle += weight * run.middle.as_dvec3();
            normal += weight * run.normal.as_dvec3();
            power += run.power.as_dvec3();
            squares += f64::from(run.squares);
        }
        middle /= whole;
        let (mut reach, mut spread) = (0.0_f64, 0.0);
        for (weight, run) in weighed() {
            let away = run.middle.as_dvec3().distance_squared(middle);
            reach = reach.max(f64::from(run.reach) + away.sqrt());
            spread += weight * (f64::from(run.spread) + away);
        }
        Self {
            middle: middle.as_vec3(),
            reach: narrow(reach),
            normal: (normal / whole).as_vec3().normalize_or_zero(),
            spread: narrow(spread / whole),
            power: power.as_vec3(),
            squares: narrow(squares),
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "f32 is close enough")]
fn narrow(value: f64) -> f32 {
    value as f32
}

impl Rings {
    /// Nothing yet around a place, the narrowest disc of a radius in scene units.
    pub(super) fn new(place: &Place, narrowest: f64) -> Self {
        let squared = std::array::from_fn(|disc| narrow(radius(narrowest, disc).powi(2)));
        Self {
            position: place.position.as_vec3(),
            normal: place.normal.as_vec3(),
            squared,
            widest: narrow(radius(narrowest, DISCS - 1)),
            sums: [[0.0; 8]; DISCS],
        }
    }

    pub(super) fn meet(&self, run: &Run) -> Met {
        let squared = run.middle.distance_squared(self.position);
        if squared > (self.widest + run.reach).powi(2) {
            Met::Outside
        } else if run.reach * run.reach <= SMALL * SMALL * squared.max(0.25 * self.squared[0]) {
            Met::Small
        } else {
            Met::Large
        }
    }

    /// Adds a run to the rings, if it faces as the place does: as if it were spread evenly over squared
    /// distances, whose variance is that of an even disc.
    pub(super) fn add(&mut self, run: &Run) {
        if run.normal.dot(self.normal) <= narrow(LEAST_AGREEMENT) {
            return;
        }
        let away = run.middle.distance_squared(self.position);
        let aside = (run.spread * (6.0 * away + run.spread)).sqrt();
        let (mut begin, end) = ((away + run.spread - aside).max(0.0), away + run.spread + aside);
        let length = end - begin;
        let held = [run.power.x, run.power.y, run.power.z, run.squares].map(f64::from);
        for (sums, &outer) in self.sums.iter_mut().zip(&self.squared) {
            if begin >= outer {
                continue;
            }
            let part = end.min(outer);
            let share = f64::from(if length > 0.0 { (part - begin) / length } else { 1.0 });
            let squared = f64::from(0.5 * (begin + part));
            for (channel, value) in held.into_iter().enumerate() {
                sums[channel] += share * value;
                sums[channel + 4] += share * value * squared;
            }
            begin = part;
            if begin >= end {
                break;
            }
        }
    }

    /// The discs, each with all rings within it.
    pub(super) fn discs(&self, narrowest: f64) -> [Held; DISCS] {
        let mut sums = [0.0; 8];
        std::array::from_fn(|disc| {
            for (sum, ring) in sums.iter_mut().zip(self.sums[disc]) {
                *sum += ring;
            }
            let squared = radius(narrowest, disc).powi(2);
            let of = |channel: usize| {
                let weighed = sums[channel] - sums[channel + 4] / squared;
                (2.0 * weighed / (PI * squared)).max(0.0)
            };
            Held { power: DVec3::new(of(0), of(1), of(2)), squares: of(3) }
        })
    }
}

/// Of a disc.
pub(super) fn radius(narrowest: f64, disc: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "one of a few")]
    let doublings = disc as f64;
    narrowest * doublings.exp2()
}
