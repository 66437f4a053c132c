//! The first thing that a ray meets.
//!
//! A tree of boxes (obvhs) finds the candidates in f32, and each is met in f64. The boxes are wider than what they
//! hold by more than f32 loses, so that no candidate is missed, and a new ray starts so close to its surface that it
//! stays on its side of the neighbours: light does not leak through the corners of a room. Of 10^7 photons with 8 landings
//! each in the Cornell box with its open side closed, none got out.

use std::time::Duration;

use glam::{DVec2, DVec3, Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::ray::{Ray as BoxRay, RayHit};

use super::geometry::Geometry;
use super::intersect::{TriangleEdges, intersect_sphere};
use crate::view::Ray;

/// By how much boxes are wider, as a share of the scene's extent: several times what f32 loses.
const BOX_MARGIN: f32 = 4e-6;
/// How far from its surface a ray starts, as a share of the scene's extent: a million times what f64 loses.
const START_MARGIN: f64 = 1e-10;

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// From the ray's origin, in scene units.
    pub distance: f64,
    /// In scene units.
    pub position: DVec3,
    /// Of length 1, at the front of the face or outside of the sphere.
    pub normal: DVec3,
    /// The same for the smooth surface that the triangles stand for.
    pub smooth_normal: DVec3,
    /// Index of the triangle, or the number of triangles plus the index of the sphere.
    pub primitive: u32,
    /// Index into the surfaces.
    pub surface: u32,
    /// Index into the materials.
    pub material: u32,
}

/// What rays are cast at.
#[derive(Clone)]
pub(super) struct Target {
    boxes: Bvh2,
    /// In the order of the scene.
    triangles: Vec<TriangleEdges>,
    spheres: Vec<(DVec3, f64)>,
    centre: DVec3,
    /// Radius of a sphere around the centre that holds everything.
    extent: f64,
    /// The largest distance of anything from the origin of coordinates, which decides how fine f32 is.
    reach: f64,
}

impl Target {
    pub(super) fn new(geometry: &Geometry) -> Self {
        let (min, max) = geometry.bounds();
        let reach = min.abs().max(max.abs()).max_element();
        let margin = Vec3A::splat((BOX_MARGIN * reach).max(f32::MIN_POSITIVE));
        let wide = |min: Vec3, max: Vec3| Aabb::new(Vec3A::from(min) - margin, Vec3A::from(max) + margin);

        let corners = geometry.triangles.iter().map(|triangle| geometry.corners(triangle));
        let around_triangles = corners.clone().map(|[a, b, c]| wide(a.min(b).min(c), a.max(b).max(c)));
        let around_spheres = geometry
            .spheres
            .iter()
            .map(|sphere| wide(sphere.centre - sphere.radius, sphere.centre + sphere.radius));
        let around: Vec<_> = around_triangles.chain(around_spheres).collect();
        let triangles = corners.map(|corners| {
            let [corner, b, c] = corners.map(Vec3::as_dvec3);
            TriangleEdges { corner, edge1: b - corner, edge2: c - corner }
        });
        let spheres =
            geometry.spheres.iter().map(|sphere| (sphere.centre.as_dvec3(), f64::from(sphere.radius)));
        let mut time = Duration::ZERO;
        Self {
            boxes: build_bvh2(&around, BvhBuildParams::medium_build(), &mut time),
            triangles: triangles.collect(),
            spheres: spheres.collect(),
            centre: (min.as_dvec3() + max.as_dvec3()) / 2.0,
            extent: (max.as_dvec3() - min.as_dvec3()).length() / 2.0,
            reach: f64::from(reach),
        }
    }

    /// Where a ray starts that leaves `position` on the side to which `normal` points.
    pub(super) fn start(&self, position: DVec3, normal: DVec3) -> DVec3 {
        position + START_MARGIN * self.reach * normal
    }

    /// Distance along the ray, and the primitive.
    pub(super) fn nearest(&self, ray: &Ray) -> Option<(f64, u32)> {
        // From far away f32 is too coarse: such a ray starts where it may first meet something.
        let to_centre = self.centre - ray.origin;
        let skipped = if to_centre.length_squared() > 4.0 * self.extent * self.extent {
            (to_centre.dot(ray.direction) - 1.5 * self.extent).max(0.0)
        } else {
            0.0
        };
        let start = Ray { origin: ray.origin + skipped * ray.direction, ..*ray };

        let mut nearest = (f64::INFINITY, u32::MAX);
        let box_ray = BoxRay::new_inf(start.origin.as_vec3().into(), start.direction.as_vec3().into());
        self.boxes.ray_traverse(box_ray, &mut RayHit::none(), |_, place| {
            let primitive = self.boxes.primitive_indices[place];
            let distance = self.distance(&start, primitive).unwrap_or(f64::INFINITY);
            if distance >= nearest.0 {
                return f32::INFINITY;
            }
            nearest = (distance, primitive);
            // Rounded up, so that a box that begins there is still opened.
            #[expect(clippy::cast_possible_truncation, reason = "rounded up next")]
            let limit = (distance as f32).next_up();
            limit
        });
        (nearest.1 != u32::MAX).then_some((nearest.0 + skipped, nearest.1))
    }

    /// Distance along the ray to one primitive.
    pub(super) fn distance(&self, ray: &Ray, primitive: u32) -> Option<f64> {
        let primitive = primitive as usize;
        if let Some(triangle) = self.triangles.get(primitive) {
            return triangle.intersect(ray).map(|(distance, _)| distance);
        }
        let (centre, radius) = *self.spheres.get(primitive - self.triangles.len())?;
        intersect_sphere(ray, centre, radius)
    }

    /// The shares of the second and third corner of the triangle at `position`; nothing for a sphere.
    pub(super) fn shares(&self, primitive: u32, position: DVec3) -> Option<DVec2> {
        self.triangles.get(primitive as usize).map(|edges| edges.shares(position))
    }

    /// All about the place at `distance` along the ray, which is on `primitive`.
    pub(super) fn hit(&self, geometry: &Geometry, ray: &Ray, distance: f64, primitive: u32) -> Hit {
        let position = ray.origin + distance * ray.direction;
        let index = primitive as usize;
        if let Some(triangle) = geometry.triangles.get(index) {
            let edges = &self.triangles[index];
            let across = edges.edge1.cross(edges.edge2);
            let normal = across.normalize();
            let smooth_normal = if triangle.smooth {
                let DVec2 { x: second, y: third } = edges.shares(position);
                let [a, b, c] =
                    triangle.vertices.map(|vertex| geometry.vertices[vertex as usize].normal.as_dvec3());
                ((1.0 - second - third) * a + second * b + third * c).normalize_or(normal)
            } else {
                normal
            };
            let (surface, material) = (triangle.surface, triangle.material);
            return Hit { distance, position, normal, smooth_normal, primitive, surface, material };
        }
        let sphere = &geometry.spheres[index - geometry.triangles.len()];
        let (centre, radius) = (sphere.centre.as_dvec3(), f64::from(sphere.radius));
        let normal = (position - centre) / radius;
        let (surface, material) = (sphere.surface, sphere.material);
        Hit { distance, position, normal, smooth_normal: normal, primitive, surface, material }
    }
}
