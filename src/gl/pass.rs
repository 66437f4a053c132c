//! One draw, over the whole target or of geometry: label, inputs, uniforms and target in one expression.

use glam::UVec2;
use glow::HasContext as _;

use super::program::Uniform;
use super::state::{DRAW_BUFFERS, UNITS};
use super::{Gl, Program, TargetShape, Texture, TextureFormat};
use crate::error::{Error, Result};

/// Textures to draw into, one draw buffer per texture or layer of one, with a framebuffer per level.
#[derive(Debug)]
pub(crate) struct Target {
    gl: Gl,
    textures: Vec<Texture>,
    /// The depth buffer, for draws of geometry.
    pub(super) depth: Option<Texture>,
    pub(super) framebuffers: Vec<glow::Framebuffer>,
}

impl Target {
    /// A target of `textures`, all of one size and one number of levels.
    ///
    /// # Errors
    /// [`Error::Gl`] with the framebuffer's status if the driver can't draw to them.
    pub(crate) fn new(gl: &Gl, textures: Vec<Texture>) -> Result<Self> {
        Self::assemble(gl, textures, None)
    }

    /// As [`Target::new`], with a depth buffer if one is given.
    pub(super) fn assemble(gl: &Gl, textures: Vec<Texture>, depth: Option<Texture>) -> Result<Self> {
        let first = &textures[0];
        assert!(
            textures.iter().all(|t| t.size() == first.size() && t.levels() == first.levels()),
            "the textures of one target have one size"
        );
        let buffers: u32 = textures.iter().map(|texture| texture.layers().unwrap_or(1)).sum();
        assert!(buffers <= DRAW_BUFFERS, "StateGuard covers {DRAW_BUFFERS} draw buffers");
        let levels = first.levels();
        let mut target = Self { gl: gl.clone(), textures, depth, framebuffers: Vec::new() };
        let glow = gl.current()?;
        for level in 0..levels {
            // SAFETY: the context is current while the handle lives.
            unsafe {
                let framebuffer = glow.create_framebuffer().map_err(|what| gl.failure(&what))?;
                target.framebuffers.push(framebuffer);
                glow.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
                let attachments: Vec<u32> = (glow::COLOR_ATTACHMENT0..).take(buffers as usize).collect();
                let mut free = attachments.iter().copied();
                for texture in &target.textures {
                    texture.attach(&mut free, level);
                }
                if let Some(depth) = &target.depth {
                    depth.attach(&mut std::iter::once(glow::DEPTH_ATTACHMENT), level);
                }
                glow.draw_buffers(&attachments);
                let status = glow.check_framebuffer_status(glow::FRAMEBUFFER);
                if status != glow::FRAMEBUFFER_COMPLETE {
                    let formats: Vec<_> = target.textures.iter().map(|t| t.format().name()).collect();
                    return Err(Error::Gl {
                        code: format!("framebuffer status {status:#06x}"),
                        what: format!("attaching {}", formats.join(" and ")),
                    });
                }
            }
        }
        Ok(target)
    }

    /// A target of one texture that is allocated for it.
    ///
    /// # Errors
    /// Those of [`Texture::new`] and [`Target::new`].
    pub(crate) fn single(gl: &Gl, texture: Texture) -> Result<Self> {
        Self::new(gl, vec![texture])
    }

    /// A target of new textures.
    ///
    /// # Errors
    /// Those of [`Texture::of`] and [`Target::new`].
    pub(crate) fn of(gl: &Gl, shape: &TargetShape) -> Result<Self> {
        let textures = shape.iter().map(|&texture| Texture::of(gl, texture)).collect::<Result<_>>()?;
        let labels: Vec<_> = shape.iter().map(|texture| texture.label).collect();
        Ok(Self::new(gl, textures)?.labelled(&labels))
    }

    /// The texture of the first draw buffer.
    pub(crate) fn texture(&self) -> &Texture {
        &self.textures[0]
    }

    /// All textures, in the order of the draw buffers.
    pub(crate) fn textures(&self) -> &[Texture] {
        &self.textures
    }

    /// Fills the levels above 0 of the first texture with glGenerateMipmap.
    pub(crate) fn generate_mipmaps(&mut self) {
        if !self.gl.is_lost() {
            let Self { gl, textures, .. } = self;
            gl.timed("mipmap levels", || textures[0].generate_mipmaps());
        }
    }

