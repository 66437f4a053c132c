//! A host that holds every state at an unusual value, and changes to each family of them.

use glam::UVec2;
use glow::HasContext as _;

use super::host::Host;
use super::snapshot::{CAPABILITIES, DRAW_BUFFERS, INDEXED_BUFFERS, TEXTURE_TARGETS};

/// The host's own objects, which are bound while the library is called.
pub(super) struct Objects {
    pub(super) program: glow::Program,
    pub(super) uniform: glow::UniformLocation,
    pub(super) sampler: glow::Sampler,
    /// Textures that the library borrows: a density and a depth.
    pub(super) textures: [glow::Texture; 2],
    /// What indexed targets have ranges of.
    ranges: glow::Buffer,
}

impl Host {
    /// Sets what a host may hold to something unusual.
    pub(super) fn set_everything(&self, textures: [glow::Texture; 2]) -> Objects {
        let objects = self.make_objects(textures);
        self.set_bindings(&objects);
        self.set_values();
        if self.is_newer() {
            self.set_newer();
        }
        // SAFETY: the context is current.
        assert_eq!(unsafe { self.gl.glow().get_error() }, glow::NO_ERROR, "all of it is OpenGL 3.3 core");
        objects
    }

    fn make_objects(&self, textures: [glow::Texture; 2]) -> Objects {
        let glow = self.gl.glow();
        // SAFETY: the context is current, and all names are created here.
        unsafe {
            let program = glow.create_program().unwrap();
            let fragment = "#version 330 core\nuniform vec4 u; out vec4 c; void main() { c = u; }";
            for (stage, text) in [
                (glow::VERTEX_SHADER, "#version 330 core\nvoid main() { gl_Position = vec4(0.0); }"),
                (glow::FRAGMENT_SHADER, fragment),
            ] {
                let shader = glow.create_shader(stage).unwrap();
                glow.shader_source(shader, text);
                glow.compile_shader(shader);
                glow.attach_shader(program, shader);
            }
            glow.link_program(program);
            glow.use_program(Some(program));
            let uniform = glow.get_uniform_location(program, "u").unwrap();
            glow.uniform_4_f32(Some(&uniform), 1.0, 2.0, 3.0, 4.0);
            for texture in textures {
                glow.bind_texture(glow::TEXTURE_2D, Some(texture));
                for (parameter, value) in [
                    (glow::TEXTURE_MIN_FILTER, glow::NEAREST),
                    (glow::TEXTURE_MAG_FILTER, glow::LINEAR),
                    (glow::TEXTURE_WRAP_S, glow::MIRRORED_REPEAT),
                    (glow::TEXTURE_MAX_LEVEL, 3),
                    (glow::TEXTURE_SWIZZLE_G, glow::ONE),
                ] {
                    glow.tex_parameter_i32(glow::TEXTURE_2D, parameter, value.cast_signed());
                }
            }
            let ranges = glow.create_buffer().unwrap();
            glow.bind_buffer(glow::UNIFORM_BUFFER, Some(ranges));
            glow.buffer_data_size(glow::UNIFORM_BUFFER, 1024, glow::STATIC_DRAW);
            Objects { program, uniform, sampler: glow.create_sampler().unwrap(), textures, ranges }
        }
    }

