//! Times of stages, by their labels.

#![expect(unsafe_code, reason = "a host has queries of its own")]

use std::time::Duration;

use glam::UVec2;
use glow::HasContext as _;
use varikernel::gl::StageTimes;
use varikernel::settings::{Edges, Laboratory, Method, Order, SatBuild, Search, Settings};
use varikernel::{CountBounds, DensityMap, Gl, RadiusPipeline};

use crate::calls::{Calls, counted};
use crate::driver::{self, RENDERER};
use crate::support::{each, egl, random_map, search};

/// A table of 20 x 9 by doubling, and a search by halving.
fn settings() -> Settings {
    Settings {
        search: search(9, 8, Edges::Scale),
        method: Method::SummedAreaTable,
        laboratory: Laboratory { sat_build: SatBuild::Doubling, ..Laboratory::default() },
        ..Settings::default()
    }
}

fn prepared(gl: &Gl, settings: Settings) -> (DensityMap, RadiusPipeline) {
    let counts = random_map(20, 9, 4);
    let map = DensityMap::upload(gl, &counts, CountBounds::of_boxes(&counts, settings.search)).unwrap();
    let pipeline = RadiusPipeline::new(gl, map.size(), map.format(), settings).unwrap();
    (map, pipeline)
}

fn fetched(times: &mut StageTimes) -> Option<Vec<(String, Duration)>> {
    Some(times.poll()?.map(|(label, duration)| (label.to_owned(), duration)).collect())
}

fn labels(stages: &[(String, Duration)]) -> Vec<&str> {
    stages.iter().map(|(label, _)| label.as_str()).collect()
}

#[test]
fn stages_come_in_the_order_of_their_passes_each_once() {
    for gl in each() {
        let (map, mut pipeline) = prepared(&gl, settings());
        let mut times = StageTimes::new(&gl).unwrap();
        assert!(times.waits() && gl.info().is_llvmpipe());
        assert!(times.poll().is_none(), "nothing was recorded");
        pipeline.render(&map).unwrap();
        assert!(times.poll().is_none(), "no frame had begun");
        times.begin_frame();
        pipeline.build(&map).unwrap();
        times.end_frame();
        pipeline.search(&map).unwrap();
        times.begin_frame();
        pipeline.render(&map).unwrap();
        times.end_frame();
        let built = fetched(&mut times).unwrap();
        assert_eq!(labels(&built), ["sat seed", "sat doubling"]);
        let rendered = fetched(&mut times).unwrap();
        assert_eq!(labels(&rendered), ["sat seed", "sat doubling", "radius search"]);
        assert!(
            built.iter().chain(&rendered).all(|(_, time)| *time > Duration::ZERO),
            "{built:?}, {rendered:?}"
        );
        assert!(times.poll().is_none());
        // A frame without a pass is a frame.
        times.begin_frame();
        times.end_frame();
        assert_eq!(fetched(&mut times).unwrap(), []);
        drop(pipeline);
        let averaged = Settings { method: Method::AveragedMipmap, ..settings() };
        let (map, mut pipeline) = prepared(&gl, averaged);
        times.begin_frame();
        pipeline.render(&map).unwrap();
        times.end_frame();
        assert_eq!(labels(&fetched(&mut times).unwrap()), ["mipmap seed", "mipmap levels", "radius search"]);
    }
}

/// Boxes of up to 49 x 49 pixels against boxes of up to 5 x 5: some hundred times the fetches. A time is
/// compared with another, not with the clock.
#[test]
fn a_pass_with_more_to_do_takes_longer() {
    let gl = egl();
    let counts = varikernel::Image::filled(UVec2::splat(128), 0_u32);
    let map = DensityMap::upload(&gl, &counts, CountBounds::UNKNOWN).unwrap();
    let mut times = StageTimes::new(&gl).unwrap();
    let mut time = |max_radius| {
        let search = Search { order: Order::Forward, ..search(9, max_radius, Edges::Zero) };
        let settings = Settings { search, ..Settings::of(Method::BruteForce) };
        let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
        pipeline.render(&map).unwrap();
        times.begin_frame();
        pipeline.render(&map).unwrap();
        times.end_frame();
        let stages = fetched(&mut times).unwrap();
        assert_eq!(labels(&stages), ["radius search"]);
        stages[0].1
    };
    let (short, long) = (time(2), time(24));
    assert!(long > short, "{long:?}, {short:?}");
}

