//! Every state of OpenGL 3.3 core that a host may hold: the tables of chapter 6 of its specification. Those of
//! later versions that matter here come with them where there are any.

use std::ffi::c_void;

use glow::HasContext as _;

use super::host::Host;
use super::unusual::Objects;

/// Each state by name, "family: state".
pub(super) type Snapshot = Vec<(String, Vec<i64>)>;

/// Outside of objects: integers, enums, flags and names, with as many values as given.
const INTEGERS: &[(&str, u32, usize)] = &[
    ("binding: program", glow::CURRENT_PROGRAM, 1),
    ("binding: vertex array", glow::VERTEX_ARRAY_BINDING, 1),
    ("binding: draw framebuffer", glow::DRAW_FRAMEBUFFER_BINDING, 1),
    ("binding: read framebuffer", glow::READ_FRAMEBUFFER_BINDING, 1),
    ("binding: renderbuffer", glow::RENDERBUFFER_BINDING, 1),
    ("binding: array buffer", glow::ARRAY_BUFFER_BINDING, 1),
    ("binding: element buffer", glow::ELEMENT_ARRAY_BUFFER_BINDING, 1),
    ("binding: copy read buffer", glow::COPY_READ_BUFFER_BINDING, 1),
    ("binding: copy write buffer", glow::COPY_WRITE_BUFFER_BINDING, 1),
    ("binding: pack buffer", glow::PIXEL_PACK_BUFFER_BINDING, 1),
    ("binding: unpack buffer", glow::PIXEL_UNPACK_BUFFER_BINDING, 1),
    ("binding: texture buffer", glow::TEXTURE_BUFFER_BINDING, 1),
    ("binding: uniform buffer", glow::UNIFORM_BUFFER_BINDING, 1),
    ("binding: transform feedback buffer", glow::TRANSFORM_FEEDBACK_BUFFER_BINDING, 1),
    ("binding: active texture", glow::ACTIVE_TEXTURE, 1),
    ("transformation: viewport", glow::VIEWPORT, 4),
    ("vertices: primitive restart index", glow::PRIMITIVE_RESTART_INDEX, 1),
    ("vertices: provoking vertex", glow::PROVOKING_VERTEX, 1),
    ("colour: clamping of what is read", glow::CLAMP_READ_COLOR, 1),
    ("rasteriser: point sprite origin", glow::POINT_SPRITE_COORD_ORIGIN, 1),
    ("rasteriser: cull face", glow::CULL_FACE_MODE, 1),
    ("rasteriser: front face", glow::FRONT_FACE, 1),
    ("rasteriser: polygon mode", glow::POLYGON_MODE, 2),
    ("multisampling: coverage inverted", glow::SAMPLE_COVERAGE_INVERT, 1),
    ("fragments: scissor box", glow::SCISSOR_BOX, 4),
    ("stencil: function", glow::STENCIL_FUNC, 1),
    ("stencil: reference", glow::STENCIL_REF, 1),
    ("stencil: bits", glow::STENCIL_VALUE_MASK, 1),
    ("stencil: fail", glow::STENCIL_FAIL, 1),
    ("stencil: depth fail", glow::STENCIL_PASS_DEPTH_FAIL, 1),
    ("stencil: pass", glow::STENCIL_PASS_DEPTH_PASS, 1),
    ("stencil: back function", glow::STENCIL_BACK_FUNC, 1),
    ("stencil: back reference", glow::STENCIL_BACK_REF, 1),
    ("stencil: back bits", glow::STENCIL_BACK_VALUE_MASK, 1),
    ("stencil: back fail", glow::STENCIL_BACK_FAIL, 1),
    ("stencil: back depth fail", glow::STENCIL_BACK_PASS_DEPTH_FAIL, 1),
    ("stencil: back pass", glow::STENCIL_BACK_PASS_DEPTH_PASS, 1),
    ("stencil: mask", glow::STENCIL_WRITEMASK, 1),
    ("stencil: back mask", glow::STENCIL_BACK_WRITEMASK, 1),
    ("stencil: clear value", glow::STENCIL_CLEAR_VALUE, 1),
    ("depth: function", glow::DEPTH_FUNC, 1),
    ("depth: mask", glow::DEPTH_WRITEMASK, 1),
    ("blending: source", glow::BLEND_SRC_RGB, 1),
    ("blending: source of alpha", glow::BLEND_SRC_ALPHA, 1),
    ("blending: destination", glow::BLEND_DST_RGB, 1),
    ("blending: destination of alpha", glow::BLEND_DST_ALPHA, 1),
    ("blending: equation", glow::BLEND_EQUATION_RGB, 1),
    ("blending: equation of alpha", glow::BLEND_EQUATION_ALPHA, 1),
    ("fragments: logic operation", glow::LOGIC_OP_MODE, 1),
    ("framebuffer: read buffer", glow::READ_BUFFER, 1),
    ("framebuffer: draw buffer 0", glow::DRAW_BUFFER0, 1),
    ("framebuffer: draw buffer 1", glow::DRAW_BUFFER1, 1),
    ("framebuffer: draw buffer 2", glow::DRAW_BUFFER2, 1),
    ("framebuffer: draw buffer 3", glow::DRAW_BUFFER3, 1),
    ("framebuffer: draw buffer 4", glow::DRAW_BUFFER4, 1),
    ("framebuffer: draw buffer 5", glow::DRAW_BUFFER5, 1),
    ("framebuffer: draw buffer 6", glow::DRAW_BUFFER6, 1),
    ("framebuffer: draw buffer 7", glow::DRAW_BUFFER7, 1),
    ("pixels: pack alignment", glow::PACK_ALIGNMENT, 1),
    ("pixels: pack row length", glow::PACK_ROW_LENGTH, 1),
    ("pixels: pack image height", glow::PACK_IMAGE_HEIGHT, 1),
    ("pixels: pack skip rows", glow::PACK_SKIP_ROWS, 1),
    ("pixels: pack skip pixels", glow::PACK_SKIP_PIXELS, 1),
    ("pixels: pack skip images", glow::PACK_SKIP_IMAGES, 1),
    ("pixels: pack swap bytes", glow::PACK_SWAP_BYTES, 1),
    ("pixels: pack least significant bit first", glow::PACK_LSB_FIRST, 1),
    ("pixels: unpack alignment", glow::UNPACK_ALIGNMENT, 1),
    ("pixels: unpack row length", glow::UNPACK_ROW_LENGTH, 1),
    ("pixels: unpack image height", glow::UNPACK_IMAGE_HEIGHT, 1),
    ("pixels: unpack skip rows", glow::UNPACK_SKIP_ROWS, 1),
    ("pixels: unpack skip pixels", glow::UNPACK_SKIP_PIXELS, 1),
    ("pixels: unpack skip images", glow::UNPACK_SKIP_IMAGES, 1),
    ("pixels: unpack swap bytes", glow::UNPACK_SWAP_BYTES, 1),
    ("pixels: unpack least significant bit first", glow::UNPACK_LSB_FIRST, 1),
    ("hint: derivatives", glow::FRAGMENT_SHADER_DERIVATIVE_HINT, 1),
    ("hint: smooth lines", glow::LINE_SMOOTH_HINT, 1),
    ("hint: smooth polygons", glow::POLYGON_SMOOTH_HINT, 1),
    ("hint: compression", glow::TEXTURE_COMPRESSION_HINT, 1),
    ("debug: depth of groups", glow::DEBUG_GROUP_STACK_DEPTH, 1),
];

