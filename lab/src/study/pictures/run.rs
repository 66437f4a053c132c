//! The run: references, pictures, and the sweep over fixed radii.

use serde::{Deserialize, Serialize};

use super::metric::Sweep;
use super::studio::{Compared, Place, Studio};
use super::{Found, Metric, PictureRow, PictureStudy, Width};
use crate::BOUNCES;
use crate::halves::ReferenceHalves;
use crate::picture::PictureError;
use varikernel::error::Result;
use varikernel::gl::Gl;
use varikernel::photon::TraceSettings;
use varikernel::render::Progress;
use varikernel::scene::Scene;
use varikernel::settings::MAX_PICTURE_RADIUS;

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
    /// Its own noise: RMSE and relative MSE of two halves against each other, brought to the mean of both (by
    /// 2 and by 4); SSIM and FLIP of the halves as they are.
    pub noise: PictureError,
}

/// Draws and compares everything. Rows of an earlier run of the same study that are given in `earlier` aren't
/// drawn again; others among them are left out. `observe` gets the rows so far, after each seed, to be saved,
/// and the progress.
///
/// Errors are the same bits on each run, whatever the number of threads; times are not.
///
/// # Errors
/// [`Error::Setting`](varikernel::Error::Setting) outside of a setting's range; those of
/// [`Renderer`](varikernel::render::Renderer) and of `observe`.
pub fn run(
    gl: &Gl,
    study: &PictureStudy,
    earlier: Vec<PictureRow>,
    observe: &mut dyn FnMut(&[PictureRow], Progress) -> Result<()>,
) -> Result<Found> {
    study.validate()?;
    let mut run = Run { gl, study, earlier, rows: Vec::new(), done: 0.0 };
    let mut references = Vec::new();
    for name in &study.scenes {
        let scene = Scene::shipped(name)?;
        let (target, reference) = run.reference(name, &scene, observe)?;
        references.push(reference);
        for &photons in &study.photons {
            let place = Place { name, scene: &scene, photons, target: &target };
            run.sweep(&place, observe)?;
        }
    }
    Ok(Found { references, rows: run.rows })
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
        let trace = |number: u32| TraceSettings {
            photons: study.reference_photons,
            bounces: Some(BOUNCES),
            seed: REFERENCE_SEED + u64::from(number),
            ..TraceSettings::default()
        };
        let photons = f64::from(study.reference_photons);
        let gl = self.gl;
        let mut observe = |_| self.tell("reference", photons, &mut *observe);
        let halves = ReferenceHalves::new(gl, scene, &settings, study.reference_seeds, trace, &mut observe)?;
        let target = Compared {
            indirect: halves.mean(|layers| &layers.indirect),
            beauty: halves.mean(|layers| &layers.beauty),
        };
        let noise = halves.noise();
        let photons = u64::from(study.reference_seeds) * u64::from(study.reference_photons);
        Ok((target, SceneReference { scene: name.to_owned(), photons, noise }))
    }

    /// All pictures of one scene and number of photons: first the smallest widths, then larger ones while
    /// they get better.
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

    /// Widths to be tried next: the first ones of the study, then those beside the best so far, by any metric
    /// and kernel, until a smaller and a larger one than each best was tried.
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
        for (width, kernel) in missing {
            let trace = TraceSettings {
                photons: place.photons,
                bounces: Some(BOUNCES),
                seed,
                russian_roulette: false,
            };
            let studio = match studio {
                Some(studio) => studio,
                None => studio.insert(Studio::new(self.gl, self.study, place, &trace)?),
            };
            self.rows.push(studio.row(place, seed, width, kernel)?);
        }
        Ok(())
    }
}
