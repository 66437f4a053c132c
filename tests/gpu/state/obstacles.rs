//! States of a host under which no call can work: refused, with nothing changed, or dealt with.

use glow::HasContext as _;
use varikernel::{Error, Gl, StatePolicy};

use super::host::Host;
use super::{Watch, borrowed_textures, calls, egl_choice};
use crate::compatible::compatible;

/// A frame is refused with these words, and works once the obstacle is gone.
fn refused(host: &Host, words: &str, set: impl FnOnce(&Watch<'_>), clear: impl FnOnce(&Watch<'_>)) {
    let mut watch = Watch::new(host, StatePolicy::Restore, borrowed_textures(host), None);
    let map = calls::map(&watch);
    let mut pipeline = calls::pipeline(&watch);
    set(&watch);
    watch.before = watch.now();
    let error = pipeline.render(&map).unwrap_err();
    assert!(matches!(error, Error::HostState { .. }), "{error:?}");
    assert!(error.to_string().contains(words), "{error}");
    watch.unchanged(words);
    clear(&watch);
    pipeline.render(&map).unwrap();
    assert_eq!(pipeline.radii().read().unwrap(), calls::expected().radius);
}

/// A program that draws nothing, and captures where its vertices are.
fn capturing(host: &Host) -> glow::Program {
    let glow = host.gl.glow();
    // SAFETY: the context is current, and all names are created here.
    unsafe {
        let program = glow.create_program().unwrap();
        let shader = glow.create_shader(glow::VERTEX_SHADER).unwrap();
        let text = "#version 330 core\nflat out uvec4 at; void main() { at = uvec4(gl_VertexID); gl_Position = vec4(0); }";
        glow.shader_source(shader, text);
        glow.compile_shader(shader);
        glow.attach_shader(program, shader);
        glow.transform_feedback_varyings(program, &["at"], glow::INTERLEAVED_ATTRIBS);
        glow.link_program(program);
        assert!(glow.get_program_link_status(program));
        program
    }
}

/// Captures the numbers of two vertices, 1 and 2, with a call between them.
fn capture(host: &Host, call: impl FnOnce()) -> [u32; 8] {
    let (glow, program) = (host.gl.glow(), capturing(host));
    // SAFETY: the context is current, and all names are created here.
    unsafe {
        let buffer = glow.create_buffer().unwrap();
        glow.bind_buffer_base(glow::TRANSFORM_FEEDBACK_BUFFER, 0, Some(buffer));
        glow.buffer_data_size(glow::TRANSFORM_FEEDBACK_BUFFER, 1 << 12, glow::STATIC_READ);
        glow.bind_vertex_array(Some(glow.create_vertex_array().unwrap()));
        // There is no window to draw to.
        glow.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(glow.create_framebuffer().unwrap()));
        glow.bind_renderbuffer(glow::RENDERBUFFER, Some(glow.create_renderbuffer().unwrap()));
        glow.renderbuffer_storage(glow::RENDERBUFFER, glow::RGBA8, 4, 4);
        let renderbuffer = glow.get_parameter_i32(glow::RENDERBUFFER_BINDING).cast_unsigned();
        glow.framebuffer_renderbuffer(
            glow::DRAW_FRAMEBUFFER,
            glow::COLOR_ATTACHMENT0,
            glow::RENDERBUFFER,
            std::num::NonZeroU32::new(renderbuffer).map(glow::NativeRenderbuffer),
        );
        glow.use_program(Some(program));
        glow.begin_transform_feedback(glow::POINTS);
        glow.draw_arrays(glow::POINTS, 1, 1);
        call();
        glow.draw_arrays(glow::POINTS, 2, 1);
        glow.end_transform_feedback();
        glow.use_program(None);
        let mut bytes = [0_u8; 32];
        glow.get_buffer_sub_data(glow::TRANSFORM_FEEDBACK_BUFFER, 0, &mut bytes);
        assert_eq!(glow.get_error(), glow::NO_ERROR);
        let numbers: [u32; 8] = bytemuck::pod_read_unaligned(&bytes);
        numbers
    }
}

#[test]
fn transform_feedback_pauses_for_a_call_and_goes_on() {
    let host = Host::new(&egl_choice());
    let watch = Watch::new(&host, StatePolicy::Restore, borrowed_textures(&host), None);
    let map = calls::map(&watch);
    let mut pipeline = calls::pipeline(&watch);
    let captured = capture(&host, || {
        pipeline.render(&map).unwrap();
    });
    assert_eq!(captured, [1, 1, 1, 1, 2, 2, 2, 2], "nothing of the call's");
    assert_eq!(pipeline.radii().read().unwrap(), calls::expected().radius);
}

#[test]
fn transform_feedback_is_refused_where_it_cannot_pause() {
    let host = Host::strict(&egl_choice());
    let watch = Watch::new(&host, StatePolicy::Restore, borrowed_textures(&host), None);
    let map = calls::map(&watch);
    let mut pipeline = calls::pipeline(&watch);
    let captured = capture(&host, || {
        let error = pipeline.render(&map).unwrap_err();
        assert!(error.to_string().contains("glEndTransformFeedback"), "{error}");
    });
    assert_eq!(captured, [1, 1, 1, 1, 2, 2, 2, 2], "it is not disturbed");
}

#[test]
fn conditional_rendering_is_refused() {
    for open in [Host::new, Host::strict] {
        let host = open(&egl_choice());
        let begin = |watch: &Watch<'_>| {
            let glow = watch.gl.glow();
            // SAFETY: the context is current, and the query has a result, which is 0.
            unsafe {
                let query = glow.create_query().unwrap();
                glow.begin_query(glow::SAMPLES_PASSED, query);
                glow.end_query(glow::SAMPLES_PASSED);
                (host.commands.begin_conditional_render)(query.0.get(), glow::QUERY_WAIT);
            }
        };
        // SAFETY: the context is current.
        let end = |_: &Watch<'_>| unsafe { (host.commands.end_conditional_render)() };
        refused(&host, "glEndConditionalRender", begin, end);
    }
}

