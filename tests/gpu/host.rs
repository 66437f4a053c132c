//! The library in somebody else's context: borrowed textures, a shared glow context, objects freed.

#![expect(unsafe_code, reason = "a host speaks OpenGL itself")]

use std::collections::BTreeMap;
use std::ffi::{CStr, c_void};
use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};

use glam::UVec2;
use glow::HasContext as _;
use varikernel::gl::TextureFormat;
use varikernel::settings::{Edges, Method, Settings};
use varikernel::{CountBounds, DensityMap, Error, Gl, Image, RadiusPipeline, context, reference};

use crate::support::{egl, osmesa, random_map, search};

/// A host's texture: any format, any filter, as hosts have them.
fn texture(gl: &Gl, internal: u32, components: u32, kind: u32, size: UVec2, bytes: &[u8]) -> glow::Texture {
    let glow = gl.glow();
    let size = size.as_ivec2();
    // SAFETY: the context is current, and `bytes` holds the texels.
    unsafe {
        let texture = glow.create_texture().unwrap();
        glow.bind_texture(glow::TEXTURE_2D, Some(texture));
        glow.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
        glow.tex_image_2d(
            glow::TEXTURE_2D,
            0,
            internal.cast_signed(),
            size.x,
            size.y,
            0,
            components,
            kind,
            glow::PixelUnpackData::Slice(Some(bytes)),
        );
        glow.bind_texture(glow::TEXTURE_2D, None);
        texture
    }
}

#[test]
fn textures_of_the_host_are_read_in_each_format() {
    for gl in [egl, osmesa] {
        let gl = gl();
        let density = random_map(37, 20, 4);
        let floats: Vec<f32> =
            density.values().iter().map(|&count| f32::from(u16::try_from(count).unwrap())).collect();
        let bytes: Vec<u8> = density.values().iter().map(|&count| u8::try_from(count).unwrap()).collect();
        let expected = reference::radius(&density, search(25, 16, Edges::Scale)).radius;
        for (format, texture) in [
            (
                TextureFormat::R32Float,
                texture(
                    &gl,
                    glow::R32F,
                    glow::RED,
                    glow::FLOAT,
                    density.size(),
                    bytemuck::cast_slice(&floats),
                ),
            ),
            (
                TextureFormat::R32Uint,
                texture(
                    &gl,
                    glow::R32UI,
                    glow::RED_INTEGER,
                    glow::UNSIGNED_INT,
                    density.size(),
                    bytemuck::cast_slice(density.values()),
                ),
            ),
            (
                TextureFormat::R8Uint,
                texture(&gl, glow::R8UI, glow::RED_INTEGER, glow::UNSIGNED_BYTE, density.size(), &bytes),
            ),
        ] {
            let map = DensityMap::borrow(&gl, texture, CountBounds::UNKNOWN).unwrap();
            assert_eq!((map.format(), map.size()), (format, density.size()));
            for method in [Method::BruteForce, Method::Pyramid, Method::SummedAreaTable] {
                let settings =
                    Settings { search: search(25, 16, Edges::Scale), method, ..Settings::default() };
                let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
                assert_eq!(
                    pipeline.render(&map).unwrap().read().unwrap(),
                    expected,
                    "{format:?}, {method:?}"
                );
            }
            drop(map);
            // SAFETY: the context is current.
            assert!(unsafe { gl.glow().is_texture(texture) }, "a borrowed texture stays the host's");
        }
    }
}

