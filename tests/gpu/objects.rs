//! Every OpenGL object is freed, and the state put back, also where making one fails half-way.

#![expect(unsafe_code, reason = "commands are wrapped to count them")]

use std::collections::BTreeMap;
use std::ffi::{CStr, c_void};
use std::sync::atomic::{AtomicI64, Ordering};

use glam::UVec2;
use glow::HasContext as _;
use varikernel::settings::{Method, Settings};
use varikernel::{CountBounds, DensityMap, Error, RadiusPipeline};

use crate::support::{random_map, working_candidates};

static TEXTURES: AtomicI64 = AtomicI64::new(0);
static FRAMEBUFFERS: AtomicI64 = AtomicI64::new(0);
static PROGRAMS: AtomicI64 = AtomicI64::new(0);
static SHADERS: AtomicI64 = AtomicI64::new(0);
static SAMPLERS: AtomicI64 = AtomicI64::new(0);
static VERTEX_ARRAYS: AtomicI64 = AtomicI64::new(0);
static QUERIES: AtomicI64 = AtomicI64::new(0);
static BUFFERS: AtomicI64 = AtomicI64::new(0);

/// Wraps a `glGen*`/`glDelete*` pair so that the live names are counted.
macro_rules! counted {
    ($generate:ident, $delete:ident, $live:ident) => {
        extern "system" fn $generate(count: i32, names: *mut u32) {
            $live.fetch_add(i64::from(count), Ordering::SeqCst);
            forward(stringify!($generate), |address| {
                // SAFETY: the address is that of the command of this name, which has this type.
                let real: extern "system" fn(i32, *mut u32) = unsafe { std::mem::transmute(address) };
                real(count, names);
            });
        }
        extern "system" fn $delete(count: i32, names: *const u32) {
            $live.fetch_sub(i64::from(count), Ordering::SeqCst);
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
        PROGRAMS.fetch_add(1, Ordering::SeqCst);
        // SAFETY: the address is that of the command of this name, which has this type.
        forward("glCreateProgram", |address| unsafe {
            std::mem::transmute::<*const c_void, extern "system" fn() -> u32>(address)()
        })
    }

    pub(super) extern "system" fn glDeleteProgram(name: u32) {
        PROGRAMS.fetch_sub(1, Ordering::SeqCst);
        // SAFETY: as above.
        forward("glDeleteProgram", |address| unsafe {
            std::mem::transmute::<*const c_void, extern "system" fn(u32)>(address)(name);
        });
    }

    pub(super) extern "system" fn glCreateShader(kind: u32) -> u32 {
        SHADERS.fetch_add(1, Ordering::SeqCst);
        // SAFETY: as above.
        forward("glCreateShader", |address| unsafe {
            std::mem::transmute::<*const c_void, extern "system" fn(u32) -> u32>(address)(kind)
        })
    }

    pub(super) extern "system" fn glDeleteShader(name: u32) {
        SHADERS.fetch_sub(1, Ordering::SeqCst);
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
            _ => return None,
        })
    }
}

thread_local! {
    static REAL: std::cell::RefCell<BTreeMap<String, usize>> = const { std::cell::RefCell::new(BTreeMap::new()) };
}

