//! The files of a run: a row each as CSV, and everything as JSON.

use std::io::Write as _;
use std::path::Path;

use super::Report;
use super::row::{Decision, Row};
use varikernel::error::Result;
use varikernel::image::write_atomically;

const COLUMNS: [&str; 14] = [
    "id",
    "promises",
    "verdict",
    "number",
    "side",
    "density",
    "shape",
    "min_photons",
    "total",
    "decision",
    "wrong",
    "wrong_share",
    "largest_error",
    "note",
];

impl Report {
    /// Writes everything as JSON, with where each number breaks, and the verdicts if it is complete, in one
    /// step.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn save_json(&self, path: &Path) -> Result<()> {
        let breaks = self.breaks();
        write_atomically(path, |file| {
            let mut all = serde_json::to_value(self)?;
            // Promises whose rows are still to come would read as broken.
            if self.complete {
                all["promises"] = serde_json::to_value(self.judge())?;
            }
            all["breaks"] = serde_json::to_value(&breaks)?;
            serde_json::to_writer_pretty(&mut *file, &all)?;
            file.write_all(b"\n")
        })
    }

    /// Writes a line for each row as CSV, in one step.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn save_csv(&self, path: &Path) -> Result<()> {
        write_atomically(path, |file| {
            let mut csv = csv::Writer::from_writer(file);
            csv.write_record(COLUMNS)?;
            for row in &self.rows {
                csv.write_record(record(row))?;
            }
            csv.flush()
        })
    }
}

fn record(row: &Row) -> [String; COLUMNS.len()] {
    fn text(value: Option<impl ToString>) -> String {
        value.map_or_else(String::new, |value| value.to_string())
    }
    let decision = row.decision.map(|decision| match decision {
        Decision::Accepted => "accepted",
        Decision::Refused => "refused",
    });
    [
        row.id.clone(),
        row.promises.join(" "),
        row.verdict.name().to_owned(),
        text(row.number.as_ref()),
        text(row.side),
        text(row.density),
        text(row.shape.as_ref()),
        text(row.min_photons),
        text(row.total),
        text(decision),
        text(row.wrong),
        text(row.wrong_share()),
        text(row.largest_error),
        row.note.clone(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::Device;
    use crate::stress::{Extent, StressSettings};

    #[test]
    fn a_report_that_is_not_complete_judges_no_promise() {
        let mut report = Report {
            program: String::new(),
            device: Device {
                renderer: String::new(),
                vendor: String::new(),
                version: String::new(),
                driver: String::new(),
                software: true,
                processor: String::new(),
                threads: 1,
            },
            settings: StressSettings { extent: Extent::Quick, planted: false },
            pruned: Vec::new(),
            rows: Vec::new(),
            renderers: Vec::new(),
            complete: false,
        };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("stress.json");
        let saved = |report: &Report| -> serde_json::Value {
            report.save_json(&path).unwrap();
            serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap()
        };
        let partial = saved(&report);
        assert!(partial["complete"] == false && partial.get("promises").is_none(), "{partial}");
        report.compare_renderers(Vec::new());
        let whole = saved(&report);
        assert!(whole["complete"] == true && whole["promises"][0]["verdict"] == "broken", "{whole}");
    }
}
