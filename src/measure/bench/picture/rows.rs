//! What the rows run, and whether their answers are right.

use std::time::Instant;

use glam::UVec2;

use crate::error::{Error, Result};
use crate::gl::{Gl, Sample, Timer};
use crate::image::Image;
use crate::measure::PointPass;
use crate::photon::{Emission, Ends, PhotonPoint, TraceSettings, trace_in_batches};
use crate::reference::{self, Shown};
use crate::render::{Renderer, Stages};
use crate::scene::Scene;
use crate::settings::{PictureSettings, RadiusChoice, Search, Settings};
use crate::view::View;

/// The fixed radius with the least RMSE in the glass box (`varikernel figures`), in pixels.
const BEST_FIXED: u32 = 2;
/// By how much gathered light may differ from the definition's, as a share of it: a photon on a border counts in either pixel.
const GATHERED: f64 = 2e-3;
/// Pixels at which the definition, which is slow, gathers too.
const SAMPLED: u32 = 61;
/// What a splat may lose or gain of its photons' power, as a share.
const ENERGY: f64 = 1e-4;

/// A stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Work {
    Points,
    Density,
    Radius,
    SplatVariable,
    SplatFixed,
    Gather,
    Photons,
}

impl Work {
    /// All of them, the unit first.
    pub(super) const ALL: [Self; 7] = [
        Self::Points,
        Self::Density,
        Self::Radius,
        Self::SplatVariable,
        Self::SplatFixed,
        Self::Gather,
        Self::Photons,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Points => "points",
            Self::Density => "density",
            Self::Radius => "radius",
            Self::SplatVariable => "splat-variable",
            Self::SplatFixed => "splat-fixed",
            Self::Gather => "gather",
            Self::Photons => "photons",
        }
    }
}

/// A scene with its photons on the GPU, and what each row needs.
pub(super) struct Rows<'a> {
    scene: &'a Scene,
    trace: TraceSettings,
    settings: PictureSettings,
    points: PointPass,
    stages: Stages,
    /// What is drawn, for the definitions.
    seen: Vec<PhotonPoint>,
    shown: Shown,
    /// Of the two splats.
    fragments: [f64; 2],
    pub(super) drawn: u64,
    pub(super) contributing: u64,
}

impl<'a> Rows<'a> {
    pub(super) fn new(gl: &Gl, scene: &'a Scene, size: UVec2, photons: u32) -> Result<Self> {
        let trace = TraceSettings { photons, ..TraceSettings::default() };
        // Direct light is not timed.
        let settings = PictureSettings { size, light_samples: 1, ..PictureSettings::default() };
        let view = View::new(scene, size);
        let mut seen: Vec<PhotonPoint> = Vec::new();
        trace_in_batches(scene, &Emission::new(scene, &trace)?, |landings, _| {
            let points = landings.iter().filter(|photon| !photon.is_direct()).map(PhotonPoint::new);
            seen.extend(points.filter(|point| point.may_be_seen(&view)));
            Ok::<(), Error>(())
        })?;
        seen.truncate(photons as usize);
        let points = PointPass::new(gl, &view)?;
        let stages = Renderer::with_photons(gl, scene, &settings, &seen)?.into_stages(&settings)?;
        let surfaces = stages.surfaces();
        let (position, normal) = (surfaces.read_position()?, surfaces.read_normal()?);
        let shown = Shown { view, position, normal };
        let (fragments, drawn) = ([0.0; 2], seen.len() as u64);
        Ok(Self { scene, trace, settings, points, stages, seen, shown, fragments, drawn, contributing: 0 })
    }

    /// n, MR and the fixed radius.
    pub(super) fn radii(&self) -> [u32; 3] {
        [self.settings.min_photons, self.settings.max_radius, BEST_FIXED]
    }

    pub(super) fn run(&mut self, timer: &mut Timer, work: Work) -> Result<Sample> {
        let stages = &mut self.stages;
        let result = match work {
            Work::Points => timer.time(|| self.points.run(stages.photons())),
            Work::Density => timer.time(|| stages.count()),
            Work::Radius => timer.time(|| stages.search()),
            Work::SplatVariable => timer.time(|| stages.splat(RadiusChoice::Variable).map(drop)),
            Work::SplatFixed => timer.time(|| stages.splat(RadiusChoice::Fixed(BEST_FIXED)).map(drop)),
            Work::Gather => timer.time(|| stages.gather().map(drop)),
            Work::Photons => {
                let emission = Emission::new(self.scene, &self.trace)?;
                let start = Instant::now();
                trace_in_batches(self.scene, &emission, |_, _| Ok::<(), Error>(()))?;
                let wall = start.elapsed();
                Ok(((), Sample { query: wall, wall }))
            }
        };
        result.map(|((), sample)| sample)
    }

