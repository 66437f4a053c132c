//! Bias apart from noise: where the mean of many pictures differs from the reference by more than chance.
//!
//! One picture's error is noise and bias together, and only noise falls with more photons. After H. Jung, J.
//! Hanika and C. Dachsbacher, "Statistical testing of (unbiased) renderers" (2020), the light of each tile is
//! tested over many seeds against that of the reference's seeds by [Welch's test](crate::Welch). A tile is
//! the mean of its pixels inside of faces, where the reference is right by counting alone; pixels at edges
//! are told as one mean, with the reference brought to what they see of their faces.

use serde::{Deserialize, Serialize};

use super::metric::Sweep;
use super::reference::{Target, taken};
use super::row::PictureRow;
use super::studio::{Place, Studio};
use super::{Family, Metric, PictureStudy, Way};
use crate::BOUNCES;
use crate::confidence::{Confidence, students_t};
use crate::welch::Welch;
use varikernel::error::Result;
use varikernel::gl::Gl;
use varikernel::image::Image;
use varikernel::photon::TraceSettings;
use varikernel::settings::PictureSettings;

/// A tile without bias is called biased this often.
pub const LEVEL: f64 = 0.01;
/// Side of a tile, in pixels.
pub const TILE: u32 = 8;
/// Tiles with fewer pixels inside of faces are not tested.
const LEAST_PIXELS: usize = 16;
/// Seeds begin here: neither a picture's, on which the best radius was chosen, nor a reference's.
const BIAS_SEED: u64 = 1 << 31;

/// How biased one way is in a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BiasRow {
    /// The scene's name.
    pub scene: String,
    /// Photons that left the lights.
    pub photons: u32,
    /// Seeds of pictures.
    pub seeds: u32,
    /// What was drawn.
    pub way: Way,
    /// The mean difference inside of faces, in parts of the reference's mean light there, and its interval.
    pub inside: Confidence,
    /// The same at edges of faces.
    pub edges: Confidence,
    /// Tiles that were tested.
    pub tested: u32,
    /// Those that differ at a level of 1 %: by chance alone, 1 % of them.
    pub biased: u32,
    /// Those that differ though all were tested (Šidák): by chance alone, one in a hundred pictures.
    pub surely_biased: u32,
    /// Root mean square over the tested tiles of the difference less its noise, in parts of the reference's
    /// mean light.
    pub size: f64,
    /// Columns and rows of tiles.
    pub tiles: [u32; 2],
    /// Of each tile, row by row: the difference in parts of the reference's light there; 0 where it is not
    /// significant, or was not tested.
    pub map: Vec<f32>,
}

/// Draws the seeds of all ways and tests them; `rows` are the pictures of the same scene and number of
/// photons, among which the best fixed radius is found. `observe` is called after each seed.
pub(super) fn run(
    gl: &Gl,
    study: &PictureStudy,
    place: &Place<'_>,
    rows: &[PictureRow],
    observe: &mut dyn FnMut() -> Result<()>,
) -> Result<Vec<BiasRow>> {
    let ways = ways(study, rows);
    let tiles = Tiles::of(place.target);
    let mut samples: Vec<Vec<Lights>> = ways.iter().map(|_| Vec::new()).collect();
    for number in 0..study.bias_seeds {
        let trace = TraceSettings {
            photons: place.photons,
            bounces: Some(BOUNCES),
            seed: BIAS_SEED + u64::from(number),
            ..TraceSettings::default()
        };
        let mut studio = Studio::new(gl, study, place.scene, &trace)?;
        for (&way, samples) in ways.iter().zip(&mut samples) {
            let (layers, ..) = studio.draw(way, study.kernels[0])?;
            samples.push(tiles.lights(&layers.indirect));
        }
        observe()?;
    }
    let expected: Vec<Lights> = place.target.seeds.iter().map(|seed| tiles.lights(seed)).collect();
    let told = |(way, samples): (Way, Vec<Lights>)| tiles.compare(place, study, way, [&samples, &expected]);
    Ok(ways.into_iter().zip(samples).filter_map(told).collect())
}

/// Tables, the default n as a splat and as a gather, and the n and the fixed radius with the least RMSE.
fn ways(study: &PictureStudy, rows: &[PictureRow]) -> Vec<Way> {
    let min_photons = PictureSettings::default().min_photons;
    let sweep = Sweep::new(rows.iter().filter(|row| row.kernel == study.kernels[0]));
    let best = |family| sweep.best(Metric::Rmse, family).map(|best| best.way);
    let mut ways = vec![Way::Tables, Way::Variable { min_photons }, Way::Gather { min_photons }];
    let best_min_photons = best(Family::Variable).filter(|way| !ways.contains(way));
    ways.extend(best_min_photons);
    ways.extend(best(Family::Fixed));
    ways
}

