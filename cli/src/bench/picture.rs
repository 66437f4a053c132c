//! `varikernel bench --suite picture`: what the stages of a picture cost.

use std::io::Write as _;
use std::path::Path;
use std::time::Duration;

use anyhow::{Result, bail};
use varikernel::image::{check_writable, write_atomically};
use varikernel::render::Progress;
use varikernel_lab::bench::{PictureCase, PictureReport, PictureSuite};

use super::cells::{align_right, new_table, three_digits};
use super::table::device_facts;
use super::{Args, targets};
use crate::render::Bar;
use crate::saving::{Autosave, Resume, how_to_go_on};
use crate::{Outcome, device, output};

pub(super) fn run(args: &Args) -> Result<Outcome> {
    for (given, name) in [
        (args.build_sizes.is_some(), "build-sizes"),
        (args.rivals, "rivals"),
        (args.protocol.is_some(), "protocol"),
        (args.csv.is_some(), "csv"),
        (args.resume.is_some(), "resume"),
    ] {
        if given {
            bail!(
                "--{name} is not possible with --suite picture\nhelp: it takes --sizes, --photons, \
                 --budget and --json"
            );
        }
    }
    if let Some(path) = &args.json {
        check_writable(path)?;
    }
    let gl = device::open(&args.device)?;
    let usual = PictureSuite::default();
    let photons = args.photons.clone().unwrap_or_else(|| usual.photons.clone());
    let sizes: Vec<[u32; 2]> = args.sizes.iter().map(glam::UVec2::to_array).collect();
    let cases = u32::try_from(sizes.len() * photons.len()).unwrap_or(u32::MAX);
    let budget = args.budget.unwrap_or_else(|| Duration::from_mins(1).saturating_mul(cases));
    let suite = PictureSuite { sizes, photons, ..usual };
    let bar = Bar::new();
    let mut autosave = Autosave::new(Duration::ZERO);
    let report = suite.run(&gl, budget, &mut |report, done| {
        bar.show(Progress { stage: "bench", done });
        if let Some(path) = &args.json {
            autosave.save_if_due(|| save(report, path));
        }
        Ok(())
    })?;
    bar.finish();
    let saved = args.json.as_ref().map_or(Ok(()), |path| save(&report, path));
    print(&report)?;
    targets::print(&report.targets, targets::MEDIANS)?;
    saved.map_err(|error| how_to_go_on(error, &Resume::Anew))?;
    Ok(Outcome::Done)
}

fn save(report: &PictureReport, path: &Path) -> varikernel::Result<()> {
    write_atomically(path, |file| {
        serde_json::to_writer_pretty(&mut *file, report)?;
        writeln!(file)
    })
}

fn print(report: &PictureReport) -> Result<()> {
    let [min_photons, max_radius, fixed] = report.radii;
    let mut facts = device_facts(&report.device);
    facts.push(("scene", report.suite.scene.clone()));
    facts.push(("radii", format!("n {min_photons}, MR {max_radius}; fixed {fixed}")));
    output::print_facts(&facts)?;
    for case in &report.cases {
        print_case(case)?;
    }
    output::print(
        "\nms: median time. copies: ms over that of a full-screen pass that copies one texel.\n\
         points: ms over that of the photons drawn as points.\n\
         fragments: for each contributing photon, and their time.\n\
         whole: flux and tables. stage-...: the passes of a whole one after the camera moved.",
    )
}

fn print_case(case: &PictureCase) -> Result<()> {
    let [width, height] = case.size;
    output::print(&format!(
        "\n{width} x {height}, {} photons traced, {} drawn, {} contribute",
        case.photons, case.drawn, case.contributing
    ))?;
    let mut table =
        new_table(&["stage", "ms", "copies", "points", "fragments", "ns each", "samples", "answer"]);
    align_right(&mut table, 1..=6);
    for row in &case.rows {
        let number = |value: Option<f64>| value.map_or_else(String::new, three_digits);
        table.add_row([
            row.name.clone(),
            three_digits(row.statistics.median_ms),
            number(row.copies),
            number(row.point_passes),
            number(row.fragments_per_photon),
            number(row.ns_per_fragment),
            row.statistics.count.to_string(),
            if row.right { "right" } else { "WRONG" }.to_owned(),
        ]);
    }
    output::print(&table.trim_fmt())?;
    for left_out in &case.left_out {
        output::print(&format!("left out: {}: {}", left_out.name, left_out.reason))?;
    }
    Ok(())
}
