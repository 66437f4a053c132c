//! From a scene file to what light meets: a camera, lights, materials, triangles and spheres, and the rays
//! cast at them.
//!
//! The format of scene files is described in `assets/scenes/README.md`. Lengths are in the file's units,
//! colours are linear RGB, coordinates are right-handed.

mod build;
mod cast;
mod entries;
mod fields;
mod geometry;
mod intersect;
mod light;
mod light_place;
mod material;
mod mesh;
mod shipped;
mod source;
mod texture;
mod tree;
mod triangle_light;

pub use cast::Hit;
pub(crate) use geometry::plane;
pub use geometry::{Geometry, Sphere, Triangle, Vertex};
pub use intersect::{TriangleEdges, intersect_sphere};
pub(crate) use light::cap_height;
pub use light::{AreaLight, Light, LightSample, LightShape, area};
pub(crate) use light_place::LightPlace;
pub use material::{Material, Scattering};
pub use texture::{PlacedTexture, Texture, Wrap};
pub use triangle_light::irradiance_of_triangle;

pub use crate::view::{Camera, Ray};

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use glam::{DVec2, DVec3, UVec2, Vec2, Vec3};

use crate::error::{Error, Result};
use crate::view::View;
use cast::Target;
use shipped::SHIPPED;
use source::{Files, Text};

/// A scene, ready to be rasterised and for rays.
#[derive(Clone)]
pub struct Scene {
    /// A title to show.
    pub title: String,
    /// The unit of length, to show: `"mm"`.
    pub units: String,
    /// Where the picture is taken from; it may be moved at any time.
    pub camera: Camera,
    lights: Vec<Light>,
    materials: Vec<Material>,
    geometry: Geometry,
    target: Target,
    /// Whether reflectances differ within a material: by textures or by colours of vertices.
    has_patterns: bool,
    /// By the indices of surface and material.
    boxes: BTreeMap<[u32; 2], (Vec3, Vec3)>,
}

impl Scene {
    /// Reads a scene file and the meshes that it names.
    ///
    /// # Errors
    /// [`Error::File`] with the line and the field: what is missing, malformed, out of range, not a number or
    /// without area, an unknown material, a mesh that can't be read or lies outside the scene's folder.
    pub fn load(path: &Path) -> Result<Self> {
        let content = source::read(path)?;
        let content = source::text(path, &content)?;
        let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
        build::scene(&Text { path, content }, &Files::Folder(folder.to_owned()))
    }

