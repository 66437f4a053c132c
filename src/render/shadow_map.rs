//! Direct light by shadow maps (thesis 2.2; McGuire and Luebke's deferred direct light).
//!
//! - Around each place of a light, a cube of maps tells what is nearest to it. A pixel is lit if what the map
//!   tells in its direction is not between the two. Area lights are some places, spread evenly, whose shadows
//!   add up to a soft one.
//! - Against the thesis: maps hold primitives instead of depths, and pixels meet those again, exactly. So
//!   shadows have edges as sharp as with rays, and there is no depth bias: only what is nearer to a surface,
//!   or to the light, than 2·10^-6 of the distances from the camera and the origin casts no shadow. What no
//!   texel sees, since it is thinner or behind something else, casts none either; a gap between triangles
//!   that is thinner than a texel is taken for a crack, and closed, if it is more than two texels away.
//! - Glass and mirrors cast hard shadows: photons bring the light that passes them.
//! - Places are the same for all pixels: few of them give steps, where rays give noise. They tell which share
//!   of a light is seen; how bright it is has a closed form, as with rays.
//! - Cost: for each place a draw of the scene and one pass over the picture for each side of the cube that it
//!   shines through: five for area lights, one for a narrow cone. Memory: 16 bytes a pixel,
//!   2 MiB, and 64 bytes for each primitive.

use std::f64::consts::PI;

use glam::{DVec3, UVec2, Vec3, Vec4};
use rayon::prelude::*;

use crate::error::Result;
use crate::gl::{Gl, Pass, Program, ShaderSource, StateGuard, Target, Texture, TextureFormat, glsl};
use crate::image::Image;
use crate::maps::SurfaceMaps;
use crate::render::cube_map::{CubeMap, FACES, shines_through};
use crate::render::direct::Samples;
use crate::render::sight::Place;
use crate::scene::{LightPlace, Scene, plane};
use crate::settings::PictureSettings;

const LABEL: &str = "direct light by shadow map";

/// Columns and rows of a map.
const SIDE: u16 = 512;
/// Texels beyond a side's edges: the four around a direction may be one past them.
const BORDER: u16 = 1;
/// Texels of each primitive.
const TEXELS: usize = 4;
/// Primitives in a row of their texture: no driver has narrower ones than 1024.
const ROW: usize = 1024 / TEXELS;

/// The maps of one scene, one at a time, and the light that they let through.
#[derive(Debug)]
pub(crate) struct ShadowMaps {
    gl: Gl,
    program: Program,
    cube: CubeMap,
    primitives: Texture,
    irradiance: Target,
}

impl ShadowMaps {
    pub(crate) fn new(gl: &Gl, scene: &Scene, size: UVec2) -> Result<Self> {
        let cube = CubeMap::new(gl, scene, SIDE, BORDER)?;
        let _state = StateGuard::new(gl)?;
        let texels = primitives(scene);
        let primitives =
            Texture::new(gl, TextureFormat::Rgba32Float, texels.size(), 1)?.labelled("primitives");
        primitives.upload(&texels);
        let irradiance = Texture::new(gl, TextureFormat::Rgba32Float, size, 1)?;
        Ok(Self {
            gl: gl.clone(),
            program: Program::new(gl, &source())?,
            cube,
            primitives,
            irradiance: Target::single(gl, irradiance)?.labelled(&["direct irradiance"]),
        })
    }

    /// Radiance of direct light that each place, all seen straight, sends to the camera, from some places on each
    /// light. `show` is told the done share.
    pub(crate) fn reflected(
        &mut self,
        scene: &Scene,
        surfaces: &SurfaceMaps,
        places: &[Place],
        settings: &PictureSettings,
        show: &mut dyn FnMut(f64),
    ) -> Result<Vec<DVec3>> {
        let mut all = vec![DVec3::ZERO; places.len()];
        let columns = settings.size.x;
        for (number, light) in (0..).zip(scene.lights()) {
            let samples = Samples::new(settings.seed, 0, number);
            let count = if light.is_point() { 1 } else { settings.light_samples };
            let on_light: Vec<_> = (0..count).map(|index| light.place(samples.at(index))).collect();
            #[expect(clippy::cast_precision_loss, reason = "a share")]
            let lights = scene.lights().len() as f64;
            let irradiance = self.irradiance(surfaces, &on_light, &mut |done| {
                show((f64::from(number) + done) / lights);
            })?;
            all.par_iter_mut().zip(places).for_each(|(sum, place)| {
                let [red, green, blue, _] =
                    irradiance.at(place.pixel % columns, place.pixel / columns).map(f64::from);
                let of_seen = DVec3::new(red, green, blue);
                let arrives = match light.irradiance(place.position, place.normal) {
                    Some(whole) if !light.is_point() => {
                        let of = |on_light: &LightPlace| on_light.irradiance(place.position, place.normal);
                        let of_all: DVec3 = on_light.iter().map(of).sum();
                        // f32 may see a little more than all of it.
                        let share = of_seen.element_sum() / of_all.element_sum().max(f64::MIN_POSITIVE);
                        whole * share.min(1.0)
                    }
                    _ => of_seen / f64::from(count),
                };
                *sum += place.share.as_dvec3() * arrives / PI;
            });
        }
        Ok(all)
    }

