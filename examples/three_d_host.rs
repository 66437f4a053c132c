//! The three-d engine as the host: its g-buffer and our light by photons, in its own frame.
//!
//! three-d draws a room with its own lights, and a g-buffer of it; photons light the room once more, and
//! three-d shows that, and the radii, through an effect of its own. The engine's own picture is the same
//! before and after our calls.
//!
//! `cargo run --example three_d_host [PICTURE.png]`

#![expect(unsafe_code, reason = "the handle's promise, and textures by their names")]
#![expect(clippy::print_stdout, reason = "a program")]

#[path = "common/headless.rs"]
#[expect(dead_code, reason = "the engine has programs and textures of its own")]
mod headless;
#[path = "common/materials.rs"]
mod materials;
#[path = "common/photons.rs"]
mod photons;

use std::num::NonZeroU32;
use std::sync::Arc;

use glow::HasContext as _;
use headless::{Headless, Result};
use materials::{ByPhotons, Normals, Radii};
use photons::{BODIES, LIGHT, Shape, trace};
use three_d::{
    AmbientLight, Attenuation, Camera, ClearState, ColorMaterial, ColorTexture, Context, CoreError,
    CpuMaterial, CpuMesh, DepthTexture2D, Effect, Gm, Interpolation, Mat4, Mesh, PhysicalMaterial,
    PointLight, RenderTarget, Srgba, Texture2D, Viewer as _, Viewport, Wrapping, degrees, radians, vec3,
};
use varikernel::glam::{self, UVec2};
use varikernel::settings::IrradianceSettings;
use varikernel::{
    Gl, HostDepth, HostSurfaces, IrradiancePipeline, PhotonPoints, PositionMaker, StatePolicy, SurfaceMaps,
    View, glow,
};

const SIDE: u16 = 320;

fn main() -> Result<()> {
    let path = std::env::args().nth(1);
    let host = Headless::open()?;
    let engine = Context::from_gl_context(Arc::clone(&host.glow))?;
    let room = Room::new(&engine);
    let target = Target::new(&engine);

    // The engine's own frame, before the library has done anything.
    let before = target.picture(&room);

    // Step 1: the engine's context is current on this thread.
    // Step 2: its glow context becomes a handle.
    // SAFETY: the context stays current until the end of `main`.
    let gl = unsafe { Gl::from_glow(Arc::clone(&host.glow)) }?;
    // Step 3: the engine keeps state from frame to frame, so that all that is touched has to be put back.
    let gl = gl.with_state_policy(StatePolicy::Restore);
    // Step 4: the question, and how it is answered.
    let settings = IrradianceSettings::default();
    // Step 5: the memory that it takes, before it is taken.
    let size = UVec2::splat(SIDE.into());
    println!("memory: {} KiB", IrradiancePipeline::memory_required(size, &settings)? >> 10);
    // Step 6: a pipeline for a size.
    let mut light = IrradiancePipeline::new(&gl, size, settings)?;

    // Step 7: the engine's g-buffer, borrowed, and photons.
    let gbuffer = Target::float(&engine);
    let (normal, depth) = gbuffer.normals(&room)?;
    let view = View::from_matrices(matrix(room.camera.view()), matrix(room.camera.projection()), size)?;
    let depth = HostDepth { texture: depth, reversed: false, zero_to_one: false };
    let mut positions = PositionMaker::borrow(&gl, depth)?;
    let surfaces = HostSurfaces { position: positions.texture(), normal };
    let mut surfaces = SurfaceMaps::borrow(&gl, view, surfaces)?;
    let mut points = PhotonPoints::new(&gl);
    points.upload(&trace(100_000))?;

    // Step 8: each frame, after the engine has drawn its g-buffer.
    positions.render(&view)?;
    surfaces.set_view(view)?;
    let irradiance = light.render(&surfaces, &points)?.texture();
    let radii = light.radii().ok_or("radii are variable")?.texture();

    // Step 9: the light and the radii in the engine's own shaders.
    let lit = target.effect(&room, ByPhotons { irradiance });
    let of_radii = target.effect(&room, Radii { radii });

    // The engine's own frame once more.
    let after = target.picture(&room);
    println!("the engine's picture is the same before and after: {}", before == after);
    if let Some(path) = path {
        save(&path, &[&after, &lit, &of_radii])?;
    }

    // Step 10: a new size takes new textures and keeps the shaders. Everything goes while the context is
    // current, in any order.
    light.resize(size / 2)?;
    Ok(())
}

/// What the engine draws.
struct Room {
    camera: Camera,
    bodies: Vec<Gm<Mesh, PhysicalMaterial>>,
    sun: PointLight,
    ambient: AmbientLight,
}

impl Room {
    fn new(engine: &Context) -> Self {
        let viewport = Viewport::new_at_origo(SIDE.into(), SIDE.into());
        let (eye, aim, up) = (vec3(0.0, 0.0, 3.6), vec3(0.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0));
        let mut camera = Camera::new_perspective(viewport, eye, aim, up, degrees(42.0), 0.1, 10.0);
        camera.disable_tone_and_color_mapping();
        let bodies = BODIES.map(|body| {
            let (mesh, place) = geometry(body.shape);
            let mut mesh = Mesh::new(engine, &mesh);
            mesh.set_transformation(place);
            // The engine takes colours as screens have them, and photons lose power by linear ones.
            let albedo = Srgba::from(body.albedo.powf(1.0 / 2.2).to_array());
            let material = CpuMaterial { albedo, roughness: 1.0, metallic: 0.0, ..CpuMaterial::default() };
            Gm::new(mesh, PhysicalMaterial::new_opaque(engine, &material))
        });
        let place = vec3(LIGHT.x, LIGHT.y, LIGHT.z);
        Self {
            camera,
            bodies: bodies.into(),
            sun: PointLight::new(engine, 1.5, Srgba::WHITE, place, Attenuation::default()),
            ambient: AmbientLight::new(engine, 0.2, Srgba::WHITE),
        }
    }
}

