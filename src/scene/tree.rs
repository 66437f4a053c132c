//! Trees of boxes in f32 (obvhs), which find what a ray may meet.
//!
//! The boxes are wider than what they hold by more than f32 loses, so that no candidate is missed. What f32
//! loses grows with the largest coordinate; so a ground or a stray thing that is a thousand times as large or
//! as far away as most of the scene gets a tree of its own, and does not make the boxes of all the others
//! coarse.

use std::time::Duration;

use glam::{DVec3, Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::ray::{Ray as BoxRay, RayHit};

use super::geometry::Geometry;
use crate::view::Ray;

/// By how much boxes are wider, at least, as a share of the largest coordinate: several times what f32 loses.
const BOX_MARGIN: f32 = 4e-6;
/// What reaches this many times as far from the middle as half of all primitives do is far.
const FAR: f32 = 1000.0;

/// Meeting a primitive in f64 takes about as long as meeting two boxes in f32: 20 % less time for photons in the
/// Cornell boxes than with the three steps of `medium_build`.
const PARAMETERS: BvhBuildParams =
    BvhBuildParams { max_prims_per_leaf: 4, collapse_traversal_cost: 1.0, ..BvhBuildParams::medium_build() };

/// The primitives of a part of the scene.
#[derive(Clone)]
pub(super) struct Tree {
    boxes: Bvh2,
    /// The number in the scene of each primitive.
    members: Vec<u32>,
    centre: DVec3,
    /// Radius of a sphere around the centre that holds everything.
    extent: f64,
    /// The largest distance of anything from the origin of coordinates, which decides how fine f32 is.
    pub(super) reach: f64,
}

impl Tree {
    /// A tree of most of the scene, and one of what is far, if anything is.
    pub(super) fn around(geometry: &Geometry) -> Vec<Self> {
        let around = geometry.boxes();
        let farthest = farthest_from_middle(&around);
        let usual = median(farthest.clone());
        let part = |wanted: bool| {
            let members =
                (0_u32..).zip(&farthest).filter(|&(_, &distance)| (distance > FAR * usual) == wanted);
            let members: Vec<u32> = members.map(|(number, _)| number).collect();
            (!members.is_empty()).then(|| Self::new(&around, members))
        };
        [part(false), part(true)].into_iter().flatten().collect()
    }

    fn new(around: &[(Vec3, Vec3)], members: Vec<u32>) -> Self {
        let own = || members.iter().map(|&number| around[number as usize]);
        let (min, max) = own().reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default();
        let reach = min.abs().max(max.abs()).max_element();
        let margin = (BOX_MARGIN * reach).max(f32::MIN_POSITIVE);
        let wide = |(number, (min, max)): (u32, (Vec3, Vec3))| {
            let margin = Vec3A::splat(margin * (1.0 + unlike(number)));
            Aabb::new(Vec3A::from(min) - margin, Vec3A::from(max) + margin)
        };
        let boxes: Vec<_> = members.iter().copied().zip(own()).map(wide).collect();
        Self {
            boxes: build_bvh2(&boxes, PARAMETERS, &mut Duration::default()),
            members,
            centre: (min.as_dvec3() + max.as_dvec3()) / 2.0,
            extent: (max.as_dvec3() - min.as_dvec3()).length() / 2.0,
            reach: f64::from(reach),
        }
    }

    /// Whether a place is within the sphere around everything here.
    pub(super) fn holds(&self, place: DVec3) -> bool {
        place.distance_squared(self.centre) <= 1.001 * self.extent * self.extent
    }

    /// Distance along the ray, less than `limit`, and the primitive; `meet` gives the distance to one.
    pub(super) fn nearest(
        &self,
        ray: &Ray,
        limit: f64,
        meet: impl Fn(&Ray, u32) -> Option<f64>,
    ) -> Option<(f64, u32)> {
        // Rounded up, so that a box that begins there is still opened.
        self.search(ray, limit, meet, rounded_up)
    }

    /// Whether anything is met before `limit`.
    pub(super) fn blocks(&self, ray: &Ray, limit: f64, meet: impl Fn(&Ray, u32) -> Option<f64>) -> bool {
        // The first that is found ends the search: no box is nearer than that.
        self.search(ray, limit, meet, |_| f32::NEG_INFINITY).is_some()
    }

    /// The last primitive that was found before `limit` and all found earlier; `rest` tells how far to look
    /// further when one is found.
    fn search(
        &self,
        ray: &Ray,
        limit: f64,
        meet: impl Fn(&Ray, u32) -> Option<f64>,
        rest: impl Fn(f64) -> f32,
    ) -> Option<(f64, u32)> {
        // From far away f32 is too coarse: such a ray starts where it may first meet something.
        let to_centre = self.centre - ray.origin;
        let skipped = if to_centre.length_squared() > 4.0 * self.extent * self.extent {
            (to_centre.dot(ray.direction) - 1.5 * self.extent).max(0.0)
        } else {
            0.0
        };
        let start = Ray { origin: ray.origin + skipped * ray.direction, ..*ray };

        let mut nearest = (limit - skipped, u32::MAX);
        let [origin, direction] = [start.origin, start.direction].map(|vector| vector.as_vec3().into());
        let box_ray = BoxRay::new(origin, direction, 0.0, rounded_up(nearest.0.max(0.0)));
        self.boxes.ray_traverse(box_ray, &mut RayHit::none(), |_, place| {
            let primitive = self.members[self.boxes.primitive_indices[place] as usize];
            let distance = meet(&start, primitive).unwrap_or(f64::INFINITY);
            if distance >= nearest.0 {
                return f32::INFINITY;
            }
            nearest = (distance, primitive);
            rest(distance)
        });
        (nearest.1 != u32::MAX).then_some((nearest.0 + skipped, nearest.1))
    }
}

fn rounded_up(distance: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "rounded up next")]
    let distance = distance as f32;
    distance.next_up()
}

/// A number from 0 to 1 of a primitive's own: without it the builder, which pairs boxes that are alike, would
/// make a chain of thousands that are the same.
fn unlike(number: u32) -> f32 {
    #[expect(clippy::cast_precision_loss, reason = "24 bits")]
    let share = (number.wrapping_mul(0x9e37_79b9) >> 8) as f32;
    share / 16_777_216.0
}

/// How far each box reaches from the middle of most of them.
fn farthest_from_middle(around: &[(Vec3, Vec3)]) -> Vec<f32> {
    let middle =
        |axis: usize| median(around.iter().map(|(min, max)| min[axis].midpoint(max[axis])).collect());
    let middle = Vec3::new(middle(0), middle(1), middle(2));
    around.iter().map(|(min, max)| (*max - middle).abs().max((*min - middle).abs()).max_element()).collect()
}

/// The middle one of some numbers, 0 if there is none.
fn median(mut numbers: Vec<f32>) -> f32 {
    let half = numbers.len() / 2;
    if numbers.is_empty() { 0.0 } else { *numbers.select_nth_unstable_by(half, f32::total_cmp).1 }
}
