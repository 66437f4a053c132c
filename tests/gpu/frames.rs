//! Frames that follow each other: masks, changes in a rectangle, added photons. Every radius equals the
//! definition's.

#![expect(unsafe_code, reason = "a host waits for the GPU itself")]

use glam::UVec2;
use glow::HasContext as _;
use varikernel::settings::{Edges, Method, Order, SatBuild, SatSamples, Search, Settings, Storage};
use varikernel::{
    AdaptivePipeline, Changed, CountBounds, DensityMap, Error, Frame, Gl, Image, Mask, MaskMaker, RadiusMap,
    RadiusPipeline, reference,
};

use crate::support::{Random, assert_same, each, egl, exact_variants, random_map, search, sparse_map, spike};

fn read(radii: &RadiusMap) -> reference::Radii {
    reference::Radii { radius: radii.read().unwrap(), limited: radii.read_limited().unwrap().unwrap() }
}

fn upload(gl: &Gl, counts: &Image<u32>, search: Search) -> DensityMap {
    DensityMap::upload(gl, counts, CountBounds::of(counts, search)).unwrap()
}

/// The usual table and its bracketed search, with the limited pixels.
fn fast(search: Search) -> Settings {
    let search = Search { order: Order::Bracketed, ..search };
    Settings { search, limited_mask: true, ..Settings::default() }
}

/// The fast path, the thesis's table, and a method without one.
fn variants(search: Search) -> [Settings; 4] {
    let fast = fast(search);
    let binary = Settings { search: Search { order: Order::Binary, ..search }, ..fast };
    [
        fast,
        binary,
        Settings { sat_build: SatBuild::Doubling, ..fast },
        Settings { method: Method::BruteForce, search: Search { order: Order::Forward, ..search }, ..fast },
    ]
}

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
                    settings.storage == Storage::U32 && settings.sat_samples == SatSamples::Four
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
fn a_mask_is_asked_for_exactly_where_the_settings_say_so() {
    let gl = egl();
    let question = search(9, 12, Edges::Scale);
    let map = upload(&gl, &random_map(8, 8, 4), question);
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
    mismatch(pipeline(true).render(&map));
    mismatch(pipeline(true).update(&Frame { mask: Some(&large), ..Frame::new(&map) }));
    pipeline(true).update(&Frame { mask: Some(&mask), ..Frame::new(&map) }).unwrap();
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
        assert_same(&radii(maker.from_depth(texture, false).unwrap()), &half(true), "nearer than 1");
        // 5 and 1 share the lowest bit.
        assert_same(&radii(maker.from_stencil(texture, 1, 0xFF).unwrap()), &half(false), "stencil 1");
        assert_same(&radii(maker.from_stencil(texture, 1, 1).unwrap()), &expected, "the lowest bit");
        assert_same(&radii(maker.from_stencil(texture, 7, 4).unwrap()), &half(true), "the third bit");
        // Reversed, no depth here is that of the far plane.
        assert_same(&radii(maker.from_depth(texture, true).unwrap()), &expected, "more than 0");
        let other = depth_and_stencil(&gl, UVec2::new(9, 9));
        for texture in [other, map_texture(&gl)] {
            let result = maker.from_depth(texture, false).map(|_| ());
            assert!(matches!(result, Err(Error::Mismatch { .. })), "{result:?}");
        }
        // After an error, the maker is as good as before.
        assert_same(&radii(maker.from_depth(texture, false).unwrap()), &half(true), "again");
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

/// Random counts in a random rectangle, which is returned.
fn edit(map: &mut Image<u32>, random: &mut Random) -> Changed {
    let size = map.size();
    let first = UVec2::new(random.below(size.x), random.below(size.y));
    let extent = UVec2::new(1 + random.below(40), 1 + random.below(40));
    let end = (first + extent).min(size);
    let most = [1, 2, 8, 100_000_000][random.below(4) as usize];
    for y in first.y..end.y {
        for x in first.x..end.x {
            map.set(x, y, random.below(most));
        }
    }
    // Past the map's end now and then, as hosts round up.
    Changed::Rectangle { first, size: extent }
}

#[test]
fn a_hundred_edits_in_rectangles_stay_exact() {
    for (max_radius, edges) in [(9, Edges::Scale), (70, Edges::Scale), (70, Edges::Zero)] {
        let gl = egl();
        let question = search(25, max_radius, edges);
        let mut counts = sparse_map(233, 150);
        for settings in variants(question) {
            if settings.method == Method::BruteForce && max_radius > 9 {
                continue;
            }
            let search = settings.search;
            let mut random = Random(u64::from(max_radius));
            let mut map = upload(&gl, &counts, search);
            let mut pipeline = RadiusPipeline::new(&gl, counts.size(), map.format(), settings).unwrap();
            pipeline.render(&map).unwrap();
            for number in 0..100 {
                let changed = edit(&mut counts, &mut random);
                map.replace(&counts, CountBounds::of(&counts, search)).unwrap();
                let radii = pipeline.update(&Frame { changed, ..Frame::new(&map) }).unwrap();
                let expected = reference::radius_by_table(&counts, search);
                assert_same(&read(radii), &expected, &format!("edit {number}: {changed:?}, {settings:?}"));
            }
        }
    }
}

#[test]
fn what_the_host_does_not_tell_is_not_seen() {
    let gl = egl();
    let question = fast(search(25, 9, Edges::Scale)).search;
    let before = sparse_map(233, 150);
    let mut after = before.clone();
    after.set(10, 10, 1000);
    let mut map = upload(&gl, &before, question);
    let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), fast(question)).unwrap();
    pipeline.render(&map).unwrap();
    map.replace(&after, CountBounds::of(&after, question)).unwrap();
    let old = reference::radius_by_table(&before, question);
    let elsewhere = Changed::Rectangle { first: UVec2::new(200, 100), size: UVec2::new(4, 4) };
    for changed in [Changed::Nothing, elsewhere] {
        let radii = pipeline.update(&Frame { changed, ..Frame::new(&map) }).unwrap();
        assert_same(&read(radii), &old, "a frame that is said to have no change there");
    }
    // The same frame, declared rightly.
    let changed = Changed::Rectangle { first: UVec2::new(10, 10), size: UVec2::ONE };
    let radii = pipeline.update(&Frame { changed, ..Frame::new(&map) }).unwrap();
    assert_same(&read(radii), &reference::radius_by_table(&after, question), "the change told");
}

