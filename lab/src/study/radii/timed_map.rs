//! A map on the device, and a way to its radii, timed and compared with the exact ones.

use std::time::{Duration, Instant};

use super::{Question, RadiusError, RadiusRow};
use crate::bench::{MapInfo, MapSource};
use crate::rivals::{Cores, Scanline};
use crate::statistics::Statistics;
use crate::study::variant::{Variant, VariantName, Way};
use crate::summary::total_photons;
use varikernel::error::Result;
use varikernel::gl::{Gl, Timer};
use varikernel::image::Image;
use varikernel::maps::CountBounds;
use varikernel::maps::DensityMap;
use varikernel::measure::Approximation;
use varikernel::measure::{Unit, UnitPass};
use varikernel::radius::RadiusPipeline;
use varikernel::settings::Search;

/// A map on the device with its exact answer, and the unit of time.
pub(super) struct Bench {
    pub(super) map: MapInfo,
    photons: u64,
    pub(super) density: DensityMap,
    /// The same, with a claim that it holds next to nothing.
    claimed: DensityMap,
    exact: Image<u32>,
    mean_radius: f64,
    copy: UnitPass,
    copies_ms: Vec<f64>,
    timer: Timer,
}

impl Bench {
    pub(super) fn new(gl: &Gl, map: &MapSource, search: Search) -> Result<Self> {
        let counts = map.make();
        let exact = Scanline::new(counts.size(), search, Cores::All).run(&counts).radius.clone();
        let sum: u64 = exact.values().iter().map(|&radius| u64::from(radius)).sum();
        #[expect(clippy::cast_precision_loss, reason = "a mean is rounded anyway")]
        let mean_radius = sum as f64 / exact.values().len() as f64;
        // Close enough for any storage.
        let density = DensityMap::upload(gl, &counts, CountBounds::of_boxes(&counts, search))?;
        Ok(Self {
            map: map.info.clone(),
            photons: total_photons(&counts),
            claimed: DensityMap::borrow(gl, density.texture(), CountBounds::total_at_most(1))?,
            density,
            exact,
            mean_radius,
            copy: UnitPass::new(gl, Unit::Copy, counts.size())?,
            copies_ms: Vec::new(),
            timer: Timer::new(gl)?,
        })
    }

    pub(super) fn take_copy(&mut self) -> Result<()> {
        self.copy.run(&self.density)?;
        let ((), sample) = self.timer.time(|| self.copy.run(&self.density))?;
        self.copies_ms.push(1000.0 * sample.query.as_secs_f64());
        Ok(())
    }

    /// Median time of a copy so far.
    pub(super) fn copy_ms(&self) -> f64 {
        Statistics::of(&self.copies_ms).map_or(f64::NAN, |statistics| statistics.median_ms)
    }

    pub(super) fn run(
        &mut self,
        machine: &mut Machine,
        question: Question,
        variant: &VariantName,
        sample_ms: u64,
    ) -> Result<RadiusRow> {
        let density = if machine.unguarded { &self.claimed } else { &self.density };
        let limit = Duration::from_millis(sample_ms);
        // The first run compiles.
        machine.render(density)?;
        let begun = Instant::now();
        let mut samples = Vec::new();
        while samples.is_empty() || begun.elapsed() < limit {
            samples.push(self.timer.time(|| machine.render(density))?.1);
        }
        let ms: Vec<f64> = samples.iter().map(|sample| 1000.0 * sample.query.as_secs_f64()).collect();
        let ms = Statistics::of(&ms).map_or(f64::NAN, |statistics| statistics.median_ms);
        Ok(RadiusRow {
            map: self.map.clone(),
            photons: self.photons,
            question,
            variant: variant.clone(),
            promised: machine.promises(&self.density, question),
            mean_radius: self.mean_radius,
            error: RadiusError::between(&machine.read()?, &self.exact),
            memory_bytes: machine.memory_bytes,
            ms,
            copies: ms / self.copy_ms(),
            samples: samples.len(),
        })
    }
}

/// A way, allocated and compiled for maps of one size.
pub(super) struct Machine {
    radii: Radii,
    /// Whether maps come with a claim that they hold next to nothing.
    unguarded: bool,
    memory_bytes: u64,
}

enum Radii {
    Searched(Box<RadiusPipeline>),
    Approximated(Box<Approximation>),
}

impl Machine {
    /// The one that is there, or a new one.
    pub(super) fn prepared<'a>(
        machine: &'a mut Option<Self>,
        gl: &Gl,
        density: &DensityMap,
        variant: &Variant,
    ) -> Result<&'a mut Self> {
        let made = match machine.take() {
            Some(made) => made,
            None => Self::new(gl, density, variant.way)?,
        };
        Ok(machine.insert(made))
    }

    fn new(gl: &Gl, density: &DensityMap, way: Way) -> Result<Self> {
        let before = gl.texture_bytes();
        let searched = |settings| {
            let pipeline = RadiusPipeline::new(gl, density.size(), density.format(), settings)?;
            Ok(Radii::Searched(Box::new(pipeline)))
        };
        let approximated = |approximation| Radii::Approximated(Box::new(approximation));
        let radii = match way {
            Way::Pipeline(settings) | Way::Unguarded(settings) => searched(settings)?,
            Way::HalfDensity(search) => approximated(Approximation::half_density(gl, density, search)?),
            Way::Grid(search, step) => approximated(Approximation::grid(gl, density, search, step)?),
        };
        let unguarded = matches!(way, Way::Unguarded(_));
        Ok(Self { radii, unguarded, memory_bytes: gl.texture_bytes() - before })
    }

    fn render(&mut self, density: &DensityMap) -> Result<()> {
        match &mut self.radii {
            Radii::Searched(pipeline) => pipeline.render(density).map(drop),
            Radii::Approximated(approximation) => approximation.render(density),
        }
    }

    fn read(&self) -> Result<Image<u32>> {
        match &self.radii {
            Radii::Searched(pipeline) => pipeline.radii().read(),
            Radii::Approximated(approximation) => approximation.read(),
        }
    }

    /// Whether the library guarantees the radii of a map.
    fn promises(&self, density: &DensityMap, question: Question) -> bool {
        match &self.radii {
            Radii::Searched(pipeline) => {
                let asked = pipeline.settings().search.max_radius == question.max_radius;
                !self.unguarded && asked && pipeline.plan(density).is_ok_and(|plan| plan.exact)
            }
            Radii::Approximated(_) => false,
        }
    }
}
