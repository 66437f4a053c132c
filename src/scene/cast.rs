//! The first thing that a ray meets.
//!
//! Trees of boxes find the candidates, and each is met in f64. A new ray starts so close to its surface that
//! it stays on its side of the neighbours: light does not leak through the corners of a room. Of 10^7 photons
//! with 8 landings each in the Cornell box with its open side closed, none got out.

use glam::{DVec2, DVec3, Vec3};

use super::geometry::Geometry;
use super::intersect::{TriangleEdges, intersect_sphere};
use super::tree::Tree;
use crate::view::Ray;

/// How far from its surface a ray starts, as a share of the largest coordinate around it: a million times
/// what f64 loses.
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
    /// In the order of the scene.
    triangles: Vec<TriangleEdges>,
    spheres: Vec<(DVec3, f64)>,
    /// Most of the scene, and what is so much larger or farther away that it has a tree of its own.
    trees: Vec<Tree>,
}

impl Target {
    pub(super) fn new(geometry: &Geometry) -> Self {
        let corners = geometry.triangles.iter().map(|triangle| geometry.corners(triangle));
        let triangles = corners.map(|corners| {
            let [corner, b, c] = corners.map(Vec3::as_dvec3);
            TriangleEdges { corner, edge1: b - corner, edge2: c - corner }
        });
        let spheres =
            geometry.spheres.iter().map(|sphere| (sphere.centre.as_dvec3(), f64::from(sphere.radius)));
        Self { triangles: triangles.collect(), spheres: spheres.collect(), trees: Tree::around(geometry) }
    }

    /// Where a ray starts that leaves `position` on the side to which `normal` points.
    pub(super) fn start(&self, position: DVec3, normal: DVec3) -> DVec3 {
        let tree = self.trees.iter().find(|tree| tree.holds(position)).or(self.trees.last());
        position + START_MARGIN * tree.map_or(0.0, |tree| tree.reach) * normal
    }

    /// Distance along the ray, and the primitive.
    pub(super) fn nearest(&self, ray: &Ray) -> Option<(f64, u32)> {
        let mut nearest = None;
        for tree in &self.trees {
            let limit = nearest.map_or(f64::INFINITY, |(distance, _)| distance);
            nearest = tree.nearest(ray, limit, |ray, primitive| self.distance(ray, primitive)).or(nearest);
        }
        nearest
    }

    /// Whether anything is met before a distance along the ray.
    pub(super) fn blocks(&self, ray: &Ray, limit: f64) -> bool {
        self.trees.iter().any(|tree| tree.blocks(ray, limit, |ray, primitive| self.distance(ray, primitive)))
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
