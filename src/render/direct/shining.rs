//! What a place gets rays to: the lights that bring it the most one by one, and all others together, so that
//! the number of rays does not grow with that of the lights.

use glam::DVec3;

use super::shadow_rays::Receiver;
use crate::render::rings::mean;
use crate::scene::{Light, Scene};

/// So many lights are looked at one by one.
const APART: usize = 16;
/// The number of all others together, beside those of lights.
const TOGETHER: u32 = u32::MAX;

/// A light, or many, as a place sees them.
#[derive(Debug)]
pub(super) enum Source<'a> {
    /// A light by its number, with its irradiance if nothing is between, where that has a closed form.
    One(u32, &'a Light, Option<DVec3>),
    /// Lights that are chosen by their irradiance, and the sum of it.
    Many(Vec<Choice<'a>>, DVec3),
}

/// A light among many.
#[derive(Debug)]
pub(super) struct Choice<'a> {
    light: &'a Light,
    /// The chance that it, or one before, is chosen, and the chance of it alone.
    up_to: f64,
    chance: f64,
}

/// Everything that would shine on a place if nothing were between.
pub(super) fn shining<'a>(scene: &'a Scene, position: DVec3, normal: DVec3) -> Vec<Source<'a>> {
    let mut known: Vec<(u32, &Light, DVec3)> = Vec::new();
    let mut all = Vec::new();
    for (number, light) in (0..).zip(scene.lights()) {
        match light.irradiance(position, normal) {
            Some(DVec3::ZERO) => {}
            Some(unblocked) => known.push((number, light, unblocked)),
            None => all.push(Source::One(number, light, None)),
        }
    }
    if known.len() > APART {
        known.sort_by(|(.., a), (.., b)| mean(*b).total_cmp(&mean(*a)));
        let others = known.split_off(APART);
        let unblocked: DVec3 = others.iter().map(|(.., unblocked)| unblocked).sum();
        let mut up_to = 0.0;
        let choice = |(_, light, own): (u32, &'a Light, DVec3)| {
            let chance = mean(own) / mean(unblocked);
            up_to += chance;
            Choice { light, up_to, chance }
        };
        all.push(Source::Many(others.into_iter().map(choice).collect(), unblocked));
    }
    all.extend(
        known.into_iter().map(|(number, light, unblocked)| Source::One(number, light, Some(unblocked))),
    );
    all
}

impl Source<'_> {
    pub(super) fn number(&self) -> u32 {
        match self {
            Self::One(number, ..) => *number,
            Self::Many(..) => TOGETHER,
        }
    }

    /// Its bit among 64.
    pub(super) fn bit(&self) -> u64 {
        1 << (self.number() % 64)
    }

    /// Irradiance if nothing is between; nothing if only samples can tell.
    pub(super) fn unblocked(&self) -> Option<DVec3> {
        match self {
            Self::One(.., unblocked) => *unblocked,
            Self::Many(_, unblocked) => Some(*unblocked),
        }
    }

    /// Whether one ray tells all.
    pub(super) fn is_point(&self) -> bool {
        matches!(self, Self::One(_, light, _) if light.is_point())
    }

    /// As [`Receiver::sample`], for a point of the unit square.
    pub(super) fn sample(
        &self,
        scene: &Scene,
        receiver: &Receiver,
        [u, v]: [f64; 2],
    ) -> Option<(DVec3, bool)> {
        match self {
            Self::One(_, light, _) => receiver.sample(scene, light, [u, v]),
            Self::Many(choices, _) => {
                let index = choices.partition_point(|choice| choice.up_to <= u).min(choices.len() - 1);
                let Choice { light, up_to, chance } = &choices[index];
                // Where u is within its part is as good as another number.
                let u = (1.0 - (up_to - u) / chance).clamp(0.0, 1.0 - f64::EPSILON);
                let (arrives, is_seen) = receiver.sample(scene, light, [u, v])?;
                Some((arrives / *chance, is_seen))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::*;

    /// A floor below 8 by 8 lamps, some of which face up.
    fn scene() -> Scene {
        let mut text = "
[camera]
position = [0, 1, 0]
direction = [0, -1, 0]
up = [0, 0, -1]
vertical_fov_degrees = 60
[materials]
grey = { lambert = [0.5, 0.5, 0.5] }
[surfaces.floor]
material = \"grey\"
quads = [[[-5, 0, 5], [5, 0, 5], [5, 0, -5], [-5, 0, -5]]]
"
        .to_owned();
        for lamp in 0..64 {
            let (x, z) = (f64::from(lamp % 8) - 3.5, f64::from(lamp / 8) - 3.5);
            let [near, far] = if lamp % 5 == 0 { [z - 0.1, z + 0.1] } else { [z + 0.1, z - 0.1] };
            let [left, right] = [x - 0.1, x + 0.1];
            write!(
                text,
                "[lights.lamp{lamp}]\nradiance = [{}, 1, 2]\nquad = [[{left}, 2, {far}], [{right}, 2, {far}], \
                 [{right}, 2, {near}], [{left}, 2, {near}]]\n",
                lamp % 3
            )
            .expect("writing to a string");
        }
        Scene::parse(&text).expect("a scene")
    }

    #[test]
    fn the_brightest_are_apart_and_the_others_bring_all_of_the_rest() {
        let scene = scene();
        let (position, normal) = (DVec3::new(0.7, 0.0, -0.4), DVec3::Y);
        let all = shining(&scene, position, normal);
        assert_eq!(all.len(), APART + 1);
        let total: DVec3 = scene.lights().iter().filter_map(|light| light.irradiance(position, normal)).sum();
        let found: DVec3 = all.iter().filter_map(Source::unblocked).sum();
        assert!(found.distance(total) < 1e-12 * total.length());
        let [Source::Many(choices, rest)] = &all[..1] else { panic!("{all:?}") };
        // A fifth of 64 lamps faces up, and 16 are apart.
        assert_eq!(choices.len(), 64 - 13 - 16);
        let darkest = all[1..].iter().filter_map(Source::unblocked).map(mean).fold(f64::INFINITY, f64::min);
        assert!(choices.iter().all(|choice| choice.chance * mean(*rest) <= darkest));

        // Samples of all of the square bring the irradiance in the mean.
        let receiver = Receiver::new(&scene, position, normal);
        let places = (0..256).flat_map(|x| (0..16).map(move |y| [x, y]));
        let sample = |[x, y]: [u32; 2]| {
            let uv = [(f64::from(x) + 0.5) / 256.0, (f64::from(y) + 0.5) / 16.0];
            all[0].sample(&scene, &receiver, uv).map_or(DVec3::ZERO, |(arrives, _)| arrives)
        };
        let sampled = places.map(sample).sum::<DVec3>() / 4096.0;
        assert!((sampled / *rest - 1.0).abs().max_element() < 0.02, "{sampled} {rest}");
    }

    #[test]
    fn few_lights_are_all_apart() {
        let scene = Scene::shipped("cornell-boxes").expect("shipped");
        let all = shining(&scene, DVec3::new(278.0, 0.0, 100.0), DVec3::Y);
        assert!(matches!(all[..], [Source::One(0, _, Some(_))]), "{all:?}");
        assert!(shining(&scene, DVec3::new(278.0, 548.7, 279.0), DVec3::Y).is_empty(), "behind the lamp");
    }
}
