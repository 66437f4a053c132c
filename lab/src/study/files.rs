//! The files of a study: JSON with everything, CSV with a row for each thing that was measured.

use std::io::Write as _;
use std::path::Path;

use serde::Serialize;

use super::density::{DensityRow, Width};
use super::pictures::{BiasRow, PictureRow, PictureStudy};
use super::radii::RadiusRow;
use super::{Study, Summary};
use crate::picture::{LightError, PictureError};
use varikernel::error::{Error, Result};
use varikernel::image::write_atomically;
use varikernel::settings::Rule;

/// What a row of `study.csv` says; a part of the study fills what it measures. Times stand last: all before
/// them is the same at each run.
#[derive(Debug, Default, Serialize)]
struct Record<'a> {
    /// `radii`, `density`, `picture` or `bias`.
    part: &'static str,
    /// The map, the shape or the scene.
    subject: &'a str,
    width: Option<u32>,
    height: Option<u32>,
    /// All photons of a map, or those that left the lights.
    photons: Option<u64>,
    seed: Option<u64>,
    seeds: Option<u32>,
    /// Of a radius map; of a picture, `splat`, `gather` or `tables`.
    method: &'a str,
    build: &'a str,
    storage: &'a str,
    search: &'a str,
    twist: &'a str,
    kernel: String,
    min_photons: Option<u32>,
    max_radius: Option<u32>,
    /// Of all pixels alike.
    fixed_radius: Option<u32>,
    /// Whether c - 1 stands for the count c.
    corrected: Option<bool>,
    /// Whether the library guarantees exact radii.
    promised: Option<bool>,
    mean_radius: Option<f64>,
    /// Part of the pixels that MR ended.
    limited_share: Option<f64>,
    /// Radii, in pixels: part of the pixels that are off, and the distances.
    wrong_share: Option<f64>,
    mean_distance: Option<f64>,
    rms_distance: Option<f64>,
    largest_distance: Option<u32>,
    /// Densities and bias, in parts of the mean; pictures, in radiance.
    mean_error: Option<f64>,
    mean_error_half_width: Option<f64>,
    bias: Option<f64>,
    noise: Option<f64>,
    rmse: Option<f64>,
    rmse_half_width: Option<f64>,
    relative_rmse: Option<f64>,
    relative_rmse_half_width: Option<f64>,
    relative_mse: Option<f64>,
    ssim: Option<f64>,
    flip: Option<f64>,
    /// Pixels inside of faces alone.
    inside_rmse: Option<f64>,
    inside_relative_mse: Option<f64>,
    /// The mean error of pixels at edges of faces.
    edge_error: Option<f64>,
    edge_error_half_width: Option<f64>,
    /// Tiles that were tested for bias, those that have it at a level of 1 %, and those that surely have it.
    tested_tiles: Option<u32>,
    biased_tiles: Option<u32>,
    surely_biased_tiles: Option<u32>,
    memory_bytes: Option<u64>,
    ms: Option<f64>,
    copies: Option<f64>,
    samples: Option<usize>,
    trace_seconds: Option<f64>,
    picture_seconds: Option<f64>,
}

impl<'a> Record<'a> {
    fn of_radii(row: &'a RadiusRow) -> Self {
        let [width, height] = row.map.size.map(Some);
        Self {
            part: "radii",
            subject: &row.map.name,
            width,
            height,
            photons: Some(row.photons),
            method: &row.variant.method,
            build: &row.variant.build,
            storage: &row.variant.storage,
            search: &row.variant.search,
            twist: &row.variant.twist,
            min_photons: Some(row.question.min_photons),
            max_radius: Some(row.question.max_radius),
            promised: Some(row.promised),
            mean_radius: Some(row.mean_radius),
            wrong_share: Some(row.error.wrong_share),
            mean_distance: Some(row.error.mean),
            rms_distance: Some(row.error.rms),
            largest_distance: Some(row.error.max),
            memory_bytes: Some(row.memory_bytes),
            ms: Some(row.ms),
            copies: Some(row.copies),
            samples: Some(row.samples),
            ..Self::default()
        }
    }

    fn of_density(row: &'a DensityRow, side: u32, max_radius: u32) -> Self {
        let (min_photons, fixed_radius) = match row.width {
            Width::Holding(n) => (Some(n), None),
            Width::Fixed(radius) => (None, Some(radius)),
            Width::Even => (None, None),
        };
        Self {
            part: "density",
            subject: row.shape.name(),
            width: Some(side),
            height: Some(side),
            seeds: Some(row.seeds),
            method: if row.width == Width::Even { Rule::Even.name() } else { "" },
            min_photons,
            max_radius: (!row.width.is_fixed()).then_some(max_radius),
            fixed_radius,
            corrected: Some(row.corrected),
            mean_radius: Some(row.mean_radius),
            mean_error: Some(row.mean_error.mean),
            mean_error_half_width: row.mean_error.half_width,
            bias: Some(row.bias),
            noise: Some(row.noise),
            rmse: Some(row.rmse.mean),
            rmse_half_width: row.rmse.half_width,
            relative_rmse: Some(row.relative_rmse.mean),
            relative_rmse_half_width: row.relative_rmse.half_width,
            ..Self::default()
        }
    }

