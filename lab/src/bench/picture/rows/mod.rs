//! The work of each row, and whether its answer is right.

mod checks;

use std::time::Instant;

use glam::UVec2;

use crate::BOUNCES;
use checks::are_counts_right;
use varikernel::error::{Error, Result};
use varikernel::gl::{Gl, Sample, Timer};
use varikernel::image::Image;
use varikernel::maps::{CountBounds, DensityMap, RadiusMap};
use varikernel::measure::{PointPass, Unit, UnitPass};
use varikernel::photon::{Emission, PhotonPoint, TraceSettings, trace_in_batches};
use varikernel::reference::{self, Shown};
use varikernel::render::Renderer;
use varikernel::scene::Scene;
use varikernel::settings::{Estimate, KernelRadius, PictureSettings, Search, Settings};

/// The fixed radius with the least RMSE in the glass box (`varikernel figures`), in pixels.
const BEST_FIXED: u32 = 2;

/// Copies of a sample, whose mean counts: one alone is over too soon for a clock.
const COPIES: u32 = 16;

/// n, MR and the fixed radius.
pub(super) fn radii() -> [u32; 3] {
    let PictureSettings { min_photons, max_radius, .. } = PictureSettings::default();
    [min_photons, max_radius, BEST_FIXED]
}

/// A stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Work {
    Copy,
    Points,
    Density,
    Radius,
    SplatVariable,
    SplatFixed,
    Gather,
    Flux,
    Tables,
    TablesMoved,
    Whole,
    Photons,
}

impl Work {
    /// All of them, the units first.
    pub(super) const ALL: [Self; 12] = [
        Self::Copy,
        Self::Points,
        Self::Density,
        Self::Radius,
        Self::SplatVariable,
        Self::SplatFixed,
        Self::Gather,
        Self::Flux,
        Self::Tables,
        Self::TablesMoved,
        Self::Whole,
        Self::Photons,
    ];

    /// Whether photons are drawn as kernels.
    pub(super) fn is_splat(self) -> bool {
        matches!(self, Self::SplatVariable | Self::SplatFixed)
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Copy => "copy",
            Self::Points => "points",
            Self::Density => "density",
            Self::Radius => "radius",
            Self::SplatVariable => "splat-variable",
            Self::SplatFixed => "splat-fixed",
            Self::Gather => "gather",
            Self::Flux => "flux",
            Self::Tables => "tables",
            Self::TablesMoved => "tables-moved",
            Self::Whole => "whole",
            Self::Photons => "photons",
        }
    }
}

