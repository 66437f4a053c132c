//! A shader of the program's own, drawn over a texture that the window shows.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::{IVec2, UVec2, Vec2};
use glow::HasContext as _;

use crate::error::{Error, Result};
use crate::gl::{Gl, glsl};

/// A value for a uniform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Uniform {
    /// An `int`.
    Int(i32),
    /// A `float`.
    Float(f32),
    /// An `ivec2`.
    IntPair(IVec2),
    /// A `vec2`.
    FloatPair(Vec2),
}

/// A texture that the shader reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Input {
    /// The sampler's name.
    pub name: &'static str,
    /// What is bound; nothing reads as 0.
    pub texture: Option<glow::Texture>,
    /// Whether texels are blended between their middles; for floats only.
    pub smooth: bool,
}

/// A program of one fragment shader, and the GL_RGBA8 texture that it fills. Row 0 is the first in memory.
///
/// It sets the state that it needs and puts nothing back, like egui, which draws next; the library's own
/// calls put back what they touch, so that the three may follow each other in any order.
#[derive(Debug)]
pub struct Canvas {
    gl: Gl,
    program: glow::Program,
    /// Of the uniforms that the compiler kept.
    locations: BTreeMap<String, glow::UniformLocation>,
    vertex_array: glow::VertexArray,
    framebuffer: glow::Framebuffer,
    smooth: glow::Sampler,
    texture: glow::Texture,
    size: UVec2,
}

impl Canvas {
    /// Compiles `fragment`, which has no version line.
    ///
    /// # Errors
    /// [`Error::Shader`] if the driver refuses it; [`Error::Gl`] when memory runs out.
    pub fn new(gl: &Gl, label: &str, fragment: &str) -> Result<Self> {
        let program = link(gl, label, fragment)?;
        let glow = gl.glow();
        // SAFETY: the context is current while the handle lives.
        unsafe {
            let made = |what: String| gl.failure(&what);
            let canvas = Self {
                gl: gl.clone(),
                program,
                locations: locations(glow, program),
                vertex_array: glow.create_vertex_array().map_err(made)?,
                framebuffer: glow.create_framebuffer().map_err(made)?,
                smooth: glow.create_sampler().map_err(made)?,
                texture: glow.create_texture().map_err(made)?,
                size: UVec2::ZERO,
            };
            for (parameter, value) in [
                (glow::TEXTURE_MIN_FILTER, glow::LINEAR),
                (glow::TEXTURE_MAG_FILTER, glow::LINEAR),
                (glow::TEXTURE_WRAP_S, glow::CLAMP_TO_EDGE),
                (glow::TEXTURE_WRAP_T, glow::CLAMP_TO_EDGE),
            ] {
                glow.sampler_parameter_i32(canvas.smooth, parameter, value.cast_signed());
            }
            Ok(canvas)
        }
    }

    /// Draws at `size`, at least 1 x 1, and returns the texture.
    ///
    /// # Errors
    /// [`Error::Gl`] when memory runs out.
    pub fn draw(
        &mut self,
        size: UVec2,
        inputs: &[Input],
        uniforms: &[(&'static str, Uniform)],
    ) -> Result<glow::Texture> {
        let glow = self.gl.glow();
        let (width, height) = size.max(UVec2::ONE).as_ivec2().into();
        // SAFETY: the context is current while the handle lives; all names are ours or the caller's.
        unsafe {
            glow.bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffer));
            if self.size != size {
                self.allocate(width, height);
                self.size = size;
            }
            for capability in [
                glow::BLEND,
                glow::COLOR_LOGIC_OP,
                glow::CULL_FACE,
                glow::DEPTH_TEST,
                glow::SCISSOR_TEST,
                glow::STENCIL_TEST,
            ] {
                glow.disable(capability);
            }
            glow.color_mask(true, true, true, true);
            glow.viewport(0, 0, width, height);
            glow.use_program(Some(self.program));
            for (unit, input) in (0_u32..).zip(inputs) {
                glow.active_texture(glow::TEXTURE0 + unit);
                glow.bind_texture(glow::TEXTURE_2D, input.texture);
                glow.bind_sampler(unit, input.smooth.then_some(self.smooth));
                glow.uniform_1_i32(self.locations.get(input.name), unit.cast_signed());
            }
            for &(name, value) in uniforms {
                // None for a name that the compiler found to be unused.
                let location = self.locations.get(name);
                match value {
                    Uniform::Int(value) => glow.uniform_1_i32(location, value),
                    Uniform::Float(value) => glow.uniform_1_f32(location, value),
                    Uniform::IntPair(value) => glow.uniform_2_i32(location, value.x, value.y),
                    Uniform::FloatPair(value) => glow.uniform_2_f32(location, value.x, value.y),
                }
            }
            glow.bind_vertex_array(Some(self.vertex_array));
            glow.draw_arrays(glow::TRIANGLES, 0, 3);
            for (unit, _) in (0_u32..).zip(inputs) {
                glow.bind_sampler(unit, None);
            }
            glow.active_texture(glow::TEXTURE0);
            glow.bind_framebuffer(glow::FRAMEBUFFER, None);
        }
        self.gl.check("drawing a view")?;
        Ok(self.texture)
    }