    fn of_picture(row: &'a PictureRow, study: &PictureStudy) -> Self {
        let [width, height] = study.size.map(Some);
        let min_photons = row.way.min_photons();
        let LightError { rmse: inside_rmse, relative_mse: inside_relative_mse } = row.inside;
        let PictureError { rmse, relative_mse, ssim, flip } = row.error;
        Self {
            part: "picture",
            subject: &row.scene,
            width,
            height,
            photons: Some(row.photons.into()),
            seed: Some(row.seed),
            method: row.way.method(),
            kernel: format!("{:?}", row.kernel).to_lowercase(),
            min_photons,
            max_radius: min_photons.map(|_| study.max_radius),
            fixed_radius: row.way.radius(),
            mean_radius: Some(row.mean_radius),
            limited_share: Some(row.limited_share),
            rmse: Some(rmse),
            relative_mse: Some(relative_mse),
            ssim: Some(ssim),
            flip: Some(flip),
            inside_rmse: Some(inside_rmse),
            inside_relative_mse: Some(inside_relative_mse),
            trace_seconds: Some(row.seconds_before),
            picture_seconds: Some(row.seconds_drawing),
            ..Self::default()
        }
    }

    fn of_bias(row: &'a BiasRow, study: &PictureStudy) -> Self {
        let [width, height] = study.size.map(Some);
        let min_photons = row.way.min_photons();
        Self {
            part: "bias",
            subject: &row.scene,
            width,
            height,
            photons: Some(row.photons.into()),
            seeds: Some(row.seeds),
            method: row.way.method(),
            kernel: format!("{:?}", study.kernels[0]).to_lowercase(),
            min_photons,
            max_radius: min_photons.map(|_| study.max_radius),
            fixed_radius: row.way.radius(),
            mean_error: Some(row.inside.mean),
            mean_error_half_width: row.inside.half_width,
            bias: Some(row.size),
            edge_error: Some(row.edges.mean),
            edge_error_half_width: row.edges.half_width,
            tested_tiles: Some(row.tested),
            biased_tiles: Some(row.biased),
            surely_biased_tiles: Some(row.surely_biased),
            ..Self::default()
        }
    }
}

/// All of a study with its summary; reading takes the rows alone.
#[derive(Serialize)]
struct WithSummary<'a> {
    #[serde(flatten)]
    study: &'a Study,
    summary: Summary,
}

impl Study {
    /// Reads what [`save`](Self::save) wrote.
    ///
    /// # Errors
    /// [`Error::File`] if there is none, or it is something else.
    pub fn load(path: &Path) -> Result<Self> {
        let remedy = "give the folder of an earlier study of this version, or leave out --resume";
        let text = std::fs::read(path)
            .map_err(|error| Error::file(path, format!("can't be read: {error}"), remedy))?;
        serde_json::from_slice(&text)
            .map_err(|error| Error::file(path, format!("is not the file of a study: {error}"), remedy))
    }

    /// Whether this, read from `path`, can be gone on with as `now`, which has found nothing yet.
    ///
    /// # Errors
    /// [`Error::File`] if it was made on another device, by another version or with other settings.
    pub fn check_resumable(&self, path: &Path, now: &Self) -> Result<()> {
        let other = if (&self.program, &self.commit) != (&now.program, &now.commit) {
            let of = |study: &Self| format!("version {}, commit {}", study.program, study.commit);
            format!("{} and this is {}", of(self), of(now))
        } else if self.device != now.device {
            format!("{} and this is {}", self.device.renderer, now.device.renderer)
        } else if self.settings != now.settings {
            "other settings".to_owned()
        } else {
            return Ok(());
        };
        let remedy = "leave out --resume, or give the same options on the same machine";
        Err(Error::file(path, format!("was made with {other}"), remedy))
    }

    /// Writes JSON, the old file kept until the new one is whole: every row, and `summary`, their
    /// conclusions.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn save(&self, path: &Path) -> Result<()> {
        write_atomically(path, |file| {
            serde_json::to_writer(&mut *file, &self.with_summary())?;
            file.write_all(b"\n")
        })
    }

    /// What [`save`](Self::save) writes.
    #[must_use]
    pub fn with_summary(&self) -> impl Serialize {
        WithSummary { study: self, summary: self.summary() }
    }

    /// Writes a row of CSV for each thing that was measured.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn save_csv(&self, path: &Path) -> Result<()> {
        write_atomically(path, |file| {
            let mut csv = csv::Writer::from_writer(file);
            for (_, answers) in &self.radii {
                for row in &answers.rows {
                    csv.serialize(Record::of_radii(row))?;
                }
            }
            let density = &self.settings.density;
            for row in &self.density {
                csv.serialize(Record::of_density(row, density.side, density.max_radius))?;
            }
            for row in &self.pictures {
                csv.serialize(Record::of_picture(row, &self.settings.pictures))?;
            }
            for row in &self.biases {
                csv.serialize(Record::of_bias(row, &self.settings.pictures))?;
            }
            csv.flush()
        })
    }
}