    /// The sum over `places` of irradiance as if each were all of its light, at what each pixel shows, linear
    /// RGB, and how many places are seen from there; 0 on mirrors and glass and where nothing is seen. `show` is told the done share.
    fn irradiance(
        &mut self,
        surfaces: &SurfaceMaps,
        places: &[LightPlace],
        show: &mut dyn FnMut(f64),
    ) -> Result<Image<[f32; 4]>> {
        let _state = StateGuard::new(&self.gl)?;
        self.irradiance.clear_floats(&[Vec4::ZERO]);
        for (index, light) in places.iter().enumerate() {
            for face in (0..FACES).filter(|&face| shines_through(light, face)) {
                self.add(surfaces, light, face)?;
            }
            #[expect(clippy::cast_precision_loss, reason = "a share")]
            show((index + 1) as f64 / places.len() as f64);
        }
        let image = self.irradiance.texture().read(0);
        self.gl.check("drawing direct light")?;
        Ok(image)
    }

    /// Adds the light of one place that leaves through one side of the cube around it.
    fn add(&mut self, surfaces: &SurfaceMaps, light: &LightPlace, face: usize) -> Result<()> {
        let place = light.position.as_vec3();
        let to_face = self.cube.to_clip(place, face);
        let nearest = self.cube.draw(place, face)?;
        Pass::new(LABEL, &self.program)
            .read("position", surfaces.position())
            .read("normal", surfaces.normal())
            .read("nearest", nearest)
            .read("primitives", &self.primitives)
            .set("place", place)
            .set("axis", light.axis.as_vec3())
            .set("cone_cosine", light.half_angle.map_or(-2.0, cosine))
            .set("intensity", light.intensity.as_vec3())
            .set("face", i32::try_from(face).unwrap_or_else(|_| unreachable!("one of six")))
            .set("to_face", to_face)
            .add(&mut self.irradiance)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "f32 is what a shader takes")]
fn cosine(angle: f32) -> f32 {
    f64::from(angle).cos() as f32
}

/// Triangles and spheres in the order of their numbers, [`TEXELS`] each.
fn primitives(scene: &Scene) -> Image<[f32; 4]> {
    let geometry = scene.geometry();
    let texel = |at: Vec3, last: f32| at.extend(last).to_array();
    let triangles = geometry.triangles.iter().flat_map(|triangle| {
        let [a, b, c] = geometry.corners(triangle);
        let (normal, distance) = plane([a, b, c], DVec3::ZERO);
        [texel(a, 0.0), texel(b - a, 0.0), texel(c - a, 0.0), texel(normal, distance)]
    });
    let spheres = geometry
        .spheres
        .iter()
        .flat_map(|sphere| [texel(sphere.centre, sphere.radius), [0.0; 4], [0.0; 4], [0.0; 4]]);
    let mut texels: Vec<_> = triangles.chain(spheres).collect();
    let rows = texels.len().div_ceil(TEXELS * ROW).max(1);
    texels.resize(TEXELS * ROW * rows, [0.0; 4]);
    #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^24 primitives")]
    Image::from_values(UVec2::new((TEXELS * ROW) as u32, rows as u32), texels)
}

pub(crate) fn source() -> ShaderSource {
    ShaderSource::new(LABEL)
        .targets([TextureFormat::Rgba32Float])
        .file(glsl!("render/shadow_map/between.glsl"))
        .file(glsl!("render/shadow_map/light.frag"))
}