/// Outside of objects: f32.
const FLOATS: &[(&str, u32, usize)] = &[
    ("rasteriser: point size", glow::POINT_SIZE, 1),
    ("rasteriser: point fade threshold", glow::POINT_FADE_THRESHOLD_SIZE, 1),
    ("rasteriser: line width", glow::LINE_WIDTH, 1),
    ("rasteriser: offset factor", glow::POLYGON_OFFSET_FACTOR, 1),
    ("rasteriser: offset units", glow::POLYGON_OFFSET_UNITS, 1),
    ("multisampling: coverage", glow::SAMPLE_COVERAGE_VALUE, 1),
    ("blending: colour", glow::BLEND_COLOR, 4),
    ("framebuffer: clear colour", glow::COLOR_CLEAR_VALUE, 4),
    ("depth: clear value", glow::DEPTH_CLEAR_VALUE, 1),
];

pub(super) const CAPABILITIES: &[u32] = &[
    glow::COLOR_LOGIC_OP,
    glow::CULL_FACE,
    glow::DEPTH_CLAMP,
    glow::DEPTH_TEST,
    glow::DITHER,
    glow::FRAMEBUFFER_SRGB,
    glow::LINE_SMOOTH,
    glow::MULTISAMPLE,
    glow::POLYGON_OFFSET_FILL,
    glow::POLYGON_OFFSET_LINE,
    glow::POLYGON_OFFSET_POINT,
    glow::POLYGON_SMOOTH,
    glow::PRIMITIVE_RESTART,
    glow::PROGRAM_POINT_SIZE,
    glow::RASTERIZER_DISCARD,
    glow::SAMPLE_ALPHA_TO_COVERAGE,
    glow::SAMPLE_ALPHA_TO_ONE,
    glow::SAMPLE_COVERAGE,
    glow::SAMPLE_MASK,
    glow::SCISSOR_TEST,
    glow::STENCIL_TEST,
    glow::TEXTURE_CUBE_MAP_SEAMLESS,
    glow::CLIP_DISTANCE0,
    glow::CLIP_DISTANCE1,
    glow::CLIP_DISTANCE2,
    glow::CLIP_DISTANCE3,
    glow::CLIP_DISTANCE4,
    glow::CLIP_DISTANCE5,
    glow::CLIP_DISTANCE6,
    glow::CLIP_DISTANCE7,
];