/// On other renderers than llvmpipe: nothing waits, and a host's own query may be running.
#[test]
fn times_are_taken_without_waiting() {
    RENDERER.set(Some(c"a GPU"));
    let mut calls = Calls::new();
    // SAFETY: a trampoline calls the command that it stands for.
    let gl = unsafe { driver::open_through(counted) };
    assert_eq!(gl.info().renderer, "a GPU");
    let (map, mut pipeline) = prepared(&gl, settings());
    let mut times = StageTimes::new(&gl).unwrap();
    assert!(!times.waits());
    // SAFETY: the context is current.
    let host = unsafe {
        let query = gl.glow().create_query().unwrap();
        gl.glow().begin_query(glow::TIME_ELAPSED, query);
        query
    };
    calls.restart();
    let mut frames = Vec::new();
    for frame in 0..6 {
        if frame == 1 {
            assert!(calls.of("glGenQueries") > 0 && calls.of("glQueryCounter") > 0, "they are counted");
            let polled = calls.of("glGetQueryObjectui64v");
            assert!(polled > 0, "results are asked for");
        }
        times.begin_frame();
        pipeline.render(&map).unwrap();
        times.end_frame();
        frames.extend(fetched(&mut times));
    }
    // One copy, passes along 20 columns and along 9 rows, and a search, two stamps each.
    let settings = settings();
    let samples = settings.laboratory.sat_samples.count();
    let passes = |side: u32| (0..6).map(|pass| u64::from(samples.pow(pass) < side)).sum::<u64>();
    let passes = 1 + passes(20) + passes(9) + 1;
    assert_eq!(calls.of("glQueryCounter"), 6 * 2 * passes);
    for waiting in ["glFinish", "glFlush", "glClientWaitSync", "glWaitSync", "glReadPixels", "glGetTexImage"]
    {
        assert_eq!(calls.of(waiting), 0, "{waiting}");
    }
    assert_eq!(calls.of("glBeginQuery"), 0, "no query of a kind that a host may be using");
    // SAFETY: the context is current, and the query is running.
    let (error, nanoseconds) = unsafe {
        gl.glow().end_query(glow::TIME_ELAPSED);
        gl.glow().finish();
        let result = gl.glow().get_query_parameter_u32(host, glow::QUERY_RESULT);
        gl.glow().delete_query(host);
        (gl.glow().get_error(), result)
    };
    assert_eq!(error, glow::NO_ERROR);
    assert!(nanoseconds > 0, "the host's query ran on");
    while let Some(frame) = fetched(&mut times) {
        frames.push(frame);
    }
    assert_eq!(frames.len(), 6, "every frame comes");
    for frame in &frames {
        assert_eq!(labels(frame), ["sat seed", "sat doubling", "radius search"]);
    }
    // After the first rounds, everything is there.
    for _ in 0..16 {
        times.begin_frame();
        pipeline.render(&map).unwrap();
        times.end_frame();
    }
    calls.restart();
    for _ in 0..16 {
        times.begin_frame();
        pipeline.render(&map).unwrap();
        times.end_frame();
        drop(times.poll());
    }
    assert_eq!(calls.of("glGenQueries"), 0);
    assert!(calls.of("glQueryCounter") > 0);
    // Between frames nothing is stamped, nor after another one took over.
    calls.restart();
    pipeline.render(&map).unwrap();
    assert_eq!(calls.of("glQueryCounter"), 0);
    let mut other = StageTimes::new(&gl).unwrap();
    times.begin_frame();
    other.begin_frame();
    times.end_frame();
    pipeline.render(&map).unwrap();
    assert_eq!(calls.of("glQueryCounter"), 2 * passes);
    other.end_frame();
    drop(other);
    drop(times);
    RENDERER.set(None);
}

/// A host that never fetches loses the oldest frames, and nothing grows.
#[test]
fn frames_that_nobody_fetches_make_room() {
    let gl = egl();
    let (map, mut pipeline) = prepared(&gl, settings());
    let mut times = StageTimes::new(&gl).unwrap();
    pipeline.build(&map).unwrap();
    for frame in 0..20 {
        times.begin_frame();
        if frame == 19 {
            pipeline.render(&map).unwrap();
        } else {
            pipeline.search(&map).unwrap();
        }
        times.end_frame();
    }
    let mut frames = Vec::new();
    while let Some(frame) = fetched(&mut times) {
        frames.push(frame);
    }
    assert_eq!(frames.len(), 8);
    assert_eq!(labels(&frames[6]), ["radius search"]);
    assert_eq!(labels(&frames[7]), ["sat seed", "sat doubling", "radius search"], "the newest is kept");
}