/// A scene with its photons on the GPU, and what each row needs.
pub(super) struct Rows<'a> {
    scene: &'a Scene,
    trace: TraceSettings,
    settings: PictureSettings,
    copy: UnitPass,
    /// What is copied: the definition's counts.
    copied: DensityMap,
    points: PointPass,
    renderer: Renderer,
    /// The same photons, for light from tables.
    tables: Renderer,
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
        let trace = TraceSettings { photons, bounces: Some(BOUNCES), ..TraceSettings::default() };
        // Direct light is not timed.
        let settings = PictureSettings { size, light_samples: 1, ..PictureSettings::default() };
        let view = scene.view(size);
        let mut seen: Vec<PhotonPoint> = Vec::new();
        trace_in_batches(scene, &Emission::new(scene, &trace)?, |landings, _| {
            let points = landings.iter().filter(|photon| !photon.is_direct()).map(PhotonPoint::new);
            seen.extend(points.filter(|point| point.may_be_seen(&view)));
            Ok::<(), Error>(())
        })?;
        seen.truncate(photons as usize);
        let points = PointPass::new(gl, &view)?;
        let renderer = Renderer::with_photons(gl, scene, &settings, &seen)?;
        let by_tables = PictureSettings { estimate: Estimate::Tables, ..settings };
        let tables = Renderer::with_photons(gl, scene, &by_tables, &seen)?;
        let surfaces = renderer.surfaces();
        let (position, normal) = (surfaces.read_position()?, surfaces.read_normal()?);
        let shown = Shown { view, position, normal };
        let counts = reference::photon_density(&shown, &seen);
        let copied = DensityMap::upload(gl, &counts, CountBounds::total_at_most(seen.len() as u64))?;
        let copy = UnitPass::new(gl, Unit::Copy, size)?;
        let (fragments, drawn) = ([0.0; 2], seen.len() as u64);
        let contributing = 0;
        Ok(Self {
            scene,
            trace,
            settings,
            copy,
            copied,
            points,
            renderer,
            tables,
            seen,
            shown,
            fragments,
            drawn,
            contributing,
        })
    }

    /// Photons that are traced.
    pub(super) fn photons(&self) -> u32 {
        self.trace.photons
    }

    /// All of light from tables, as when the camera has moved, and waits for it.
    pub(super) fn whole_when_moved(&mut self) -> Result<()> {
        self.tables.forget_camera();
        self.tables.count()?;
        self.tables.spread()?.read().map(drop)
    }

    pub(super) fn run(&mut self, timer: &mut Timer, work: Work) -> Result<Sample> {
        let settings = self.settings_of(work);
        let renderer = &mut self.renderer;
        // Not timed: another kernel is compiled, and its light cleared, outside of the stage.
        renderer.change(&settings)?;
        let result = match work {
            Work::Copy => timer.time(|| (0..COPIES).try_for_each(|_| self.copy.run(&self.copied))).map(
                |((), Sample { query, wall })| ((), Sample { query: query / COPIES, wall: wall / COPIES }),
            ),
            Work::Points => timer.time(|| self.points.run(renderer.photons())),
            Work::Density => timer.time(|| renderer.count()),
            Work::Radius => timer.time(|| renderer.search()),
            Work::SplatVariable | Work::SplatFixed | Work::Gather => {
                timer.time(|| renderer.spread().map(drop))
            }
            Work::Flux => timer.time(|| self.tables.count()),
            Work::Tables => timer.time(|| self.tables.spread().map(drop)),
            Work::Whole => timer.time(|| {
                self.tables.count()?;
                self.tables.spread().map(drop)
            }),
            Work::TablesMoved => {
                self.tables.forget_camera();
                timer.time(|| self.tables.spread().map(drop))
            }
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

    /// The picture whose light a row finds.
    fn settings_of(&self, work: Work) -> PictureSettings {
        match work {
            Work::SplatFixed => PictureSettings { radius: KernelRadius::Fixed(BEST_FIXED), ..self.settings },
            Work::Gather => {
                PictureSettings { estimate: Estimate::Gather { count_correction: false }, ..self.settings }
            }
            _ => self.settings,
        }
    }

    /// Runs a row untimed, after all rows before it. Whether its answer is right.
    pub(super) fn warm_up(&mut self, timer: &mut Timer, work: Work) -> Result<bool> {
        let total = |counts: &Image<f32>| counts.values().iter().map(|&count| f64::from(count)).sum::<f64>();
        if matches!(work, Work::Copy | Work::Points | Work::Density | Work::Radius) {
            self.run(timer, work)?;
        }
        Ok(match work {
            Work::Copy => self.copy.read()? == reference::photon_density(&self.shown, &self.seen),
            Work::Points => (total(&self.points.read()?) - self.drawn_as_f64()).abs() <= self.strays(),
            Work::Density => {
                let counts = self.counts()?;
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a sum of counts"
                )]
                let contributing = total(&counts) as u64;
                self.contributing = contributing;
                let expected = reference::photon_density(&self.shown, &self.seen);
                contributing > 0 && are_counts_right(&counts, &expected, self.drawn_as_f64())
            }
            Work::Radius => {
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts")]
                let counts = self.counts()?.map(|count| count as u32);
                let (min_photons, max_radius) = (self.settings.min_photons, self.settings.max_radius);
                let search = Search { min_photons, max_radius, ..Settings::default().search };
                self.found_radii()? == reference::radius_by_table(&counts, search).radius
            }
            Work::SplatVariable => self.is_whole(work, 0)?,
            Work::SplatFixed => self.is_whole(work, 1)?,
            Work::Gather => self.is_gathered()?,
            Work::Flux => self.is_flux_right()?,
            Work::Tables | Work::TablesMoved | Work::Whole => self.is_tabled()?,
            Work::Photons => self.is_told()?,
        })
    }

    /// What a row of light finds, untimed.
    fn light_of(&mut self, work: Work) -> Result<Image<[f32; 4]>> {
        self.renderer.change(&self.settings_of(work))?;
        self.renderer.spread()?.read()
    }

    fn counts(&self) -> Result<Image<f32>> {
        self.renderer.pipeline().density_stage().read_counts()
    }

    fn found_radii(&self) -> Result<Image<u32>> {
        self.renderer.pipeline().radii().map_or_else(|| unreachable!("radii are variable"), RadiusMap::read)
    }

    #[expect(clippy::cast_precision_loss, reason = "below 2^53")]
    fn drawn_as_f64(&self) -> f64 {
        self.drawn as f64
    }

    /// How many photons may get over the picture's edge: rasterisers place points to 1/256 of a pixel.
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
