//! Scene and camera to what each pixel shows: place, normal and albedo of the nearest surface (thesis 2.3.2).
//!
//! - Triangles are rasterised with a depth test by distance, which f32 keeps as finely near as far, so that
//!   nothing is too near or too far to be seen. A fragment meets the plane of its triangle along its own ray.
//!   Spheres are met exactly: a cube is rasterised around each, and the fragments find where their line of
//!   sight meets the sphere.
//! - Cost: one pass over the triangles and one over the spheres. Memory: 48 bytes a pixel, and 4 of depth.
//! - Against the thesis: the place is kept, not only its depth, since photons are compared with it.
//! - Mirrors and glass are shown as what they are, with a negative number: what is seen in them is another
//!   stage's job.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

use crate::error::Result;
use crate::gl::{Gl, Pass, Program, ShaderSource, StateGuard, TextureFormat, Vertices, glsl};
use crate::maps::SurfaceMaps;
use crate::scene::{Scattering, Scene, plane};
use crate::view::View;

const TRIANGLES: &str = "surfaces of triangles";
const SPHERES: &str = "surfaces of spheres";

/// A corner of a triangle.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Corner {
    position: Vec3,
    normal: Vec3,
    albedo: Vec3,
    distance: f32,
    number: f32,
}

/// A corner of the cube around a sphere.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct CubeCorner {
    position: Vec3,
    centre: Vec3,
    albedo: Vec3,
    radius: f32,
    number: f32,
}

/// What each pixel of the view shows, as the first stage of a picture draws it.
///
/// # Errors
/// [`Error::TooLarge`](crate::Error::TooLarge); [`Error::Shader`](crate::Error::Shader);
/// [`Error::OutOfMemory`](crate::Error::OutOfMemory).
pub fn draw_surfaces(gl: &Gl, scene: &Scene, view: View) -> Result<SurfaceMaps> {
    SurfaceStage::new(gl)?.draw(scene, view)
}

/// The shaders, for any scene and view.
#[derive(Debug)]
pub(crate) struct SurfaceStage {
    gl: Gl,
    triangles: Program,
    spheres: Program,
}

impl SurfaceStage {
    pub(crate) fn new(gl: &Gl) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let [triangles, spheres] = sources();
        Ok(Self {
            gl: gl.clone(),
            triangles: Program::new(gl, &triangles)?,
            spheres: Program::new(gl, &spheres)?,
        })
    }

    /// What each pixel of the view shows.
    pub(crate) fn draw(&self, scene: &Scene, view: View) -> Result<SurfaceMaps> {
        let _state = StateGuard::new(&self.gl)?;
        let mut maps = SurfaceMaps::new(&self.gl, view)?;
        let triangles = Vertices::upload(&self.gl, &corners(scene, view.position()), &[3, 3, 3, 1, 1])?;
        let triangles = triangles.labelled(TRIANGLES);
        let spheres = Vertices::upload(&self.gl, &cubes(scene), &[3, 3, 3, 1, 1])?.labelled(SPHERES);
        let [to_corner, to_right, to_next_row] = view.rays();
        let (min, max) = scene.bounds();
        let far = view.position().distance(min.midpoint(max)) + (max - min).length();
        maps.target().clear_floats(&[Vec4::ZERO; 3]);
        for (label, program, vertices) in
            [(TRIANGLES, &self.triangles, &triangles), (SPHERES, &self.spheres, &spheres)]
        {
            let pass = Pass::new(label, program)
                .set("to_clip", view.to_clip())
                .set("camera", view.position())
                .set("to_corner", to_corner)
                .set("to_right", to_right)
                .set("to_next_row", to_next_row)
                .set("far", far);
            // From the camera the distances of planes are as exact as f32 can be.
            let pass = if label == TRIANGLES { pass.set("plane_origin", view.position()) } else { pass };
            pass.draw_triangles(vertices, maps.target())?;
        }
        self.gl.check("drawing the surfaces")?;
        Ok(maps)
    }
}

/// Number and albedo of a surface with a material.
fn appearance(scene: &Scene, surface: u32, material: u32) -> (f32, Vec3) {
    let material = &scene.materials()[material as usize];
    #[expect(clippy::cast_precision_loss, reason = "fewer than 2^24 surfaces")]
    let number = (surface + 1) as f32;
    match material.scattering {
        Scattering::Lambert(reflectance) => (number, reflectance),
        Scattering::Mirror(_) | Scattering::Dielectric { .. } | Scattering::ThinDielectric { .. } => {
            (-number, Vec3::ZERO)
        }
    }
}

/// Triangles, whose distances count from the camera.
fn corners(scene: &Scene, camera: Vec3) -> Vec<Corner> {
    let geometry = scene.geometry();
    let of_triangle = |triangle: &crate::scene::Triangle| {
        let places = geometry.corners(triangle);
        let (normal, distance) = plane(places, camera.as_dvec3());
        let (number, albedo) = appearance(scene, triangle.surface, triangle.material);
        places.map(|position| Corner { position, normal, albedo, distance, number })
    };
    geometry.triangles.iter().flat_map(of_triangle).collect()
}

fn cubes(scene: &Scene) -> Vec<CubeCorner> {
    let of_sphere = |sphere: &crate::scene::Sphere| {
        let (number, albedo) = appearance(scene, sphere.surface, sphere.material);
        let (centre, radius) = (sphere.centre, sphere.radius);
        sphere.cube().map(move |position| CubeCorner { position, centre, albedo, radius, number })
    };
    scene.geometry().spheres.iter().flat_map(of_sphere).collect()
}

pub(crate) fn sources() -> [ShaderSource; 2] {
    [
        ShaderSource::new(TRIANGLES)
            .targets([TextureFormat::Rgba32Float; 3])
            .vertex_file(glsl!("render/surfaces/triangles.vert"))
            .file(glsl!("render/surfaces/ray.glsl"))
            .file(glsl!("render/surfaces/plane.glsl"))
            .file(glsl!("render/surfaces/triangles.frag")),
        ShaderSource::new(SPHERES)
            .targets([TextureFormat::Rgba32Float; 3])
            .vertex_file(glsl!("render/surfaces/spheres.vert"))
            .file(glsl!("render/surfaces/ray.glsl"))
            .file(glsl!("render/surfaces/spheres.frag")),
    ]
}
