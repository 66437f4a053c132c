//! Frames that follow each other: changes in a rectangle, added photons. Every radius equals the
//! definition's.

#![expect(unsafe_code, reason = "a host waits for the GPU itself")]

use glam::UVec2;
use glow::HasContext as _;
use varikernel::settings::{Edges, Laboratory, Method, Order, SatBuild, Search, Settings};
use varikernel::{
    Changed, CountBounds, DensityMap, Error, Frame, Gl, Image, RadiusMap, RadiusPipeline, reference,
};

use crate::support::{Random, assert_same, egl, planned, random_map, search, sparse_map};

pub(crate) fn read(radii: &RadiusMap) -> reference::Radii {
    reference::Radii { radius: radii.read().unwrap(), limited: radii.read_limited().unwrap().unwrap() }
}

pub(crate) fn upload(gl: &Gl, counts: &Image<u32>, search: Search) -> DensityMap {
    DensityMap::upload(gl, counts, CountBounds::of(counts, search)).unwrap()
}

/// The usual table and its bracketed search, with the limited pixels.
pub(crate) fn fast(search: Search) -> Settings {
    let search = Search { order: Order::Bracketed, ..search };
    Settings { search, limited_mask: true, ..Settings::default() }
}

/// The fast path, the thesis's table, and a method without one.
pub(crate) fn variants(search: Search) -> [Settings; 4] {
    let fast = fast(search);
    let binary = Settings { search: Search { order: Order::Binary, ..search }, ..fast };
    [
        fast,
        binary,
        Settings { laboratory: Laboratory { sat_build: SatBuild::Doubling, ..fast.laboratory }, ..fast },
        Settings { method: Method::BruteForce, search: Search { order: Order::Forward, ..search }, ..fast },
    ]
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
fn until_planned(gl: &Gl, pipeline: &mut RadiusPipeline, frame: &Frame<'_>, expected: &reference::Radii) {
    for number in 0..3 {
        let radii = pipeline.update(frame).unwrap();
        assert_same(&read(radii), expected, &format!("frame {number}"));
        // SAFETY: the context is current.
        unsafe { gl.glow().finish() };
    }
}

#[test]
fn planning_follows_the_photons_and_stays_exact() {
    let gl = egl();
    let question = fast(search(25, 32, Edges::Scale));
    let size = UVec2::new(200, 180);
    let dense = Image::filled(size, 12);
    let sparse = sparse_map(size.x, size.y);
    let mut map = upload(&gl, &dense, question.search);
    let mut pipeline = RadiusPipeline::new(&gl, size, map.format(), planned(question)).unwrap();
    assert_eq!(pipeline.decision().unwrap().settings.search.order, Order::Bracketed, "nothing is known yet");
    for (counts, order) in [
        (&dense, Order::Forward),
        (&sparse, Order::Bracketed),
        (&Image::filled(size, 0), Order::Bracketed),
        (&dense, Order::Forward),
    ] {
        map.replace(counts, CountBounds::of(counts, question.search)).unwrap();
        let expected = reference::radius_by_table(counts, question.search);
        until_planned(&gl, &mut pipeline, &Frame::new(&map), &expected);
        assert_eq!(
            pipeline.decision().unwrap().settings.search.order,
            order,
            "{}",
            pipeline.decision().unwrap().reason
        );
    }
}

/// Photons keep coming while the planner changes its choice: none of those before may be lost.
#[test]
fn photons_added_while_planning_stay_when_the_order_changes() {
    let gl = egl();
    let question = fast(search(25, 32, Edges::Scale));
    let mut total = sparse_map(200, 180);
    let more = Image::from_fn(total.size(), |x, y| 1 + (x + y) % 2);
    let mut map = upload(&gl, &total, question.search);
    let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), planned(question)).unwrap();
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
        orders.push(pipeline.decision().unwrap().settings.search.order);
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