/// Targets of textures, with their bindings.
pub(super) const TEXTURE_TARGETS: [(u32, u32); 10] = [
    (glow::TEXTURE_1D, glow::TEXTURE_BINDING_1D),
    (glow::TEXTURE_2D, glow::TEXTURE_BINDING_2D),
    (glow::TEXTURE_3D, glow::TEXTURE_BINDING_3D),
    (glow::TEXTURE_1D_ARRAY, glow::TEXTURE_BINDING_1D_ARRAY),
    (glow::TEXTURE_2D_ARRAY, glow::TEXTURE_BINDING_2D_ARRAY),
    (glow::TEXTURE_RECTANGLE, glow::TEXTURE_BINDING_RECTANGLE),
    (glow::TEXTURE_BUFFER, glow::TEXTURE_BINDING_BUFFER),
    (glow::TEXTURE_CUBE_MAP, glow::TEXTURE_BINDING_CUBE_MAP),
    (glow::TEXTURE_2D_MULTISAMPLE, glow::TEXTURE_BINDING_2D_MULTISAMPLE),
    (glow::TEXTURE_2D_MULTISAMPLE_ARRAY, glow::TEXTURE_BINDING_2D_MULTISAMPLE_ARRAY),
];

/// Targets with bindings by index: how many, and what is asked for.
pub(super) const INDEXED_BUFFERS: [(u32, u32, [u32; 3]); 2] = [
    (
        glow::UNIFORM_BUFFER,
        glow::MAX_UNIFORM_BUFFER_BINDINGS,
        [glow::UNIFORM_BUFFER_BINDING, glow::UNIFORM_BUFFER_START, glow::UNIFORM_BUFFER_SIZE],
    ),
    (
        glow::TRANSFORM_FEEDBACK_BUFFER,
        glow::MAX_TRANSFORM_FEEDBACK_SEPARATE_ATTRIBS,
        [
            glow::TRANSFORM_FEEDBACK_BUFFER_BINDING,
            glow::TRANSFORM_FEEDBACK_BUFFER_START,
            glow::TRANSFORM_FEEDBACK_BUFFER_SIZE,
        ],
    ),
];