/// A body as one of the engine's meshes, and where it is.
fn geometry(shape: Shape) -> (CpuMesh, Mat4) {
    let moved = |to: glam::Vec3| Mat4::from_translation(vec3(to.x, to.y, to.z));
    match shape {
        Shape::Wall { normal } => {
            // The engine's square faces along z.
            let turn = if normal.y == 0.0 {
                Mat4::from_angle_y(radians(normal.x.atan2(normal.z)))
            } else {
                Mat4::from_angle_x(radians(-normal.y.asin()))
            };
            (CpuMesh::square(), moved(-normal) * turn)
        }
        Shape::Box { centre, half } => {
            (CpuMesh::cube(), moved(centre) * Mat4::from_nonuniform_scale(half.x, half.y, half.z))
        }
        Shape::Sphere { centre, radius } => (CpuMesh::sphere(64), moved(centre) * Mat4::from_scale(radius)),
    }
}

/// Colour and depth textures of the engine.
struct Target {
    engine: Context,
    colour: Texture2D,
    depth: DepthTexture2D,
}

impl Target {
    fn new(engine: &Context) -> Self {
        Self::of::<[u8; 4]>(engine)
    }

    /// For normals and numbers.
    fn float(engine: &Context) -> Self {
        Self::of::<[f32; 4]>(engine)
    }

    fn of<T: three_d::TextureDataType>(engine: &Context) -> Self {
        let (side, nearest, clamp) = (u32::from(SIDE), Interpolation::Nearest, Wrapping::ClampToEdge);
        let colour = Texture2D::new_empty::<T>(engine, side, side, nearest, nearest, None, clamp, clamp);
        let depth = DepthTexture2D::new::<f32>(engine, side, side, clamp, clamp);
        Self { engine: engine.clone(), colour, depth }
    }

    fn as_target(&self) -> RenderTarget<'_> {
        RenderTarget::new(self.colour.as_color_target(None), self.depth.as_depth_target())
    }

    /// The engine's ordinary picture, rows from the top.
    fn picture(&self, room: &Room) -> Vec<[u8; 4]> {
        let mut camera = room.camera.clone();
        camera.set_default_tone_and_color_mapping();
        self.as_target()
            .clear(ClearState::color_and_depth(0.0, 0.0, 0.0, 1.0, 1.0))
            .render(&camera, &room.bodies, &[&room.sun, &room.ambient])
            .read_color()
    }

    /// Albedo, seen through an effect.
    fn effect(&self, room: &Room, effect: impl Effect) -> Vec<[u8; 4]> {
        let albedo = Self::new(&self.engine);
        let target = albedo.as_target();
        target.clear(ClearState::color_and_depth(0.0, 0.0, 0.0, 1.0, 1.0));
        for body in &room.bodies {
            let flat = ColorMaterial { color: body.material.albedo, ..ColorMaterial::default() };
            target.render_with_material(&flat, &room.camera, [&body.geometry], &[]);
        }
        let albedo = Some(ColorTexture::Single(&albedo.colour));
        self.as_target().apply_screen_effect(&effect, &room.camera, &[], albedo, None).read_color()
    }

    /// Draws normals, numbers and depth, and gives the names of the textures that hold them.
    fn normals(&self, room: &Room) -> Result<(glow::Texture, glow::Texture)> {
        let target = self.as_target();
        target.clear(ClearState::color_and_depth(0.0, 0.0, 0.0, 0.0, 1.0));
        for (number, body) in (1_u8..).zip(&room.bodies) {
            let material = Normals { number: number.into() };
            target.render_with_material(&material, &room.camera, [&body.geometry], &[]);
        }
        // three-d does not give its names away; OpenGL does.
        let mut names = [0; 2];
        target.write(|| {
            names = [glow::COLOR_ATTACHMENT0, glow::DEPTH_ATTACHMENT].map(|attachment| {
                let what = glow::FRAMEBUFFER_ATTACHMENT_OBJECT_NAME;
                // SAFETY: the context is current, and the engine has bound the target's framebuffer.
                unsafe {
                    self.engine.get_framebuffer_attachment_parameter_i32(
                        glow::DRAW_FRAMEBUFFER,
                        attachment,
                        what,
                    )
                }
            });
            Ok::<_, CoreError>(())
        })?;
        let name =
            |name: i32| -> Result<_> { Ok(glow::NativeTexture(NonZeroU32::try_from(name.cast_unsigned())?)) };
        Ok((name(names[0])?, name(names[1])?))
    }
}

fn matrix(matrix: Mat4) -> glam::Mat4 {
    glam::Mat4::from_cols_array(AsRef::<[f32; 16]>::as_ref(&matrix))
}

/// Pictures side by side.
fn save(path: &str, pictures: &[&Vec<[u8; 4]>]) -> Result<()> {
    let side = usize::from(SIDE);
    let rows = (0..side).flat_map(|row| pictures.iter().flat_map(move |all| &all[row * side..][..side]));
    let bytes: Vec<u8> = rows.flatten().copied().collect();
    let width = u32::from(SIDE) * u32::try_from(pictures.len())?;
    Ok(image::save_buffer(path, &bytes, width, SIDE.into(), image::ColorType::Rgba8)?)
}
