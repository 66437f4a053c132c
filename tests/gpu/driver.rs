//! A driver that counts its objects and fails on demand: commands wrapped on their way through the loader.
//!
//! All is of the thread, as a context is.

#![expect(unsafe_code, reason = "commands are wrapped to count them")]

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::ffi::{CStr, c_void};

use varikernel::Gl;

use crate::support::working_candidates;

thread_local! {
    static TEXTURES: Cell<i64> = const { Cell::new(0) };
    static FRAMEBUFFERS: Cell<i64> = const { Cell::new(0) };
    static PROGRAMS: Cell<i64> = const { Cell::new(0) };
    static SHADERS: Cell<i64> = const { Cell::new(0) };
    static SAMPLERS: Cell<i64> = const { Cell::new(0) };
    static VERTEX_ARRAYS: Cell<i64> = const { Cell::new(0) };
    static QUERIES: Cell<i64> = const { Cell::new(0) };
    static BUFFERS: Cell<i64> = const { Cell::new(0) };

    static REAL: RefCell<BTreeMap<String, usize>> = const { RefCell::new(BTreeMap::new()) };

    /// How many more calls that can fail succeed; nothing once one has failed.
    pub(crate) static FAIL_AT: Cell<Option<u32>> = const { Cell::new(None) };

    /// What glGetError answers next.
    pub(crate) static PENDING_ERROR: Cell<u32> = const { Cell::new(glow::NO_ERROR) };

    /// What glGetError answers, and how many times it is asked before.
    pub(crate) static LATER_ERROR: Cell<Option<(u32, u32)>> = const { Cell::new(None) };

    /// What GL_RENDERER is, if not the real one.
    pub(crate) static RENDERER: Cell<Option<&'static CStr>> = const { Cell::new(None) };
}

/// Live textures, framebuffers, programs, shaders, samplers, vertex arrays, queries, buffers.
pub(crate) fn live() -> [i64; 8] {
    [&TEXTURES, &FRAMEBUFFERS, &PROGRAMS, &SHADERS, &SAMPLERS, &VERTEX_ARRAYS, &QUERIES, &BUFFERS]
        .map(std::thread::LocalKey::get)
}

/// The first device that works, behind the wrappers; `command` is asked after them.
///
/// # Safety
/// As `Candidate::open_through`.
pub(crate) unsafe fn open_through(mut command: impl FnMut(&CStr, *const c_void) -> *const c_void) -> Gl {
    // SAFETY: each wrapper calls the command that it stands for; the caller guarantees for `command`.
    unsafe {
        working_candidates()[0].open_through(|name, address| {
            let wrapped = wrappers::of(name).map_or(address, |wrapper| {
                REAL.with_borrow_mut(|real| {
                    real.insert(name.to_str().unwrap().to_owned(), address.expose_provenance())
                });
                wrapper
            });
            command(name, wrapped)
        })
    }
    .unwrap()
}

/// The first device that works, behind the wrappers.
pub(crate) fn open() -> Gl {
    // SAFETY: addresses are passed on as they are.
    unsafe { open_through(|_, address| address) }
}

/// Wraps a `glGen*`/`glDelete*` pair so that the live names are counted.
macro_rules! counted {
    ($generate:ident, $delete:ident, $live:ident) => {
        extern "system" fn $generate(count: i32, names: *mut u32) {
            $live.set($live.get() + i64::from(count));
            forward(stringify!($generate), |address| {
                // SAFETY: the address is that of the command of this name, which has this type.
                let real: extern "system" fn(i32, *mut u32) = unsafe { std::mem::transmute(address) };
                real(count, names);
            });
        }
        extern "system" fn $delete(count: i32, names: *const u32) {
            $live.set($live.get() - i64::from(count));
            forward(stringify!($delete), |address| {
                // SAFETY: as above.
                let real: extern "system" fn(i32, *const u32) = unsafe { std::mem::transmute(address) };
                real(count, names);
            });
        }
    };
}

#[expect(non_snake_case, reason = "named as the commands that they wrap")]
mod wrappers {
    use super::*;

