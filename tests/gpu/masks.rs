//! Masks of the pixels that need a radius: all others get 0, and without a mask every pixel has its own.

#![expect(unsafe_code, reason = "a host has a depth buffer of its own")]

use glam::UVec2;
use glow::HasContext as _;
use varikernel::settings::{Edges, SatSamples, Settings, Storage};
use varikernel::{
    Changed, CountBounds, Error, Frame, Gl, HostDepth, Image, Mask, MaskMaker, RadiusMap, RadiusPipeline,
    reference,
};

use crate::frames::{fast, read, upload, variants};
use crate::support::{Random, assert_same, each, egl, exact_variants, random_map, search, sparse_map, spike};

#[test]
fn masked_pixels_get_zero_and_all_others_their_radius() {
    for gl in each() {
        for density in [random_map(1, 1, 4), sparse_map(140, 67), spike(66, 71)] {
            let size = density.size();
            let mut random = Random(7);
            let masks = [
                Image::filled(size, 0_u8),
                Image::filled(size, 255),
                Image::from_fn(size, |x, _| u8::from(x < size.x / 2)),
                // Whole tiles without a pixel, and a last one with a single pixel.
                Image::from_fn(size, |x, y| u8::from((x, y) == (size.x - 1, size.y - 1))),
                Image::from_fn(size, |_, _| u8::from(random.below(2) == 0)),
            ];
            for edges in [Edges::Zero, Edges::Scale] {
                let search = search(9, 12, edges);
                let expected = reference::radius_by_table(&density, search);
                let once = |settings: &Settings| {
                    settings.storage == Storage::U32 && settings.laboratory.sat_samples == SatSamples::Four
                };
                for settings in exact_variants(search).into_iter().filter(once) {
                    let map = upload(&gl, &density, settings.search);
                    let settings = Settings { masked: true, ..settings };
                    let mut pipeline = RadiusPipeline::new(&gl, size, map.format(), settings).unwrap();
                    for mask in &masks {
                        let on_gpu = Mask::upload(&gl, mask).unwrap();
                        let frame = Frame { mask: Some(&on_gpu), ..Frame::new(&map) };
                        let radii = pipeline.update(&frame).unwrap();
                        assert_same(
                            &read(radii),
                            &expected.where_needed(mask),
                            &format!("{size} {settings:?}"),
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_mask_may_come_where_the_settings_say_so() {
    let gl = egl();
    let question = search(9, 12, Edges::Scale);
    let counts = random_map(8, 8, 4);
    let map = upload(&gl, &counts, question);
    let mask = Mask::upload(&gl, &Image::filled(UVec2::new(8, 8), 1)).unwrap();
    let large = Mask::upload(&gl, &Image::filled(UVec2::new(9, 8), 1)).unwrap();
    let pipeline = |masked| {
        let settings = Settings { masked, ..fast(question) };
        RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap()
    };
    let mismatch = |result: varikernel::Result<&RadiusMap>| match result {
        Err(Error::Mismatch { what: "mask", .. }) => (),
        other => panic!("{other:?}"),
    };
    mismatch(pipeline(false).update(&Frame { mask: Some(&mask), ..Frame::new(&map) }));
    mismatch(pipeline(true).update(&Frame { mask: Some(&large), ..Frame::new(&map) }));
    let expected = reference::radius(&counts, question);
    for mask in [None, Some(&mask)] {
        let mut pipeline = pipeline(true);
        assert_same(
            &read(pipeline.update(&Frame { mask, ..Frame::new(&map) }).unwrap()),
            &expected,
            "all pixels",
        );
    }
    // No certificate says which pixels a mask left out.
    let mut masked = pipeline(true);
    masked.render(&map).unwrap();
    match masked.certify(&map) {
        Err(Error::Mismatch { what: "pipeline of a certificate", .. }) => (),
        other => panic!("{other:?}"),
    }
}

/// Masks come and go, whatever a frame says of what changed; then the counts change in a rectangle.
#[test]
fn a_frame_without_a_mask_finds_every_radius() {
    for gl in each() {
        for (density, other) in [
            (random_map(1, 1, 4), random_map(1, 1, 5)),
            (sparse_map(140, 67), random_map(140, 67, 3)),
            (spike(66, 71), Image::filled(UVec2::new(66, 71), 0)),
        ] {
            let size = density.size();
            // The right of the map; whole tiles of 64 x 64 are left out.
            let mask = Image::from_fn(size, |x, _| u8::from(x >= size.x / 2));
            let on_gpu = Mask::upload(&gl, &mask).unwrap();
            let whole = Changed::Rectangle { first: UVec2::ZERO, size };
            let corner = Changed::Rectangle { first: UVec2::ZERO, size: UVec2::ONE };
            for edges in [Edges::Zero, Edges::Scale] {
                for settings in variants(search(9, 12, edges)) {
                    let mut map = upload(&gl, &density, settings.search);
                    let settings = Settings { masked: true, ..settings };
                    let mut pipeline = RadiusPipeline::new(&gl, size, map.format(), settings).unwrap();
                    for (counts, is_masked, changed) in [
                        (&density, false, Changed::Everything),
                        (&density, true, Changed::Nothing),
                        (&density, false, corner),
                        (&density, false, Changed::Nothing),
                        (&other, false, whole),
                        (&density, true, whole),
                        (&density, true, corner),
                        (&other, false, whole),
                    ] {
                        map.replace(counts, CountBounds::of(counts, settings.search)).unwrap();
                        let frame = Frame { density: &map, mask: is_masked.then_some(&on_gpu), changed };
                        let found = read(pipeline.update(&frame).unwrap());
                        let all = reference::radius_by_table(counts, settings.search);
                        let expected = if is_masked { all.where_needed(&mask) } else { all };
                        assert_same(
                            &found,
                            &expected,
                            &format!("{size} {is_masked} {changed:?} {settings:?}"),
                        );
                    }
                }
            }
        }
    }
}

/// A depth-stencil texture in which the left half has a receiver: depth 0.5 and stencil 5; elsewhere the far
/// plane and 1.
pub(crate) fn depth_and_stencil(gl: &Gl, size: UVec2) -> glow::Texture {
    let texel = |x: u32| {
        let depth = if x < size.x / 2 { 0x0080_0000_u32 } else { 0x00FF_FFFF };
        depth << 8 | if x < size.x / 2 { 5 } else { 1 }
    };
    let texels: Vec<u32> = (0..size.x * size.y).map(|index| texel(index % size.x)).collect();
    let glow = gl.glow();
    // SAFETY: the context is current, and the slice holds a texel for each pixel.
    unsafe {
        let texture = glow.create_texture().unwrap();
        glow.bind_texture(glow::TEXTURE_2D, Some(texture));
        glow.tex_image_2d(
            glow::TEXTURE_2D,
            0,
            glow::DEPTH24_STENCIL8.cast_signed(),
            size.x.cast_signed(),
            size.y.cast_signed(),
            0,
            glow::DEPTH_STENCIL,
            glow::UNSIGNED_INT_24_8,
            glow::PixelUnpackData::Slice(Some(bytemuck::cast_slice(&texels))),
        );
        texture
    }
}

#[test]
fn depth_and_stencil_of_a_host_become_a_mask() {
    for gl in each() {
        let density = sparse_map(140, 67);
        let question = search(9, 12, Edges::Scale);
        let expected = reference::radius_by_table(&density, question);
        let half = |left: bool| {
            let mask = Image::from_fn(density.size(), |x, _| u8::from((x < density.size().x / 2) == left));
            expected.where_needed(&mask)
        };
        let map = upload(&gl, &density, fast(question).search);
        let settings = Settings { masked: true, ..fast(question) };
        let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
        let mut maker = MaskMaker::new(&gl, map.size()).unwrap();
        let texture = depth_and_stencil(&gl, map.size());
        let mut radii =
            |mask: &Mask| read(pipeline.update(&Frame { mask: Some(mask), ..Frame::new(&map) }).unwrap());
        assert_same(
            &radii(maker.from_depth(crate::support::usual_depth(texture)).unwrap()),
            &half(true),
            "nearer than 1",
        );
        // 5 and 1 share the lowest bit.
        assert_same(&radii(maker.from_stencil(texture, 1, 0xFF).unwrap()), &half(false), "stencil 1");
        assert_same(&radii(maker.from_stencil(texture, 1, 1).unwrap()), &expected, "the lowest bit");
        assert_same(&radii(maker.from_stencil(texture, 7, 4).unwrap()), &half(true), "the third bit");
        // Reversed, no depth here is that of the far plane.
        assert_same(
            &radii(
                maker
                    .from_depth(HostDepth { reversed: true, ..crate::support::usual_depth(texture) })
                    .unwrap(),
            ),
            &expected,
            "more than 0",
        );
        let other = depth_and_stencil(&gl, UVec2::new(9, 9));
        for texture in [other, map_texture(&gl)] {
            let result = maker.from_depth(crate::support::usual_depth(texture)).map(|_| ());
            assert!(matches!(result, Err(Error::Mismatch { .. })), "{result:?}");
        }
        // After an error, the maker is as good as before.
        assert_same(
            &radii(maker.from_depth(crate::support::usual_depth(texture)).unwrap()),
            &half(true),
            "again",
        );
    }
}

/// A texture without depth.
fn map_texture(gl: &Gl) -> glow::Texture {
    let glow = gl.glow();
    // SAFETY: the context is current.
    unsafe {
        let texture = glow.create_texture().unwrap();
        glow.bind_texture(glow::TEXTURE_2D, Some(texture));
        let nothing = glow::PixelUnpackData::Slice(None);
        let format = glow::R8.cast_signed();
        glow.tex_image_2d(glow::TEXTURE_2D, 0, format, 140, 67, 0, glow::RED, glow::UNSIGNED_BYTE, nothing);
        texture
    }
}
