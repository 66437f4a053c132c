//! What photons meet first, rasterised from the lights (thesis 2.6.1).
//!
//! - Photons are cut into groups that leave from one place each, spread evenly over the lights; around each place a cube of
//!   five or six maps is drawn, whose texels tell the nearest triangle or sphere. A photon reads the texel of its direction.
//! - Against the thesis: of Table 2.1 the map holds only what the rasteriser has to find. Power and direction are those that the
//!   emission drew by its seed, and place, normal and index are computed again from the primitive, exactly. So photons
//!   do not lie on a grid of texels, and only within a texel of an edge may the wrong one of two primitives be taken.
//! - Cost: a draw of the scene and a read-back for each map, 256 KiB.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, UVec2, Vec3};

use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, StateGuard, Target, Texture, TextureFormat, Vertices, glsl,
};
use crate::image::Image;
use crate::photon::{Emission, EmittedPhoton, FirstHit};
use crate::scene::{Camera, Scene};

const TRIANGLES: &str = "bounce map of triangles";
const SPHERES: &str = "bounce map of spheres";

/// Places on the lights, all together.
const PLACES: u32 = 256;
/// Columns and rows of a map.
const SIDE: u32 = 256;

/// As `surfaces/triangles.vert` takes it.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Corner {
    position: Vec3,
    unused: [f32; 6],
    number: f32,
}

/// As `surfaces/spheres.vert` takes it.
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
pub(crate) struct BounceMaps {
    gl: Gl,
    programs: [Program; 2],
    triangles: Vertices,
    spheres: Vertices,
    map: Target,
    near: f32,
    far: f32,
}

impl BounceMaps {
    pub(crate) fn new(gl: &Gl, scene: &Scene) -> Result<Self> {
        let _state = StateGuard::new(gl);
        let [triangles, spheres] = sources();
        let programs = [Program::new(gl, &triangles)?, Program::new(gl, &spheres)?];
        let map = Texture::new(gl, TextureFormat::R32Uint, UVec2::splat(SIDE), 1)?;
        let (min, max) = scene.bounds();
        let extent = (max - min).length();
        Ok(Self {
            gl: gl.clone(),
            programs,
            triangles: Vertices::upload(gl, &corners(scene), &[3, 3, 3, 1])?,
            spheres: Vertices::upload(gl, &cubes(scene), &[3, 3, 3, 1, 1])?,
            map: Target::with_depth(gl, vec![map])?,
            near: 1e-5 * extent,
            far: 4.0 * extent,
        })
    }

    /// The photons from number `first` on that leave one place, and what they meet; nothing after the last.
    pub(crate) fn next_hits(&mut self, emission: &Emission<'_>, first: u32) -> Result<Option<Vec<FirstHit>>> {
        let photons = emission.settings().photons;
        if first >= photons {
            return Ok(None);
        }
        let light = emission.light(first);
        let end = photons.min(first.saturating_add(photons.div_ceil(PLACES)));
        let end = (first..end).find(|&id| emission.light(id) != light).unwrap_or(end);
        let place = emission.photon(first.midpoint(end - 1)).origin;
        let group: Vec<_> =
            (first..end).map(|id| EmittedPhoton { origin: place, ..emission.photon(id) }).collect();

        // What no map tells is met by a ray.
        let mut hits: Vec<_> = group.iter().map(|&photon| FirstHit { photon, primitive: u32::MAX }).collect();
        for face in 0..6 {
            let mine: Vec<usize> =
                (0..group.len()).filter(|&index| face_of(group[index].direction) == face).collect();
            if mine.is_empty() {
                continue;
            }
            let to_clip = self.to_clip(place, face);
            let map = self.draw(place, to_clip)?;
            for index in mine {
                let clip = to_clip * (place + group[index].direction).extend(1.0);
                let texel = (clip.truncate().truncate() / clip.w * 0.5 + 0.5) * UVec2::splat(SIDE).as_vec2();
                let texel = texel.as_uvec2().min(UVec2::splat(SIDE - 1));
                hits[index].primitive = map.at(texel.x, texel.y).wrapping_sub(1);
            }
        }
        Ok(Some(hits))
    }

    fn draw(&mut self, place: Vec3, to_clip: Mat4) -> Result<Image<u32>> {
        let _state = StateGuard::new(&self.gl);
        self.map.clear(&[0]);
        self.map.clear_depth();
        Pass::new(TRIANGLES, &self.programs[0])
            .set("to_clip", to_clip)
            .draw_triangles(&self.triangles, &mut self.map)?;
        Pass::new(SPHERES, &self.programs[1])
            .set("to_clip", to_clip)
            .set("camera", place)
            .draw_triangles(&self.spheres, &mut self.map)?;
        let map = self.map.texture().read(0);
        self.gl.check("drawing a bounce map")?;
        Ok(map)
    }

    fn to_clip(&self, place: Vec3, face: usize) -> Mat4 {
        let mut direction = Vec3::ZERO;
        direction[face / 2] = if face.is_multiple_of(2) { 1.0 } else { -1.0 };
        let mut up = Vec3::ZERO;
        up[(face / 2 + 1) % 3] = 1.0;
        let camera = Camera { position: place, direction, up, vertical_fov_degrees: 90.0 };
        camera.projection(1.0, self.near, self.far) * camera.view()
    }
}

/// The side of the cube that a direction leaves through: 0 and 1 along x, 2 and 3 along y, 4 and 5 along z.
fn face_of(direction: Vec3) -> usize {
    let axis = direction.abs().max_position();
    2 * axis + usize::from(direction[axis] < 0.0)
}

#[expect(clippy::cast_precision_loss, reason = "fewer than 2^24 primitives")]
fn corners(scene: &Scene) -> Vec<Corner> {
    let geometry = scene.geometry();
    let numbered = (1..).zip(&geometry.triangles);
    let corners = numbered.flat_map(|(number, triangle): (u32, _)| {
        geometry.corners(triangle).map(|position| Corner {
            position,
            unused: [0.0; 6],
            number: number as f32,
        })
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
            .vertex_file(glsl!("surfaces/triangles.vert"))
            .file(glsl!("bounce_map/triangles.frag")),
        ShaderSource::new(SPHERES)
            .define("PRIMITIVES", 1_u32)
            .vertex_file(glsl!("surfaces/spheres.vert"))
            .file(glsl!("surfaces/spheres.frag")),
    ]
}
