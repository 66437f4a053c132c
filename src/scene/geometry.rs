//! Triangles and spheres, as they are rasterised and as rays see them.

use std::collections::BTreeMap;

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use glam::{Vec2, Vec3};

/// A corner of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Vertex {
    /// In scene units.
    pub position: Vec3,
    /// Of length 1: that of the face, or of the smooth surface that the triangles stand for.
    pub normal: Vec3,
    /// What reflectances are multiplied with there, linear RGB from 0 to 1; 1 without vertex colours.
    pub colour: Vec3,
    /// Where it lies in the material's reflectance texture, and in its emission texture.
    pub coordinates: [Vec2; 2],
}

impl Vertex {
    /// A corner without colour and texture coordinates.
    #[must_use]
    pub fn plain(position: Vec3, normal: Vec3) -> Self {
        Self { position, normal, colour: Vec3::ONE, coordinates: [Vec2::ZERO; 2] }
    }
}

/// Three corners, counter-clockwise as seen from the front.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Triangle {
    /// Indices into the vertices.
    pub vertices: [u32; 3],
    /// Index into the surfaces.
    pub surface: u32,
    /// Index into the materials.
    pub material: u32,
    /// Whether mirrors and glass bend light at the normals of the vertices instead of the face's.
    pub smooth: bool,
}

/// A sphere, whose front is its outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// In scene units.
    pub centre: Vec3,
    /// In scene units, more than zero.
    pub radius: f32,
    /// Index into the surfaces.
    pub surface: u32,
    /// Index into the materials.
    pub material: u32,
}

/// Everything that light meets, in the numbers of the scene's file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Geometry {
    /// Names of the surfaces.
    pub surfaces: Vec<String>,
    /// Corners; corners of faces that are not smooth are not shared.
    pub vertices: Vec<Vertex>,
    /// All triangles: primitives 0 and up.
    pub triangles: Vec<Triangle>,
    /// All spheres: the primitives after the triangles.
    pub spheres: Vec<Sphere>,
}

impl Geometry {
    /// The corners of a triangle.
    #[must_use]
    pub fn corners(&self, triangle: &Triangle) -> [Vec3; 3] {
        triangle.vertices.map(|index| self.vertices[index as usize].position)
    }

    /// Adds a flat triangle with corners of its own.
    pub(super) fn push_flat(&mut self, corners: [Vec3; 3], surface: u32, material: u32) {
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a).normalize().as_vec3();
        let first = u32::try_from(self.vertices.len()).expect("fewer than 2^32 vertices fit into memory");
        self.vertices.extend(corners.map(|position| Vertex::plain(position, normal)));
        self.triangles.push(Triangle {
            vertices: [first, first + 1, first + 2],
            surface,
            material,
            smooth: false,
        });
    }

    /// The opposite corners of the box around each primitive.
    pub(super) fn boxes(&self) -> Vec<(Vec3, Vec3)> {
        let around_triangles = self.triangles.iter().map(|triangle| {
            let [a, b, c] = self.corners(triangle);
            (a.min(b).min(c), a.max(b).max(c))
        });
        around_triangles.chain(self.spheres.iter().map(Sphere::around)).collect()
    }

    /// The opposite corners of the box around each surface, by the indices of surface and material.
    pub(super) fn boxes_of_surfaces(&self) -> BTreeMap<[u32; 2], (Vec3, Vec3)> {
        let triangles = self.triangles.iter().map(|triangle| [triangle.surface, triangle.material]);
        let spheres = self.spheres.iter().map(|sphere| [sphere.surface, sphere.material]);
        let mut around: BTreeMap<[u32; 2], (Vec3, Vec3)> = BTreeMap::new();
        for (of, (low, high)) in triangles.chain(spheres).zip(self.boxes()) {
            let known = around.entry(of).or_insert((low, high));
            *known = (known.0.min(low), known.1.max(high));
        }
        around
    }

    /// The opposite corners of the box around everything.
    #[must_use]
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let points = self.vertices.iter().map(|vertex| (vertex.position, vertex.position));
        points
            .chain(self.spheres.iter().map(Sphere::around))
            .reduce(|(min, max), (low, high)| (min.min(low), max.max(high)))
            .unwrap_or((Vec3::ZERO, Vec3::ZERO))
    }
}

/// The normal of a triangle, and the distance of its plane from `origin` along it, in scene units.
pub(crate) fn plane(corners: [Vec3; 3], origin: DVec3) -> (Vec3, f32) {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let normal = (b - a).cross(c - a).normalize();
    #[expect(clippy::cast_possible_truncation, reason = "what a shader takes")]
    let distance = normal.dot(a - origin) as f32;
    (normal.as_vec3(), distance)
}

impl Sphere {
    /// The opposite corners of the box around it.
    fn around(&self) -> (Vec3, Vec3) {
        (self.centre - self.radius, self.centre + self.radius)
    }

    /// A cube around the sphere, a little larger, as 36 corners of triangles for a rasteriser.
    pub(crate) fn cube(&self) -> [Vec3; 36] {
        // Six sides of two triangles each: an axis, its direction, and the corners in the plane across it.
        let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        std::array::from_fn(|index| {
            let (side, [u, v]) = (index / 6, square[index % 6]);
            let axis = side / 2;
            let mut away = [0.0; 3];
            (away[axis], away[(axis + 1) % 3], away[(axis + 2) % 3]) =
                (if side.is_multiple_of(2) { -1.0 } else { 1.0 }, u, v);
            self.centre + 1.001 * self.radius * Vec3::from(away)
        })
    }

    /// The sphere as triangles for a rasteriser: `rings` from pole to pole and twice as many around.
    ///
    /// Corners lie on the sphere, so that the triangles are inside it by at most about
    /// radius · (π / (2 `rings`))² at the middle of a face.
    ///
    /// # Panics
    /// If `rings` is less than 2 or more than 10000.
    #[must_use]
    pub fn tessellate(&self, rings: u16) -> (Vec<Vertex>, Vec<[u32; 3]>) {
        assert!((2..=10_000).contains(&rings), "{rings} rings");
        let around = 2 * u32::from(rings);
        let mut vertices = Vec::new();
        for ring in 0..=rings {
            let (sin_polar, cos_polar) =
                (std::f32::consts::PI * f32::from(ring) / f32::from(rings)).sin_cos();
            for step in 0..around {
                #[expect(clippy::cast_precision_loss, reason = "at most 20000")]
                let (sin, cos) = (std::f32::consts::TAU * step as f32 / around as f32).sin_cos();
                let normal = Vec3::new(sin_polar * cos, cos_polar, sin_polar * sin);
                vertices.push(Vertex::plain(self.centre + self.radius * normal, normal));
            }
        }
        let mut triangles = Vec::new();
        for ring in 0..u32::from(rings) {
            for step in 0..around {
                let next = (step + 1) % around;
                let [upper, upper_next] = [step, next].map(|step| ring * around + step);
                let [lower, lower_next] = [step, next].map(|step| (ring + 1) * around + step);
                // At the poles one of the two would have no area.
                if ring > 0 {
                    triangles.push([upper, upper_next, lower]);
                }
                if ring + 1 < u32::from(rings) {
                    triangles.push([upper_next, lower_next, lower]);
                }
            }
        }
        (vertices, triangles)
    }
}