#[test]
fn a_program_that_is_marked_for_deletion_is_refused() {
    let host = Host::new(&egl_choice());
    let bind = |watch: &Watch<'_>| {
        let glow = watch.gl.glow();
        let program = capturing(&host);
        // SAFETY: the context is current; the program stays until it is no longer bound.
        unsafe {
            glow.use_program(Some(program));
            glow.delete_program(program);
        }
    };
    // SAFETY: the context is current.
    let leave = |watch: &Watch<'_>| unsafe { watch.gl.glow().use_program(None) };
    refused(&host, "marked for deletion", bind, leave);
}

#[test]
fn the_groups_of_a_host_that_has_all_of_them_stay() {
    let host = Host::new(&egl_choice());
    let glow = host.gl.glow();
    let mut watch = Watch::new(&host, StatePolicy::Restore, borrowed_textures(&host), None);
    let map = calls::map(&watch);
    let mut pipeline = calls::pipeline(&watch);
    let limit = host.limit(glow::MAX_DEBUG_GROUP_STACK_DEPTH);
    // All levels but one, then that one as well.
    for left in [1, 0] {
        while host.limit(glow::DEBUG_GROUP_STACK_DEPTH) < limit - left {
            // SAFETY: the context is current, and has KHR_debug.
            unsafe { glow.push_debug_group(glow::DEBUG_SOURCE_APPLICATION, 1, "of the host") };
        }
        watch.before = watch.now();
        pipeline.render(&map).unwrap();
        watch.unchanged("a frame with all groups pushed");
        assert_eq!(pipeline.radii().read().unwrap(), calls::expected().radius);
    }
}

/// An engine with two contexts has the other one current.
#[test]
fn another_context_is_noticed_and_keeps_its_objects() {
    let [ours, other] = [compatible(), compatible()];
    ours.make_current();
    assert!(ours.gl.is_current() && !other.gl.is_current());
    let (map, mut pipeline) = calls::uploaded(&ours.gl);
    pipeline.render(&map).unwrap();
    other.make_current();
    let glow = other.gl.glow();
    // SAFETY: the context is current; names in it count up as in the first.
    let textures: Vec<_> = (0..64).map(|_| unsafe { glow.create_texture() }.unwrap()).collect();
    for &texture in &textures {
        // SAFETY: as above; a name becomes a texture when it is bound.
        unsafe { glow.bind_texture(glow::TEXTURE_2D, Some(texture)) };
    }
    let error = pipeline.render(&map).unwrap_err();
    assert!(matches!(error, Error::WrongContext), "{error:?}");
    assert!(matches!(pipeline.radii().read(), Err(Error::WrongContext)));
    ours.make_current();
    pipeline.render(&map).unwrap();
    assert_eq!(pipeline.radii().read().unwrap(), calls::expected().radius);
    other.make_current();
    drop((map, pipeline));
    for texture in textures {
        // SAFETY: as above.
        assert!(unsafe { glow.is_texture(texture) }, "a drop deletes nothing here");
    }
}

/// What OpenGL 3.1 dropped, in a context that still has it.
mod compatibility {
    use super::*;

    const POLYGON_STIPPLE: u32 = 0x0B42;
    const ALPHA_TEST: u32 = 0x0BC0;
    const POINT_SMOOTH: u32 = 0x0B10;
    const COMPILE: u32 = 0x1300;

    #[test]
    fn stipple_and_alpha_tests_neither_spoil_radii_nor_change() {
        let context = compatible();
        let gl: &Gl = &context.gl;
        let (map, mut pipeline) = calls::uploaded(gl);
        let capabilities = [POLYGON_STIPPLE, ALPHA_TEST, POINT_SMOOTH];
        // SAFETY: the context is current, and one of compatibility.
        unsafe {
            (context.polygon_stipple)([0x55_u8; 128].as_ptr());
            (context.alpha_func)(glow::NEVER, 0.5);
            gl.glow().polygon_mode(glow::FRONT, glow::LINE);
            gl.glow().polygon_mode(glow::BACK, glow::POINT);
            for capability in capabilities {
                gl.glow().enable(capability);
            }
        }
        pipeline.render(&map).unwrap();
        assert_eq!(pipeline.radii().read().unwrap(), calls::expected().radius);
        for capability in capabilities {
            // SAFETY: as above.
            assert!(unsafe { gl.glow().is_enabled(capability) }, "{capability:#06x}");
        }
        let mut modes = [0; 2];
        // SAFETY: as above; it has two values.
        unsafe { gl.glow().get_parameter_i32_slice(glow::POLYGON_MODE, &mut modes) };
        assert_eq!(modes.map(i32::cast_unsigned), [glow::LINE, glow::POINT], "front and back apart");
    }

    #[test]
    fn an_open_display_list_is_refused_and_records_nothing() {
        let context = compatible();
        let gl: &Gl = &context.gl;
        let (map, mut pipeline) = calls::uploaded(gl);
        // SAFETY: the context is current, and one of compatibility.
        unsafe { (context.new_list)(1, COMPILE) };
        let error = pipeline.render(&map).unwrap_err();
        assert!(error.to_string().contains("glEndList"), "{error}");
        // SAFETY: as above.
        unsafe { (context.end_list)() };
        pipeline.render(&map).unwrap();
        assert_eq!(pipeline.radii().read().unwrap(), calls::expected().radius);
    }
}
