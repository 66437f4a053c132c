//! A host: a context, the commands that glow lacks, and a framebuffer or a shader that fails on demand.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::ffi::{CStr, c_void};

use varikernel::{Gl, context};

use crate::shaders::is_core;

/// Commands of OpenGL 3.3 core that glow does not have, with their types.
macro_rules! commands {
    ($($field:ident = $name:literal: ($($argument:ty),*) $(-> $result:ty)?,)*) => {
        pub(super) struct Commands {
            $(pub(super) $field: unsafe extern "system" fn($($argument),*) $(-> $result)?,)*
        }

        impl Commands {
            fn of(addresses: &BTreeMap<String, usize>) -> Self {
                Self {
                    $($field: {
                        type Command = unsafe extern "system" fn($($argument),*) $(-> $result)?;
                        let address = std::ptr::with_exposed_provenance::<c_void>(addresses[$name]);
                        assert!(!address.is_null(), $name);
                        // SAFETY: this is the address of the command of that name, which has this type.
                        unsafe { std::mem::transmute::<*const c_void, Command>(address) }
                    },)*
                }
            }
        }
    };
}

commands! {
    get_booleani_v = "glGetBooleani_v": (u32, u32, *mut u8),
    is_enabledi = "glIsEnabledi": (u32, u32) -> u8,
    get_doublev = "glGetDoublev": (u32, *mut f64),
    get_queryiv = "glGetQueryiv": (u32, u32, *mut i32),
    get_vertex_attrib_iiv = "glGetVertexAttribIiv": (u32, u32, *mut i32),
    get_vertex_attrib_iv = "glGetVertexAttribiv": (u32, u32, *mut i32),
    get_vertex_attrib_pointer = "glGetVertexAttribPointerv": (u32, u32, *mut *mut c_void),
    get_buffer_pointer = "glGetBufferPointerv": (u32, u32, *mut *mut c_void),
    get_tex_parameter_fv = "glGetTexParameterfv": (u32, u32, *mut f32),
    get_sampler_parameter_fv = "glGetSamplerParameterfv": (u32, u32, *mut f32),
    point_size = "glPointSize": (f32),
    point_parameter_f = "glPointParameterf": (u32, f32),
    point_parameter_i = "glPointParameteri": (u32, i32),
    sample_mask_i = "glSampleMaski": (u32, u32),
    primitive_restart_index = "glPrimitiveRestartIndex": (u32),
    provoking_vertex = "glProvokingVertex": (u32),
    clamp_color = "glClampColor": (u32, u32),
    logic_op = "glLogicOp": (u32),
    begin_conditional_render = "glBeginConditionalRender": (u32, u32),
    end_conditional_render = "glEndConditionalRender": (),
    // Newer than OpenGL 3.3.
    get_floati_v = "glGetFloati_v": (u32, u32, *mut f32),
    get_doublei_v = "glGetDoublei_v": (u32, u32, *mut f64),
    clip_control = "glClipControl": (u32, u32),
    gen_program_pipelines = "glGenProgramPipelines": (i32, *mut u32),
    bind_program_pipeline = "glBindProgramPipeline": (u32),
}

/// A context and all that a host may do with it.
pub(super) struct Host {
    pub(super) gl: Gl,
    pub(super) commands: Commands,
    /// Whether the library is given the commands of OpenGL 3.3 core alone.
    pub(super) is_strict: bool,
}

impl Host {
    pub(super) fn new(choice: &context::DeviceChoice) -> Self {
        Self::open(choice, false)
    }

    /// With a library that knows OpenGL 3.3 core alone.
    pub(super) fn strict(choice: &context::DeviceChoice) -> Self {
        Self::open(choice, true)
    }

    fn open(choice: &context::DeviceChoice, is_strict: bool) -> Self {
        let (candidates, _) = context::candidates();
        let candidate = candidates.iter().find(|candidate| candidate.choice == *choice).unwrap();
        let mut addresses = BTreeMap::new();
        // SAFETY: addresses are passed on as they are, but for that of a command which may answer that it
        // failed.
        let gl = unsafe {
            candidate.open_through(|name, real| {
                let known = name.to_str().unwrap();
                addresses.insert(known.to_owned(), real.expose_provenance());
                if is_strict && !is_core(known) { std::ptr::null() } else { failing(name, real) }
            })
        }
        .unwrap();
        Self { gl, commands: Commands::of(&addresses), is_strict }
    }
}

thread_local! {
    static CHECK_FRAMEBUFFER_STATUS: Cell<usize> = const { Cell::new(0) };
    static GET_SHADERIV: Cell<usize> = const { Cell::new(0) };
    /// How many more calls that can fail succeed; nothing once one has failed.
    static FAIL_AT: Cell<Option<u32>> = const { Cell::new(None) };
}

fn failing(name: &CStr, real: *const c_void) -> *const c_void {
    if name == c"glCheckFramebufferStatus" {
        CHECK_FRAMEBUFFER_STATUS.set(real.expose_provenance());
        return check_framebuffer_status as *const c_void;
    }
    if name == c"glGetShaderiv" {
        GET_SHADERIV.set(real.expose_provenance());
        return get_shaderiv as *const c_void;
    }
    real
}

fn fails_now() -> bool {
    let left = FAIL_AT.get();
    FAIL_AT.set(left.and_then(|calls| calls.checked_sub(1)));
    left == Some(0)
}

extern "system" fn check_framebuffer_status(target: u32) -> u32 {
    if fails_now() {
        return glow::FRAMEBUFFER_UNSUPPORTED;
    }
    let real = std::ptr::with_exposed_provenance::<c_void>(CHECK_FRAMEBUFFER_STATUS.get());
    // SAFETY: the address is that of glCheckFramebufferStatus, which has this type.
    unsafe { std::mem::transmute::<*const c_void, extern "system" fn(u32) -> u32>(real)(target) }
}

extern "system" fn get_shaderiv(shader: u32, parameter: u32, value: *mut i32) {
    let real = std::ptr::with_exposed_provenance::<c_void>(GET_SHADERIV.get());
    // SAFETY: the address is that of glGetShaderiv, which has this type; the caller's pointer is passed on.
    unsafe {
        std::mem::transmute::<*const c_void, extern "system" fn(u32, u32, *mut i32)>(real)(
            shader, parameter, value,
        );
        if parameter == glow::COMPILE_STATUS && fails_now() {
            *value = 0;
        }
    }
}

/// Lets `call` fail at its first framebuffer or shader, then at its second, until there is none left; `after`
/// sees each.
pub(super) fn fail_at_each<T>(mut call: impl FnMut() -> varikernel::Result<T>, after: impl Fn(u32)) -> u32 {
    for failures in 0.. {
        FAIL_AT.set(Some(failures));
        let result = call();
        if FAIL_AT.replace(None).is_some() {
            assert!(result.is_ok(), "nothing failed");
            return failures;
        }
        assert!(result.is_err(), "failure {failures} is lost");
        drop(result);
        after(failures);
    }
    unreachable!("a call has an end")
}