    /// Gives the texture its size, and attaches it to the bound framebuffer.
    unsafe fn allocate(&self, width: i32, height: i32) {
        let glow = self.gl.glow();
        // SAFETY: guaranteed by the caller; without a buffer or data nothing is read.
        unsafe {
            glow.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
            glow.active_texture(glow::TEXTURE0);
            let (plane, texture) = (glow::TEXTURE_2D, Some(self.texture));
            glow.bind_texture(plane, texture);
            let (internal, kind) = (glow::RGBA8.cast_signed(), glow::UNSIGNED_BYTE);
            let nothing = glow::PixelUnpackData::Slice(None);
            glow.tex_image_2d(plane, 0, internal, width, height, 0, glow::RGBA, kind, nothing);
            for parameter in [glow::TEXTURE_MIN_FILTER, glow::TEXTURE_MAG_FILTER] {
                glow.tex_parameter_i32(plane, parameter, glow::NEAREST.cast_signed());
            }
            glow.tex_parameter_i32(plane, glow::TEXTURE_MAX_LEVEL, 0);
            glow.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, plane, texture, 0);
        }
    }
}

impl Drop for Canvas {
    fn drop(&mut self) {
        let glow = self.gl.glow();
        // SAFETY: the context is current while the handle lives, and the names are ours.
        unsafe {
            glow.delete_program(self.program);
            glow.delete_vertex_array(self.vertex_array);
            glow.delete_framebuffer(self.framebuffer);
            glow.delete_sampler(self.smooth);
            glow.delete_texture(self.texture);
        }
    }
}

/// The uniforms of a linked program.
unsafe fn locations(glow: &glow::Context, program: glow::Program) -> BTreeMap<String, glow::UniformLocation> {
    // SAFETY: the caller guarantees that the context is current and the program linked.
    unsafe {
        let active = (0..glow.get_active_uniforms(program))
            .filter_map(|index| glow.get_active_uniform(program, index));
        active
            .filter_map(|uniform| {
                Some((uniform.name.clone(), glow.get_uniform_location(program, &uniform.name)?))
            })
            .collect()
    }
}

/// One triangle over the whole canvas, and the fragment shader.
fn link(gl: &Gl, label: &str, fragment: &str) -> Result<glow::Program> {
    let glow = gl.glow();
    let (_, vertex) = glsl!("common/full_screen.vert");
    let refused = |log: String, source: &str| {
        let mut source_text = String::new();
        for (number, line) in (1..).zip(source.lines()) {
            writeln!(source_text, "{number:<4} {line}").expect("writing to a string");
        }
        Error::Shader { label: label.to_owned(), log, source_text }
    };
    // SAFETY: the context is current while the handle lives.
    unsafe {
        let program = glow.create_program().map_err(|what| gl.failure(&what))?;
        for (stage, source) in [(glow::VERTEX_SHADER, vertex), (glow::FRAGMENT_SHADER, fragment)] {
            let source = format!("#version 330 core\n{source}");
            let shader = glow.create_shader(stage).map_err(|what| gl.failure(&what))?;
            glow.shader_source(shader, &source);
            glow.compile_shader(shader);
            let (compiled, log) = (glow.get_shader_compile_status(shader), glow.get_shader_info_log(shader));
            glow.attach_shader(program, shader);
            glow.delete_shader(shader);
            if !compiled {
                glow.delete_program(program);
                return Err(refused(log, &source));
            }
        }
        glow.bind_frag_data_location(program, 0, "colour");
        glow.link_program(program);
        if !glow.get_program_link_status(program) {
            let log = glow.get_program_info_log(program);
            glow.delete_program(program);
            return Err(refused(log, fragment));
        }
        Ok(program)
    }
}
