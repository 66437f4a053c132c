//! The table of what the library touches: how each state is read and set, OpenGL's default, and what passes
//! rely on.
//!
//! Saving, putting back and setting defaults all go through it, and its names are those of the page
//! [`state_contract`](crate::gl::state_contract), which a test compares. The stencil test needs no change but
//! for masks, since the framebuffers drawn to have no such buffer; multisampling likewise.

use super::row::{Number, Row, Setting, Values, halves};

/// A row: how it is set, its parameters, OpenGL's default, and what is relied on.
macro_rules! row {
    ($setting:expr, [$($name:ident),+], $default:expr, $relied_on:expr) => {
        row!($setting, [$($name),+], $default, $relied_on, Number::One)
    };
    ($setting:expr, [$($name:ident),+], $default:expr, $relied_on:expr, $number:expr) => {
        Row {
            parameters: &[$(glow::$name),+],
            #[cfg(test)]
            names: &[$(concat!("GL_", stringify!($name))),+],
            setting: $setting,
            number: $number,
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

/// The same in compatibility contexts alone, where glow does not know its name.
macro_rules! of_compatibility {
    ($name:literal, $parameter:literal) => {
        Row {
            parameters: &[$parameter],
            #[cfg(test)]
            names: &[$name],
            setting: Setting::Capability,
            number: Number::Compatibility,
            default: OFF,
            relied_on: OFF,
        }
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
        Number::Units
    ),
    binding!(Setting::Program, CURRENT_PROGRAM),
    binding!(Setting::VertexArray, VERTEX_ARRAY_BINDING),
    binding!(Setting::Buffer(glow::ARRAY_BUFFER), ARRAY_BUFFER_BINDING),
    binding!(Setting::Framebuffer(glow::DRAW_FRAMEBUFFER), DRAW_FRAMEBUFFER_BINDING),
    binding!(Setting::Framebuffer(glow::READ_FRAMEBUFFER), READ_FRAMEBUFFER_BINDING),
    row!(Setting::Viewport, [VIEWPORT], None, None, Number::Viewports),
    row!(Setting::IndexedCapability, [BLEND], OFF, OFF, Number::DrawBuffers),
    row!(Setting::ColorMask, [COLOR_WRITEMASK], ON, ON, Number::DrawBuffers),
    row!(
        Setting::BlendFunction,
        [BLEND_SRC_RGB, BLEND_DST_RGB, BLEND_SRC_ALPHA, BLEND_DST_ALPHA],
        Some(enums([glow::ONE, glow::ZERO, glow::ONE, glow::ZERO])),
        None,
        Number::DrawBuffersIfSplit
    ),
    row!(
        Setting::BlendEquation,
        [BLEND_EQUATION_RGB, BLEND_EQUATION_ALPHA],
        Some(enums([glow::FUNC_ADD, glow::FUNC_ADD])),
        None,
        Number::DrawBuffersIfSplit
    ),
    off!(DEPTH_TEST),
    row!(Setting::DepthFunction, [DEPTH_FUNC], Some(enums([glow::LESS])), None),
    row!(Setting::DepthMask, [DEPTH_WRITEMASK], Some(integer(1)), None),
    off!(DEPTH_CLAMP),
    off!(POLYGON_OFFSET_FILL),
    off!(POLYGON_SMOOTH),
    // A vertex shader that draws points sets their size itself, where it draws them.
    off!(PROGRAM_POINT_SIZE),
    off!(CULL_FACE),
    row!(Setting::IndexedCapability, [SCISSOR_TEST], OFF, OFF, Number::Viewports),
    off!(COLOR_LOGIC_OP),
    off!(RASTERIZER_DISCARD),
    // Before OpenGL 4.3 it was not clear that drawing without indices is not restarted.
    off!(PRIMITIVE_RESTART),
    // A host may have the upper left corner as its origin, or depths from 0 to 1.
    row!(
        Setting::ClipControl,
        [CLIP_ORIGIN, CLIP_DEPTH_MODE],
        Some(enums([glow::LOWER_LEFT, glow::NEGATIVE_ONE_TO_ONE])),
        Some(enums([glow::LOWER_LEFT, glow::NEGATIVE_ONE_TO_ONE])),
        Number::ClipControl
    ),
    of_compatibility!("GL_POLYGON_STIPPLE", 0x0B42),
    of_compatibility!("GL_ALPHA_TEST", 0x0BC0),
    of_compatibility!("GL_POINT_SMOOTH", 0x0B10),
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
    row!(Setting::DepthRange, [DEPTH_RANGE], Some(halves([0.0, 1.0])), None, Number::Viewports),
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
