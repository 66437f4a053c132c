//! What each change of chapter 6 gains, before and after taking turns in one run.

use std::time::{Duration, Instant};

use crate::statistics::Statistics;
use crate::thesis::claims::usual_search;
use crate::thesis::evidence::Gain;
use varikernel::error::Result;
use varikernel::gl::{Gl, Timer};
use varikernel::image::Difference;
use varikernel::image::Image;
use varikernel::maps::CountBounds;
use varikernel::maps::DensityMap;
use varikernel::radius::RadiusPipeline;
use varikernel::reference;
use varikernel::settings::{
    Edges, Laboratory, Matching, Method, Order, SatSamples, Search, Settings, Variation,
};

/// Most samples of each side of a gain.
const SAMPLES: usize = 60;

/// One change.
struct Change {
    id: &'static str,
    what: &'static str,
    before: Settings,
    after: Settings,
    /// Only the build is timed, or the whole frame.
    build_only: bool,
}

fn changes() -> Vec<Change> {
    let thesis = Settings { search: usual_search(), ..Settings::thesis() };
    let binary = Settings { search: Search { order: Order::Binary, ..thesis.search }, ..thesis };
    let brute_force = Settings { method: Method::BruteForce, ..thesis };
    let pyramid = Settings { method: Method::Pyramid, ..thesis };
    let varied = |before: Settings, variation| Settings {
        laboratory: Laboratory { variation: Some(variation), ..before.laboratory },
        ..before
    };
    let frame = |id, what, before, after| Change { id, what, before, after, build_only: false };
    let build = |id, what, before, after| Change { id, what, before, after, build_only: true };
    vec![
        frame(
            "scale-cost",
            "table, forward, whole frame",
            Settings { search: Search { edges: Edges::Zero, ..thesis.search }, ..thesis },
            thesis,
        ),
        frame(
            "future-brute-reuse",
            "brute force, forward",
            brute_force,
            varied(brute_force, Variation::ReusedSums),
        ),
        frame(
            "future-brute-several",
            "brute force, forward, four fetches a turn",
            brute_force,
            varied(brute_force, Variation::FetchesAtOnce),
        ),
        frame(
            "future-pyramid-bits",
            "pyramid, forward",
            pyramid,
            Settings { laboratory: Laboratory { matching: Matching::Bits, ..pyramid.laboratory }, ..pyramid },
        ),
        frame("future-pyramid-strips", "pyramid, forward", pyramid, varied(pyramid, Variation::WholeStrips)),
        build(
            "future-sat-samples",
            "table, 8 samples a pass against 4, build alone",
            thesis,
            Settings {
                laboratory: Laboratory { sat_samples: SatSamples::Eight, ..thesis.laboratory },
                ..thesis
            },
        ),
        build(
            "future-sat-scissor",
            "table, 2 samples a pass, build alone",
            Settings {
                laboratory: Laboratory { sat_samples: SatSamples::Two, ..thesis.laboratory },
                ..thesis
            },
            varied(
                Settings {
                    laboratory: Laboratory { sat_samples: SatSamples::Two, ..thesis.laboratory },
                    ..thesis
                },
                Variation::UnfinishedTexels,
            ),
        ),
        frame(
            "future-sat-select",
            "table, binary, whole frame",
            binary,
            varied(binary, Variation::UnconditionalFetches),
        ),
    ]
}

/// Times every change on `map` within `budget`, each with an equal share.
///
/// # Errors
/// [`Error::Gl`](varikernel::Error::Gl) if the driver fails.
pub(super) fn time(gl: &Gl, map: &Image<u32>, name: &str, budget: Duration) -> Result<Vec<Gain>> {
    let mut timer = Timer::new(gl)?;
    let changes = changes();
    let share = budget / u32::try_from(changes.len()).unwrap_or(u32::MAX);
    changes.iter().map(|change| gain(gl, &mut timer, map, name, change, share)).collect()
}

fn gain(
    gl: &Gl,
    timer: &mut Timer,
    map: &Image<u32>,
    name: &str,
    change: &Change,
    budget: Duration,
) -> Result<Gain> {
    let search = change.after.search;
    let density = DensityMap::upload(gl, map, CountBounds::of(map, search))?;
    let pipeline = |settings| RadiusPipeline::new(gl, map.size(), density.format(), settings);
    let mut sides = [pipeline(change.before)?, pipeline(change.after)?];
    for side in &mut sides {
        side.render(&density)?;
    }
    let found = sides[1].radii().read()?;
    let wrong_pixels =
        Difference::between(&found, &reference::radius_by_table(map, search).radius)?.wrong_pixels;

    let start = Instant::now();
    let mut samples = [Vec::new(), Vec::new()];
    while samples[1].is_empty() || (samples[1].len() < SAMPLES && start.elapsed() < budget) {
        for (side, samples) in sides.iter_mut().zip(&mut samples) {
            let ((), sample) = timer.time(|| {
                if change.build_only { side.build(&density) } else { side.render(&density).map(drop) }
            })?;
            samples.push(1e3 * sample.query.as_secs_f64());
        }
    }
    let [before_ms, after_ms] =
        samples.map(|samples| Statistics::of(&samples).map_or(0.0, |of| of.median_ms));
    let size = map.size();
    Ok(Gain {
        id: change.id.to_owned(),
        what: format!(
            "{}; {name}, {} x {}, n {}, MR {}",
            change.what, size.x, size.y, search.min_photons, search.max_radius
        ),
        before_ms,
        after_ms,
        wrong_pixels,
    })
}