thread_local! {
    /// How many more calls that can fail succeed; nothing once one has failed.
    static FAIL_AT: std::cell::Cell<Option<u32>> = const { std::cell::Cell::new(None) };
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

/// Calls the real command behind a wrapper.
fn forward<T>(name: &str, call: impl FnOnce(*const c_void) -> T) -> T {
    let address = REAL.with_borrow(|real| real[name]);
    call(std::ptr::with_exposed_provenance(address))
}

#[test]
fn every_object_is_freed_and_the_state_put_back_also_after_an_error() {
    let live = || {
        [&TEXTURES, &FRAMEBUFFERS, &PROGRAMS, &SHADERS, &SAMPLERS, &VERTEX_ARRAYS, &QUERIES, &BUFFERS]
            .map(|counter| counter.load(Ordering::SeqCst))
    };
    // SAFETY: each wrapper calls the command that it stands for.
    let gl = unsafe {
        working_candidates()[0].open_through(|name, address| match wrappers::of(name) {
            None => address,
            Some(wrapper) => {
                REAL.with_borrow_mut(|real| {
                    real.insert(name.to_str().unwrap().to_owned(), address.expose_provenance())
                });
                wrapper
            }
        })
    }
    .unwrap();
    let before = live();
    assert!(before[4] == 2 && before[5] == 1, "the counters count: {before:?}");
    #[cfg(feature = "render")]
    fail_in_pictures(&gl, &live);
    {
        let density = random_map(12, 19, 4);
        let map = DensityMap::upload(&gl, &density, CountBounds::UNKNOWN).unwrap();
        for method in Method::ALL {
            let settings = Settings { limited_mask: true, ..Settings::of(method) };
            let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
            pipeline.render(&map).unwrap().read().unwrap();
            let is_table = method == Method::SummedAreaTable;
            assert_eq!(pipeline.certify(&map).is_ok(), is_table);
            assert_eq!(live()[6] - before[6], i64::from(is_table), "queries");
            let mut other = RadiusPipeline::new(&gl, UVec2::ONE, map.format(), settings).unwrap();
            assert!(other.render(&map).is_err());
        }
        assert!(live()[0] > before[0], "the map is alive");
        let too_large = UVec2::splat(gl.info().max_texture_size + 1);
        assert!(RadiusPipeline::new(&gl, too_large, map.format(), Settings::default()).is_err());

        // Whatever object fails half-way, what was made before it is freed.
        let (alive, viewport) = (live(), [3, 5, 7, 11]);
        // SAFETY: the context is current.
        unsafe { gl.glow().viewport(viewport[0], viewport[1], viewport[2], viewport[3]) };
        for method in Method::ALL {
            let settings = Settings { limited_mask: true, ..Settings::of(method) };
            let new = || RadiusPipeline::new(&gl, map.size(), map.format(), settings);
            let mut failures = 0;
            for call in 0.. {
                FAIL_AT.set(Some(call));
                let result = new();
                if FAIL_AT.replace(None).is_some() {
                    // Fewer such calls were made: nothing failed.
                    assert!(result.is_ok(), "{method:?}: {result:?}");
                    break;
                }
                let error =
                    result.err().unwrap_or_else(|| panic!("{method:?}: the failure of call {call} is lost"));
                assert!(matches!(error, Error::Gl { .. } | Error::Shader { .. }), "{error}");
                if let Error::Shader { source_text, .. } = &error {
                    assert!(source_text.contains("glsl/"), "{error}");
                }
                assert_eq!(live(), alive, "{method:?}, call {call}: {error}");
                let mut now = [0; 4];
                // SAFETY: the context is current, and the viewport has four values.
                unsafe { gl.glow().get_parameter_i32_slice(glow::VIEWPORT, &mut now) };
                assert_eq!(now, viewport, "{method:?}, call {call}: the state is put back");
                failures += 1;
            }
            assert!(failures >= 2, "{method:?}: {failures}");
        }
    }
    assert_eq!(live(), before);
    drop(gl);
    assert_eq!(live(), [0; 8]);
}

/// Whatever object of a picture fails half-way, what was made before it is freed.
#[cfg(feature = "render")]
fn fail_in_pictures(gl: &varikernel::Gl, live: &dyn Fn() -> [i64; 8]) {
    use varikernel::render::Renderer;
    use varikernel::settings::{Estimate, PictureSettings};

    let alive = live();
    let scene = varikernel::scene::Scene::shipped("cornell-glass").unwrap();
    let photons = crate::stage::traced(&scene, 100, 1);
    for estimate in [Estimate::Splat, Estimate::Gather { count_correction: false }] {
        let settings = PictureSettings {
            size: UVec2::splat(8),
            light_samples: 1,
            estimate,
            ..PictureSettings::default()
        };
        let mut failures = 0;
        for call in 0.. {
            FAIL_AT.set(Some(call));
            let result = Renderer::with_photons(gl, &scene, &settings, &photons)
                .and_then(|mut renderer| renderer.picture(&settings).map(drop));
            if FAIL_AT.replace(None).is_some() {
                assert!(result.is_ok(), "{result:?}");
                break;
            }
            assert!(result.is_err(), "the failure of call {call} is lost");
            assert_eq!(live(), alive, "call {call}: {result:?}");
            failures += 1;
        }
        assert!(failures >= 12, "{failures}");
    }
    assert_eq!(live(), alive);
}
