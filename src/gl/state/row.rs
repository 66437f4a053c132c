//! One state of OpenGL: how many there are of it, how it is read and set.

use std::num::NonZeroU32;

use glow::HasContext as _;

use crate::gl::Gl;

/// Texture units that passes use.
pub(in crate::gl) const UNITS: u32 = 8;
/// Draw buffers that passes use.
pub(in crate::gl) const DRAW_BUFFERS: u32 = 8;

/// A state's values: names, enums, 0 or 1, or the bits of f32 or f64; unused ones are 0.
pub(super) type Values = [i32; 4];

/// A state, or one of each texture unit, draw buffer or viewport.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// The enums by which it is queried.
    pub(super) parameters: &'static [u32],
    /// Their names, for the comparison with the page.
    #[cfg(test)]
    pub(super) names: &'static [&'static str],
    pub(super) setting: Setting,
    pub(super) number: Number,
    /// OpenGL's own values; none where they depend on the host's window.
    pub(super) default: Option<Values>,
    /// What every pass and transfer relies on; none where each sets its own.
    pub(super) relied_on: Option<Values>,
}

/// How many there are of a state.
#[derive(Clone, Copy, Debug)]
pub(super) enum Number {
    One,
    /// One of each texture unit that passes use.
    Units,
    /// One of each draw buffer that passes use.
    DrawBuffers,
    /// That, from OpenGL 4.0 on; one command still sets all.
    DrawBuffersIfSplit,
    /// One of each viewport, from OpenGL 4.1 on; one command still sets all.
    Viewports,
    /// One, from OpenGL 4.5 on.
    ClipControl,
    /// One, in compatibility contexts.
    Compatibility,
}

/// The command that sets a state.
#[derive(Clone, Copy, Debug)]
pub(super) enum Setting {
    ActiveTexture,
    /// The textures of a unit, and its sampler.
    Unit,
    Program,
    VertexArray,
    Framebuffer(u32),
    Buffer(u32),
    Viewport,
    Capability,
    /// Of a draw buffer or a viewport.
    IndexedCapability,
    ColorMask,
    BlendFunction,
    BlendEquation,
    DepthFunction,
    DepthMask,
    DepthRange,
    ClipControl,
    PolygonMode,
    StencilFunction(u32),
    StencilOperation(u32),
    PixelStore,
}

impl Row {
    /// Each of it by its index; where there is none of its own, the one of all.
    pub(super) fn instances(&self, gl: &Gl) -> impl DoubleEndedIterator<Item = Option<u32>> + use<> {
        let one = |is_there: bool| if is_there { (1, false) } else { (0, false) };
        let (count, has_index) = match self.number {
            Number::Units => (UNITS, true),
            Number::DrawBuffers => (DRAW_BUFFERS, true),
            Number::DrawBuffersIfSplit if gl.commands().blends_by_buffer => (DRAW_BUFFERS, true),
            Number::Viewports if gl.commands().viewports.is_some() => (gl.extent().viewports, true),
            Number::One | Number::DrawBuffersIfSplit | Number::Viewports => one(true),
            Number::ClipControl => one(gl.commands().clip_control.is_some()),
            Number::Compatibility => one(gl.extent().is_compatible),
        };
        (0..count).map(move |index| has_index.then_some(index))
    }

    /// Sets all instances, by one command where there is one.
    pub(super) fn write_all(&self, gl: &Gl, values: Values) {
        match self.number {
            Number::DrawBuffersIfSplit | Number::Viewports => self.write(gl, None, values),
            _ => self.instances(gl).rev().for_each(|instance| self.write(gl, instance, values)),
        }
    }

    /// Queries the values of one instance.
    pub(super) fn read(&self, gl: &Gl, instance: Option<u32>) -> Values {
        let glow = gl.glow();
        let parameter = self.parameters[0];
        let mut values = [0; 4];
        // SAFETY: the context is current while the handle lives; each state has at most four values.
        unsafe {
            match self.setting {
                Setting::Capability => values[0] = glow.is_enabled(parameter).into(),
                Setting::IndexedCapability => values[0] = gl.is_enabled(parameter, instance).into(),
                Setting::ColorMask => values = gl.color_mask(instance.unwrap_or(0)).map(i32::from),
                Setting::Viewport => match gl.commands().viewports.zip(instance) {
                    Some((commands, index)) => {
                        let mut rectangle = [0_f32; 4];
                        (commands.get_floats)(parameter, index, rectangle.as_mut_ptr());
                        values = rectangle.map(|side| side.to_bits().cast_signed());
                    }
                    None => glow.get_parameter_i32_slice(parameter, &mut values),
                },
                // Two values, front and back, although a core profile sets them together.
                Setting::PolygonMode => glow.get_parameter_i32_slice(parameter, &mut values[..2]),
                Setting::DepthRange => values = halves(gl.depth_range(instance)),
                _ => {
                    if let Setting::Unit = self.setting {
                        glow.active_texture(glow::TEXTURE0 + instance.unwrap_or(0));
                    }
                    for (value, &parameter) in values.iter_mut().zip(self.parameters) {
                        *value = match (self.number, instance) {
                            (Number::DrawBuffersIfSplit, Some(index)) => {
                                glow.get_parameter_indexed_i32(parameter, index)
                            }
                            _ => glow.get_parameter_i32(parameter),
                        };
                    }
                }
            }
        }
        values
    }