    counted!(glGenTextures, glDeleteTextures, TEXTURES);
    counted!(glGenFramebuffers, glDeleteFramebuffers, FRAMEBUFFERS);
    counted!(glGenSamplers, glDeleteSamplers, SAMPLERS);
    counted!(glGenVertexArrays, glDeleteVertexArrays, VERTEX_ARRAYS);
    counted!(glGenQueries, glDeleteQueries, QUERIES);
    counted!(glGenBuffers, glDeleteBuffers, BUFFERS);

    pub(super) extern "system" fn glCreateProgram() -> u32 {
        PROGRAMS.set(PROGRAMS.get() + 1);
        // SAFETY: the address is that of the command of this name, which has this type.
        forward("glCreateProgram", |address| unsafe {
            std::mem::transmute::<*const c_void, extern "system" fn() -> u32>(address)()
        })
    }

    pub(super) extern "system" fn glDeleteProgram(name: u32) {
        PROGRAMS.set(PROGRAMS.get() - 1);
        // SAFETY: as above.
        forward("glDeleteProgram", |address| unsafe {
            std::mem::transmute::<*const c_void, extern "system" fn(u32)>(address)(name);
        });
    }

    pub(super) extern "system" fn glCreateShader(kind: u32) -> u32 {
        SHADERS.set(SHADERS.get() + 1);
        // SAFETY: as above.
        forward("glCreateShader", |address| unsafe {
            std::mem::transmute::<*const c_void, extern "system" fn(u32) -> u32>(address)(kind)
        })
    }

    pub(super) extern "system" fn glDeleteShader(name: u32) {
        SHADERS.set(SHADERS.get() - 1);
        // SAFETY: as above.
        forward("glDeleteShader", |address| unsafe {
            std::mem::transmute::<*const c_void, extern "system" fn(u32)>(address)(name);
        });
    }

    pub(super) extern "system" fn glCheckFramebufferStatus(target: u32) -> u32 {
        if fails_now() {
            return glow::FRAMEBUFFER_UNSUPPORTED;
        }
        // SAFETY: as above.
        forward("glCheckFramebufferStatus", |address| unsafe {
            std::mem::transmute::<*const c_void, extern "system" fn(u32) -> u32>(address)(target)
        })
    }

    pub(super) extern "system" fn glGetShaderiv(shader: u32, parameter: u32, value: *mut i32) {
        // SAFETY: as above; the caller's pointer is passed on.
        forward("glGetShaderiv", |address| unsafe {
            std::mem::transmute::<*const c_void, extern "system" fn(u32, u32, *mut i32)>(address)(
                shader, parameter, value,
            );
            if parameter == glow::COMPILE_STATUS && fails_now() {
                *value = 0;
            }
        });
    }

    pub(super) extern "system" fn glGetError() -> u32 {
        match LATER_ERROR.get() {
            Some((0, code)) => {
                LATER_ERROR.set(None);
                PENDING_ERROR.set(code);
            }
            Some((answers, code)) => LATER_ERROR.set(Some((answers - 1, code))),
            None => (),
        }
        match PENDING_ERROR.replace(glow::NO_ERROR) {
            // SAFETY: as above.
            glow::NO_ERROR => forward("glGetError", |address| unsafe {
                std::mem::transmute::<*const c_void, extern "system" fn() -> u32>(address)()
            }),
            code => code,
        }
    }

    pub(super) extern "system" fn glGetString(name: u32) -> *const u8 {
        match RENDERER.get() {
            Some(renderer) if name == glow::RENDERER => renderer.as_ptr().cast(),
            // SAFETY: as above.
            _ => forward("glGetString", |address| unsafe {
                std::mem::transmute::<*const c_void, extern "system" fn(u32) -> *const u8>(address)(name)
            }),
        }
    }

