//! The run: references, pictures, the sweeps over n and fixed radii, and bias.

use super::metric::Sweep;
use super::reference::Target;
use super::studio::{Place, Studio};
use super::{Family, Found, Metric, PictureRow, PictureStudy, Way, bias};
use crate::BOUNCES;
use varikernel::error::Result;
use varikernel::gl::Gl;
use varikernel::photon::TraceSettings;
use varikernel::render::Progress;
use varikernel::scene::Scene;
use varikernel::settings::{MAX_PICTURE_RADIUS, PictureSettings};

/// A photon of a picture takes about as long as this many of a reference: it is drawn many times.
const DRAWN: f64 = 8.0;
/// About as often are more widths tried.
const ROUNDS: u32 = 4;
/// n goes no further than this, times two at the most: MR ends the search long before.
const MOST_MIN_PHOTONS: u32 = 6400;

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
    let (mut references, mut biases) = (Vec::new(), Vec::new());
    for name in &study.scenes {
        let scene = Scene::shipped(name)?;
        let photons = f64::from(study.reference_photons);
        let target = Target::new(gl, &scene, study, &mut || run.tell("reference", photons, &mut *observe))?;
        references.push(target.told(name, study));
        for &photons in &study.photons {
            let place = Place { name, scene: &scene, photons, target: &target };
            let first = run.rows.len();
            run.sweep(&place, observe)?;
            if photons == study.bias_photons {
                let rows = run.rows[first..].to_vec();
                let work = DRAWN * f64::from(photons) / f64::from(ROUNDS);
                let mut tell = || run.tell("bias", work, &mut *observe);
                biases.extend(bias::run(gl, study, &place, &rows, &mut tell)?);
            }
        }
    }
    Ok(Found { references, rows: run.rows, biases })
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
        let of_photons = |&photons: &u32| f64::from(study.seeds_of(photons)) * DRAWN * f64::from(photons);
        let pictures = study.photons.iter().map(of_photons).sum::<f64>();
        let bias = f64::from(study.bias_seeds) * DRAWN * f64::from(study.bias_photons) / f64::from(ROUNDS);
        #[expect(clippy::cast_precision_loss, reason = "a few scenes")]
        let all = study.scenes.len() as f64 * (reference + pictures + bias);
        self.done += more;
        observe(&self.rows, Progress { stage, done: (self.done / all).min(1.0) })
    }

    /// All pictures of one scene and number of photons: first the smallest widths, then larger ones while
    /// they get better. The first seed tells where the best widths are, the others draw those and the ones
    /// beside them.
    fn sweep(&mut self, place: &Place<'_>, observe: Observe<'_>) -> Result<()> {
        let first = self.rows.len();
        let work = DRAWN * f64::from(place.photons);
        let all_seeds = self.study.seeds_of(place.photons);
        let mut studios: Vec<Option<Studio<'s>>> = (0..all_seeds).map(|_| None).collect();
        let mut rounds = 0;
        for seeds in [1, all_seeds] {
            loop {
                let ways = self.next_ways(first, seeds);
                if ways.is_empty() {
                    break;
                }
                let share = if rounds < ROUNDS { work / f64::from(ROUNDS) } else { 0.0 };
                for (seed, studio) in (1..=u64::from(seeds)).zip(&mut studios) {
                    self.draw(place, first, seed, &ways, studio)?;
                    self.tell("pictures", share, observe)?;
                }
                rounds += 1;
            }
        }
        let rest = f64::from(ROUNDS.saturating_sub(rounds)) / f64::from(ROUNDS);
        self.tell("pictures", rest * work * f64::from(all_seeds), observe)?;
        let order = |row: &PictureRow| {
            let kernel = self.study.kernels.iter().position(|&kernel| kernel == row.kernel);
            (row.seed, kernel, row.way)
        };
        self.rows[first..].sort_by_key(order);
        Ok(())
    }

    /// Ways that some of the seeds have not drawn and are to draw next. With none drawn, the first ones of the
    /// study; then those that have no rival and the best so far, by any metric and kernel, with the ones
    /// beside each.
    fn next_ways(&self, first: usize, seeds: u32) -> Vec<Way> {
        let study = self.study;
        let rows = &self.rows[first..];
        let min_photons = PictureSettings::default().min_photons;
        let always = [Way::Variable { min_photons }, Way::Gather { min_photons }, Way::Tables];
        if rows.is_empty() {
            let fixed = study.fixed.iter().take(2).map(|&radius| Way::Fixed { radius });
            let variable = study.min_photons.iter().map(|&min_photons| Way::Variable { min_photons });
            return variable.chain(fixed).chain(always.into_iter().skip(1)).collect();
        }
        let count =
            |way: Way, kernel| rows.iter().filter(|row| (row.way, row.kernel) == (way, kernel)).count();
        let is_whole = |way: Way| study.kernels.iter().all(|&kernel| count(way, kernel) >= seeds as usize);
        let mut wanted: Vec<Way> = always
            .into_iter()
            .filter(|&way| study.kernels.iter().any(|&kernel| count(way, kernel) > 0))
            .collect();
        for &kernel in &study.kernels {
            let sweep = Sweep::new(rows.iter().filter(|row| row.kernel == kernel));
            for metric in Metric::ALL {
                for family in [Family::Variable, Family::Fixed] {
                    let Some(best) = sweep.best(metric, family) else { continue };
                    wanted.extend(self.beside(&sweep, best.way));
                    wanted.extend(sweep.around(best.way));
                }
            }
        }
        wanted.retain(|&way| !is_whole(way));
        wanted.sort_unstable();
        wanted.dedup();
        wanted
    }

    /// The way to be tried beside the best one, if it is the widest or least so far.
    fn beside(&self, sweep: &Sweep<'_>, best: Way) -> Option<Way> {
        let (smallest, largest) = sweep.ends(best.family())?;
        match best {
            Way::Fixed { radius } if best == largest => {
                let listed = self.study.fixed.iter().copied().filter(|&next| next > radius).min();
                let next = listed.unwrap_or(radius + radius.div_ceil(3)).min(MAX_PICTURE_RADIUS);
                (next > radius).then_some(Way::Fixed { radius: next })
            }
            Way::Fixed { radius } if best == smallest => {
                (radius > 1).then(|| Way::Fixed { radius: radius - radius.div_ceil(4) })
            }
            Way::Variable { min_photons } if best == largest => {
                (min_photons < MOST_MIN_PHOTONS).then_some(Way::Variable { min_photons: 2 * min_photons })
            }
            Way::Variable { min_photons } if best == smallest => {
                (min_photons > 1).then_some(Way::Variable { min_photons: min_photons / 2 })
            }
            _ => None,
        }
    }

    /// The pictures of one seed that are not there yet.
    fn draw(
        &mut self,
        place: &Place<'_>,
        first: usize,
        seed: u64,
        ways: &[Way],
        studio: &mut Option<Studio<'s>>,
    ) -> Result<()> {
        let mut missing = Vec::new();
        for &kernel in &self.study.kernels {
            for &way in ways {
                let is_it = |row: &PictureRow| {
                    (row.scene.as_str(), row.photons, row.seed, row.kernel, row.way)
                        == (place.name, place.photons, seed, kernel, way)
                };
                if self.rows[first..].iter().any(is_it) {
                    continue;
                }
                match self.earlier.iter().position(is_it) {
                    Some(index) => self.rows.push(self.earlier.swap_remove(index)),
                    None => missing.push((way, kernel)),
                }
            }
        }
        for (way, kernel) in missing {
            let trace = TraceSettings {
                photons: place.photons,
                bounces: Some(BOUNCES),
                seed,
                russian_roulette: false,
            };
            let studio = match studio {
                Some(studio) => studio,
                None => studio.insert(Studio::new(self.gl, self.study, place.scene, &trace)?),
            };
            self.rows.push(studio.row(place, seed, way, kernel)?);
        }
        Ok(())
    }
}
