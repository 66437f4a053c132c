//! Lights that are far from everything else: which way their photons have to go to meet anything.

use glam::{DVec3, Vec3};

use super::direction::Cone;
use crate::scene::{AreaLight, Light, LightShape, Scene};

/// A light is far if it is this many times the radius of the sphere around everything else away from its
/// middle: then less than a sixtieth of all directions leads there.
const FAR: f64 = 4.0;

/// Corners times triangles of a light for which is asked whether it lights itself; with more, it is taken to
/// do so.
const MOST_PAIRS: usize = 1 << 24;
/// A corner this far before a triangle, as a share of its distance, is in the triangle's plane.
const IN_PLANE: f64 = 1e-6;

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
        Cone::new(away, height)
    }

    /// Where a photon that leaves a place in a direction starts: near the sphere, as nothing is before that.
    /// From far away its place and direction, which are kept in f32, would be too coarse.
    pub(super) fn near(&self, origin: DVec3, direction: DVec3) -> DVec3 {
        let skipped = (self.centre - origin).dot(direction) - 1.5 * self.radius;
        origin + skipped.max(0.0) * direction
    }
}

impl Aim {
    /// What a light is aimed at; nothing if it is not far, if there is nothing else, or if it lights itself.
    pub(super) fn of(scene: &Scene, light: &Light) -> Option<Self> {
        let others = scene.boxes().iter().filter(|&(of, _)| light.of != Some(*of)).map(|(_, &around)| around);
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
        let is_far = radius > 0.0 && distance > FAR * radius;
        let lights_itself = || matches!(&light.shape, LightShape::Area(area) if lights_itself(area));
        (is_far && !lights_itself()).then_some(Self { centre, radius })
    }
}

/// Whether any corner of the light is before one of its triangles, as in a bowl or between two panels.
fn lights_itself(light: &AreaLight) -> bool {
    let triangles = light.triangles();
    if 3 * triangles.len() * triangles.len() > MOST_PAIRS {
        return true;
    }
    triangles.iter().any(|triangle| {
        let [a, b, c] = triangle.map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a).normalize();
        triangles.iter().flatten().any(|corner| {
            let away = corner.as_dvec3() - a;
            normal.dot(away) > IN_PLANE * away.length()
        })
    })
}
