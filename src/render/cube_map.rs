//! What is nearest around a place, rasterised: six maps, one for each side of a cube (thesis 2.2, 2.6.1).
//!
//! - A texel holds the nearest triangle or sphere in its direction, from 1; the triangles come first, in the
//!   order of the scene, then the spheres. 0 is nothing.
//! - The depth test is by the distance from the place, not by z of the projection, which would be coarse far
//!   away.
//! - Sides may reach beyond the cube's edges by some texels, so that a texel at an edge has all its
//!   neighbours.
//! - Cost: a draw of the scene for each side.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat4, UVec2, Vec3};

use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, StateGuard, Target, Texture, TextureFormat, Vertices, glsl,
};
use crate::scene::{Camera, LightPlace, Scene, plane};

const TRIANGLES: &str = "cube map of triangles";
const SPHERES: &str = "cube map of spheres";

/// The near plane, as a share of the largest distance.
pub(crate) const NEAREST: f32 = 1e-12;

/// Sides of a cube.
pub(crate) const FACES: usize = 6;

/// As `render/surfaces/triangles.vert` takes it.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Corner {
    position: Vec3,
    normal: Vec3,
    unused: [f32; 3],
    distance: f32,
    number: f32,
}

/// As `render/surfaces/spheres.vert` takes it.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct CubeCorner {
    position: Vec3,
    centre: Vec3,
    unused: [f32; 3],
    radius: f32,
    number: f32,
}

/// The maps of one scene, one at a time.
#[derive(Debug)]
pub(crate) struct CubeMap {
    gl: Gl,
    programs: [Program; 2],
    triangles: Vertices,
    spheres: Vertices,
    map: Target,
    fov_degrees: f32,
    /// The scene's middle, and the length of its diagonal.
    centre: Vec3,
    extent: f32,
}

impl CubeMap {
    /// Maps of `side` columns and rows, of which `border` on each edge lie beyond the cube's.
    pub(crate) fn new(gl: &Gl, scene: &Scene, side: u16, border: u16) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let [triangles, spheres] = sources();
        let programs = [Program::new(gl, &triangles)?, Program::new(gl, &spheres)?];
        let map = Texture::new(gl, TextureFormat::R32Uint, UVec2::splat(side.into()), 1)?;
        let (min, max) = scene.bounds();
        let extent = (max - min).length();
        let wider = f32::from(side) / f32::from(side - 2 * border);
        Ok(Self {
            gl: gl.clone(),
            programs,
            triangles: Vertices::upload(gl, &corners(scene), &[3, 3, 3, 1, 1])?.labelled(TRIANGLES),
            spheres: Vertices::upload(gl, &cubes(scene), &[3, 3, 3, 1, 1])?.labelled(SPHERES),
            map: Target::with_depth(gl, vec![map])?.labelled(&["cube map"]),
            fov_degrees: 2.0 * wider.atan().to_degrees(),
            centre: min.midpoint(max),
            extent,
        })
    }

    /// One side of the cube around `place`.
    pub(crate) fn draw(&mut self, place: Vec3, face: usize) -> Result<&Texture> {
        let _state = StateGuard::new(&self.gl)?;
        let to_clip = self.to_clip(place, face);
        let (far, [to_corner, to_right, to_next_row]) = (self.far(place), self.rays(face));
        self.map.clear(&[0]);
        self.map.clear_depth();
        for (label, program, vertices) in
            [(TRIANGLES, &self.programs[0], &self.triangles), (SPHERES, &self.programs[1], &self.spheres)]
        {
            let pass = Pass::new(label, program)
                .set("to_clip", to_clip)
                .set("camera", place)
                .set("to_corner", to_corner)
                .set("to_right", to_right)
                .set("to_next_row", to_next_row)
                .set("far", far);
            let pass = if label == TRIANGLES { pass.set("plane_origin", Vec3::ZERO) } else { pass };
            pass.draw_triangles(vertices, &mut self.map)?;
        }
        self.gl.check("drawing a cube map")?;
        Ok(self.map.texture())
    }

    /// From scene units to the clip space of one side.
    pub(crate) fn to_clip(&self, place: Vec3, face: usize) -> Mat4 {
        let [direction, up] = axes(face);
        let camera = Camera { position: place, direction, up, vertical_fov_degrees: self.fov_degrees };
        let far = self.far(place);
        // Depth is the shaders' own, so that the near plane only has to be before everything.
        camera.projection(1.0, NEAREST * far, far) * camera.view()
    }

    /// From `place` to the corner of a side at depth 1, and to the next column and row.
    fn rays(&self, face: usize) -> [Vec3; 3] {
        let [direction, up] = axes(face);
        let half = (self.fov_degrees.to_radians() / 2.0).tan();
        let right = direction.cross(up);
        let texel = 2.0 * half / self.map.size().as_vec2().x;
        [direction - half * (right + up), texel * right, texel * up]
    }

    /// A distance from `place` beyond everything.
    fn far(&self, place: Vec3) -> f32 {
        place.distance(self.centre) + self.extent
    }
}

