//! Many contexts: a thousand one after another and eight at once, each with a radius map that is the
//! definition's. In a process of their own, one test at a time, so that memory and open files can be
//! measured.

#![expect(clippy::unwrap_used, reason = "in the helpers of tests too, a panic is the report")]

#[path = "../common/osmesa.rs"]
mod osmesa;

use std::fs;
use std::sync::{Barrier, Mutex, MutexGuard, PoisonError};
use std::thread;

use glam::UVec2;
use osmesa::osmesa_is_here;
use varikernel::context::{self, DeviceChoice};
use varikernel::settings::{Edges, Method, Order, Search, Settings};
use varikernel::{CountBounds, DensityMap, Gl, Image, RadiusPipeline, reference};

/// Waits until no other test runs, for as long as what it gives is held.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn open(choice: &DeviceChoice) -> Gl {
    context::open(choice).unwrap_or_else(|error| panic!("{error}"))
}

/// Whether the radii of a small map of that number are the definition's.
fn is_exact(gl: &Gl, number: u32, method: Method) -> bool {
    let density = Image::from_fn(UVec2::new(7, 5), |x, y| (x * 3 + y * 5 + number) % 4);
    let search = Search { min_photons: 6, max_radius: 4, edges: Edges::Scale, order: Order::Binary };
    let settings = Settings { search, ..Settings::of(method) };
    let map = DensityMap::upload(gl, &density, CountBounds::of(&density, search)).unwrap();
    let mut pipeline = RadiusPipeline::new(gl, map.size(), map.format(), settings).unwrap();
    let found = pipeline.render(&map).unwrap().read().unwrap();
    found == reference::radius(&density, search).radius
}

/// Resident MiB and open files of this process; neither is known outside of Linux.
fn held() -> Option<(u64, usize)> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kibibytes: u64 = line.trim().trim_end_matches(" kB").parse().unwrap();
    Some((kibibytes / 1024, fs::read_dir("/proc/self/fd").unwrap().count()))
}

fn a_thousand_one_after_another(choice: &DeviceChoice) {
    let mut before = None;
    for number in 0..1000 {
        // What is made once, caches above all, is there after some.
        if number == 100 {
            before = held();
        }
        let gl = open(choice);
        assert!(is_exact(&gl, number, Method::BruteForce), "context {number}");
    }
    if let (Some((memory, files)), Some((memory_after, files_after))) = (before, held()) {
        assert_eq!(files_after, files, "open files after 100 contexts and after 1000");
        // 73 KiB for each of the 900 contexts between: one that stayed would hold more.
        assert!(memory_after <= memory + 64, "{memory} MiB after 100 contexts, {memory_after} after 1000");
    }
}

/// Each computes while the seven others do.
fn eight_at_once(choice: &DeviceChoice) {
    let barrier = Barrier::new(8);
    thread::scope(|scope| {
        let threads: Vec<_> = (0..8)
            .map(|number| {
                let barrier = &barrier;
                scope.spawn(move || {
                    let gl = open(choice);
                    // None begins before all contexts are open.
                    barrier.wait();
                    (0..10).all(|turn| {
                        let method = [Method::SummedAreaTable, Method::BruteForce, Method::Pyramid][turn % 3];
                        is_exact(&gl, number, method)
                    })
                })
            })
            .collect();
        for (number, thread) in threads.into_iter().enumerate() {
            assert!(thread.join().unwrap(), "the context of thread {number} computed something else");
        }
    });
}

#[test]
fn a_thousand_contexts_one_after_another_on_egl() {
    let _alone = alone();
    a_thousand_one_after_another(&DeviceChoice::Egl(None));
}

#[test]
fn a_thousand_contexts_one_after_another_on_osmesa() {
    let _alone = alone();
    if osmesa_is_here() {
        a_thousand_one_after_another(&DeviceChoice::OsMesa);
    }
}

#[test]
fn eight_contexts_at_once_on_egl() {
    let _alone = alone();
    eight_at_once(&DeviceChoice::Egl(None));
}

#[test]
fn eight_contexts_at_once_on_osmesa() {
    let _alone = alone();
    if osmesa_is_here() {
        eight_at_once(&DeviceChoice::OsMesa);
    }
}

#[test]
fn memory_and_open_files_are_told() {
    let _alone = alone();
    let Some((memory, files)) = held() else { return };
    let more = vec![1_u8; 200 << 20];
    let file = fs::File::open("/proc/self/status").unwrap();
    let (memory_after, files_after) = held().unwrap();
    assert!(memory_after >= memory + 190 && files_after == files + 1, "{memory} and {memory_after} MiB");
    drop((more, file));
}
