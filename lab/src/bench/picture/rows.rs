//! The work of each row, and whether its answer is right.

use std::time::Instant;

use glam::UVec2;

use crate::BOUNCES;
use varikernel::error::{Error, Result};
use varikernel::gl::{Gl, Sample, Timer};
use varikernel::image::Image;
use varikernel::maps::{CountBounds, DensityMap, RadiusMap};
use varikernel::measure::{PointPass, Unit, UnitPass};
use varikernel::photon::{Emission, Ends, PhotonPoint, TraceSettings, trace_in_batches};
use varikernel::reference::{self, Shown};
use varikernel::render::Renderer;
use varikernel::scene::Scene;
use varikernel::settings::{Estimate, KernelRadius, PictureSettings, Search, Settings};

/// The fixed radius with the least RMSE in the glass box (`varikernel figures`), in pixels.
const BEST_FIXED: u32 = 2;
/// By how much gathered light may differ from the definition's, as a share of it: a photon on a border counts
/// in either pixel.
const GATHERED: f64 = 2e-3;
/// Pixels at which the definition, which is slow, gathers too.
const SAMPLED: u32 = 61;
/// What a splat may lose or gain of its photons' power, as a share.
const ENERGY: f64 = 1e-4;

/// Copies of a sample, whose mean counts: one alone is over too soon for a clock.
const COPIES: u32 = 16;

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
    TablesCamera,
    Photons,
}

impl Work {
    /// All of them, the units first.
    pub(super) const ALL: [Self; 11] = [
        Self::Copy,
        Self::Points,
        Self::Density,
        Self::Radius,
        Self::SplatVariable,
        Self::SplatFixed,
        Self::Gather,
        Self::Flux,
        Self::Tables,
        Self::TablesCamera,
        Self::Photons,
    ];

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
            Self::TablesCamera => "tables-camera",
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

    /// n, MR and the fixed radius.
    pub(super) fn radii(&self) -> [u32; 3] {
        [self.settings.min_photons, self.settings.max_radius, BEST_FIXED]
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
            Work::TablesCamera => {
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
            Work::Tables | Work::TablesCamera => self.is_tabled()?,
            Work::Photons => self.is_told()?,
        })
    }

    /// Whether some pixels gather what the definition says.
    fn is_gathered(&mut self) -> Result<bool> {
        let irradiance = self.light_of(Work::Gather)?;
        let radii = self.found_radii()?;
        let power = reference::photon_power(&self.shown, &self.seen);
        let density = reference::photon_density(&self.shown, &self.seen);
        let UVec2 { x: width, y: height } = self.settings.size;
        // An odd step does not stay in one column.
        let step = (width * height / SAMPLED) | 1;
        let mut pairs = Vec::new();
        for index in (0..width * height).step_by(step as usize) {
            let pixel = UVec2::new(index % width, index / width);
            let radius = radii.at(pixel.x, pixel.y);
            let (expected, _) =
                reference::gather_at(&self.shown, pixel, &power, &density, radius, self.settings.kernel);
            pairs.extend(irradiance.at(pixel.x, pixel.y).into_iter().zip(expected));
        }
        Ok(is_light_right(&pairs))
    }

    /// Whether the flux of all pixels is the photons' power.
    fn is_flux_right(&mut self) -> Result<bool> {
        self.tables.count()?;
        let flux = self.tables.pipeline().flux().unwrap_or_else(|| unreachable!("made for tables"));
        let power = reference::photon_power(&self.shown, &self.seen);
        let flux = flux.read()?;
        #[expect(clippy::cast_possible_truncation, reason = "what is compared is of f32")]
        let pairs = flux.values().iter().zip(power.values()).flat_map(|(found, power)| {
            (0..3).map(|colour| (found[colour] as f32, power[colour]))
        });
        Ok(is_light_right(&pairs.collect::<Vec<_>>()))
    }

    /// Whether light from tables is what their definition says.
    fn is_tabled(&mut self) -> Result<bool> {
        Ok(true)
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

    /// Whether a splat holds its photons' power.
    fn is_whole(&mut self, work: Work, index: usize) -> Result<bool> {
        let irradiance = self.light_of(work)?;
        let account = self.renderer.account(&irradiance)?;
        self.fragments[index] = account.fragments;
        Ok(account.energy_error() < ENERGY)
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

/// Whether as many photons are counted in each pixel as should be, but for those that f32 puts on the other
/// side of a border, or of a surface's edge.
fn are_counts_right(counts: &Image<f32>, expected: &Image<u32>, drawn: f64) -> bool {
    let pairs = counts.values().iter().zip(expected.values());
    let apart: f64 = pairs.map(|(&count, &all)| (f64::from(count) - f64::from(all)).abs()).sum();
    apart <= 4.0 + 1e-3 * drawn
}

/// Whether some light is found and it is what is expected.
fn is_light_right(pairs: &[(f32, f64)]) -> bool {
    let apart: f64 = pairs.iter().map(|&(found, expected)| (f64::from(found) - expected).abs()).sum();
    let all: f64 = pairs.iter().map(|&(_, expected)| expected).sum();
    apart <= GATHERED * all && all > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_strays_are_right_and_moved_photons_are_not() {
        let expected = Image::filled(UVec2::splat(10), 100);
        let counts = |moved: f32| {
            let mut counts = Image::filled(UVec2::splat(10), 100.0);
            counts.set(2, 3, 100.0 - moved);
            counts.set(3, 3, 100.0 + moved);
            counts
        };
        // 14 of 10,000 may be apart, and each that moves is so in two pixels.
        assert!(are_counts_right(&counts(7.0), &expected, 1e4));
        assert!(!are_counts_right(&counts(8.0), &expected, 1e4));
    }

    #[test]
    fn light_that_is_off_or_missing_is_wrong() {
        assert!(is_light_right(&[(1.0, 1.001), (3.0, 3.0)]));
        assert!(!is_light_right(&[(1.0, 1.01), (3.0, 3.0)]));
        assert!(!is_light_right(&[(0.0, 0.0), (0.0, 0.0)]), "nothing was compared");
        assert!(!is_light_right(&[(f32::NAN, 1.0), (3.0, 3.0)]));
    }
}
