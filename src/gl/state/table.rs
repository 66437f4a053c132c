//! The table of what the library touches: how each state is read and set, OpenGL's default, and what passes
//! rely on.
//!
//! Saving, putting back and setting defaults all go through it, and its names are those of the page
//! [`state_contract`](crate::gl::state_contract), which a test compares. The stencil test needs no change but
//! for masks, since the framebuffers drawn to have no such buffer; multisampling likewise.

use std::num::NonZeroU32;

use glow::HasContext as _;

use crate::gl::Gl;

/// Texture units that passes use.
pub(in crate::gl) const UNITS: u32 = 8;
/// Draw buffers that passes use.
pub(in crate::gl) const DRAW_BUFFERS: u32 = 8;

/// A state's values: names, enums, 0 or 1, or the bits of an f32; unused ones are 0.
pub(super) type Values = [i32; 4];

/// A state, or one of each texture unit or draw buffer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// The enums by which it is queried.
    parameters: &'static [u32],
    /// Their names, for the comparison with the page.
    #[cfg(test)]
    pub(super) names: &'static [&'static str],
    setting: Setting,
    /// How many there are of it.
    pub(super) instances: u32,
    /// OpenGL's own values; none where they depend on the host's window.
    pub(super) default: Option<Values>,
    /// What every pass and transfer relies on; none where each sets its own.
    pub(super) relied_on: Option<Values>,
}

/// The command that sets a state.
#[derive(Clone, Copy, Debug)]
enum Setting {
    ActiveTexture,
    /// The textures of a unit, and its sampler.
    Unit,
    Program,
    VertexArray,
    Framebuffer(u32),
    Buffer(u32),
    Viewport,
    Capability,
    /// Blending of a draw buffer.
    Blend,
    ColorMask,
    BlendFunction,
    BlendEquation,
    DepthFunction,
    DepthMask,
    DepthRange,
    PolygonMode,
    StencilFunction(u32),
    StencilOperation(u32),
    PixelStore,
}

/// A row: how it is set, its parameters, OpenGL's default, and what is relied on.
macro_rules! row {
    ($setting:expr, [$($name:ident),+], $default:expr, $relied_on:expr) => {
        row!($setting, [$($name),+], $default, $relied_on, 1)
    };
    ($setting:expr, [$($name:ident),+], $default:expr, $relied_on:expr, $instances:expr) => {
        Row {
            parameters: &[$(glow::$name),+],
            #[cfg(test)]
            names: &[$(concat!("GL_", stringify!($name))),+],
            setting: $setting,
            instances: $instances,
            default: $default,
            relied_on: $relied_on,
        }
    };
}

/// A capability that is off by default, and that passes need off.
macro_rules! off {
    ($name:ident) => {
        row!(Setting::Capability, [$name], OFF, OFF)
    };
}

/// A binding of nothing by default, that each pass sets.
macro_rules! binding {
    ($setting:expr, $name:ident) => {
        row!($setting, [$name], NOTHING, None)
    };
}

const OFF: Option<Values> = Some([0; 4]);
const ON: Option<Values> = Some([1; 4]);
const NOTHING: Option<Values> = Some([0; 4]);

const fn enums<const N: usize>(names: [u32; N]) -> Values {
    let mut values = [0; 4];
    let mut index = 0;
    while index < N {
        values[index] = names[index].cast_signed();
        index += 1;
    }
    values
}

const fn integer(value: i32) -> Values {
    [value, 0, 0, 0]
}

