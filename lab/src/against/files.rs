//! The files of a comparison: JSON with everything, CSV with a row for each picture and region.

use std::io::Write as _;
use std::path::Path;

use serde::Serialize;
use varikernel::error::Result;
use varikernel::image::write_atomically;

use super::{Against, Region};

/// A row of `against.csv`.
#[derive(Serialize)]
struct Record<'a> {
    scene: &'a str,
    way: &'a str,
    options: &'a str,
    seed: &'a str,
    seconds: f64,
    region: Region,
    pixels: usize,
    /// Of green, over the mean of the reference.
    rmse: f64,
    median_relative_error: f64,
    bias: f64,
}

impl Against {
    /// Writes JSON, the old file kept until the new one is whole.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn save(&self, path: &Path) -> Result<()> {
        write_atomically(path, |file| {
            serde_json::to_writer_pretty(&mut *file, self)?;
            file.write_all(b"\n")
        })
    }

    /// Writes a row of CSV for each picture and region.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn save_csv(&self, path: &Path) -> Result<()> {
        write_atomically(path, |file| {
            let mut csv = csv::Writer::from_writer(file);
            for scene in &self.scenes {
                for way in &scene.ways {
                    for point in &way.points {
                        for picture in &point.pictures {
                            for error in &picture.errors {
                                csv.serialize(Record {
                                    scene: &scene.scene,
                                    way: &way.way,
                                    options: &point.options,
                                    seed: &picture.seed,
                                    seconds: picture.seconds,
                                    region: error.region,
                                    pixels: error.pixels,
                                    rmse: error.rmse,
                                    median_relative_error: error.median,
                                    bias: error.bias,
                                })?;
                            }
                        }
                    }
                }
            }
            csv.flush()
        })
    }
}