    /// A scene from the text of a scene file that names no other files.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn parse(content: &str) -> Result<Self> {
        build::scene(&Text { path: Path::new("scene"), content }, &Files::Shipped(&[]))
    }

    /// A scene that comes with the program, by one of [`Scene::shipped_names`].
    ///
    /// # Errors
    /// If there is none of this name.
    pub fn shipped(name: &str) -> Result<Self> {
        let found = SHIPPED.iter().find(|shipped| shipped.name == name).ok_or_else(|| {
            let names = Self::shipped_names().collect::<Vec<_>>().join(", ");
            Error::file(name, "no scene of this name comes with the program", format!("use one of: {names}"))
        })?;
        build::scene(
            &Text { path: Path::new(found.file), content: found.content },
            &Files::Shipped(found.meshes),
        )
    }

    /// Names of the scenes that come with the program.
    pub fn shipped_names() -> impl Iterator<Item = &'static str> {
        SHIPPED.iter().map(|shipped| shipped.name)
    }

    fn new(
        title: String,
        units: String,
        camera: Camera,
        lights: Vec<Light>,
        materials: Vec<Material>,
        geometry: Geometry,
    ) -> Self {
        let target = Target::new(&geometry);
        let has_patterns = materials.iter().any(|material| material.reflectance_texture.is_some())
            || geometry.vertices.iter().any(|vertex| vertex.colour != Vec3::ONE);
        let boxes = geometry.boxes_of_surfaces();
        Self { title, units, camera, lights, materials, geometry, target, has_patterns, boxes }
    }

    /// Lights, in the order of their names; surfaces that shine come last.
    #[must_use]
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// Materials, by [`Triangle::material`] and [`Sphere::material`].
    #[must_use]
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// Triangles, spheres and the names of surfaces.
    #[must_use]
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// The opposite corners of the box around all surfaces, in scene units.
    #[must_use]
    pub fn bounds(&self) -> (Vec3, Vec3) {
        self.geometry.bounds()
    }

    /// The opposite corners of the box around each surface, by the indices of surface and material.
    pub(crate) fn boxes(&self) -> &BTreeMap<[u32; 2], (Vec3, Vec3)> {
        &self.boxes
    }

    /// The scene as its camera sees it in a picture of `size`, all of it between the near and the far plane.
    #[must_use]
    pub fn view(&self, size: UVec2) -> View {
        let (min, max) = self.bounds();
        View::new(&self.camera, self.camera.depth_range(min, max), size)
    }

    /// The first surface that the ray meets.
    #[must_use]
    pub fn cast(&self, ray: &Ray) -> Option<Hit> {
        let (distance, primitive) = self.target.nearest(ray)?;
        Some(self.target.hit(&self.geometry, ray, distance, primitive))
    }

    /// Whether the ray meets anything before a distance in scene units.
    #[must_use]
    pub fn is_blocked(&self, ray: &Ray, distance: f64) -> bool {
        self.target.blocks(ray, distance)
    }

    /// Where the ray meets one primitive, whatever is before it.
    #[must_use]
    pub fn cast_at(&self, ray: &Ray, primitive: u32) -> Option<Hit> {
        let distance = self.target.distance(ray, primitive)?;
        Some(self.target.hit(&self.geometry, ray, distance, primitive))
    }

    /// What the surface does with light where it was hit: the material's scattering, with textures and
    /// colours of vertices.
    #[must_use]
    pub fn scattering(&self, hit: &Hit) -> Scattering {
        let material = &self.materials[hit.material as usize];
        if !self.has_patterns {
            return material.scattering;
        }
        let Some((vertices, shares)) = self.corners_around(hit) else { return material.scattering };
        let [a, b, c] = vertices.map(|vertex| vertex.colour);
        let Vec2 { x: second, y: third } = shares.as_vec2();
        let colour = (1.0 - second - third) * a + second * b + third * c;
        let texel = material.reflectance_texture.as_ref().map_or(Vec3::ONE, |texture| {
            texture.between(vertices.map(|vertex| vertex.coordinates[0]), shares)
        });
        material.scattering.times((colour * texel).clamp(Vec3::ZERO, Vec3::ONE))
    }

    /// Whether places are seen in a mirror or through glass anywhere.
    #[must_use]
    pub fn has_mirrors_or_glass(&self) -> bool {
        self.materials.iter().any(|material| !matches!(material.scattering, Scattering::Lambert(_)))
    }

    /// Whether reflectances differ within a material, so that [`scattering`](Self::scattering) has to be
    /// called at each place.
    #[must_use]
    pub fn has_patterns(&self) -> bool {
        self.has_patterns
    }

    /// Radiance that leaves the surface by itself, where it was hit, against `direction`; zero at its back.
    #[must_use]
    pub fn emission(&self, hit: &Hit, direction: DVec3) -> Vec3 {
        let material = &self.materials[hit.material as usize];
        if material.emission == Vec3::ZERO || hit.normal.dot(direction) >= 0.0 {
            return Vec3::ZERO;
        }
        let Some(texture) = &material.emission_texture else { return material.emission };
        let Some((vertices, shares)) = self.corners_around(hit) else { return material.emission };
        material.emission * texture.between(vertices.map(|vertex| vertex.coordinates[1]), shares)
    }

    /// The corners of the triangle that was hit, and the shares of the second and third; nothing for a
    /// sphere.
    fn corners_around(&self, hit: &Hit) -> Option<([&Vertex; 3], DVec2)> {
        let shares = self.target.shares(hit.primitive, hit.position)?;
        let triangle = &self.geometry.triangles[hit.primitive as usize];
        Some((triangle.vertices.map(|vertex| &self.geometry.vertices[vertex as usize]), shares))
    }

    /// Where a ray starts that leaves a surface at `position` on the side to which `normal` points: so close
    /// to it that it does not pass a neighbour, and not so close that it meets the surface again.
    #[must_use]
    pub fn start(&self, position: DVec3, normal: DVec3) -> DVec3 {
        self.target.start(position, normal)
    }
}

impl fmt::Debug for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Scene")
            .field("title", &self.title)
            .field("camera", &self.camera)
            .field("lights", &self.lights)
            .field("materials", &self.materials)
            .field("surfaces", &self.geometry.surfaces)
            .finish_non_exhaustive()
    }
}
