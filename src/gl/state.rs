//! What the library touches of a host's OpenGL state, saved and put back.
//!
//! The list is in the crate's documentation, "The host's OpenGL state". The stencil test needs no change, since the
//! framebuffers drawn to have no such buffer; multisampling likewise.

use glow::HasContext as _;

use super::Gl;

/// Texture units that passes use.
pub(super) const UNITS: u32 = 4;
/// Draw buffers that passes use.
pub(super) const DRAW_BUFFERS: u32 = 8;

const CAPABILITIES: [u32; 17] = [
    glow::CULL_FACE,
    glow::DEPTH_TEST,
    glow::DEPTH_CLAMP,
    glow::POLYGON_OFFSET_FILL,
    // A vertex shader that draws points says how large they are, where it draws them.
    glow::PROGRAM_POINT_SIZE,
    glow::SCISSOR_TEST,
    glow::COLOR_LOGIC_OP,
    glow::RASTERIZER_DISCARD,
    // Before OpenGL 4.3 it was not clear that drawing without indices is not restarted.
    glow::PRIMITIVE_RESTART,
    glow::CLIP_DISTANCE0,
    glow::CLIP_DISTANCE1,
    glow::CLIP_DISTANCE2,
    glow::CLIP_DISTANCE3,
    glow::CLIP_DISTANCE4,
    glow::CLIP_DISTANCE5,
    glow::CLIP_DISTANCE6,
    glow::CLIP_DISTANCE7,
];

/// Pixel-store parameters and the values for tightly packed rows.
const PIXEL_STORE: [(u32, i32); 10] = [
    (glow::PACK_ALIGNMENT, 1),
    (glow::PACK_ROW_LENGTH, 0),
    (glow::PACK_SKIP_ROWS, 0),
    (glow::PACK_SKIP_PIXELS, 0),
    (glow::PACK_SWAP_BYTES, 0),
    (glow::UNPACK_ALIGNMENT, 1),
    (glow::UNPACK_ROW_LENGTH, 0),
    (glow::UNPACK_SKIP_ROWS, 0),
    (glow::UNPACK_SKIP_PIXELS, 0),
    (glow::UNPACK_SWAP_BYTES, 0),
];

/// What is bound to a texture unit.
#[derive(Clone, Copy, Debug)]
struct Unit {
    plane: Option<glow::Texture>,
    array: Option<glow::Texture>,
    sampler: Option<glow::Sampler>,
}

/// How fragments are added to what is there: factors and equations, for colour and alpha.
#[derive(Clone, Copy, Debug)]
struct Blending {
    source: [u32; 2],
    destination: [u32; 2],
    equation: [u32; 2],
}

/// Saves the state above and sets the library's own; puts the saved one back when dropped. Nothing is there to save
/// if the context is lost.
#[derive(Debug)]
pub(crate) struct StateGuard {
    /// Put back when dropped.
    _saved: Option<Saved>,
}

#[derive(Debug)]
struct Saved {
    gl: Gl,
    program: Option<glow::Program>,
    vertex_array: Option<glow::VertexArray>,
    draw_framebuffer: Option<glow::Framebuffer>,
    read_framebuffer: Option<glow::Framebuffer>,
    viewport: [i32; 4],
    active_texture: u32,
    units: [Unit; UNITS as usize],
    draw_buffers: [(bool, [bool; 4]); DRAW_BUFFERS as usize],
    capabilities: [bool; CAPABILITIES.len()],
    polygon_mode: u32,
    blending: Blending,
    depth_function: u32,
    depth_mask: bool,
    array_buffer: Option<glow::Buffer>,
    pixel_store: [i32; PIXEL_STORE.len()],
    pack_buffer: Option<glow::Buffer>,
    unpack_buffer: Option<glow::Buffer>,
}

impl StateGuard {
    /// Saves the host's state and sets what every pass and transfer relies on.
    pub(crate) fn new(gl: &Gl) -> Self {
        gl.forget_errors();
        let Some(glow) = gl.live() else { return Self { _saved: None } };
        let saved = Saved::of(gl, glow);
        // SAFETY: the context is current while the handle lives.
        unsafe {
            for capability in CAPABILITIES {
                glow.disable(capability);
            }
            for index in 0..DRAW_BUFFERS {
                glow.disable_draw_buffer(glow::BLEND, index);
                glow.color_mask_draw_buffer(index, true, true, true, true);
            }
            glow.polygon_mode(glow::FRONT_AND_BACK, glow::FILL);
            glow.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
            glow.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
            for (parameter, value) in PIXEL_STORE {
                glow.pixel_store_i32(parameter, value);
            }
        }
        Self { _saved: Some(saved) }
    }
}