#[test]
fn added_photons_are_those_of_one_map_with_all() {
    let gl = egl();
    for edges in [Edges::Zero, Edges::Scale] {
        for settings in variants(search(40, 30, edges)) {
            let search = settings.search;
            let mut total = sparse_map(233, 150);
            let mut map = upload(&gl, &total, search);
            let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
            pipeline.render(&map).unwrap();
            for number in 0..6 {
                // Photons in a part of the map, so that some tiles are untouched.
                let mut random = Random(number);
                let more = Image::from_fn(total.size(), |x, y| {
                    if x / 64 == u32::try_from(number % 4).unwrap() && y > 20 { random.below(3) } else { 0 }
                });
                map.replace(&more, CountBounds::of(&more, search)).unwrap();
                let added = pipeline.update(&Frame { changed: Changed::Added, ..Frame::new(&map) });
                if settings.method != Method::SummedAreaTable {
                    assert!(matches!(added, Err(Error::Setting { name: "method", .. })), "{added:?}");
                    break;
                }
                total = Image::from_fn(total.size(), |x, y| total.at(x, y) + more.at(x, y));
                let expected = reference::radius_by_table(&total, search);
                assert_same(&read(added.unwrap()), &expected, &format!("addition {number} {settings:?}"));
            }
        }
    }
}

/// Frames until the census of the first has come; llvmpipe is done when glFinish returns.
fn until_planned(gl: &Gl, pipeline: &mut AdaptivePipeline, frame: &Frame<'_>, expected: &reference::Radii) {
    for number in 0..3 {
        let radii = pipeline.update(frame).unwrap();
        assert_same(&read(radii), expected, &format!("frame {number}"));
        // SAFETY: the context is current.
        unsafe { gl.glow().finish() };
    }
}

#[test]
fn the_adaptive_pipeline_follows_the_photons_and_stays_exact() {
    let gl = egl();
    let question = fast(search(25, 32, Edges::Scale));
    let size = UVec2::new(200, 180);
    let dense = Image::filled(size, 12);
    let sparse = sparse_map(size.x, size.y);
    let mut map = upload(&gl, &dense, question.search);
    let mut pipeline = AdaptivePipeline::new(&gl, size, map.format(), question).unwrap();
    assert_eq!(pipeline.choice().settings.search.order, Order::Bracketed, "nothing is known yet");
    for (counts, order) in [
        (&dense, Order::Forward),
        (&sparse, Order::Bracketed),
        (&Image::filled(size, 0), Order::Bracketed),
        (&dense, Order::Forward),
    ] {
        map.replace(counts, CountBounds::of(counts, question.search)).unwrap();
        let expected = reference::radius_by_table(counts, question.search);
        until_planned(&gl, &mut pipeline, &Frame::new(&map), &expected);
        assert_eq!(pipeline.choice().settings.search.order, order, "{}", pipeline.choice().reason);
    }
}

