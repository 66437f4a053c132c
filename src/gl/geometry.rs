//! Draws of geometry: points, triangles and instanced quads from a vertex buffer, with depth or added up.

use bytemuck::Pod;
use glam::{UVec2, Vec4};
use glow::HasContext as _;

use super::pass::{Pass, Target};
use super::{Gl, Texture, TextureFormat};
use crate::error::Result;

/// Vertices of f32 attributes, on the GPU: one vertex each for points and triangles, one quad each for instances.
#[derive(Debug)]
pub(crate) struct Vertices {
    gl: Gl,
    buffer: Option<glow::Buffer>,
    /// Attributes advance with each vertex, and with each instance.
    arrays: [Option<glow::VertexArray>; 2],
    count: i32,
    bytes: u64,
}

impl Vertices {
    /// Uploads `vertices`, whose f32 fields are attributes 0, 1, ... of as many components as `components` says.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`](crate::Error::OutOfMemory).
    ///
    /// # Panics
    /// If the components do not make up a vertex: our own mistake.
    pub(crate) fn upload<V: Pod>(gl: &Gl, vertices: &[V], components: &[u8]) -> Result<Self> {
        let stride = i32::try_from(size_of::<V>()).expect("small vertices");
        let floats: i32 = components.iter().map(|&count| i32::from(count)).sum();
        assert_eq!(floats * 4, stride, "attributes make up a vertex");
        let count = i32::try_from(vertices.len()).expect("fewer than 2^31 vertices in a buffer");
        let mut owned = Self { gl: gl.clone(), buffer: None, arrays: [None; 2], count, bytes: 0 };
        let glow = gl.current()?;
        // SAFETY: the context is current while the handle lives; the buffer holds `count` vertices of `stride` bytes, and
        // each attribute lies inside of one.
        unsafe {
            let failed = |what: String| gl.failure(&what);
            owned.buffer = Some(glow.create_buffer().map_err(failed)?);
            glow.bind_buffer(glow::ARRAY_BUFFER, owned.buffer);
            owned.bytes = size_of_val(vertices) as u64;
            gl.inner.buffer_bytes.set(gl.buffer_bytes() + owned.bytes);
            glow.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytemuck::cast_slice(vertices), glow::STATIC_DRAW);
            for (divisor, array) in (0..).zip(&mut owned.arrays) {
                *array = Some(glow.create_vertex_array().map_err(failed)?);
                glow.bind_vertex_array(*array);
                let mut offset = 0;
                for (attribute, &count) in (0..).zip(components) {
                    glow.enable_vertex_attrib_array(attribute);
                    glow.vertex_attrib_divisor(attribute, divisor);
                    let count = i32::from(count);
                    glow.vertex_attrib_pointer_f32(attribute, count, glow::FLOAT, false, stride, offset);
                    offset += 4 * count;
                }
            }
        }
        gl.check_allocation("uploading vertices", Some(owned.bytes))?;
        Ok(owned)
    }

    /// How many there are.
    pub(crate) fn count(&self) -> u32 {
        self.count.cast_unsigned()
    }
}

impl Drop for Vertices {
    fn drop(&mut self) {
        self.gl.inner.buffer_bytes.set(self.gl.buffer_bytes() - self.bytes);
        let Some(glow) = self.gl.live() else { return };
        // SAFETY: the context is current while the handle lives, and the names are ours.
        unsafe {
            for array in self.arrays.into_iter().flatten() {
                glow.delete_vertex_array(array);
            }
            if let Some(buffer) = self.buffer {
                glow.delete_buffer(buffer);
            }
        }
    }
}

impl Target {
    /// A target of `textures` with a depth buffer of their size.
    ///
    /// # Errors
    /// Those of [`Texture::new`] and [`Target::new`].
    pub(crate) fn with_depth(gl: &Gl, textures: Vec<Texture>) -> Result<Self> {
        let depth = Texture::new(gl, TextureFormat::Depth32Float, textures[0].size(), 1)?;
        Self::assemble(gl, textures, Some(depth))
    }