/// Which pixels make up the tiles, and the edges.
struct Tiles {
    /// Columns and rows.
    size: [u32; 2],
    places: Vec<Vec<usize>>,
    edges: Vec<usize>,
}

/// The mean light of one picture in each tile, inside of all faces, and at edges.
struct Lights {
    tiles: Vec<f64>,
    inside: f64,
    edges: f64,
}

impl Tiles {
    fn of(target: &Target) -> Self {
        let (inside, shares) = (&target.coverage.inside, &target.coverage.shares);
        let size = inside.size().map(|side| side.div_ceil(TILE));
        let mut places = vec![Vec::new(); size.element_product() as usize];
        let mut edges = Vec::new();
        for (place, (&is_inside, &share)) in inside.values().iter().zip(shares.values()).enumerate() {
            let width = inside.size().x as usize;
            let [column, row] = [place % width, place / width].map(|at| at / TILE as usize);
            if is_inside {
                places[row * size.x as usize + column].push(place);
            } else if share > 0.0 {
                edges.push(place);
            }
        }
        Self { size: size.to_array(), places, edges }
    }

    fn lights(&self, picture: &Image<[f32; 3]>) -> Lights {
        let mean = |places: &[usize]| mean_light(&taken(picture, places));
        let inside: Vec<usize> = self.places.iter().flatten().copied().collect();
        Lights {
            tiles: self.places.iter().map(|places| mean(places)).collect(),
            inside: mean(&inside),
            edges: mean(&self.edges),
        }
    }

    /// Nothing where there are too few seeds to be tested.
    fn compare(
        &self,
        place: &Place<'_>,
        study: &PictureStudy,
        way: Way,
        [found, expected]: [&[Lights]; 2],
    ) -> Option<BiasRow> {
        let all = |of: &dyn Fn(&Lights) -> f64| {
            let [found, expected] = [found, expected].map(|side| side.iter().map(of).collect::<Vec<_>>());
            Some((Welch::test(&found, &expected)?, mean(&expected)))
        };
        let relative = |of: &dyn Fn(&Lights) -> f64| {
            let (test, light) = all(of)?;
            let half_width = (light > 0.0).then(|| students_t(test.freedom) * test.error / light);
            let mean = if light > 0.0 { test.difference / light } else { 0.0 };
            Some(Confidence { count: found.len(), mean, half_width })
        };
        let (inside, edges) = (relative(&|light| light.inside)?, relative(&|light| light.edges)?);
        let light = all(&|light| light.inside)?.1;
        let tests: Vec<Option<(Welch, f64)>> =
            (0..self.places.len())
                .map(|tile| {
                    if self.places[tile].len() < LEAST_PIXELS {
                        None
                    } else {
                        all(&|light| light.tiles[tile])
                    }
                })
                .collect();
        let tested = tests.iter().flatten().count();
        let number = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
        let tests_count = f64::from(number(tested).max(1));
        // The level of each of so many tests together.
        let sure = -((-LEVEL).ln_1p() / tests_count).exp_m1();
        let biased =
            |level: f64| number(tests.iter().flatten().filter(|(test, _)| test.differs(level)).count());
        let squares = tests.iter().flatten().map(|(test, _)| test.difference.powi(2) - test.error.powi(2));
        let size = (squares.sum::<f64>().max(0.0) / tests_count).sqrt();
        #[expect(clippy::cast_possible_truncation, reason = "a share, to be shown")]
        let shown = |test: &Option<(Welch, f64)>| match test {
            Some((test, light)) if test.differs(LEVEL) && *light > 0.0 => (test.difference / light) as f32,
            _ => 0.0,
        };
        Some(BiasRow {
            scene: place.name.to_owned(),
            photons: place.photons,
            seeds: study.bias_seeds,
            way,
            inside,
            edges,
            tested: number(tested),
            biased: biased(LEVEL),
            surely_biased: biased(sure),
            size: if light > 0.0 { size / light } else { 0.0 },
            tiles: self.size,
            map: tests.iter().map(shown).collect(),
        })
    }
}

/// Of the three colours together; 0 without pixels.
fn mean_light(pixels: &[[f32; 3]]) -> f64 {
    mean(
        &pixels
            .iter()
            .map(|pixel| pixel.iter().copied().map(f64::from).sum::<f64>() / 3.0)
            .collect::<Vec<_>>(),
    )
}

#[expect(clippy::cast_precision_loss, reason = "fewer than 2^53 pixels")]
fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}
