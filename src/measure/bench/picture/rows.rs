//! What the rows run, and whether their answers are right.

use std::time::Instant;

use glam::UVec2;

use crate::error::{Error, Result};
use crate::gl::{Gl, Sample, Timer};
use crate::image::Image;
use crate::measure::PointPass;
use crate::photon::{Emission, PhotonPoint, TraceSettings, trace_in_batches};
use crate::reference;
use crate::render::{Renderer, Stages};
use crate::scene::Scene;
use crate::settings::{PictureSettings, RadiusChoice, Search, Settings};
use crate::view::View;

/// The fixed radius with the least RMSE in the glass box (`varikernel figures`), in pixels.
const BEST_FIXED: u32 = 2;
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
        let drawn = seen.len() as u64;
        Ok(Self { scene, trace, settings, points, stages, fragments: [0.0; 2], drawn, contributing: 0 })
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

    /// Runs a row untimed, after all rows before it. Whether its answer is right; nothing if there is no other to hold it against.
    pub(super) fn warm_up(&mut self, timer: &mut Timer, work: Work) -> Result<Option<bool>> {
        let total = |counts: &Image<f32>| counts.values().iter().map(|&count| f64::from(count)).sum::<f64>();
        if !matches!(work, Work::SplatVariable | Work::SplatFixed) {
            self.run(timer, work)?;
        }
        Ok(match work {
            Work::Points => Some((total(&self.points.read()?) - self.drawn_as_f64()).abs() <= self.strays()),
            Work::Density => {
                let (counts, points) = (self.stages.read_counts()?, self.points.read()?);
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a sum of counts"
                )]
                let contributing = total(&counts) as u64;
                self.contributing = contributing;
                // Only photons that are there are counted, and most of them are.
                let pairs = counts.values().iter().zip(points.values());
                let more: f64 = pairs.map(|(count, points)| f64::from((count - points).max(0.0))).sum();
                Some(more <= self.strays() && contributing > self.drawn / 2)
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
            Work::Gather | Work::Photons => None,
        })
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
