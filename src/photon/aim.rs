//! Lights that are far from everything else: which way their photons have to go to meet anything.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};

use super::emission::{Cone, Leaving};
use crate::scene::{Light, LightShape, Ray, Scene};

/// A light is far if it is this many times the radius of the sphere around everything else away from its middle: then less than a
/// sixtieth of all directions leads there.
const FAR: f64 = 4.0;

/// What the photons of a far light are aimed at: a sphere around everything but the light itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Aim {
    centre: DVec3,
    radius: f64,
}

impl Aim {
    /// The directions from a place to the sphere; the place is outside of it.
    pub(super) fn cone(&self, place: DVec3) -> Cone {
        let away = self.centre - place;
        let sin = (self.radius / away.length()).min(1.0);
        // 1 - cos without loss for small angles.
        let height = sin * sin / (1.0 + (1.0 - sin * sin).sqrt());
        Cone { axis: away.normalize(), height }
    }

    /// Where a photon starts: as near to the sphere as its light lets it. From far away its place and direction, which are kept in
    /// f32, would be too coarse.
    pub(super) fn near(&self, scene: &Scene, leaving: &Leaving) -> DVec3 {
        let Leaving { origin, direction, .. } = *leaving;
        let skipped = (self.centre - origin).dot(direction) - 1.5 * self.radius;
        let own = scene.cast(&Ray { origin, direction }).is_some_and(|hit| hit.distance < skipped);
        if own || skipped <= 0.0 { origin } else { origin + skipped * direction }
    }
}

/// Where the parts of a scene lie.
pub(super) struct Surroundings {
    /// Boxes around the triangles and spheres of each surface and material.
    boxes: BTreeMap<(u32, u32), (Vec3, Vec3)>,
    /// Names of the surfaces, as lights have them that are surfaces.
    names: Vec<String>,
    shining: Vec<bool>,
}

impl Surroundings {
    pub(super) fn new(scene: &Scene) -> Self {
        let geometry = scene.geometry();
        let mut boxes: BTreeMap<(u32, u32), (Vec3, Vec3)> = BTreeMap::new();
        let mut add = |surface, material, low: Vec3, high: Vec3| {
            let known = boxes.entry((surface, material)).or_insert((low, high));
            *known = (known.0.min(low), known.1.max(high));
        };
        for triangle in &geometry.triangles {
            for corner in geometry.corners(triangle) {
                add(triangle.surface, triangle.material, corner, corner);
            }
        }
        for sphere in &geometry.spheres {
            let (low, high) = (sphere.centre - sphere.radius, sphere.centre + sphere.radius);
            add(sphere.surface, sphere.material, low, high);
        }
        let shining = scene.materials().iter().map(|material| material.emission != Vec3::ZERO).collect();
        Self { boxes, names: geometry.surfaces.clone(), shining }
    }

    /// What a light is aimed at; nothing if it is not far, or if there is nothing else.
    pub(super) fn aim(&self, light: &Light) -> Option<Aim> {
        let is_own = |&(surface, material): &(u32, u32)| {
            matches!(light.shape, LightShape::Area(_))
                && self.shining[material as usize]
                && self.names[surface as usize] == light.name
        };
        let others = self.boxes.iter().filter(|(of, _)| !is_own(of)).map(|(_, &around)| around);
        let (low, high) = others.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let centre = low.as_dvec3().midpoint(high.as_dvec3());
        let radius = (high.as_dvec3() - low.as_dvec3()).length() / 2.0;
        let (nearest, farthest) = match &light.shape {
            LightShape::Point { position, .. } => (*position, *position),
            LightShape::Area(area) => {
                let corners = area.triangles().iter().flatten().copied();
                corners.map(|corner| (corner, corner)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?
            }
        };
        let distance = (centre - centre.clamp(nearest.as_dvec3(), farthest.as_dvec3())).length();
        (radius > 0.0 && distance > FAR * radius).then_some(Aim { centre, radius })
    }
}