const QUERIES: [u32; 5] = [
    glow::SAMPLES_PASSED,
    glow::ANY_SAMPLES_PASSED,
    glow::PRIMITIVES_GENERATED,
    glow::TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN,
    glow::TIME_ELAPSED,
];

/// What a texture's or a sampler's parameters are, as f32; those of samplers first.
const TEXTURE_PARAMETERS: [(u32, usize); 16] = [
    (glow::TEXTURE_BORDER_COLOR, 4),
    (glow::TEXTURE_MIN_FILTER, 1),
    (glow::TEXTURE_MAG_FILTER, 1),
    (glow::TEXTURE_WRAP_S, 1),
    (glow::TEXTURE_WRAP_T, 1),
    (glow::TEXTURE_WRAP_R, 1),
    (glow::TEXTURE_MIN_LOD, 1),
    (glow::TEXTURE_MAX_LOD, 1),
    (glow::TEXTURE_LOD_BIAS, 1),
    (glow::TEXTURE_COMPARE_MODE, 1),
    (glow::TEXTURE_COMPARE_FUNC, 1),
    (glow::TEXTURE_BASE_LEVEL, 1),
    (glow::TEXTURE_MAX_LEVEL, 1),
    (glow::TEXTURE_SWIZZLE_R, 1),
    (glow::TEXTURE_SWIZZLE_G, 1),
    (glow::TEXTURE_SWIZZLE_A, 1),
];
const SAMPLER_PARAMETERS: usize = 11;

pub(super) const DRAW_BUFFERS: u32 = 8;

fn bits(values: &[f32]) -> Vec<i64> {
    values.iter().map(|value| i64::from(value.to_bits())).collect()
}

fn wide(values: &[i32]) -> Vec<i64> {
    values.iter().copied().map(i64::from).collect()
}

fn address(pointer: *mut c_void) -> i64 {
    i64::try_from(pointer.addr()).unwrap()
}

impl Host {
    pub(super) fn limit(&self, name: u32) -> u32 {
        // SAFETY: the context is current.
        unsafe { self.gl.glow().get_parameter_i32(name) }.cast_unsigned()
    }