/// What every public call touches. It is read from the first row to the last, and put back from the last to
/// the first.
pub(super) static PASSES: &[Row] = &[
    // First, since querying what a unit holds changes it.
    row!(Setting::ActiveTexture, [ACTIVE_TEXTURE], Some(enums([glow::TEXTURE0])), None),
    row!(
        Setting::Unit,
        [TEXTURE_BINDING_2D, TEXTURE_BINDING_2D_ARRAY, SAMPLER_BINDING],
        NOTHING,
        None,
        UNITS
    ),
    binding!(Setting::Program, CURRENT_PROGRAM),
    binding!(Setting::VertexArray, VERTEX_ARRAY_BINDING),
    binding!(Setting::Buffer(glow::ARRAY_BUFFER), ARRAY_BUFFER_BINDING),
    binding!(Setting::Framebuffer(glow::DRAW_FRAMEBUFFER), DRAW_FRAMEBUFFER_BINDING),
    binding!(Setting::Framebuffer(glow::READ_FRAMEBUFFER), READ_FRAMEBUFFER_BINDING),
    row!(Setting::Viewport, [VIEWPORT], None, None),
    row!(Setting::Blend, [BLEND], OFF, OFF, DRAW_BUFFERS),
    row!(Setting::ColorMask, [COLOR_WRITEMASK], ON, ON, DRAW_BUFFERS),
    row!(
        Setting::BlendFunction,
        [BLEND_SRC_RGB, BLEND_DST_RGB, BLEND_SRC_ALPHA, BLEND_DST_ALPHA],
        Some(enums([glow::ONE, glow::ZERO, glow::ONE, glow::ZERO])),
        None
    ),
    row!(
        Setting::BlendEquation,
        [BLEND_EQUATION_RGB, BLEND_EQUATION_ALPHA],
        Some(enums([glow::FUNC_ADD, glow::FUNC_ADD])),
        None
    ),
    off!(DEPTH_TEST),
    row!(Setting::DepthFunction, [DEPTH_FUNC], Some(enums([glow::LESS])), None),
    row!(Setting::DepthMask, [DEPTH_WRITEMASK], Some(integer(1)), None),
    off!(DEPTH_CLAMP),
    off!(POLYGON_OFFSET_FILL),
    // A vertex shader that draws points sets their size itself, where it draws them.
    off!(PROGRAM_POINT_SIZE),
    off!(CULL_FACE),
    off!(SCISSOR_TEST),
    off!(COLOR_LOGIC_OP),
    off!(RASTERIZER_DISCARD),
    // Before OpenGL 4.3 it was not clear that drawing without indices is not restarted.
    off!(PRIMITIVE_RESTART),
    off!(CLIP_DISTANCE0),
    off!(CLIP_DISTANCE1),
    off!(CLIP_DISTANCE2),
    off!(CLIP_DISTANCE3),
    off!(CLIP_DISTANCE4),
    off!(CLIP_DISTANCE5),
    off!(CLIP_DISTANCE6),
    off!(CLIP_DISTANCE7),
    row!(
        Setting::PolygonMode,
        [POLYGON_MODE],
        Some(enums([glow::FILL, glow::FILL])),
        Some(enums([glow::FILL, glow::FILL]))
    ),
    row!(Setting::Buffer(glow::PIXEL_PACK_BUFFER), [PIXEL_PACK_BUFFER_BINDING], NOTHING, NOTHING),
    row!(Setting::Buffer(glow::PIXEL_UNPACK_BUFFER), [PIXEL_UNPACK_BUFFER_BINDING], NOTHING, NOTHING),
    // Rows are tightly packed.
    row!(Setting::PixelStore, [PACK_ALIGNMENT], Some(integer(4)), Some(integer(1))),
    row!(Setting::PixelStore, [PACK_ROW_LENGTH], Some(integer(0)), Some(integer(0))),
    row!(Setting::PixelStore, [PACK_SKIP_ROWS], Some(integer(0)), Some(integer(0))),
    row!(Setting::PixelStore, [PACK_SKIP_PIXELS], Some(integer(0)), Some(integer(0))),
    row!(Setting::PixelStore, [PACK_SWAP_BYTES], Some(integer(0)), Some(integer(0))),
    row!(Setting::PixelStore, [UNPACK_ALIGNMENT], Some(integer(4)), Some(integer(1))),
    row!(Setting::PixelStore, [UNPACK_ROW_LENGTH], Some(integer(0)), Some(integer(0))),
    row!(Setting::PixelStore, [UNPACK_SKIP_ROWS], Some(integer(0)), Some(integer(0))),
    row!(Setting::PixelStore, [UNPACK_SKIP_PIXELS], Some(integer(0)), Some(integer(0))),
    row!(Setting::PixelStore, [UNPACK_SWAP_BYTES], Some(integer(0)), Some(integer(0))),
];

/// What masks made of a host's depth buffer touch besides.
pub(super) static DEPTH_TESTS: &[Row] = &[
    row!(Setting::Capability, [STENCIL_TEST], OFF, None),
    row!(Setting::DepthRange, [DEPTH_RANGE], Some([0, 1_f32.to_bits().cast_signed(), 0, 0]), None),
];

/// What masks made of a host's stencil buffer touch besides.
///
/// A driver returns as many bits of the reference as the framebuffer that is drawn to has: it needs a stencil
/// buffer.
pub(super) static STENCIL_TESTS: &[Row] = &[
    row!(Setting::Capability, [STENCIL_TEST], OFF, None),
    row!(
        Setting::StencilFunction(glow::FRONT),
        [STENCIL_FUNC, STENCIL_REF, STENCIL_VALUE_MASK],
        Some([glow::ALWAYS.cast_signed(), 0, -1, 0]),
        None
    ),
    row!(
        Setting::StencilFunction(glow::BACK),
        [STENCIL_BACK_FUNC, STENCIL_BACK_REF, STENCIL_BACK_VALUE_MASK],
        Some([glow::ALWAYS.cast_signed(), 0, -1, 0]),
        None
    ),
    row!(
        Setting::StencilOperation(glow::FRONT),
        [STENCIL_FAIL, STENCIL_PASS_DEPTH_FAIL, STENCIL_PASS_DEPTH_PASS],
        Some(enums([glow::KEEP; 3])),
        None
    ),
    row!(
        Setting::StencilOperation(glow::BACK),
        [STENCIL_BACK_FAIL, STENCIL_BACK_PASS_DEPTH_FAIL, STENCIL_BACK_PASS_DEPTH_PASS],
        Some(enums([glow::KEEP; 3])),
        None
    ),
];

