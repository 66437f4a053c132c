//! The library in a host's context: borrowed textures, a shared glow context.

#![expect(unsafe_code, reason = "a host speaks OpenGL itself")]

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::UVec2;
use glow::HasContext as _;
use varikernel::gl::TextureFormat;
use varikernel::settings::{Edges, Laboratory, Method, SatBuild, Settings, Storage};
use varikernel::{CountBounds, DensityMap, Error, Gl, Image, RadiusPipeline, context, reference};

use crate::support::{each, egl, random_map, search, working_candidates};

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
    for gl in each() {
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
            // The host knows how many photons it has drawn.
            let map = DensityMap::borrow(&gl, texture, CountBounds::total_at_most(4 * 37 * 20)).unwrap();
            assert_eq!((map.format(), map.size()), (format, density.size()));
            for method in [Method::BruteForce, Method::Pyramid, Method::SummedAreaTable] {
                for storage in [Storage::U32, Storage::F32] {
                    let search = search(25, 16, Edges::Scale);
                    let sat_build = SatBuild::Doubling;
                    let settings = Settings {
                        search,
                        method,
                        storage,
                        laboratory: Laboratory { sat_build, ..Laboratory::default() },
                        ..Settings::default()
                    };
                    let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
                    let found = pipeline.render(&map).unwrap().read().unwrap();
                    assert_eq!(found, expected, "{format:?}, {method:?}, {storage:?}");
                }
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
    let swizzled = texture(&gl, glow::R32F, glow::RED, glow::FLOAT, UVec2::ONE, &[0; 4]);
    // SAFETY: the context is current.
    unsafe {
        gl.glow().bind_texture(glow::TEXTURE_2D, Some(swizzled));
        gl.glow().tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_SWIZZLE_R, glow::ZERO.cast_signed());
    }
    assert!(refuse(swizzled).0.contains("GL_TEXTURE_SWIZZLE_R"));
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
fn a_host_may_borrow_the_radius_texture_which_is_complete_without_a_sampler() {
    let gl = egl();
    let density = random_map(9, 7, 4);
    let map = DensityMap::upload(&gl, &density, CountBounds::UNKNOWN).unwrap();
    let settings = Settings { limited_mask: true, ..Settings::default() };
    let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
    let radii = pipeline.render(&map).unwrap();
    // The library borrows its own output back as a host's texture: same name, complete, readable.
    let borrowed = DensityMap::borrow(&gl, radii.texture(), CountBounds::UNKNOWN).unwrap();
    assert_eq!((borrowed.size(), borrowed.format()), (map.size(), TextureFormat::R32Uint));
    assert!(
        matches!(pipeline.render(&borrowed), Err(Error::Mismatch { .. })),
        "it would read what it writes"
    );
    let radii = pipeline.render(&map).unwrap();
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
fn a_search_needs_the_map_that_was_built_last() {
    let gl = egl();
    let map = |end| DensityMap::upload(&gl, &random_map(9, 7, end), CountBounds::UNKNOWN).unwrap();
    let (first, second) = (map(3), map(4));
    for method in Method::ALL {
        let settings = Settings::of(method);
        let mut pipeline = RadiusPipeline::new(&gl, first.size(), first.format(), settings).unwrap();
        assert!(matches!(pipeline.search(&first), Err(Error::Mismatch { .. })), "nothing was built");
        pipeline.build(&first).unwrap();
        assert!(matches!(pipeline.search(&second), Err(Error::Mismatch { .. })), "another was built");
        pipeline.search(&first).unwrap();
    }
}

#[test]
fn errors_that_the_host_left_behind_are_not_blamed_on_us() {
    let gl = egl();
    // SAFETY: the context is current; an unknown capability is an error and nothing else.
    let leave_error = || unsafe { gl.glow().enable(0xFFFF) };
    let density = random_map(9, 7, 3);
    leave_error();
    let map = DensityMap::upload(&gl, &density, CountBounds::UNKNOWN).unwrap();
    leave_error();
    let settings = Settings { limited_mask: true, ..Settings::default() };
    let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
    leave_error();
    let radii = pipeline.render(&map).unwrap();
    leave_error();
    radii.read().unwrap();
    leave_error();
    radii.read_limited().unwrap();
    leave_error();
    DensityMap::borrow(&gl, radii.texture(), CountBounds::UNKNOWN).unwrap();
    leave_error();
    varikernel::RadiusMap::borrow(&gl, radii.texture(), radii.limited_texture()).unwrap();
    leave_error();
    pipeline.certify(&map).unwrap();
    leave_error();
    varikernel::gl::time(&gl, || Ok(())).unwrap();
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
    let candidate_loader = std::cell::RefCell::new(BTreeMap::new());
    // SAFETY: addresses are passed on as they are.
    let owner = unsafe {
        working_candidates()[0].open_through(|name, address| {
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
    assert!(matches!(result, Err(Error::NoContext { .. })));
}

#[test]
fn a_second_headless_context_on_one_thread_is_refused_until_the_first_is_dropped() {
    let first = egl();
    let density = random_map(3, 3, 3);
    let map = DensityMap::upload(&first, &density, CountBounds::UNKNOWN).unwrap();
    drop(first);
    // The map still holds its context.
    let refused = context::open(&context::DeviceChoice::Auto);
    assert!(matches!(refused, Err(Error::NoContext { reason, .. }) if reason.contains("already open")));
    drop(map);
    drop(egl());
}