    /// Every state outside of objects.
    pub(super) fn snapshot(&self) -> Snapshot {
        let mut states = Snapshot::new();
        let glow = self.gl.glow();
        // SAFETY: the context is current; every buffer has room for its state's values.
        unsafe {
            assert_eq!(glow.get_error(), glow::NO_ERROR, "the library leaves no error behind");
            for &(name, state, count) in INTEGERS {
                let mut values = vec![0; count];
                glow.get_parameter_i32_slice(state, &mut values);
                // No stencil has more than 8 bits; drivers may return anything in the others.
                if name.starts_with("stencil") && name.ends_with("bits") {
                    values[0] &= 0xFF;
                }
                states.push((name.to_owned(), wide(&values)));
            }
            for &(name, state, count) in FLOATS {
                let mut values = vec![0.0; count];
                glow.get_parameter_f32_slice(state, &mut values);
                states.push((name.to_owned(), bits(&values)));
            }
            for &capability in CAPABILITIES {
                let name = format!("capability: {capability:#06x}");
                states.push((name, vec![i64::from(glow.is_enabled(capability))]));
            }
            for index in 0..DRAW_BUFFERS {
                let mut mask = [0_u8; 4];
                (self.commands.get_booleani_v)(glow::COLOR_WRITEMASK, index, mask.as_mut_ptr());
                states.push((format!("framebuffer: colour mask {index}"), mask.map(i64::from).to_vec()));
                let blend = glow.get_parameter_indexed_i32(glow::BLEND, index);
                states.push((format!("blending: of draw buffer {index}"), wide(&[blend])));
            }
            let mut range = [0_f64; 2];
            (self.commands.get_doublev)(glow::DEPTH_RANGE, range.as_mut_ptr());
            let range = range.map(|limit| limit.to_bits().cast_signed());
            states.push(("transformation: depth range".to_owned(), range.to_vec()));
            let mask = glow.get_parameter_indexed_i32(glow::SAMPLE_MASK_VALUE, 0);
            states.push(("multisampling: mask".to_owned(), wide(&[mask])));
            for (target, count, parameters) in INDEXED_BUFFERS {
                for index in 0..self.limit(count) {
                    let values = parameters.map(|state| glow.get_parameter_indexed_i64(state, index));
                    states.push((format!("indexed buffer: {index} of {target:#06x}"), values.to_vec()));
                }
            }
            for attribute in 0..self.limit(glow::MAX_VERTEX_ATTRIBS) {
                let mut values = [0; 4];
                (self.commands.get_vertex_attrib_iiv)(
                    attribute,
                    glow::CURRENT_VERTEX_ATTRIB,
                    values.as_mut_ptr(),
                );
                states.push((format!("vertices: generic attribute {attribute}"), wide(&values)));
            }
            for query in QUERIES {
                let mut name = 0;
                (self.commands.get_queryiv)(query, glow::CURRENT_QUERY, &raw mut name);
                states.push((format!("query: {query:#06x}"), wide(&[name])));
            }
            self.units(&mut states);
            if self.is_newer() {
                states.extend(self.snapshot_of_newer());
            }
            assert_eq!(glow.get_error(), glow::NO_ERROR, "the snapshot asks for what there is");
        }
        states
    }

    unsafe fn units(&self, states: &mut Snapshot) {
        let glow = self.gl.glow();
        // SAFETY: the context is current.
        unsafe {
            let active = glow.get_parameter_i32(glow::ACTIVE_TEXTURE).cast_unsigned();
            for unit in 0..self.limit(glow::MAX_COMBINED_TEXTURE_IMAGE_UNITS) {
                glow.active_texture(glow::TEXTURE0 + unit);
                for (target, binding) in TEXTURE_TARGETS {
                    let name = format!("unit: texture {target:#06x} of {unit}");
                    states.push((name, wide(&[glow.get_parameter_i32(binding)])));
                }
                let name = format!("unit: sampler of {unit}");
                states.push((name, wide(&[glow.get_parameter_i32(glow::SAMPLER_BINDING)])));
            }
            glow.active_texture(active);
        }
    }