    fn set_bindings(&self, objects: &Objects) {
        let glow = self.gl.glow();
        // SAFETY: the context is current, and all names are created here.
        unsafe {
            glow.bind_vertex_array(Some(glow.create_vertex_array().unwrap()));
            for target in [
                glow::ARRAY_BUFFER,
                glow::ELEMENT_ARRAY_BUFFER,
                glow::COPY_READ_BUFFER,
                glow::COPY_WRITE_BUFFER,
                glow::PIXEL_PACK_BUFFER,
                glow::PIXEL_UNPACK_BUFFER,
                glow::TEXTURE_BUFFER,
            ] {
                glow.bind_buffer(target, Some(glow.create_buffer().unwrap()));
                glow.buffer_data_u8_slice(target, &[7; 64], glow::DYNAMIC_COPY);
            }
            // A mapped buffer stays mapped.
            assert!(!glow.map_buffer_range(glow::COPY_READ_BUFFER, 16, 32, glow::MAP_WRITE_BIT).is_null());
            glow.enable_vertex_attrib_array(2);
            glow.vertex_attrib_pointer_f32(2, 3, glow::FLOAT, true, 20, 4);
            glow.vertex_attrib_divisor(2, 5);
            for (target, count, _) in INDEXED_BUFFERS {
                for index in 0..self.limit(count) {
                    glow.bind_buffer_range(target, index, Some(objects.ranges), 256, 64);
                }
            }
            for attribute in 0..self.limit(glow::MAX_VERTEX_ATTRIBS) {
                glow.vertex_attrib_4_f32(attribute, 0.25, 0.5, 0.75, 0.125);
            }
            for unit in 0..self.limit(glow::MAX_COMBINED_TEXTURE_IMAGE_UNITS) {
                glow.active_texture(glow::TEXTURE0 + unit);
                for (target, _) in TEXTURE_TARGETS {
                    glow.bind_texture(target, Some(glow.create_texture().unwrap()));
                }
                glow.bind_sampler(unit, Some(objects.sampler));
            }
            let parameter = glow::TEXTURE_WRAP_T;
            glow.sampler_parameter_i32(objects.sampler, parameter, glow::MIRRORED_REPEAT.cast_signed());
            glow.active_texture(glow::TEXTURE5);
            glow.bind_renderbuffer(glow::RENDERBUFFER, Some(glow.create_renderbuffer().unwrap()));
            glow.renderbuffer_storage(glow::RENDERBUFFER, glow::RGBA8, 6, 5);
            for (target, attachment) in [
                (glow::DRAW_FRAMEBUFFER, glow::COLOR_ATTACHMENT1),
                (glow::READ_FRAMEBUFFER, glow::COLOR_ATTACHMENT3),
            ] {
                glow.bind_framebuffer(target, Some(glow.create_framebuffer().unwrap()));
                let texture = Some(objects.textures[0]);
                glow.framebuffer_texture_2d(target, attachment, glow::TEXTURE_2D, texture, 0);
            }
            // A driver returns the stencil reference where there is a stencil, which it detects when the
            // status is checked.
            let (target, attachment) = (glow::DRAW_FRAMEBUFFER, glow::DEPTH_STENCIL_ATTACHMENT);
            let texture = Some(objects.textures[1]);
            glow.framebuffer_texture_2d(target, attachment, glow::TEXTURE_2D, texture, 0);
            assert_eq!(glow.check_framebuffer_status(target), glow::FRAMEBUFFER_COMPLETE);
            let buffers: Vec<_> =
                (0..DRAW_BUFFERS).rev().map(|index| glow::COLOR_ATTACHMENT0 + index).collect();
            glow.draw_buffers(&buffers);
            glow.read_buffer(glow::COLOR_ATTACHMENT3);
            for query in [glow::PRIMITIVES_GENERATED, glow::TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN] {
                glow.begin_query(query, glow.create_query().unwrap());
            }
            if !self.is_strict {
                glow.push_debug_group(glow::DEBUG_SOURCE_APPLICATION, 1, "of the host");
            }
        }
    }

