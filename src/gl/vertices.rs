//! Draws of geometry: points, triangles and instanced quads from a vertex buffer, with depth or added up.

use bytemuck::Pod;
use glam::{UVec2, Vec4};
use glow::HasContext as _;

use super::Gl;
use super::pass::{Pass, Target};
#[cfg(feature = "scene")]
use super::{Texture, TextureFormat};
use crate::error::{Error, Result};

/// Vertices of f32 attributes, on the GPU: one vertex each for points and triangles, one quad each for
/// instances.
#[derive(Debug)]
pub(crate) struct Vertices {
    gl: Gl,
    buffer: Buffer,
    /// Attributes advance with each vertex, and with each instance.
    arrays: [Option<glow::VertexArray>; 2],
    count: i32,
    /// What the buffer holds, if it is ours.
    bytes: u64,
}

/// Where vertices lie.
#[derive(Debug)]
enum Buffer {
    Ours(glow::Buffer),
    Hosts,
}

impl Vertices {
    /// Uploads `vertices`, whose f32 fields are attributes 0, 1, ... of as many components as `components`
    /// says.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    ///
    /// # Panics
    /// If the components do not make up a vertex, which is a bug of the library.
    pub(crate) fn upload<V: Pod>(gl: &Gl, vertices: &[V], components: &[u8]) -> Result<Self> {
        assert_eq!(size_of::<V>(), vertex_bytes(components), "attributes make up a vertex");
        // SAFETY: the context is current while the handle lives.
        let buffer = unsafe { gl.current()?.create_buffer() }.map_err(|what| gl.failure(&what))?;
        let mut owned = Self::over(gl, Buffer::Ours(buffer));
        owned.replace(vertices)?;
        owned.describe(buffer, 0, components)?;
        Ok(owned)
    }

    /// Whether a buffer of the host has room for `count` vertices.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if it is no buffer, or has not.
    pub(crate) fn check_room(gl: &Gl, buffer: glow::Buffer, count: u32, components: &[u8]) -> Result<()> {
        let bytes = u64::try_from(vertex_bytes(components)).expect("few bytes");
        let needed = bytes * u64::from(count);
        let mismatch = |got: String| Error::Mismatch {
            what: "host's vertex buffer",
            expected: format!("{count} vertices of {bytes} bytes, {needed} bytes in all"),
            got,
        };
        let glow = gl.current()?;
        // SAFETY: the context is current while the handle lives.
        let size = unsafe {
            if !glow.is_buffer(buffer) {
                return Err(mismatch("a name that is no buffer, or was never bound".to_owned()));
            }
            glow.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
            u64::from(glow.get_buffer_parameter_i32(glow::ARRAY_BUFFER, glow::BUFFER_SIZE).cast_unsigned())
        };
        if size < needed {
            return Err(mismatch(format!("{size} bytes, room for {}", size / bytes)));
        }
        Ok(())
    }

    /// Reads `count` vertices from `first` on of a buffer that stays the host's, and [has
    /// room](Self::check_room) for them.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if they are too far into it; [`Error::OutOfMemory`].
    pub(crate) fn borrow(
        gl: &Gl,
        buffer: glow::Buffer,
        first: u32,
        count: u32,
        components: &[u8],
    ) -> Result<Self> {
        let bytes = u64::try_from(vertex_bytes(components)).expect("few bytes");
        let Ok(offset) = i32::try_from(bytes * u64::from(first)) else {
            return Err(Error::Mismatch {
                what: "host's vertex buffer",
                expected: "vertices in the first 2^31 bytes".to_owned(),
                got: format!("vertex {first}, {bytes} bytes each"),
            });
        };
        let mut owned = Self::over(gl, Buffer::Hosts);
        owned.count = signed(count);
        owned.describe(buffer, offset, components)?;
        Ok(owned)
    }

    fn over(gl: &Gl, buffer: Buffer) -> Self {
        Self { gl: gl.clone(), buffer, arrays: [None; 2], count: 0, bytes: 0 }
    }

