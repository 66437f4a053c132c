//! The query and the clock.

use std::time::Duration;

use glam::UVec2;
use varikernel::gl::{Sample, Timer};
use varikernel::measure::{Unit, UnitPass};
use varikernel::settings::Settings;
use varikernel::{CountBounds, DensityMap, Image};

/// Synchronous runs of 5 ms and more. The median of several: another program may take the processor between a
/// query's end and the clock's.
#[test]
fn query_and_clock_agree_within_5_percent() {
    let gl = crate::egl();
    if !gl.info().software {
        // On a GPU the clock includes the way there and back.
        return;
    }
    let counts = Image::from_fn(UVec2::splat(1024), |x, y| x ^ y);
    let density =
        DensityMap::upload(&gl, &counts, CountBounds::of(&counts, Settings::default().search)).unwrap();
    let mut pass = UnitPass::new(&gl, Unit::Probe, counts.size()).unwrap();
    let mut timer = Timer::new(&gl).unwrap();
    let mut passes = 1;
    loop {
        let mut take = || {
            let work = || (0..passes).try_for_each(|_| pass.run(&density));
            timer.time(work).unwrap().1
        };
        take();
        let mut samples: Vec<Sample> = (0..15).map(|_| take()).collect();
        samples.sort_by_key(|sample| sample.wall);
        if samples[0].wall < Duration::from_millis(5) {
            passes *= 2;
            continue;
        }
        let mut differences: Vec<f64> = samples
            .iter()
            .map(|sample| (sample.query.as_secs_f64() / sample.wall.as_secs_f64() - 1.0).abs())
            .collect();
        differences.sort_by(f64::total_cmp);
        assert!(differences[7] < 0.05, "{samples:?}");
        assert_eq!(pass.read().unwrap(), Unit::Probe.expected(&counts));
        return;
    }
}
