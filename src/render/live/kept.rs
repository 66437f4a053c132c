//! Photons of the latest steps, which are counted again where the camera moves: they lie in the scene, and
//! not in the picture.

use std::collections::VecDeque;

use crate::photon::PhotonPoint;
use crate::view::View;

/// Landings step by step, the oldest first.
#[derive(Debug, Default)]
pub(super) struct Kept {
    steps: VecDeque<(u32, Vec<PhotonPoint>)>,
    landings: usize,
}

impl Kept {
    /// Adds a step's landings, of so many photons that left the lights, and lets go of the oldest steps as long
    /// as there are more than `most` landings.
    pub(super) fn push(&mut self, emitted: u32, landings: Vec<PhotonPoint>, most: usize) {
        self.landings += landings.len();
        self.steps.push_back((emitted, landings));
        while self.landings > most
            && let Some((_, oldest)) = self.steps.pop_front()
        {
            self.landings -= oldest.len();
        }
    }

    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Photons that left the lights for these landings.
    pub(super) fn emitted(&self) -> u64 {
        self.steps.iter().map(|(emitted, _)| u64::from(*emitted)).sum()
    }

    /// Landings that a view may see.
    pub(super) fn seen(&self, view: &View) -> Vec<PhotonPoint> {
        let landings = self.steps.iter().flat_map(|(_, landings)| landings);
        landings.copied().filter(|landing| landing.may_be_seen(view)).collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn the_oldest_steps_go_first() {
        let landing = PhotonPoint { position: Vec3::ZERO, normal: Vec3::Y, power: Vec3::ONE, surface: 1.0 };
        let mut kept = Kept::default();
        for (emitted, landings) in [(10, 3), (20, 4), (30, 2)] {
            kept.push(emitted, vec![landing; landings], 6);
        }
        assert_eq!((kept.emitted(), kept.landings), (50, 6));
        kept.push(5, Vec::new(), 6);
        assert_eq!((kept.emitted(), kept.landings), (55, 6), "steps in which nothing landed count as well");
        kept.push(40, vec![landing; 7], 6);
        assert_eq!((kept.emitted(), kept.landings), (0, 0), "a step that is larger than all is not kept");
    }
}