    pub(super) extern "system" fn glTexImage2D(
        target: u32,
        level: i32,
        internal: i32,
        width: i32,
        height: i32,
        border: i32,
        format: u32,
        kind: u32,
        pixels: *const c_void,
    ) {
        type TexImage2D = extern "system" fn(u32, i32, i32, i32, i32, i32, u32, u32, *const c_void);
        if is_out_of_memory() {
            return;
        }
        // SAFETY: as above; the caller's pointer is passed on.
        forward("glTexImage2D", |address| unsafe {
            std::mem::transmute::<*const c_void, TexImage2D>(address)(
                target, level, internal, width, height, border, format, kind, pixels,
            );
        });
    }

    pub(super) extern "system" fn glTexImage3D(
        target: u32,
        level: i32,
        internal: i32,
        width: i32,
        height: i32,
        depth: i32,
        border: i32,
        format: u32,
        kind: u32,
        pixels: *const c_void,
    ) {
        type TexImage3D = extern "system" fn(u32, i32, i32, i32, i32, i32, i32, u32, u32, *const c_void);
        if is_out_of_memory() {
            return;
        }
        // SAFETY: as above; the caller's pointer is passed on.
        forward("glTexImage3D", |address| unsafe {
            std::mem::transmute::<*const c_void, TexImage3D>(address)(
                target, level, internal, width, height, depth, border, format, kind, pixels,
            );
        });
    }

    pub(super) extern "system" fn glBufferData(target: u32, bytes: isize, data: *const c_void, usage: u32) {
        type BufferData = extern "system" fn(u32, isize, *const c_void, u32);
        if is_out_of_memory() {
            return;
        }
        // SAFETY: as above; the caller's pointer is passed on.
        forward("glBufferData", |address| unsafe {
            std::mem::transmute::<*const c_void, BufferData>(address)(target, bytes, data, usage);
        });
    }

    pub(super) fn of(name: &CStr) -> Option<*const c_void> {
        Some(match name.to_str().unwrap() {
            "glGenTextures" => glGenTextures as *const c_void,
            "glDeleteTextures" => glDeleteTextures as *const c_void,
            "glGenFramebuffers" => glGenFramebuffers as *const c_void,
            "glDeleteFramebuffers" => glDeleteFramebuffers as *const c_void,
            "glGenSamplers" => glGenSamplers as *const c_void,
            "glDeleteSamplers" => glDeleteSamplers as *const c_void,
            "glGenVertexArrays" => glGenVertexArrays as *const c_void,
            "glDeleteVertexArrays" => glDeleteVertexArrays as *const c_void,
            "glGenQueries" => glGenQueries as *const c_void,
            "glDeleteQueries" => glDeleteQueries as *const c_void,
            "glGenBuffers" => glGenBuffers as *const c_void,
            "glDeleteBuffers" => glDeleteBuffers as *const c_void,
            "glCreateProgram" => glCreateProgram as *const c_void,
            "glDeleteProgram" => glDeleteProgram as *const c_void,
            "glCreateShader" => glCreateShader as *const c_void,
            "glDeleteShader" => glDeleteShader as *const c_void,
            "glCheckFramebufferStatus" => glCheckFramebufferStatus as *const c_void,
            "glGetShaderiv" => glGetShaderiv as *const c_void,
            "glGetError" => glGetError as *const c_void,
            "glGetString" => glGetString as *const c_void,
            "glTexImage2D" => glTexImage2D as *const c_void,
            "glTexImage3D" => glTexImage3D as *const c_void,
            "glBufferData" => glBufferData as *const c_void,
            _ => return None,
        })
    }
}

fn fails_now() -> bool {
    match FAIL_AT.get() {
        Some(0) => {
            FAIL_AT.set(None);
            true
        }
        Some(calls) => {
            FAIL_AT.set(Some(calls - 1));
            false
        }
        None => false,
    }
}

/// Whether this allocation fails; glGetError then says so.
fn is_out_of_memory() -> bool {
    let fails = fails_now();
    if fails {
        PENDING_ERROR.set(glow::OUT_OF_MEMORY);
    }
    fails
}

/// Calls the real command behind a wrapper.
fn forward<T>(name: &str, call: impl FnOnce(*const c_void) -> T) -> T {
    let address = REAL.with_borrow(|real| real[name]);
    call(std::ptr::with_exposed_provenance(address))
}