impl Saved {
    fn of(gl: &Gl, glow: &glow::Context) -> Self {
        // SAFETY: the context is current while the handle lives; each buffer has room for its state's values.
        unsafe {
            let active_texture = glow.get_parameter_i32(glow::ACTIVE_TEXTURE).cast_unsigned();
            let mut viewport = [0; 4];
            glow.get_parameter_i32_slice(glow::VIEWPORT, &mut viewport);
            // Two values, front and back, although a core profile sets them together.
            let mut polygon_mode = [0; 2];
            glow.get_parameter_i32_slice(glow::POLYGON_MODE, &mut polygon_mode);
            let state = |names: [u32; 2]| names.map(|name| glow.get_parameter_i32(name).cast_unsigned());
            Self {
                gl: gl.clone(),
                program: glow.get_parameter_program(glow::CURRENT_PROGRAM),
                vertex_array: glow.get_parameter_vertex_array(glow::VERTEX_ARRAY_BINDING),
                draw_framebuffer: glow.get_parameter_framebuffer(glow::DRAW_FRAMEBUFFER_BINDING),
                read_framebuffer: glow.get_parameter_framebuffer(glow::READ_FRAMEBUFFER_BINDING),
                viewport,
                active_texture,
                units: std::array::from_fn(|unit| {
                    glow.active_texture(glow::TEXTURE0 + u32::try_from(unit).expect("few units"));
                    Unit {
                        plane: glow.get_parameter_texture(glow::TEXTURE_BINDING_2D),
                        array: glow.get_parameter_texture(glow::TEXTURE_BINDING_2D_ARRAY),
                        sampler: glow.get_parameter_sampler(glow::SAMPLER_BINDING),
                    }
                }),
                draw_buffers: std::array::from_fn(|index| {
                    let index = u32::try_from(index).expect("few draw buffers");
                    (gl.is_blending(index), gl.color_mask(index))
                }),
                capabilities: CAPABILITIES.map(|capability| glow.is_enabled(capability)),
                polygon_mode: polygon_mode[0].cast_unsigned(),
                blending: Blending {
                    source: state([glow::BLEND_SRC_RGB, glow::BLEND_SRC_ALPHA]),
                    destination: state([glow::BLEND_DST_RGB, glow::BLEND_DST_ALPHA]),
                    equation: state([glow::BLEND_EQUATION_RGB, glow::BLEND_EQUATION_ALPHA]),
                },
                depth_function: glow.get_parameter_i32(glow::DEPTH_FUNC).cast_unsigned(),
                depth_mask: glow.get_parameter_bool(glow::DEPTH_WRITEMASK),
                array_buffer: glow.get_parameter_buffer(glow::ARRAY_BUFFER_BINDING),
                pixel_store: PIXEL_STORE.map(|(parameter, _)| glow.get_parameter_i32(parameter)),
                pack_buffer: glow.get_parameter_buffer(glow::PIXEL_PACK_BUFFER_BINDING),
                unpack_buffer: glow.get_parameter_buffer(glow::PIXEL_UNPACK_BUFFER_BINDING),
            }
        }
    }
}

impl Drop for Saved {
    fn drop(&mut self) {
        let Some(glow) = self.gl.live() else { return };
        // SAFETY: the context is current while the handle lives; every value was read from it.
        unsafe {
            for ((parameter, _), value) in PIXEL_STORE.into_iter().zip(self.pixel_store) {
                glow.pixel_store_i32(parameter, value);
            }
            glow.bind_buffer(glow::PIXEL_PACK_BUFFER, self.pack_buffer);
            glow.bind_buffer(glow::PIXEL_UNPACK_BUFFER, self.unpack_buffer);
            glow.polygon_mode(glow::FRONT_AND_BACK, self.polygon_mode);
            for (capability, enabled) in CAPABILITIES.into_iter().zip(self.capabilities) {
                if enabled {
                    glow.enable(capability);
                } else {
                    glow.disable(capability);
                }
            }
            for (index, (blend, [red, green, blue, alpha])) in (0..).zip(self.draw_buffers) {
                if blend {
                    glow.enable_draw_buffer(glow::BLEND, index);
                } else {
                    glow.disable_draw_buffer(glow::BLEND, index);
                }
                glow.color_mask_draw_buffer(index, red, green, blue, alpha);
            }
            let Blending { source, destination, equation } = self.blending;
            glow.blend_func_separate(source[0], destination[0], source[1], destination[1]);
            glow.blend_equation_separate(equation[0], equation[1]);
            glow.depth_func(self.depth_function);
            glow.depth_mask(self.depth_mask);
            glow.bind_buffer(glow::ARRAY_BUFFER, self.array_buffer);
            for (unit, Unit { plane, array, sampler }) in (0..).zip(self.units) {
                glow.active_texture(glow::TEXTURE0 + unit);
                glow.bind_texture(glow::TEXTURE_2D, plane);
                glow.bind_texture(glow::TEXTURE_2D_ARRAY, array);
                glow.bind_sampler(unit, sampler);
            }
            glow.active_texture(self.active_texture);
            let [x, y, width, height] = self.viewport;
            glow.viewport(x, y, width, height);
            glow.bind_framebuffer(glow::DRAW_FRAMEBUFFER, self.draw_framebuffer);
            glow.bind_framebuffer(glow::READ_FRAMEBUFFER, self.read_framebuffer);
            glow.bind_vertex_array(self.vertex_array);
            glow.use_program(self.program);
        }
    }
}