#[test]
fn textures_that_do_not_fit_are_refused_with_the_names_of_their_enums() {
    let gl = egl();
    let refuse = |texture| match DensityMap::borrow(&gl, texture, CountBounds::UNKNOWN) {
        Err(Error::Mismatch { expected, got, .. }) => (expected, got),
        other => panic!("{other:?}"),
    };
    let rgba = texture(&gl, glow::RGBA8, glow::RGBA, glow::UNSIGNED_BYTE, UVec2::ONE, &[0; 4]);
    let (expected, got) = refuse(rgba);
    assert!(expected.contains("GL_R32UI") && got == "GL_RGBA8", "{expected}, {got}");
    // SAFETY: the context is current; the texture becomes a cube map when bound as one.
    let (empty, cube) = unsafe {
        let (empty, cube) = (gl.glow().create_texture().unwrap(), gl.glow().create_texture().unwrap());
        gl.glow().bind_texture(glow::TEXTURE_CUBE_MAP, Some(cube));
        (empty, cube)
    };
    assert_eq!(refuse(empty).1, "none");
    assert!(refuse(cube).1.contains("GL_INVALID_OPERATION"));

    let density = random_map(5, 4, 3);
    let map = DensityMap::upload(&gl, &density, CountBounds::UNKNOWN).unwrap();
    let mut other_size =
        RadiusPipeline::new(&gl, UVec2::new(4, 5), map.format(), Settings::default()).unwrap();
    assert!(matches!(other_size.render(&map), Err(Error::Mismatch { what: "density map", .. })));
    let mut other_format =
        RadiusPipeline::new(&gl, map.size(), TextureFormat::R32Float, Settings::default()).unwrap();
    assert!(matches!(other_format.render(&map), Err(Error::Mismatch { what: "density map", .. })));
}

#[test]
fn a_host_reads_the_radius_texture_in_its_own_shader_without_a_sampler() {
    let gl = egl();
    let density = random_map(9, 7, 4);
    let map = DensityMap::upload(&gl, &density, CountBounds::UNKNOWN).unwrap();
    let settings = Settings { limited_mask: true, ..Settings::default() };
    let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
    let radii = pipeline.render(&map).unwrap();
    // The library borrows its own output back as a host's texture: same name, complete, readable.
    let borrowed = DensityMap::borrow(&gl, radii.texture(), CountBounds::UNKNOWN).unwrap();
    assert_eq!((borrowed.size(), borrowed.format()), (map.size(), TextureFormat::R32Uint));
    let mask = DensityMap::borrow(&gl, radii.limited_texture().unwrap(), CountBounds::UNKNOWN).unwrap();
    assert_eq!(mask.format(), TextureFormat::R8Uint);
    // SAFETY: the context is current.
    let filter = unsafe {
        gl.glow().bind_texture(glow::TEXTURE_2D, Some(radii.texture()));
        gl.glow().get_tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MIN_FILTER)
    };
    assert_eq!(filter.cast_unsigned(), glow::NEAREST, "an integer texture is complete with GL_NEAREST only");
}

#[test]
fn two_pipelines_live_side_by_side_and_a_map_may_change_between_frames() {
    let gl = egl();
    let (small, large) = (random_map(12, 19, 4), random_map(64, 64, 3));
    let question = search(25, 16, Edges::Zero);
    let settings = Settings { search: question, ..Settings::default() };
    let map = |density: &Image<u32>| DensityMap::upload(&gl, density, CountBounds::UNKNOWN).unwrap();
    let (small_map, large_map) = (map(&small), map(&large));
    let mut first = RadiusPipeline::new(&gl, small.size(), small_map.format(), settings).unwrap();
    let pyramid = Settings { method: Method::Pyramid, ..settings };
    let mut second = RadiusPipeline::new(&gl, large.size(), large_map.format(), pyramid).unwrap();
    let other = random_map(12, 19, 9);
    let other_map = map(&other);
    for _ in 0..2 {
        for (density, density_map) in [(&small, &small_map), (&other, &other_map)] {
            let radii = first.render(density_map).unwrap().read().unwrap();
            assert_eq!(radii, reference::radius(density, question).radius);
        }
        let radii = second.render(&large_map).unwrap().read().unwrap();
        assert_eq!(radii, reference::radius(&large, question).radius);
    }
}