/// Photons keep coming while the planner changes its choice: none of those before may be lost.
#[test]
fn photons_added_to_an_adaptive_pipeline_stay_when_the_order_changes() {
    let gl = egl();
    let question = fast(search(25, 32, Edges::Scale));
    let mut total = sparse_map(200, 180);
    let more = Image::from_fn(total.size(), |x, y| 1 + (x + y) % 2);
    let mut map = upload(&gl, &total, question.search);
    let mut pipeline = AdaptivePipeline::new(&gl, map.size(), map.format(), question).unwrap();
    let mut orders = Vec::new();
    for number in 0..6 {
        let changed = if number == 0 { Changed::Everything } else { Changed::Added };
        if number > 0 {
            map.replace(&more, CountBounds::of(&more, question.search)).unwrap();
            total = Image::from_fn(total.size(), |x, y| total.at(x, y) + more.at(x, y));
        }
        let radii = pipeline.update(&Frame { changed, ..Frame::new(&map) }).unwrap();
        let expected = reference::radius_by_table(&total, question.search);
        assert_same(&read(radii), &expected, &format!("addition {number}"));
        orders.push(pipeline.choice().settings.search.order);
        // SAFETY: the context is current.
        unsafe { gl.glow().finish() };
    }
    assert!(orders.contains(&Order::Bracketed) && orders.contains(&Order::Forward), "{orders:?}");
}

/// Parts of a frame called one by one, as hosts that time them do.
#[test]
fn a_search_alone_believes_only_what_was_searched_before() {
    let gl = egl();
    let question = search(25, 9, Edges::Scale);
    let (one, other) = (sparse_map(233, 150), random_map(233, 150, 3));
    let corner = Changed::Rectangle { first: UVec2::ZERO, size: UVec2::ONE };
    for settings in variants(question) {
        let mut map = upload(&gl, &one, settings.search);
        let mut pipeline = RadiusPipeline::new(&gl, one.size(), map.format(), settings).unwrap();
        pipeline.build(&map).unwrap();
        for (counts, changed) in [(&one, corner), (&other, corner), (&one, Changed::Nothing)] {
            map.replace(counts, CountBounds::of(counts, settings.search)).unwrap();
            pipeline.build(&map).unwrap();
            let radii = pipeline.search_frame(&Frame { changed, ..Frame::new(&map) }).unwrap();
            let expected = reference::radius_by_table(counts, settings.search);
            assert_same(&read(radii), &expected, &format!("{changed:?} {settings:?}"));
        }
    }
}

#[test]
fn a_map_without_photons_is_followed_by_any_other() {
    let gl = egl();
    let question = search(25, 9, Edges::Scale);
    let full = sparse_map(150, 91);
    let none = Image::filled(full.size(), 0);
    for settings in variants(question) {
        let mut map = upload(&gl, &none, settings.search);
        let mut pipeline = RadiusPipeline::new(&gl, full.size(), map.format(), settings).unwrap();
        let whole = Changed::Rectangle { first: UVec2::ZERO, size: full.size() };
        for (counts, changed) in
            [(&none, Changed::Everything), (&full, whole), (&none, whole), (&full, Changed::Everything)]
        {
            map.replace(counts, CountBounds::of(counts, settings.search)).unwrap();
            let radii = pipeline.update(&Frame { changed, ..Frame::new(&map) }).unwrap();
            let expected = reference::radius_by_table(counts, settings.search);
            assert_same(&read(radii), &expected, &format!("{changed:?} {settings:?}"));
        }
    }
}

#[test]
fn additions_past_what_sums_hold_are_refused() {
    let gl = egl();
    let question = fast(search(25, 9, Edges::Zero)).search;
    let half = Image::filled(UVec2::new(40, 40), 4_000_000_000 / 1600);
    let map = upload(&gl, &half, question);
    let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), fast(question)).unwrap();
    pipeline.render(&map).unwrap();
    let added = pipeline.update(&Frame { changed: Changed::Added, ..Frame::new(&map) });
    assert!(matches!(added, Err(Error::Inexact { .. })), "{added:?}");
}