    /// Sets level 0 of the textures, of unsigned integers and without layers, to a value each.
    pub(crate) fn clear(&mut self, values: &[u32]) {
        assert_eq!(values.len(), self.textures.len(), "a value for each texture");
        let Some(glow) = self.gl.live() else { return };
        // SAFETY: the context is current while the handle lives, and the draw buffers are unsigned integer
        // ones.
        unsafe {
            glow.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(self.framebuffers[0]));
            for (buffer, &value) in (0..).zip(values) {
                glow.clear_buffer_u32_slice(glow::COLOR, buffer, &[value; 4]);
            }
        }
    }

    /// Sets level 0 of the textures, without layers, to 0.
    fn clear_to_zero(&self) {
        self.bind_for_drawing();
        for (buffer, texture) in (0..).zip(&self.textures) {
            let glow = self.gl.glow();
            // SAFETY: the context is current while the handle lives, and the values are of the buffer's kind.
            unsafe {
                if texture.format().is_float() {
                    glow.clear_buffer_f32_slice(glow::COLOR, buffer, &[0.0; 4]);
                } else {
                    glow.clear_buffer_u32_slice(glow::COLOR, buffer, &[0; 4]);
                }
            }
        }
    }

    /// The format of each draw buffer.
    fn formats(&self) -> Vec<TextureFormat> {
        let of =
            |texture: &Texture| std::iter::repeat_n(texture.format(), texture.layers().unwrap_or(1) as usize);
        self.textures.iter().flat_map(of).collect()
    }

    /// Binds level 0 as what draws write to.
    pub(super) fn bind_for_drawing(&self) {
        // SAFETY: the context is current while the handle lives, and the framebuffer is complete.
        unsafe {
            self.gl.glow().bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(self.framebuffers[0]));
        }
    }

    /// Whether level 0 of a GL_TEXTURE_2D of the host has the size of level 0.
    pub(super) fn has_size_of(&self, texture: glow::Texture) -> bool {
        let glow = self.gl.glow();
        // SAFETY: the context is current while the handle lives; StateGuard puts the binding back.
        let size = unsafe {
            glow.active_texture(glow::TEXTURE0);
            glow.bind_texture(glow::TEXTURE_2D, Some(texture));
            [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT]
                .map(|side| glow.get_tex_level_parameter_i32(glow::TEXTURE_2D, 0, side))
        };
        size == self.size().as_ivec2().to_array()
    }

    /// Binds level 0 as what glReadPixels reads.
    pub(super) fn bind_for_reading(&self) {
        // SAFETY: the context is current while the handle lives, and the framebuffer is complete.
        unsafe {
            self.gl.glow().bind_framebuffer(glow::READ_FRAMEBUFFER, Some(self.framebuffers[0]));
        }
    }

    pub(crate) fn size(&self) -> UVec2 {
        self.texture().size()
    }
}

impl Drop for Target {
    fn drop(&mut self) {
        let Some(glow) = self.gl.live() else { return };
        for framebuffer in self.framebuffers.drain(..) {
            // SAFETY: the context is current while the handle lives, and the name is ours.
            unsafe { glow.delete_framebuffer(framebuffer) };
        }
    }
}

/// One draw, not yet sent.
///
/// The raster state (no blending, no scissor, ...) is that of [`StateGuard`](super::StateGuard), which every
/// public call holds; a pass adds program, textures, samplers, framebuffer, viewport and vertex array.
#[must_use = "a pass draws nothing before `fill`"]
pub(crate) struct Pass<'a> {
    label: &'a str,
    program: &'a Program,
    reads: Vec<(&'static str, &'a Texture)>,
    uniforms: Vec<(&'static str, Uniform)>,
    vertices: u32,
    /// Whether the target is 0 where nothing is drawn.
    over_zeros: bool,
}

impl<'a> Pass<'a> {
    pub(crate) fn new(label: &'a str, program: &'a Program) -> Self {
        Self { label, program, reads: Vec::new(), uniforms: Vec::new(), vertices: 3, over_zeros: false }
    }

    /// Binds `texture` to the sampler `name`.
    pub(crate) fn read(mut self, name: &'static str, texture: &'a Texture) -> Self {
        assert!(self.reads.len() < UNITS as usize, "StateGuard covers {UNITS} texture units");
        self.reads.push((name, texture));
        self
    }