#[test]
fn a_glow_context_of_the_host_will_do() {
    // The host's own handle to the same context.
    let host = egl();
    // SAFETY: the loader below is that of the context that `host` keeps current on this thread.
    let candidate_loader = std::cell::RefCell::new(BTreeMap::new());
    drop(host);
    let (candidates, _) = context::candidates();
    // SAFETY: addresses are passed on as they are.
    let owner = unsafe {
        candidates[0].open_through(|name, address| {
            candidate_loader.borrow_mut().insert(name.to_owned(), address);
            address
        })
    }
    .unwrap();
    // SAFETY: the same addresses, for the context that `owner` keeps current.
    let glow = unsafe {
        glow::Context::from_loader_function_cstr(|name| {
            candidate_loader.borrow().get(name).copied().unwrap_or(std::ptr::null())
        })
    };
    // SAFETY: the context is current as long as `owner` lives, which is longer than `gl`.
    let gl = unsafe { Gl::from_glow(Arc::new(glow)) }.unwrap();
    assert_eq!(gl.info(), owner.info());
    let density = random_map(12, 19, 4);
    let map = DensityMap::upload(&gl, &density, CountBounds::UNKNOWN).unwrap();
    let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), Settings::default()).unwrap();
    let expected = reference::radius(&density, Settings::default().search).radius;
    assert_eq!(pipeline.render(&map).unwrap().read().unwrap(), expected);
}

#[test]
fn a_loader_without_a_context_is_an_error() {
    // SAFETY: null is what a loader may return.
    let result = unsafe { Gl::from_loader(|_| std::ptr::null()) };
    assert!(matches!(result, Err(Error::NoContext(_))));
}

#[test]
fn a_second_headless_context_on_one_thread_is_refused_until_the_first_is_dropped() {
    let first = egl();
    let density = random_map(3, 3, 3);
    let map = DensityMap::upload(&first, &density, CountBounds::UNKNOWN).unwrap();
    drop(first);
    // The map still holds its context.
    let refused = context::open(&context::DeviceChoice::Auto);
    assert!(matches!(refused, Err(Error::NoContext(reason)) if reason.contains("already open")));
    drop(map);
    drop(egl());
}

static TEXTURES: AtomicI64 = AtomicI64::new(0);
static FRAMEBUFFERS: AtomicI64 = AtomicI64::new(0);
static PROGRAMS: AtomicI64 = AtomicI64::new(0);
static SHADERS: AtomicI64 = AtomicI64::new(0);
static SAMPLERS: AtomicI64 = AtomicI64::new(0);
static VERTEX_ARRAYS: AtomicI64 = AtomicI64::new(0);

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
            "glCreateProgram" => glCreateProgram as *const c_void,
            "glDeleteProgram" => glDeleteProgram as *const c_void,
            "glCreateShader" => glCreateShader as *const c_void,
            "glDeleteShader" => glDeleteShader as *const c_void,
            _ => return None,
        })
    }
}

thread_local! {
    static REAL: std::cell::RefCell<BTreeMap<String, usize>> = const { std::cell::RefCell::new(BTreeMap::new()) };
}

/// Calls the real command behind a wrapper.
fn forward<T>(name: &str, call: impl FnOnce(*const c_void) -> T) -> T {
    let address = REAL.with_borrow(|real| real[name]);
    call(std::ptr::with_exposed_provenance(address))
}

#[test]
fn every_object_is_freed_also_after_an_error() {
    let live = || {
        [&TEXTURES, &FRAMEBUFFERS, &PROGRAMS, &SHADERS, &SAMPLERS, &VERTEX_ARRAYS]
            .map(|counter| counter.load(Ordering::SeqCst))
    };
    let (candidates, _) = context::candidates();
    // SAFETY: each wrapper calls the command that it stands for.
    let gl = unsafe {
        candidates[0].open_through(|name, address| match wrappers::of(name) {
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
    {
        let density = random_map(12, 19, 4);
        let map = DensityMap::upload(&gl, &density, CountBounds::UNKNOWN).unwrap();
        for method in Method::ALL {
            let settings = Settings { method, limited_mask: true, ..Settings::default() };
            let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
            pipeline.render(&map).unwrap().read().unwrap();
            let mut other = RadiusPipeline::new(&gl, UVec2::ONE, map.format(), settings).unwrap();
            assert!(other.render(&map).is_err());
        }
        assert!(live()[0] > before[0], "the map is alive");
        let too_large = UVec2::splat(gl.info().max_texture_size + 1);
        assert!(RadiusPipeline::new(&gl, too_large, map.format(), Settings::default()).is_err());
    }
    assert_eq!(live(), before);
    drop(gl);
    assert_eq!(live(), [0; 6]);
}
