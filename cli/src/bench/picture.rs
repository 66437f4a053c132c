//! `varikernel bench --suite picture`: what the stages of a picture cost.

use std::io::Write as _;
use std::path::Path;
use std::time::Duration;

use anyhow::{Result, bail};
use varikernel::image::{check_writable, write_atomically};
use varikernel::render::Progress;
use varikernel_lab::bench::{PictureReport, PictureSuite};

use super::cells::{align_right, new_table, three_digits};
use super::table::device_facts;
use super::{Args, targets};
use crate::render::Bar;
use crate::saving::{Autosave, Resume, how_to_go_on};
use crate::{Outcome, device, output};

pub(super) fn run(args: &Args) -> Result<Outcome> {
    let &[size] = args.sizes.as_slice() else {
        bail!("--suite picture takes one size\nhelp: give one with --sizes")
    };
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
    let budget = args.budget.unwrap_or(Duration::from_mins(1));
    let usual = PictureSuite::default();
    let photons = args.photons.unwrap_or(usual.photons);
    let suite = PictureSuite { size: size.to_array(), photons, ..usual };
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
    targets::print(&report.targets)?;
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
    let PictureSuite { scene, size: [width, height], photons, .. } = &report.suite;
    let [min_photons, max_radius, fixed] = report.radii;
    let mut facts = device_facts(&report.device);
    facts.push(("scene", format!("{scene}, {width} x {height}")));
    facts.push((
        "photons",
        format!("{photons} traced, {} drawn, {} contribute", report.drawn, report.contributing),
    ));
    facts.push(("radii", format!("n {min_photons}, MR {max_radius}; fixed {fixed}")));
    output::print_facts(&facts)?;
    let mut table =
        new_table(&["stage", "ms", "copies", "point passes", "fragments", "ns each", "samples", "answer"]);
    align_right(&mut table, 1..=6);
    for row in &report.rows {
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
    output::print(
        "\nms: median time. copies: ms over that of a full-screen pass that copies one texel.\n\
         points: ms over that of the photons drawn as points.\n\
         fragments: for each contributing photon, and their time.",
    )
}
