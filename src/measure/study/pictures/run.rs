//! The run: references, pictures, and the sweep over fixed radii.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::metric::Sweep;
use super::{Metric, PictureRow, PictureStudy, PictureStudyResult, Width, equal_photons, equal_time};
use crate::error::Result;
use crate::gl::Gl;
use crate::image::Image;
use crate::measure::PictureError;
use crate::photon::TraceSettings;
use crate::render::{Layers, Progress, Reference, Renderer};
use crate::scene::Scene;
use crate::settings::{Kernel, MAX_PICTURE_RADIUS, PictureSettings, RadiusChoice};

/// Seeds of references begin here, beyond those of pictures.
const REFERENCE_SEED: u64 = 1 << 32;
/// A photon of a picture takes about as long as this many of a reference: it is drawn many times.
const DRAWN: f64 = 8.0;
/// About as often are more widths tried.
const ROUNDS: u32 = 4;
/// n goes no further than this, times two at the most: MR ends the search long before.
const MOST_MIN_PHOTONS: u32 = 6400;

/// What the pictures of a scene are compared with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneReference {
    /// The scene's name.
    pub scene: String,
    /// Photons of all seeds.
    pub photons: u64,
    /// Its own noise: RMSE and relative MSE of two halves against each other, brought to the mean of both (by 2 and by 4); SSIM
    /// and FLIP of the halves as they are.
    pub noise: PictureError,
}

/// Draws and compares everything. Rows of an earlier run of the same study that are given in `earlier` aren't drawn again;
/// others among them are left out. `observe` gets the rows so far, after each seed, to be saved, and the progress.
///
/// Errors are the same bits on each run, whatever the number of threads; times are not.
///
/// # Errors
/// [`Error::Setting`](crate::Error::Setting) outside of a setting's range; those of [`Renderer`] and of `observe`.
pub fn run(
    gl: &Gl,
    study: &PictureStudy,
    earlier: Vec<PictureRow>,
    observe: &mut dyn FnMut(&[PictureRow], Progress) -> Result<()>,
) -> Result<PictureStudyResult> {
    study.validate()?;
    let mut run = Run { gl, study, earlier, rows: Vec::new(), done: 0.0 };
    let mut references = Vec::new();
    warm_up(gl, study)?;
    for name in &study.scenes {
        let scene = Scene::shipped(name)?;
        let (target, reference) = run.reference(name, &scene, observe)?;
        references.push(reference);
        for &photons in &study.photons {
            let place = Place { name, scene: &scene, photons, target: &target };
            run.sweep(&place, observe)?;
        }
    }
    let rows = run.rows;
    Ok(PictureStudyResult {
        study: study.clone(),
        renderer: gl.info().renderer.clone(),
        references,
        equal_photons: equal_photons(&rows),
        equal_time: equal_time(&rows),
        rows,
    })
}

/// Compiles what pictures need, so that the first is not slower than others.
fn warm_up(gl: &Gl, study: &PictureStudy) -> Result<()> {
    let scene = Scene::shipped(&study.scenes[0])?;
    let settings = |width| study.settings(width, study.kernels[0]);
    let trace = TraceSettings { photons: 1000, ..TraceSettings::default() };
    let first = settings(Width::Variable { min_photons: 1 });
    let mut renderer = Renderer::new(gl, &scene, &first, &trace, &mut |_| ())?;
    for &kernel in &study.kernels {
        renderer.picture(&PictureSettings { kernel, ..first })?;
        renderer.picture(&PictureSettings { kernel, ..settings(Width::Fixed { radius: 1 }) })?;
    }
    Ok(())
}

/// The pictures that others are compared with.
struct Compared {
    indirect: Image<[f32; 3]>,
    beauty: Image<[f32; 3]>,
}

/// A scene, photons in it, and what is to come out.
struct Place<'a> {
    name: &'a str,
    scene: &'a Scene,
    photons: u32,
    target: &'a Compared,
}

struct Run<'a> {
    gl: &'a Gl,
    study: &'a PictureStudy,
    earlier: Vec<PictureRow>,
    rows: Vec<PictureRow>,
    /// In photons of a reference.
    done: f64,
}

type Observe<'a> = &'a mut dyn FnMut(&[PictureRow], Progress) -> Result<()>;

impl<'s> Run<'s> {
    fn tell(&mut self, stage: &'static str, more: f64, observe: Observe<'_>) -> Result<()> {
        let study = self.study;
        let reference = f64::from(study.reference_seeds) * f64::from(study.reference_photons);
        let pictures = study.photons.iter().map(|&photons| DRAWN * f64::from(photons)).sum::<f64>();
        #[expect(clippy::cast_precision_loss, reason = "a few scenes")]
        let all = study.scenes.len() as f64 * (reference + f64::from(study.seeds) * pictures);
        self.done += more;
        observe(&self.rows, Progress { stage, done: (self.done / all).min(1.0) })
    }