    /// Sets the textures, of f32, to a value each, and the depth to the farthest.
    pub(crate) fn clear_floats(&mut self, values: &[Vec4]) {
        assert_eq!(values.len(), self.textures().len(), "a value for each texture");
        let Some(glow) = self.texture().gl().live() else { return };
        // SAFETY: the context is current while the handle lives, and the draw buffers are f32 ones.
        unsafe {
            glow.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(self.framebuffers[0]));
            for (buffer, value) in (0..).zip(values) {
                glow.clear_buffer_f32_slice(glow::COLOR, buffer, &value.to_array());
            }
        }
        self.clear_depth();
    }

    /// Sets the depth to the farthest, if there is one.
    pub(crate) fn clear_depth(&mut self) {
        if self.depth.is_some() {
            let Some(glow) = self.texture().gl().live() else { return };
            // SAFETY: the context is current while the handle lives.
            unsafe {
                glow.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(self.framebuffers[0]));
                glow.depth_mask(true);
                glow.clear_buffer_f32_slice(glow::DEPTH, 0, &[1.0]);
            }
        }
    }
}

impl Pass<'_> {
    /// Draws triangles, three vertices each, of which the nearest stays; both sides are drawn.
    ///
    /// # Errors
    /// [`Error::UnknownUniform`](crate::Error::UnknownUniform) if the program lacks a name.
    pub(crate) fn draw_triangles(self, vertices: &Vertices, target: &mut Target) -> Result<()> {
        assert!(target.depth.is_some(), "triangles hide each other by depth");
        self.prepare(target, 0, UVec2::ZERO, target.size(), |gl| {
            let glow = gl.glow();
            // SAFETY: the context is current, and the buffer holds that many vertices.
            unsafe {
                glow.enable(glow::DEPTH_TEST);
                glow.depth_func(glow::LESS);
                glow.depth_mask(true);
                glow.bind_vertex_array(vertices.arrays[0]);
                glow.draw_arrays(glow::TRIANGLES, 0, vertices.count);
                glow.disable(glow::DEPTH_TEST);
            }
        })
    }

    /// Draws one point of one pixel for each vertex; the values of points at one place are added to what is there.
    ///
    /// The vertex shader sets `gl_PointSize`.
    ///
    /// # Errors
    /// [`Error::UnknownUniform`](crate::Error::UnknownUniform) if the program lacks a name.
    pub(crate) fn add_points(self, vertices: &Vertices, target: &mut Target) -> Result<()> {
        self.prepare(target, 0, UVec2::ZERO, target.size(), |gl| {
            // SAFETY: the context is current, and the buffer holds that many vertices.
            adding(gl, target, || unsafe {
                gl.glow().enable(glow::PROGRAM_POINT_SIZE);
                gl.glow().bind_vertex_array(vertices.arrays[0]);
                gl.glow().draw_arrays(glow::POINTS, 0, vertices.count);
                gl.glow().disable(glow::PROGRAM_POINT_SIZE);
            });
        })
    }

    /// Draws over the whole of `target`; values are added to what is there.
    ///
    /// # Errors
    /// [`Error::UnknownUniform`](crate::Error::UnknownUniform) if the program lacks a name.
    pub(crate) fn add(self, target: &mut Target) -> Result<()> {
        self.prepare(target, 0, UVec2::ZERO, target.size(), |gl| {
            // SAFETY: the context is current, and the full-screen vertex stage reads no buffer.
            adding(gl, target, || unsafe {
                gl.glow().bind_vertex_array(Some(gl.vertex_array()));
                gl.glow().draw_arrays(glow::TRIANGLES, 0, 3);
            });
        })
    }

    /// Draws one quad for each vertex, which is an instance of a strip of four; values are added to what is there.
    ///
    /// # Errors
    /// [`Error::UnknownUniform`](crate::Error::UnknownUniform) if the program lacks a name.
    pub(crate) fn add_quads(self, vertices: &Vertices, target: &mut Target) -> Result<()> {
        self.prepare(target, 0, UVec2::ZERO, target.size(), |gl| {
            // SAFETY: the context is current, and the buffer holds that many instances.
            adding(gl, target, || unsafe {
                gl.glow().bind_vertex_array(vertices.arrays[1]);
                gl.glow().draw_arrays_instanced(glow::TRIANGLE_STRIP, 0, 4, vertices.count);
            });
        })
    }
}

/// Draws with values added to those of the target.
fn adding(gl: &Gl, target: &Target, draw: impl FnOnce()) {
    let buffers = 0..u32::try_from(target.textures().len()).expect("few draw buffers");
    let glow = gl.glow();
    // SAFETY: the context is current, and the draw buffers are f32 ones.
    unsafe {
        glow.blend_equation(glow::FUNC_ADD);
        glow.blend_func(glow::ONE, glow::ONE);
        for buffer in buffers.clone() {
            glow.enable_draw_buffer(glow::BLEND, buffer);
        }
        draw();
        for buffer in buffers {
            glow.disable_draw_buffer(glow::BLEND, buffer);
        }
    }
}