    /// Sets the uniform `name`.
    pub(crate) fn set(mut self, name: &'static str, value: impl Into<Uniform>) -> Self {
        self.uniforms.push((name, value.into()));
        self
    }

    /// Draws `count` triangles that the program's vertex stage places by gl_VertexID, instead of the one.
    pub(crate) fn triangles(mut self, count: u32) -> Self {
        self.vertices = 3 * count;
        self
    }

    /// What is not drawn over becomes 0.
    pub(crate) fn over_zeros(mut self) -> Self {
        self.over_zeros = true;
        self
    }

    /// Draws over the whole of `target`.
    ///
    /// # Errors
    /// [`Error::UnknownUniform`] if the program lacks a name.
    pub(crate) fn fill(self, target: &mut Target) -> Result<()> {
        self.draw(target, 0, UVec2::ZERO, target.size())
    }

    /// Draws over `target` from the column and row of `origin` on; what lies before either stays as it is.
    ///
    /// gl_FragCoord is the texel's place in the whole target all the same.
    ///
    /// # Errors
    /// [`Error::UnknownUniform`] if the program lacks a name.
    pub(crate) fn fill_from(self, origin: UVec2, target: &mut Target) -> Result<()> {
        self.draw(target, 0, origin, target.size())
    }

    /// Draws over the texels of `target` from `first` to before `end`.
    ///
    /// # Errors
    /// [`Error::UnknownUniform`] if the program lacks a name.
    pub(crate) fn fill_between(self, first: UVec2, end: UVec2, target: &mut Target) -> Result<()> {
        self.draw(target, 0, first, end)
    }

    /// Draws over `level` of `target`, reading the level before it as the sampler `name`.
    ///
    /// # Errors
    /// [`Error::UnknownUniform`] if the program lacks a name.
    pub(crate) fn fill_from_level_below(
        self,
        name: &'static str,
        target: &mut Target,
        level: u32,
    ) -> Result<()> {
        target.texture().select_levels(level - 1, level - 1);
        let chain = target.texture();
        let pass = Pass {
            reads: self.reads.iter().copied().chain([(name, chain)]).collect(),
            uniforms: self.uniforms.clone(),
            ..self
        };
        let drawn = pass.draw(target, level, UVec2::ZERO, target.texture().level_size(level));
        target.texture().select_levels(0, target.texture().levels() - 1);
        drawn
    }

    fn draw(&self, target: &Target, level: u32, first: UVec2, end: UVec2) -> Result<()> {
        self.prepare(target, level, first, end, |gl| {
            if self.over_zeros {
                target.clear_to_zero();
            }
            // SAFETY: the context is current, and the vertex stage reads no buffer.
            unsafe {
                gl.glow().bind_vertex_array(Some(gl.vertex_array()));
                gl.glow().draw_arrays(glow::TRIANGLES, 0, self.vertices.cast_signed());
            }
        })
    }

    /// Sets everything up, and lets `draw` bind vertices and draw them.
    pub(super) fn prepare(
        &self,
        target: &Target,
        level: u32,
        first: UVec2,
        end: UVec2,
        draw: impl FnOnce(&Gl),
    ) -> Result<()> {
        assert!(first.cmplt(end).all(), "a pass draws something: from {first} to {end}");
        let (corner, size) = (first.as_ivec2(), (end - first).as_ivec2());
        if cfg!(debug_assertions) {
            self.program.check_targets(&target.formats());
        }
        let gl = self.program.gl();
        gl.current()?;
        gl.timed(self.label, || {
            self.program.use_program();
            for (unit, &(name, texture)) in (0..).zip(&self.reads) {
                texture.bind(unit);
                self.program.set_sampler(name, texture.sampler_kind(), unit)?;
                // SAFETY: the context is current, and the sampler lives as long as the handle.
                unsafe { gl.glow().bind_sampler(unit, Some(gl.sampler(texture.levels()))) };
            }
            for &(name, value) in &self.uniforms {
                self.program.set(name, value)?;
            }
            // SAFETY: the context is current, and the framebuffer is complete.
            unsafe {
                let glow = gl.glow();
                glow.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(target.framebuffers[level as usize]));
                glow.viewport(corner.x, corner.y, size.x, size.y);
            }
            draw(gl);
            Ok(())
        })
    }
}
