//! Pictures of other renderers beside ours: error over time against a common reference, region by region.
//!
//! A file names pictures with the seconds that they took; nothing is drawn here. The error is that of green;
//! where a scene has layers of ours, edges, mirrors and glass, caustics, penumbras and the rest are judged apart.
//! The first way of a scene is what the others are compared with, in equal time and at equal error.

mod comparison_page;
mod curve;
mod entries;
mod error;
mod files;
mod regions;

pub use curve::{Comparison, Factor};
pub use error::RegionError;
pub use regions::Region;

use std::path::Path;

use serde::Serialize;
use varikernel::error::{Error, Result};
use varikernel::image::{Colours, Image, read_colours};

use crate::statistics::Statistics;
use entries::SceneFiles;
use error::Reference;

/// What was found: `against.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Against {
    /// The version of the program.
    pub program: String,
    /// The commit that it was built from.
    pub commit: String,
    /// Scene by scene, in the order of the file.
    pub scenes: Vec<SceneFound>,
}

/// The pictures of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneFound {
    /// Its name.
    pub scene: String,
    /// Columns and rows.
    pub size: [u32; 2],
    /// How many pictures the reference is the mean of.
    pub references: usize,
    /// The reference's own RMSE in each region, over its mean, as far as its pictures tell; it is in all errors.
    pub noise: Vec<(Region, f64)>,
    /// Way by way, in the order of the file.
    pub ways: Vec<WayFound>,
}

/// A renderer's pictures of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WayFound {
    /// Its name.
    pub way: String,
    /// By increasing time.
    pub points: Vec<Point>,
    /// Each point against the first way, for each region; empty for the first.
    pub comparisons: Vec<Vec<Comparison>>,
}

/// Pictures of the same options.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// What the renderer was asked for.
    pub options: String,
    /// Median over the pictures.
    pub seconds: f64,
    /// One for each seed.
    pub pictures: Vec<Picture>,
}

/// A picture's errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Picture {
    /// As the file says.
    pub seed: String,
    /// As the file says.
    pub seconds: f64,
    /// Region by region.
    pub errors: Vec<RegionError>,
}

impl Picture {
    /// The RMSE of a region, if there is one.
    fn rmse(&self, region: Region) -> Option<f64> {
        self.errors.iter().find(|error| error.region == region).map(|error| error.rmse)
    }
}

impl Against {
    /// Judges the pictures that a CSV file names: columns `scene`, `way`, `options`, `seed`, `seconds`, `file`.
    /// The way `reference` is for pictures whose mean is right, `layers` for an EXR of `varikernel render`.
    ///
    /// `show` is told each file that is read, and the done share.
    ///
    /// # Errors
    /// [`Error::File`] where a row or a picture is not what it should be.
    pub fn read(path: &Path, show: &mut dyn FnMut(&Path, f64)) -> Result<Self> {
        let scenes = entries::read(path)?;
        let of_scene = |scene: &SceneFiles| scene.references.len() + scene.runs.len();
        let total: usize = scenes.iter().map(of_scene).sum();
        let mut read = 0_u32;
        let mut picture = |path: &Path| {
            #[expect(clippy::cast_precision_loss, reason = "a share")]
            show(path, f64::from(read) / total as f64);
            read += 1;
            radiance(path)
        };
        let found = scenes.iter().map(|scene| SceneFound::read(scene, &mut picture));
        Ok(Self {
            program: env!("CARGO_PKG_VERSION").to_owned(),
            commit: crate::COMMIT.to_owned(),
            scenes: found.collect::<Result<_>>()?,
        })
    }
}

impl SceneFound {
    fn read(files: &SceneFiles, picture: &mut dyn FnMut(&Path) -> Result<Image<[f32; 3]>>) -> Result<Self> {
        let references: Vec<_> = files.references.iter().map(|path| picture(path)).collect::<Result<_>>()?;
        let size = references[0].size();
        let check = |path: &Path, other: glam::UVec2| {
            let problem = || {
                let first = files.references[0].display();
                format!("{} x {} pixels, but {first} has {} x {}", other.x, other.y, size.x, size.y)
            };
            let remedy = "draw all pictures of a scene at one size";
            if other == size { Ok(()) } else { Err(Error::file(path, problem(), remedy)) }
        };
        for (path, reference) in files.references.iter().zip(&references) {
            check(path, reference.size())?;
        }
        let regions = files.layers.as_ref().map(|path| {
            let regions = regions::Layers::read(path)?.regions();
            check(path, regions.size()).map(|()| regions)
        });
        let reference = Reference::new(&references, regions.transpose()?.as_ref());
        let mut ways: Vec<WayFound> = Vec::new();
        for run in &files.runs {
            let image = picture(&run.file)?;
            check(&run.file, image.size())?;
            let found =
                Picture { seed: run.seed.clone(), seconds: run.seconds, errors: reference.errors(&image) };
            let way = ways.iter().position(|one| one.way == run.way).unwrap_or_else(|| {
                ways.push(WayFound { way: run.way.clone(), points: Vec::new(), comparisons: Vec::new() });
                ways.len() - 1
            });
            let points = &mut ways[way].points;
            let point = points.iter().position(|one| one.options == run.options).unwrap_or_else(|| {
                points.push(Point { options: run.options.clone(), seconds: 0.0, pictures: Vec::new() });
                points.len() - 1
            });
            points[point].pictures.push(found);
        }
        for way in &mut ways {
            for point in &mut way.points {
                let seconds: Vec<f64> = point.pictures.iter().map(|picture| 1e3 * picture.seconds).collect();
                let median = Statistics::of(&seconds).map(|found| found.median_ms / 1e3);
                point.seconds = median.unwrap_or_else(|| unreachable!("each point has a picture"));
            }
            way.points.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        }
        let first = ways[0].points.clone();
        for way in ways.iter_mut().skip(1) {
            let of = |point: &Point| {
                let regions = Region::ALL.into_iter();
                regions.filter_map(|region| curve::compare(point, &first, region)).collect()
            };
            way.comparisons = way.points.iter().map(of).collect();
        }
        let noise = reference.noise();
        let scene = files.scene.clone();
        Ok(Self { scene, size: size.to_array(), references: references.len(), noise, ways })
    }
}

/// A picture of finite radiance.
fn radiance(path: &Path) -> Result<Image<[f32; 3]>> {
    let Colours::Radiance(image) = read_colours(path)? else {
        let problem = "it holds colours of a screen, whose light nobody knows";
        return Err(Error::file(path, problem, "give an EXR file with linear R, G and B"));
    };
    let wrong = image.values().iter().filter(|light| light.iter().any(|value| !value.is_finite())).count();
    if wrong > 0 {
        let problem = format!("{wrong} pixels are not finite, so that it has no error");
        return Err(Error::file(path, problem, "mend them or leave its row out"));
    }
    Ok(image)
}