/// The direction of a side, and what is up in it.
fn axes(face: usize) -> [Vec3; 2] {
    let mut direction = Vec3::ZERO;
    direction[face / 2] = if face.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut up = Vec3::ZERO;
    up[(face / 2 + 1) % 3] = 1.0;
    [direction, up]
}

/// The side of the cube that a direction leaves through: 0 and 1 along x, 2 and 3 along y, 4 and 5 along z.
pub(crate) fn face_of(direction: Vec3) -> usize {
    let axis = direction.abs().max_position();
    2 * axis + usize::from(direction[axis] < 0.0)
}

/// Whether a light sends anything through a side of the cube around it.
pub(crate) fn shines_through(light: &LightPlace, face: usize) -> bool {
    let axis = light.axis.as_vec3();
    let along = if face.is_multiple_of(2) { axis[face / 2] } else { -axis[face / 2] };
    match light.half_angle {
        // From the middle of a side to its corners.
        Some(angle) => along.clamp(-1.0, 1.0).acos() <= angle + 3.0_f32.sqrt().recip().acos(),
        // At the corner where the cosine is largest.
        None => along + axis.abs().element_sum() - axis[face / 2].abs() > 0.0,
    }
}

#[expect(clippy::cast_precision_loss, reason = "fewer than 2^24 primitives")]
fn corners(scene: &Scene) -> Vec<Corner> {
    let geometry = scene.geometry();
    let numbered = (1..).zip(&geometry.triangles);
    let corners = numbered.flat_map(|(number, triangle): (u32, _)| {
        let places = geometry.corners(triangle);
        let (normal, distance) = plane(places, DVec3::ZERO);
        places.map(|position| Corner { position, normal, unused: [0.0; 3], distance, number: number as f32 })
    });
    corners.collect()
}

#[expect(clippy::cast_precision_loss, reason = "fewer than 2^24 primitives")]
fn cubes(scene: &Scene) -> Vec<CubeCorner> {
    let geometry = scene.geometry();
    let first = geometry.triangles.len() + 1;
    let corners = (first..).zip(&geometry.spheres).flat_map(|(number, sphere)| {
        let (centre, radius) = (sphere.centre, sphere.radius);
        sphere.cube().map(|position| CubeCorner {
            position,
            centre,
            unused: [0.0; 3],
            radius,
            number: number as f32,
        })
    });
    corners.collect()
}

/// The shaders of a map.
pub(crate) fn sources() -> [ShaderSource; 2] {
    [
        ShaderSource::new(TRIANGLES)
            .targets([TextureFormat::R32Uint])
            .vertex_file(glsl!("render/surfaces/triangles.vert"))
            .file(glsl!("render/surfaces/ray.glsl"))
            .file(glsl!("render/surfaces/plane.glsl"))
            .file(glsl!("render/cube_map/triangles.frag")),
        ShaderSource::new(SPHERES)
            .targets([TextureFormat::R32Uint])
            .define("PRIMITIVES", 1_u32)
            .vertex_file(glsl!("render/surfaces/spheres.vert"))
            .file(glsl!("render/surfaces/ray.glsl"))
            .file(glsl!("render/surfaces/spheres.frag")),
    ]
}