    fn set_values(&self) {
        let (glow, commands) = (self.gl.glow(), &self.commands);
        // SAFETY: the context is current.
        unsafe {
            glow.viewport(3, 5, 7, 11);
            glow.depth_range_f64(0.1, 0.7);
            glow.scissor(1, 2, 3, 4);
            glow.blend_func_separate(glow::ZERO, glow::DST_COLOR, glow::DST_ALPHA, glow::SRC_ALPHA);
            glow.blend_equation_separate(glow::FUNC_SUBTRACT, glow::MAX);
            glow.blend_color(0.5, 0.25, 0.75, 0.125);
            glow.clear_color(1.0, 0.0, 1.0, 0.0);
            glow.clear_depth_f64(0.25);
            glow.clear_stencil(3);
            glow.depth_mask(false);
            glow.depth_func(glow::NEVER);
            glow.stencil_func(glow::NEVER, 1, 2);
            glow.stencil_func_separate(glow::BACK, glow::LESS, 3, 4);
            glow.stencil_op(glow::ZERO, glow::INVERT, glow::INCR);
            glow.stencil_op_separate(glow::BACK, glow::REPLACE, glow::DECR, glow::INCR_WRAP);
            glow.stencil_mask(3);
            glow.stencil_mask_separate(glow::BACK, 5);
            glow.cull_face(glow::FRONT_AND_BACK);
            glow.front_face(glow::CW);
            glow.polygon_mode(glow::FRONT_AND_BACK, glow::LINE);
            glow.polygon_offset(2.0, 3.0);
            glow.line_width(2.0);
            glow.sample_coverage(0.5, true);
            (commands.sample_mask_i)(0, 6);
            (commands.point_size)(3.0);
            (commands.point_parameter_f)(glow::POINT_FADE_THRESHOLD_SIZE, 2.0);
            (commands.point_parameter_i)(glow::POINT_SPRITE_COORD_ORIGIN, glow::LOWER_LEFT.cast_signed());
            (commands.primitive_restart_index)(77);
            (commands.provoking_vertex)(glow::FIRST_VERTEX_CONVENTION);
            (commands.clamp_color)(glow::CLAMP_READ_COLOR, u32::from(glow::TRUE));
            (commands.logic_op)(glow::XOR);
            for side in [
                [glow::PACK_ALIGNMENT, glow::PACK_ROW_LENGTH, glow::PACK_IMAGE_HEIGHT],
                [glow::UNPACK_ALIGNMENT, glow::UNPACK_ROW_LENGTH, glow::UNPACK_IMAGE_HEIGHT],
            ] {
                for (parameter, value) in side.into_iter().zip([8, 99, 50]) {
                    glow.pixel_store_i32(parameter, value);
                }
            }
            for (value, parameter) in (2..).zip([
                glow::PACK_SKIP_ROWS,
                glow::PACK_SKIP_PIXELS,
                glow::PACK_SKIP_IMAGES,
                glow::UNPACK_SKIP_ROWS,
                glow::UNPACK_SKIP_PIXELS,
                glow::UNPACK_SKIP_IMAGES,
            ]) {
                glow.pixel_store_i32(parameter, value);
            }
            for parameter in
                [glow::PACK_SWAP_BYTES, glow::PACK_LSB_FIRST, glow::UNPACK_SWAP_BYTES, glow::UNPACK_LSB_FIRST]
            {
                glow.pixel_store_i32(parameter, 1);
            }
            for hint in [
                glow::FRAGMENT_SHADER_DERIVATIVE_HINT,
                glow::LINE_SMOOTH_HINT,
                glow::POLYGON_SMOOTH_HINT,
                glow::TEXTURE_COMPRESSION_HINT,
            ] {
                glow.hint(hint, glow::NICEST);
            }
            for &capability in CAPABILITIES {
                if glow.is_enabled(capability) {
                    glow.disable(capability);
                } else {
                    glow.enable(capability);
                }
            }
            for index in 0..DRAW_BUFFERS {
                glow.color_mask_draw_buffer(index, index % 2 == 1, true, index == 0, false);
                glow.enable_draw_buffer(glow::BLEND, index);
            }
        }
    }
}

/// A change of one state of each family.
pub(super) type Plant = unsafe fn(&Host, &Objects);