    fn reference(
        &mut self,
        name: &str,
        scene: &Scene,
        observe: Observe<'_>,
    ) -> Result<(Compared, SceneReference)> {
        let study = self.study;
        let settings = study.settings(Width::Fixed { radius: 1 }, study.kernels[0]);
        let mut halves = Vec::new();
        for first in [0, 1] {
            let mut half = Reference::new(self.gl, scene, &settings, &mut |_| ())?;
            for number in (first..study.reference_seeds).step_by(2) {
                let seed = REFERENCE_SEED + u64::from(number);
                let photons = study.reference_photons;
                half.add_seed(
                    scene,
                    &TraceSettings { photons, seed, ..TraceSettings::default() },
                    &mut |_| (),
                )?;
                self.tell("reference", f64::from(photons), observe)?;
            }
            halves.push(half.picture()?);
        }
        let mean = |of: fn(&Layers) -> &Image<[f32; 3]>| mean(of(&halves[0]), of(&halves[1]));
        let apart = PictureError::of_light_and_sight(
            [&halves[0].indirect, &halves[1].indirect],
            [&halves[0].beauty, &halves[1].beauty],
        );
        let noise = PictureError { rmse: apart.rmse / 2.0, relative_mse: apart.relative_mse / 4.0, ..apart };
        let photons = u64::from(study.reference_seeds) * u64::from(study.reference_photons);
        let target =
            Compared { indirect: mean(|layers| &layers.indirect), beauty: mean(|layers| &layers.beauty) };
        Ok((target, SceneReference { scene: name.to_owned(), photons, noise }))
    }

    /// All pictures of one scene and number of photons: first the smallest widths, then larger ones while they get better.
    fn sweep(&mut self, place: &Place<'_>, observe: Observe<'_>) -> Result<()> {
        let first = self.rows.len();
        let work = DRAWN * f64::from(place.photons);
        let mut studios: Vec<Option<Studio<'s>>> = (0..self.study.seeds).map(|_| None).collect();
        let mut widths = self.next_widths(first);
        let mut rounds = 0;
        while !widths.is_empty() {
            let share = if rounds < ROUNDS { work / f64::from(ROUNDS) } else { 0.0 };
            for (seed, studio) in (1..).zip(&mut studios) {
                self.draw(place, seed, &widths, studio)?;
                self.tell("pictures", share, observe)?;
            }
            rounds += 1;
            widths = self.next_widths(first);
        }
        let rest = f64::from(ROUNDS.saturating_sub(rounds)) / f64::from(ROUNDS);
        self.tell("pictures", rest * work * f64::from(self.study.seeds), observe)?;
        let order = |row: &PictureRow| {
            let kernel = self.study.kernels.iter().position(|&kernel| kernel == row.kernel);
            (row.seed, kernel, row.width)
        };
        self.rows[first..].sort_by_key(order);
        Ok(())
    }

    /// Widths to be tried next: the first ones of the study, then those beside the best so far, by any metric and kernel, until
    /// a smaller and a larger one than each best was tried.
    fn next_widths(&self, first: usize) -> Vec<Width> {
        let study = self.study;
        let rows = &self.rows[first..];
        if rows.is_empty() {
            let fixed = study.fixed.iter().take(2).map(|&radius| Width::Fixed { radius });
            let variable = study.min_photons.iter().map(|&min_photons| Width::Variable { min_photons });
            return variable.chain(fixed).collect();
        }
        let mut wanted = Vec::new();
        for &kernel in &study.kernels {
            let sweep = Sweep::new(rows.iter().filter(|row| row.kernel == kernel));
            for metric in Metric::ALL {
                for is_fixed in [false, true] {
                    wanted.extend(
                        sweep.best(metric, is_fixed).and_then(|best| self.beside(&sweep, best.width)),
                    );
                }
            }
        }
        wanted.sort_unstable();
        wanted.dedup();
        wanted
    }

    /// The width to be tried beside the best one, if it is the largest or smallest so far.
    fn beside(&self, sweep: &Sweep<'_>, best: Width) -> Option<Width> {
        let (smallest, largest) = sweep.ends(best.is_fixed())?;
        match best {
            Width::Fixed { radius } if best == largest => {
                let listed = self.study.fixed.iter().copied().filter(|&next| next > radius).min();
                let next = listed.unwrap_or(radius + radius.div_ceil(3)).min(MAX_PICTURE_RADIUS);
                (next > radius).then_some(Width::Fixed { radius: next })
            }
            Width::Fixed { radius } if best == smallest => {
                (radius > 1).then(|| Width::Fixed { radius: radius - radius.div_ceil(4) })
            }
            Width::Variable { min_photons } if best == largest => {
                (min_photons < MOST_MIN_PHOTONS).then_some(Width::Variable { min_photons: 2 * min_photons })
            }
            Width::Variable { min_photons } if best == smallest => {
                (min_photons > 1).then_some(Width::Variable { min_photons: min_photons / 2 })
            }
            _ => None,
        }
    }