impl Row {
    /// Queries the values of one instance.
    pub(super) fn read(&self, gl: &Gl, instance: u32) -> Values {
        let glow = gl.glow();
        let mut values = [0; 4];
        // SAFETY: the context is current while the handle lives; each state has at most four values.
        unsafe {
            match self.setting {
                Setting::Capability => values[0] = glow.is_enabled(self.parameters[0]).into(),
                Setting::Blend => values[0] = gl.is_blending(instance).into(),
                Setting::ColorMask => values = gl.color_mask(instance).map(i32::from),
                Setting::Viewport => glow.get_parameter_i32_slice(self.parameters[0], &mut values),
                // Two values, front and back, although a core profile sets them together.
                Setting::PolygonMode => glow.get_parameter_i32_slice(self.parameters[0], &mut values[..2]),
                Setting::DepthRange => {
                    let mut range = [0_f32; 2];
                    glow.get_parameter_f32_slice(self.parameters[0], &mut range);
                    for (value, limit) in values.iter_mut().zip(range) {
                        *value = limit.to_bits().cast_signed();
                    }
                }
                _ => {
                    if let Setting::Unit = self.setting {
                        glow.active_texture(glow::TEXTURE0 + instance);
                    }
                    for (value, &parameter) in values.iter_mut().zip(self.parameters) {
                        *value = glow.get_parameter_i32(parameter);
                    }
                }
            }
        }
        values
    }

    /// Sets the values of one instance.
    pub(super) fn write(&self, gl: &Gl, instance: u32, values: Values) {
        let glow = gl.glow();
        let parameter = self.parameters[0];
        let [first, second, third, fourth] = values;
        let enums = values.map(i32::cast_unsigned);
        let name = |value: i32| NonZeroU32::new(value.cast_unsigned());
        let texture = |value| name(value).map(glow::NativeTexture);
        // SAFETY: the context is current while the handle lives; the values were read from it, or are
        // OpenGL's own.
        unsafe {
            match self.setting {
                Setting::ActiveTexture => glow.active_texture(enums[0]),
                Setting::Unit => {
                    glow.active_texture(glow::TEXTURE0 + instance);
                    glow.bind_texture(glow::TEXTURE_2D, texture(first));
                    glow.bind_texture(glow::TEXTURE_2D_ARRAY, texture(second));
                    glow.bind_sampler(instance, name(third).map(glow::NativeSampler));
                }
                Setting::Program => glow.use_program(name(first).map(glow::NativeProgram)),
                Setting::VertexArray => glow.bind_vertex_array(name(first).map(glow::NativeVertexArray)),
                Setting::Framebuffer(target) => {
                    glow.bind_framebuffer(target, name(first).map(glow::NativeFramebuffer));
                }
                Setting::Buffer(target) => glow.bind_buffer(target, name(first).map(glow::NativeBuffer)),
                Setting::Viewport => glow.viewport(first, second, third, fourth),
                Setting::Capability if first != 0 => glow.enable(parameter),
                Setting::Capability => glow.disable(parameter),
                Setting::Blend if first != 0 => glow.enable_draw_buffer(parameter, instance),
                Setting::Blend => glow.disable_draw_buffer(parameter, instance),
                Setting::ColorMask => {
                    let [red, green, blue, alpha] = values.map(|value| value != 0);
                    glow.color_mask_draw_buffer(instance, red, green, blue, alpha);
                }
                Setting::BlendFunction => {
                    glow.blend_func_separate(enums[0], enums[1], enums[2], enums[3]);
                }
                Setting::BlendEquation => glow.blend_equation_separate(enums[0], enums[1]),
                Setting::DepthFunction => glow.depth_func(enums[0]),
                Setting::DepthMask => glow.depth_mask(first != 0),
                Setting::DepthRange => {
                    glow.depth_range_f32(f32::from_bits(enums[0]), f32::from_bits(enums[1]));
                }
                Setting::PolygonMode => glow.polygon_mode(glow::FRONT_AND_BACK, enums[0]),
                Setting::StencilFunction(face) => {
                    glow.stencil_func_separate(face, enums[0], second, enums[2]);
                }
                Setting::StencilOperation(face) => {
                    glow.stencil_op_separate(face, enums[0], enums[1], enums[2]);
                }
                Setting::PixelStore => glow.pixel_store_i32(parameter, first),
            }
        }
    }
}
