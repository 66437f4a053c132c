//! The files of a timing run: JSON with every sample, CSV with a row for each case.

use std::fs;
use std::io;
use std::path::Path;

use super::case::Case;
use super::report::{Report, Run};
use crate::statistics::Statistics;
use varikernel::error::{Error, Result};
use varikernel::image::write_atomically;
use varikernel::settings::{Edges, Method, Order};

impl Report {
    /// Reads what [`save`](Self::save) wrote.
    ///
    /// # Errors
    /// [`Error::File`] if there is no such file or it is something else.
    pub fn load(path: &Path) -> Result<Self> {
        let text = fs::read_to_string(path).map_err(|error| {
            Error::file(path, format!("could not be read: {error}"), "give a file that `bench --json` wrote")
        })?;
        serde_json::from_str(&text).map_err(|error| {
            Error::file(
                path,
                format!("is not a complete file of results: {error}"),
                "give a file that `bench --json` of this version wrote",
            )
        })
    }

    /// Writes JSON, in one step.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn save(&self, path: &Path) -> Result<()> {
        write_atomically(path, |file| {
            serde_json::to_writer(&mut *file, self)?;
            io::Write::write_all(file, b"\n")
        })
    }

    /// Writes a row of CSV for each run, without the samples.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn save_csv(&self, path: &Path) -> Result<()> {
        write_atomically(path, |file| {
            let mut csv = csv::Writer::from_writer(file);
            csv.write_record(CSV_COLUMNS)?;
            for run in &self.runs {
                csv.write_record(csv_record(run))?;
            }
            csv.flush()
        })
    }
}

const CSV_COLUMNS: [&str; 23] = [
    "stage",
    "variant",
    "search",
    "map",
    "width",
    "height",
    "min_photons",
    "max_radius",
    "edges",
    "sets",
    "samples",
    "median_ms",
    "mean_ms",
    "min_ms",
    "quartile_1_ms",
    "quartile_3_ms",
    "max_ms",
    "median_wall_ms",
    "copies",
    "suspect",
    "wrong_pixels",
    "exact_method",
    "wrong",
];

fn csv_record(run: &Run) -> [String; CSV_COLUMNS.len()] {
    let number = |value: Option<u32>| value.map_or_else(String::new, |value| value.to_string());
    let Case { stage, variant, map, size, method, search, min_photons, max_radius, edges, .. } = &run.case;
    let all = &run.statistics;
    let wall = Statistics::of(&run.wall_ms).map_or(0.0, |wall| wall.median_ms);
    [
        stage.name().to_owned(),
        variant.clone(),
        search.map_or("", Order::name).to_owned(),
        map.clone(),
        size[0].to_string(),
        size[1].to_string(),
        number(*min_photons),
        number(*max_radius),
        edges.map_or("", Edges::name).to_owned(),
        run.sets.len().to_string(),
        all.count.to_string(),
        all.median_ms.to_string(),
        all.mean_ms.to_string(),
        all.min_ms.to_string(),
        all.quartile_1_ms.to_string(),
        all.quartile_3_ms.to_string(),
        all.max_ms.to_string(),
        wall.to_string(),
        run.copies.map_or_else(String::new, |copies| copies.to_string()),
        run.suspect.len().to_string(),
        run.wrong_pixels.to_string(),
        method.is_none_or(Method::is_exact).to_string(),
        run.is_wrong().to_string(),
    ]
}