    /// What the host's own objects hold, those of [`Objects`]; they are the ones that are bound.
    pub(super) fn snapshot_of_objects(&self, objects: &Objects) -> Snapshot {
        let mut states = Snapshot::new();
        let (glow, commands) = (self.gl.glow(), &self.commands);
        // SAFETY: the context is current; the objects are alive; every buffer has room for its state's
        // values.
        unsafe {
            for attribute in 0..self.limit(glow::MAX_VERTEX_ATTRIBS) {
                let mut values = [
                    glow::VERTEX_ATTRIB_ARRAY_ENABLED,
                    glow::VERTEX_ATTRIB_ARRAY_SIZE,
                    glow::VERTEX_ATTRIB_ARRAY_STRIDE,
                    glow::VERTEX_ATTRIB_ARRAY_TYPE,
                    glow::VERTEX_ATTRIB_ARRAY_NORMALIZED,
                    glow::VERTEX_ATTRIB_ARRAY_INTEGER,
                    glow::VERTEX_ATTRIB_ARRAY_DIVISOR,
                    glow::VERTEX_ATTRIB_ARRAY_BUFFER_BINDING,
                ]
                .map(|parameter| {
                    let mut value = 0;
                    (commands.get_vertex_attrib_iv)(attribute, parameter, &raw mut value);
                    i64::from(value)
                })
                .to_vec();
                let mut pointer = std::ptr::null_mut::<c_void>();
                let parameter = glow::VERTEX_ATTRIB_ARRAY_POINTER;
                (commands.get_vertex_attrib_pointer)(attribute, parameter, &raw mut pointer);
                values.push(address(pointer));
                states.push((format!("vertex array: attribute {attribute}"), values));
            }
            for (target, attachment) in [
                (glow::DRAW_FRAMEBUFFER, glow::COLOR_ATTACHMENT1),
                (glow::DRAW_FRAMEBUFFER, glow::DEPTH_ATTACHMENT),
                (glow::READ_FRAMEBUFFER, glow::COLOR_ATTACHMENT3),
            ] {
                let values =
                    [glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, glow::FRAMEBUFFER_ATTACHMENT_OBJECT_NAME].map(
                        |parameter| {
                            glow.get_framebuffer_attachment_parameter_i32(target, attachment, parameter)
                        },
                    );
                let name = format!("framebuffer object: {attachment:#06x} of {target:#06x}");
                states.push((name, wide(&values)));
            }
            let size = [glow::RENDERBUFFER_WIDTH, glow::RENDERBUFFER_INTERNAL_FORMAT]
                .map(|parameter| glow.get_renderbuffer_parameter_i32(glow::RENDERBUFFER, parameter));
            states.push(("renderbuffer object: size and format".to_owned(), wide(&size)));
            let values =
                [glow::BUFFER_SIZE, glow::BUFFER_USAGE, glow::BUFFER_ACCESS_FLAGS, glow::BUFFER_MAPPED]
                    .map(|parameter| glow.get_buffer_parameter_i32(glow::COPY_READ_BUFFER, parameter));
            states.push(("buffer object: mapped one".to_owned(), wide(&values)));
            let mut pointer = std::ptr::null_mut::<c_void>();
            (commands.get_buffer_pointer)(glow::COPY_READ_BUFFER, glow::BUFFER_MAP_POINTER, &raw mut pointer);
            states.push(("buffer object: where it is mapped".to_owned(), vec![address(pointer)]));
            for target in [glow::PIXEL_PACK_BUFFER, glow::PIXEL_UNPACK_BUFFER, glow::ARRAY_BUFFER] {
                let mut bytes = [0_u8; 64];
                glow.get_buffer_sub_data(target, 0, &mut bytes);
                states
                    .push((format!("buffer object: bytes of {target:#06x}"), bytes.map(i64::from).to_vec()));
            }
            let mut uniform = [0.0; 4];
            glow.get_uniform_f32(objects.program, &objects.uniform, &mut uniform);
            states.push(("program object: uniform".to_owned(), bits(&uniform)));
            for (parameter, count) in &TEXTURE_PARAMETERS[..SAMPLER_PARAMETERS] {
                let mut values = [0.0; 4];
                (commands.get_sampler_parameter_fv)(objects.sampler.0.get(), *parameter, values.as_mut_ptr());
                states.push((format!("sampler object: {parameter:#06x}"), bits(&values[..*count])));
            }
            let bound = glow.get_parameter_texture(glow::TEXTURE_BINDING_2D);
            for (index, texture) in objects.textures.iter().enumerate() {
                glow.bind_texture(glow::TEXTURE_2D, Some(*texture));
                for (parameter, count) in TEXTURE_PARAMETERS {
                    let mut values = [0.0; 4];
                    (commands.get_tex_parameter_fv)(glow::TEXTURE_2D, parameter, values.as_mut_ptr());
                    states.push((
                        format!("texture object: {parameter:#06x} of {index}"),
                        bits(&values[..count]),
                    ));
                }
            }
            glow.bind_texture(glow::TEXTURE_2D, bound);
            assert_eq!(glow.get_error(), glow::NO_ERROR, "the snapshot asks for what there is");
        }
        states
    }
}