    /// Runs a row untimed, after all rows before it. Whether its answer is right.
    pub(super) fn warm_up(&mut self, timer: &mut Timer, work: Work) -> Result<Option<bool>> {
        let total = |counts: &Image<f32>| counts.values().iter().map(|&count| f64::from(count)).sum::<f64>();
        if matches!(work, Work::Points | Work::Density | Work::Radius) {
            self.run(timer, work)?;
        }
        Ok(match work {
            Work::Points => Some((total(&self.points.read()?) - self.drawn_as_f64()).abs() <= self.strays()),
            Work::Density => {
                let counts = self.stages.read_counts()?;
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a sum of counts"
                )]
                let contributing = total(&counts) as u64;
                self.contributing = contributing;
                let expected = reference::photon_density(&self.shown, &self.seen);
                let pairs = counts.values().iter().zip(expected.values());
                let apart: f64 = pairs.map(|(&count, &all)| (f64::from(count) - f64::from(all)).abs()).sum();
                // Those that f32 puts on the other side of a border, or of a surface's edge.
                Some(apart <= 4.0 + 1e-3 * self.drawn_as_f64() && contributing > 0)
            }
            Work::Radius => {
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts")]
                let counts = self.stages.read_counts()?.map(|count| count as u32);
                let (min_photons, max_radius) = (self.settings.min_photons, self.settings.max_radius);
                let search = Search { min_photons, max_radius, ..Settings::default().search };
                Some(self.stages.read_radii()? == reference::radius_by_table(&counts, search).radius)
            }
            Work::SplatVariable => self.is_whole(RadiusChoice::Variable, 0)?,
            Work::SplatFixed => self.is_whole(RadiusChoice::Fixed(BEST_FIXED), 1)?,
            Work::Gather => Some(self.is_gathered()?),
            Work::Photons => Some(self.is_told()?),
        })
    }

    /// Whether some pixels gather what the definition says.
    fn is_gathered(&mut self) -> Result<bool> {
        let irradiance = self.stages.gather()?.read()?;
        let radii = self.stages.read_radii()?;
        let power = reference::photon_power(&self.shown, &self.seen);
        let density = reference::photon_density(&self.shown, &self.seen);
        let UVec2 { x: width, y: height } = self.settings.size;
        // An odd step does not stay in one column.
        let step = (width * height / SAMPLED) | 1;
        let (mut apart, mut all) = (0.0, 0.0);
        for index in (0..width * height).step_by(step as usize) {
            let pixel = UVec2::new(index % width, index / width);
            let radius = radii.at(pixel.x, pixel.y);
            let (expected, _) =
                reference::gather_at(&self.shown, pixel, &power, &density, radius, self.settings.kernel);
            for (found, expected) in irradiance.at(pixel.x, pixel.y).into_iter().zip(expected) {
                apart += (f64::from(found) - expected).abs();
                all += expected;
            }
        }
        Ok(apart <= GATHERED * all && all > 0.0)
    }

    /// Whether every photon is followed to an end, and all landings that are tallied are handed out.
    fn is_told(&self) -> Result<bool> {
        let mut landings = 0;
        let emission = Emission::new(self.scene, &self.trace)?;
        let tally = trace_in_batches(self.scene, &emission, |photons, _| {
            landings += photons.len() as u64;
            Ok::<(), Error>(())
        })?;
        let Ends { left, absorbed, bounces_used, given_up } = tally.ends;
        let ended = left + absorbed + bounces_used + given_up;
        let asked = u64::from(self.trace.photons);
        Ok(tally.photons == asked && ended == asked && tally.total() == landings && landings > 0)
    }

    /// Whether a splat holds its photons' power.
    fn is_whole(&mut self, radius: RadiusChoice, index: usize) -> Result<Option<bool>> {
        let irradiance = self.stages.splat(radius)?.read()?;
        let account = self.stages.account(&irradiance)?;
        self.fragments[index] = account.fragments;
        Ok(Some(account.energy_error() < ENERGY))
    }

    #[expect(clippy::cast_precision_loss, reason = "below 2^53")]
    fn drawn_as_f64(&self) -> f64 {
        self.drawn as f64
    }

    /// How many photons may get into the pixel beside theirs: rasterisers place points to 1/256 of a pixel.
    fn strays(&self) -> f64 {
        2.0 + 0.01 * self.drawn_as_f64()
    }

    pub(super) fn fragments(&self, work: Work) -> Option<f64> {
        match work {
            Work::SplatVariable => Some(self.fragments[0]),
            Work::SplatFixed => Some(self.fragments[1]),
            _ => None,
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "below 2^53")]
    pub(super) fn contributing_or_one(&self) -> f64 {
        self.contributing.max(1) as f64
    }
}