    /// Sets the values of one instance.
    pub(super) fn write(&self, gl: &Gl, instance: Option<u32>, values: Values) {
        let glow = gl.glow();
        let parameter = self.parameters[0];
        let [first, second, third, fourth] = values;
        let enums = values.map(i32::cast_unsigned);
        let name = |value: i32| NonZeroU32::new(value.cast_unsigned());
        let texture = |value| name(value).map(glow::NativeTexture);
        let index = instance.unwrap_or(0);
        // SAFETY: the context is current while the handle lives; the values were read from it, or are
        // OpenGL's own.
        unsafe {
            match self.setting {
                Setting::ActiveTexture => glow.active_texture(enums[0]),
                Setting::Unit => {
                    glow.active_texture(glow::TEXTURE0 + index);
                    glow.bind_texture(glow::TEXTURE_2D, texture(first));
                    glow.bind_texture(glow::TEXTURE_2D_ARRAY, texture(second));
                    glow.bind_sampler(index, name(third).map(glow::NativeSampler));
                }
                Setting::Program => glow.use_program(name(first).map(glow::NativeProgram)),
                Setting::VertexArray => glow.bind_vertex_array(name(first).map(glow::NativeVertexArray)),
                Setting::Framebuffer(target) => {
                    glow.bind_framebuffer(target, name(first).map(glow::NativeFramebuffer));
                }
                Setting::Buffer(target) => glow.bind_buffer(target, name(first).map(glow::NativeBuffer)),
                Setting::Viewport if instance.is_some() => {
                    glow.viewport_f32_slice(index, 1, &[enums.map(f32::from_bits)]);
                }
                Setting::Viewport => glow.viewport(first, second, third, fourth),
                Setting::Capability => set_capability(glow, parameter, None, first != 0),
                Setting::IndexedCapability => set_capability(glow, parameter, instance, first != 0),
                Setting::ColorMask => {
                    let [red, green, blue, alpha] = values.map(|value| value != 0);
                    glow.color_mask_draw_buffer(index, red, green, blue, alpha);
                }
                Setting::BlendFunction => {
                    let [source, target, source_alpha, target_alpha] = enums;
                    if instance.is_some() {
                        glow.blend_func_separate_draw_buffer(
                            index,
                            source,
                            target,
                            source_alpha,
                            target_alpha,
                        );
                    } else {
                        glow.blend_func_separate(source, target, source_alpha, target_alpha);
                    }
                }
                Setting::BlendEquation if instance.is_some() => {
                    glow.blend_equation_separate_draw_buffer(index, enums[0], enums[1]);
                }
                Setting::BlendEquation => glow.blend_equation_separate(enums[0], enums[1]),
                Setting::DepthFunction => glow.depth_func(enums[0]),
                Setting::DepthMask => glow.depth_mask(first != 0),
                Setting::DepthRange if instance.is_some() => {
                    glow.depth_range_f64_slice(index, 1, &[doubles(values)]);
                }
                Setting::DepthRange => {
                    let [near, far] = doubles(values);
                    glow.depth_range_f64(near, far);
                }
                Setting::ClipControl => gl.set_clip_control(enums[0], enums[1]),
                Setting::PolygonMode if gl.extent().is_compatible => {
                    glow.polygon_mode(glow::FRONT, enums[0]);
                    glow.polygon_mode(glow::BACK, enums[1]);
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

/// Of one draw buffer or viewport, or of all.
///
/// # Safety
/// The context is current.
unsafe fn set_capability(glow: &glow::Context, capability: u32, index: Option<u32>, is_on: bool) {
    // SAFETY: guaranteed by the caller.
    unsafe {
        match (index, is_on) {
            (Some(index), true) => glow.enable_draw_buffer(capability, index),
            (Some(index), false) => glow.disable_draw_buffer(capability, index),
            (None, true) => glow.enable(capability),
            (None, false) => glow.disable(capability),
        }
    }
}

/// Two f64 by their bits.
pub(super) const fn halves([first, second]: [f64; 2]) -> Values {
    let (first, second) = (first.to_bits().cast_signed(), second.to_bits().cast_signed());
    #[expect(clippy::cast_possible_truncation, reason = "the other half is kept as well")]
    [first as i32, (first >> 32) as i32, second as i32, (second >> 32) as i32]
}

fn doubles(values: Values) -> [f64; 2] {
    let [a, b, c, d] = values.map(|half| u64::from(half.cast_unsigned()));
    [a | b << 32, c | d << 32].map(f64::from_bits)
}
