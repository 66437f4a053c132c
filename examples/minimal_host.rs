//! A host with a context and textures of its own, and the ten steps from its photons to its picture of radii.
//!
//! `cargo run --example minimal_host [PICTURE.png]`

#![expect(unsafe_code, reason = "a host speaks OpenGL itself")]
#![expect(clippy::print_stdout, reason = "a program")]

#[path = "common/headless.rs"]
mod headless;

use glow::HasContext as _;
use headless::{Headless, Result, framebuffer, program, texture};
use varikernel::gl::TextureFormat;
use varikernel::glam::UVec2;
use varikernel::settings::Search;
use varikernel::{CountBounds, DensityMap, Gl, RadiusPipeline, Settings, StatePolicy, glow};

const SIDE: u16 = 256;
const PHOTONS: u16 = 40_000;

/// Photons that lie the denser, the nearer they are to the middle.
const SCATTER: &str = "void main() {
    float turn = 2.39996 * float(gl_VertexID), share = float(gl_VertexID) / PHOTONS;
    gl_Position = vec4(share * sqrt(share) * vec2(cos(turn), sin(turn)), 0.0, 1.0);
    gl_PointSize = 1.0;
}";
const ONE: &str = "out float count; void main() { count = 1.0; }";
const FULL_SCREEN: &str =
    "void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }";
/// From black at radius 0 to white at MR.
const SHOW: &str = "uniform usampler2D radii; uniform float max_radius; out vec4 colour;
void main() {
    uint radius = texelFetch(radii, ivec2(gl_FragCoord.xy), 0).r;
    colour = vec4(vec3(float(radius) / max_radius), 1.0);
}";

fn main() -> Result<()> {
    let picture = std::env::args().nth(1);

    // Step 1: the host's context is current on this thread. Its photons are drawn by its own commands.
    let host = Headless::open()?;
    let (glow, size) = (&*host.glow, (i32::from(SIDE), i32::from(SIDE)));
    let counts = texture(glow, glow::R32F, (glow::RED, glow::FLOAT), size)?;
    let (scatter, show) = (
        program(glow, &format!("const float PHOTONS = {PHOTONS}.0;\n{SCATTER}"), ONE)?,
        program(glow, FULL_SCREEN, SHOW)?,
    );
    // SAFETY: the context is current; no vertex is read from a buffer.
    unsafe {
        framebuffer(glow, counts)?;
        glow.bind_vertex_array(Some(glow.create_vertex_array()?));
        glow.viewport(0, 0, size.0, size.1);
        glow.clear_color(0.0, 0.0, 0.0, 0.0);
        glow.clear(glow::COLOR_BUFFER_BIT);
        glow.enable(glow::PROGRAM_POINT_SIZE);
        glow.enable(glow::BLEND);
        glow.blend_func(glow::ONE, glow::ONE);
        glow.use_program(Some(scatter));
        glow.draw_arrays(glow::POINTS, 0, PHOTONS.into());
        glow.disable(glow::BLEND);
    }

    // Step 2: the loader becomes a handle.
    // SAFETY: the context stays current until the end of `main`.
    let gl = unsafe { Gl::from_loader(host.loader()) }?;
    // Step 3: all state that is touched is put back.
    let gl = gl.with_state_policy(StatePolicy::Restore);
    // Step 4: the question, and how it is answered.
    let usual = Settings::default();
    let settings = Settings { search: Search { min_photons: 25, max_radius: 32, ..usual.search }, ..usual };
    // Step 5: the memory that it takes, before it is taken.
    let map_size = UVec2::splat(SIDE.into());
    let memory = RadiusPipeline::memory_required(map_size, &settings)?.at_creation;
    // Step 6: a pipeline for a size.
    let mut pipeline = RadiusPipeline::new(&gl, map_size, TextureFormat::R32Float, settings)?;
    // Step 7: the host's texture, borrowed. Its bounds say that the result will be exact.
    let density = DensityMap::borrow(&gl, counts, CountBounds::total_at_most(PHOTONS.into()))?;
    // Step 8: each frame.
    let radii = pipeline.render(&density)?.texture();

    // Step 9: the radii in the host's own shader; program, vertex array and viewport are as it left them but
    // for its own changes.
    let shown = texture(glow, glow::RGBA8, (glow::RGBA, glow::UNSIGNED_BYTE), size)?;
    let mut pixels = vec![0_u8; 4 * usize::from(SIDE) * usize::from(SIDE)];
    // SAFETY: the context is current, and `pixels` has room for all of them.
    unsafe {
        framebuffer(glow, shown)?;
        glow.use_program(Some(show));
        glow.bind_texture(glow::TEXTURE_2D, Some(radii));
        glow.uniform_1_f32(glow.get_uniform_location(show, "max_radius").as_ref(), 32.0);
        glow.draw_arrays(glow::TRIANGLES, 0, 3);
        let to = glow::PixelPackData::Slice(Some(&mut pixels));
        glow.read_pixels(0, 0, size.0, size.1, glow::RGBA, glow::UNSIGNED_BYTE, to);
    }
    let radius = |x: u16, y: u16| {
        let row = usize::from(y) * usize::from(SIDE);
        (u32::from(pixels[4 * (row + usize::from(x))]) * 32 + 127) / 255
    };
    let proved = pipeline.certify(&density)?.is_proved();
    let (middle, corner) = (radius(SIDE / 2, SIDE / 2), radius(0, 0));
    println!("{} KiB; radius in the middle {middle}, in a corner {corner}; proved: {proved}", memory >> 10);
    if let Some(path) = picture {
        image::save_buffer(&path, &pixels, SIDE.into(), SIDE.into(), image::ColorType::Rgba8)?;
    }

    // Step 10: a new size takes new textures and keeps the shaders. Everything goes while the context is
    // current, in any order.
    pipeline.resize(map_size / 2)?;
    Ok(())
}