    /// The pictures of one seed that are not there yet.
    fn draw(
        &mut self,
        place: &Place<'_>,
        seed: u64,
        widths: &[Width],
        studio: &mut Option<Studio<'s>>,
    ) -> Result<()> {
        let mut missing = Vec::new();
        for &kernel in &self.study.kernels {
            for &width in widths {
                let is_it = |row: &PictureRow| {
                    (row.scene.as_str(), row.photons, row.seed, row.kernel, row.width)
                        == (place.name, place.photons, seed, kernel, width)
                };
                match self.earlier.iter().position(is_it) {
                    Some(index) => self.rows.push(self.earlier.swap_remove(index)),
                    None => missing.push((width, kernel)),
                }
            }
        }
        // Fixed radii come last: no search is wanted for them.
        missing.sort_by_key(|(width, _)| width.is_fixed());
        for (width, kernel) in missing {
            let trace = TraceSettings { photons: place.photons, seed, ..TraceSettings::default() };
            let studio = match studio {
                Some(studio) => studio,
                None => studio.insert(Studio::new(self.gl, self.study, place, &trace)?),
            };
            self.rows.push(studio.row(place, seed, width, kernel)?);
        }
        Ok(())
    }
}

/// Photons of one seed.
struct Studio<'a> {
    study: &'a PictureStudy,
    renderer: Renderer,
    seconds_before: f64,
    /// What the renderer has radii for.
    searched: Option<u32>,
}

impl<'a> Studio<'a> {
    fn new(gl: &Gl, study: &'a PictureStudy, place: &Place<'_>, trace: &TraceSettings) -> Result<Self> {
        let settings = study.settings(Width::Fixed { radius: 1 }, study.kernels[0]);
        let mut begin = Instant::now();
        let renderer = Renderer::new(gl, place.scene, &settings, trace, &mut |progress| {
            // Direct light comes first, and is the same for all.
            if progress.stage == "direct light" {
                begin = Instant::now();
            }
        })?;
        // A read waits for what was drawn.
        renderer.surfaces().read_normal()?;
        Ok(Self { study, renderer, seconds_before: begin.elapsed().as_secs_f64(), searched: None })
    }

    fn row(&mut self, place: &Place<'_>, seed: u64, width: Width, kernel: Kernel) -> Result<PictureRow> {
        let mut settings = self.study.settings(width, kernel);
        // The renderer keeps its radii while n stays. Variable ones are searched within their time, fixed ones have none.
        match width {
            Width::Variable { min_photons } if self.searched == Some(min_photons) => {
                self.unmeasured(&PictureSettings { min_photons: min_photons + 1, ..settings })?;
            }
            Width::Variable { .. } => (),
            Width::Fixed { .. } => match self.searched {
                Some(min_photons) => settings.min_photons = min_photons,
                None => self.unmeasured(&settings)?,
            },
        }
        let begin = Instant::now();
        let (layers, account) = self.renderer.picture(&settings)?;
        let seconds_drawing = begin.elapsed().as_secs_f64();
        self.searched = Some(settings.min_photons);
        let error = PictureError::of_light_and_sight(
            [&layers.indirect, &place.target.indirect],
            [&layers.beauty, &place.target.beauty],
        );
        Ok(PictureRow {
            scene: place.name.to_owned(),
            photons: place.photons,
            seed,
            kernel,
            width,
            error,
            mean_radius: mean_radius(&layers),
            limited_share: if width.is_fixed() { 0.0 } else { account.limited_share },
            seconds_before: self.seconds_before,
            seconds_drawing,
        })
    }

    /// Leaves the renderer with the radii of these settings.
    fn unmeasured(&mut self, settings: &PictureSettings) -> Result<()> {
        self.renderer.picture(&PictureSettings { radius: RadiusChoice::Fixed(1), ..*settings })?;
        self.searched = Some(settings.min_photons);
        Ok(())
    }
}

/// Over the pixels where something is seen directly: only there do radii matter.
fn mean_radius(layers: &Layers) -> f64 {
    let normals = layers.normal.values().iter();
    let radii = layers.radius.values().iter().zip(normals).filter(|(_, normal)| **normal != [0.0; 3]);
    let (sum, count) =
        radii.fold((0.0, 0.0), |(sum, count), (&radius, _)| (sum + f64::from(radius), count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// The mean of two pictures.
fn mean(first: &Image<[f32; 3]>, second: &Image<[f32; 3]>) -> Image<[f32; 3]> {
    let pairs = first.values().iter().zip(second.values());
    let values = pairs.map(|(a, b)| std::array::from_fn(|colour| a[colour].midpoint(b[colour])));
    Image::from_values(first.size(), values.collect())
}