#[expect(
    clippy::undocumented_unsafe_blocks,
    reason = "the context is current in each, as the caller vouches"
)]
pub(super) const PLANTS: &[(&str, Plant)] = &[
    ("binding", |host, _| unsafe { host.gl.glow().bind_buffer(glow::COPY_WRITE_BUFFER, None) }),
    ("transformation", |host, _| unsafe { host.gl.glow().viewport(1, 1, 1, 1) }),
    ("vertices", |host, _| unsafe { host.gl.glow().vertex_attrib_4_f32(5, 9.0, 9.0, 9.0, 9.0) }),
    ("colour", |host, _| unsafe {
        (host.commands.clamp_color)(glow::CLAMP_READ_COLOR, glow::FIXED_ONLY);
    }),
    ("rasteriser", |host, _| unsafe { (host.commands.point_size)(7.0) }),
    ("multisampling", |host, _| unsafe { (host.commands.sample_mask_i)(0, 9) }),
    ("fragments", |host, _| unsafe { (host.commands.logic_op)(glow::COPY) }),
    ("stencil", |host, _| unsafe { host.gl.glow().stencil_mask_separate(glow::BACK, 1) }),
    ("depth", |host, _| unsafe { host.gl.glow().clear_depth_f64(0.125) }),
    ("blending", |host, _| unsafe { host.gl.glow().blend_color(0.0, 1.0, 0.0, 1.0) }),
    ("framebuffer", |host, _| unsafe {
        host.gl.glow().color_mask_draw_buffer(1, false, true, false, false);
    }),
    ("pixels", |host, _| unsafe { host.gl.glow().pixel_store_i32(glow::PACK_IMAGE_HEIGHT, 51) }),
    ("hint", |host, _| unsafe { host.gl.glow().hint(glow::LINE_SMOOTH_HINT, glow::FASTEST) }),
    ("debug", |host, _| unsafe {
        host.gl.glow().push_debug_group(glow::DEBUG_SOURCE_APPLICATION, 2, "left open");
    }),
    ("capability", |host, _| unsafe { host.gl.glow().enable(glow::DITHER) }),
    ("indexed buffer", |host, objects| unsafe {
        host.gl.glow().bind_buffer(glow::UNIFORM_BUFFER, Some(objects.ranges));
        host.gl.glow().bind_buffer_range(glow::UNIFORM_BUFFER, 3, Some(objects.ranges), 0, 64);
    }),
    ("query", |host, _| unsafe { host.gl.glow().end_query(glow::PRIMITIVES_GENERATED) }),
    ("unit", |host, _| unsafe { host.gl.glow().bind_texture(glow::TEXTURE_3D, None) }),
    ("vertex array", |host, _| unsafe { host.gl.glow().disable_vertex_attrib_array(2) }),
    ("framebuffer object", |host, _| unsafe {
        let (target, attachment) = (glow::DRAW_FRAMEBUFFER, glow::COLOR_ATTACHMENT1);
        host.gl.glow().framebuffer_texture_2d(target, attachment, glow::TEXTURE_2D, None, 0);
    }),
    ("renderbuffer object", |host, _| unsafe {
        host.gl.glow().renderbuffer_storage(glow::RENDERBUFFER, glow::RGBA8, 9, 9);
    }),
    ("buffer object", |host, _| unsafe { host.gl.glow().unmap_buffer(glow::COPY_READ_BUFFER) }),
    ("program object", |host, objects| unsafe {
        host.gl.glow().uniform_4_f32(Some(&objects.uniform), 1.0, 2.0, 3.0, 5.0);
    }),
    ("sampler object", |host, objects| unsafe {
        host.gl.glow().sampler_parameter_f32(objects.sampler, glow::TEXTURE_MIN_LOD, 1.0);
    }),
    ("texture object", |host, objects| unsafe {
        let glow = host.gl.glow();
        let bound = glow.get_parameter_texture(glow::TEXTURE_BINDING_2D);
        glow.bind_texture(glow::TEXTURE_2D, Some(objects.textures[1]));
        glow.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MAX_LEVEL, 2);
        glow.bind_texture(glow::TEXTURE_2D, bound);
    }),
];

/// A density texture of a host.
pub(super) fn density_texture(host: &Host, size: UVec2, counts: &[u32]) -> glow::Texture {
    let glow = host.gl.glow();
    // SAFETY: the context is current, and the slice holds a count for each pixel.
    unsafe {
        let texture = glow.create_texture().unwrap();
        glow.bind_texture(glow::TEXTURE_2D, Some(texture));
        glow.tex_image_2d(
            glow::TEXTURE_2D,
            0,
            glow::R32UI.cast_signed(),
            size.x.cast_signed(),
            size.y.cast_signed(),
            0,
            glow::RED_INTEGER,
            glow::UNSIGNED_INT,
            glow::PixelUnpackData::Slice(Some(bytemuck::cast_slice(counts))),
        );
        texture
    }
}
