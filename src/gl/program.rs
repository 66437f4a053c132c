//! A linked program and the uniforms that it really has.

use std::collections::BTreeMap;

use glow::HasContext as _;

use super::{Gl, ShaderSource, TextureFormat};
use crate::error::{Error, Result};

/// A value for a uniform.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Uniform {
    Int(i32),
    Uint(u32),
    IntPair(glam::IVec2),
    Float(f32),
    FloatTriple(glam::Vec3),
    Matrix(glam::Mat4),
}

impl From<i32> for Uniform {
    fn from(value: i32) -> Self {
        Self::Int(value)
    }
}

impl From<u32> for Uniform {
    fn from(value: u32) -> Self {
        Self::Uint(value)
    }
}

impl From<glam::IVec2> for Uniform {
    fn from(value: glam::IVec2) -> Self {
        Self::IntPair(value)
    }
}

impl From<f32> for Uniform {
    fn from(value: f32) -> Self {
        Self::Float(value)
    }
}

impl From<glam::Vec3> for Uniform {
    fn from(value: glam::Vec3) -> Self {
        Self::FloatTriple(value)
    }
}

impl From<glam::Mat4> for Uniform {
    fn from(value: glam::Mat4) -> Self {
        Self::Matrix(value)
    }
}

/// A linked program of a vertex stage, mostly the full-screen one, and one fragment shader.
#[derive(Debug)]
pub(crate) struct Program {
    gl: Gl,
    label: String,
    name: glow::Program,
    uniforms: BTreeMap<String, Slot>,
    target_formats: Vec<TextureFormat>,
}

#[derive(Debug)]
struct Slot {
    location: glow::UniformLocation,
    kind: u32,
}

impl Program {
    /// Compiles, links, and lists the active uniforms.
    ///
    /// # Errors
    /// [`Error::Shader`] with the driver's log and the numbered source.
    pub(crate) fn new(gl: &Gl, source: &ShaderSource) -> Result<Self> {
        let glow = gl.current()?;
        let failure = |log: String| Error::Shader {
            label: source.label().to_owned(),
            log: log.trim().to_owned(),
            source_text: source.listing(),
        };
        // SAFETY: the context is current while the handle lives; each name is deleted on every way out.
        unsafe {
            let name = glow.create_program().map_err(|what| gl.failure(&what))?;
            let mut owned = Self {
                gl: gl.clone(),
                label: source.label().to_owned(),
                name,
                uniforms: BTreeMap::new(),
                target_formats: source.target_formats().to_vec(),
            };
            for (stage, text) in
                [(glow::VERTEX_SHADER, source.vertex()), (glow::FRAGMENT_SHADER, source.fragment())]
            {
                let shader = glow.create_shader(stage).map_err(|what| gl.failure(&what))?;
                glow.shader_source(shader, &text);
                glow.compile_shader(shader);
                let compiled = glow.get_shader_compile_status(shader);
                let log = glow.get_shader_info_log(shader);
                glow.attach_shader(name, shader);
                // The shader is deleted once the program is.
                glow.delete_shader(shader);
                if !compiled {
                    return Err(failure(log));
                }
            }
            glow.link_program(name);
            if !glow.get_program_link_status(name) {
                return Err(failure(glow.get_program_info_log(name)));
            }
            gl.label(glow::PROGRAM, name.0.get(), source.label());
            for index in 0..glow.get_active_uniforms(name) {
                let Some(uniform) = glow.get_active_uniform(name, index) else { continue };
                let Some(location) = glow.get_uniform_location(name, &uniform.name) else { continue };
                owned.uniforms.insert(uniform.name, Slot { location, kind: uniform.utype });
            }
            Ok(owned)
        }
    }

    /// Makes the program current.
    pub(super) fn use_program(&self) {
        // SAFETY: the context is current while the handle lives, and the program is linked.
        unsafe { self.gl.glow().use_program(Some(self.name)) };
    }

    /// Sets a uniform of the current program.
    ///
    /// # Errors
    /// [`Error::UnknownUniform`] if the program has none of that name.
    ///
    /// # Panics
    /// If the uniform has another type, which is a bug of the library.
    pub(super) fn set(&self, name: &str, value: Uniform) -> Result<()> {
        let slot = self.slot(name)?;
        let location = Some(&slot.location);
        let glow = self.gl.glow();
        // SAFETY: the program is current, and the kind of the slot is that of the call.
        unsafe {
            match (slot.kind, value) {
                (glow::INT, Uniform::Int(value)) => glow.uniform_1_i32(location, value),
                (glow::UNSIGNED_INT, Uniform::Uint(value)) => glow.uniform_1_u32(location, value),
                (glow::INT_VEC2, Uniform::IntPair(value)) => glow.uniform_2_i32(location, value.x, value.y),
                (glow::FLOAT, Uniform::Float(value)) => glow.uniform_1_f32(location, value),
                (glow::FLOAT_VEC3, Uniform::FloatTriple(value)) => {
                    glow.uniform_3_f32(location, value.x, value.y, value.z);
                }
                (glow::FLOAT_MAT4, Uniform::Matrix(value)) => {
                    glow.uniform_matrix_4_f32_slice(location, false, &value.to_cols_array());
                }
                (kind, value) => panic!("{}: \"{name}\" of type {kind:#06x} set to {value:?}", self.label),
            }
        }
        Ok(())
    }

    /// Points a sampler of the current program at a texture unit.
    ///
    /// # Errors
    /// [`Error::UnknownUniform`] if the program has none of that name.
    ///
    /// # Panics
    /// If the sampler is of another type than `kind`, which is a bug of the library.
    pub(super) fn set_sampler(&self, name: &str, kind: u32, unit: u32) -> Result<()> {
        let slot = self.slot(name)?;
        assert_eq!(slot.kind, kind, "{}: sampler \"{name}\" does not fit its texture's format", self.label);
        // SAFETY: the program is current, and the slot is a sampler.
        unsafe { self.gl.glow().uniform_1_i32(Some(&slot.location), unit.cast_signed()) };
        Ok(())
    }

    fn slot(&self, name: &str) -> Result<&Slot> {
        self.uniforms.get(name).ok_or_else(|| Error::UnknownUniform {
            label: self.label.clone(),
            name: name.to_owned(),
            known: self.uniforms.keys().map(String::as_str).collect::<Vec<_>>().join(", "),
        })
    }

    /// Whether a draw to textures of `formats` is what the source says.
    ///
    /// # Panics
    /// If it is not, which is a bug of the library.
    pub(super) fn check_targets(&self, formats: &[TextureFormat]) {
        let declared = &self.target_formats;
        assert!(
            declared.is_empty() || declared == formats,
            "{}: drawn to {formats:?}, not {declared:?}",
            self.label
        );
    }

    pub(super) fn gl(&self) -> &Gl {
        &self.gl
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let Some(glow) = self.gl.live() else { return };
        // SAFETY: the context is current while the handle lives, and the name is ours.
        unsafe { glow.delete_program(self.name) };
    }
}