    /// Replaces the vertices by others of the same kind; the driver need not wait until the old ones are
    /// drawn.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`]; there are no vertices then.
    pub(crate) fn replace<V: Pod>(&mut self, vertices: &[V]) -> Result<()> {
        let Buffer::Ours(buffer) = self.buffer else {
            unreachable!("a host's vertices are the host's to change")
        };
        let glow = self.gl.current()?;
        let total = &self.gl.inner.buffer_bytes;
        self.count = 0;
        total.set(total.get() - self.bytes + size_of_val(vertices) as u64);
        self.bytes = size_of_val(vertices) as u64;
        // SAFETY: the context is current while the handle lives; the whole buffer is made anew.
        unsafe {
            glow.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
            glow.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytemuck::cast_slice(vertices), glow::STREAM_DRAW);
        }
        self.gl.check_allocation("uploading vertices", Some(self.bytes))?;
        self.count = i32::try_from(vertices.len()).expect("fewer than 2^31 vertices in a buffer");
        Ok(())
    }

    /// Makes the vertex arrays over the buffer, from byte `first` on.
    fn describe(&mut self, buffer: glow::Buffer, first: i32, components: &[u8]) -> Result<()> {
        let stride = i32::try_from(vertex_bytes(components)).expect("few bytes");
        let glow = self.gl.current()?;
        // SAFETY: the context is current while the handle lives; each attribute lies inside of a vertex, and
        // the vertices in the buffer.
        unsafe {
            glow.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
            for (divisor, array) in (0..).zip(&mut self.arrays) {
                *array = Some(glow.create_vertex_array().map_err(|what| self.gl.failure(&what))?);
                glow.bind_vertex_array(*array);
                let mut offset = first;
                for (attribute, &count) in (0..).zip(components) {
                    glow.enable_vertex_attrib_array(attribute);
                    glow.vertex_attrib_divisor(attribute, divisor);
                    let count = i32::from(count);
                    glow.vertex_attrib_pointer_f32(attribute, count, glow::FLOAT, false, stride, offset);
                    offset += 4 * count;
                }
            }
        }
        self.gl.check("describing vertices")
    }

    /// Names buffer and arrays.
    pub(crate) fn labelled(self, label: &str) -> Self {
        if let Buffer::Ours(buffer) = self.buffer {
            self.gl.label(glow::BUFFER, buffer.0.get(), label);
        }
        for (array, of) in self.arrays.into_iter().flatten().zip(["vertices", "instances"]) {
            self.gl.label(glow::VERTEX_ARRAY, array.0.get(), &format!("{label}, {of}"));
        }
        self
    }

    /// How many there are.
    pub(crate) fn count(&self) -> u32 {
        self.count.cast_unsigned()
    }
}

/// Bytes of a vertex with f32 attributes of so many components.
fn vertex_bytes(components: &[u8]) -> usize {
    components.iter().map(|&count| 4 * usize::from(count)).sum()
}

fn signed(count: u32) -> i32 {
    i32::try_from(count).expect("fewer than 2^31 vertices in a buffer")
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
            if let Buffer::Ours(buffer) = self.buffer {
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
    #[cfg(feature = "scene")]
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
    /// [`Error::UnknownUniform`] if the program lacks a name.
    #[cfg(feature = "scene")]
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

    /// Draws one point of one pixel for each vertex; the values of points at one place are added to what is
    /// there.
    ///
    /// The vertex shader sets `gl_PointSize`.
    ///
    /// # Errors
    /// [`Error::UnknownUniform`] if the program lacks a name.
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
    /// [`Error::UnknownUniform`] if the program lacks a name.
    pub(crate) fn add(self, target: &mut Target) -> Result<()> {
        self.prepare(target, 0, UVec2::ZERO, target.size(), |gl| {
            // SAFETY: the context is current, and the full-screen vertex stage reads no buffer.
            adding(gl, target, || unsafe {
                gl.glow().bind_vertex_array(Some(gl.vertex_array()));
                gl.glow().draw_arrays(glow::TRIANGLES, 0, 3);
            });
        })
    }

    /// Draws one quad for each vertex, which is an instance of a strip of four; values are added to what is
    /// there.
    ///
    /// # Errors
    /// [`Error::UnknownUniform`] if the program lacks a name.
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
