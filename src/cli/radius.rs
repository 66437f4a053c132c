//! `varikernel radius`: density map in, radius map out.

use std::path::{Path, PathBuf};

use anyhow::Result;
use serde::Serialize;
use varikernel::context::{self, DeviceChoice};
use varikernel::exactness::Plan;
use varikernel::gl::{self, DeviceInfo, Sample};
use varikernel::image::{
    Attribute, Format, Picture, ReadOptions, check_writable, read_counts, write_counts, write_picture,
};
use varikernel::measure::{Difference, RadiusSummary, total_photons};
use varikernel::settings::{
    Edges, Exactness, Faults, Matching, Method, Order, SatSamples, Search, Settings, Split, Storage,
    Variation,
};
use varikernel::{CountBounds, DensityMap, Image, RadiusPipeline, reference};

use super::{Outcome, output};

/// Find, for each pixel, the smallest box that holds at least n photons.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Photon density map, counts per pixel: EXR (one f16, f32 or u32 channel), PNG (8 or 16-bit grey) or NPY.
    map: PathBuf,

    /// Radius map to write: .exr (u32 channel "radius", settings as attributes), .npy (u32), or .png (a picture).
    #[arg(short, long)]
    output: PathBuf,

    /// n: photons that a box has to hold.
    #[arg(short = 'n', long, default_value_t = 25)]
    min_photons: u32,

    /// MR: the radius at which the search ends, in pixels; pixels that find too few photons get it.
    #[arg(short = 'r', long, default_value_t = 32)]
    max_radius: u32,

    /// What counts outside the map (thesis 3.1).
    #[arg(long, value_enum, default_value_t = Edges::Scale)]
    edges: Edges,

    /// How photons in a box are counted (thesis 3.2 to 3.4).
    #[arg(long, value_enum, default_value_t = Method::SummedAreaTable)]
    method: Method,

    /// Order in which radii are tried (thesis 3.5); the naive mipmap has its own.
    #[arg(long, value_enum, default_value_t = Order::Binary)]
    search: Order,

    /// Samples a pass when the summed-area table is built (thesis 4.2).
    #[arg(long, value_enum, default_value_t = SatSamples::Four)]
    sat_samples: SatSamples,

    /// Number in which sums are kept.
    #[arg(long, value_enum, default_value_t = Storage::U32)]
    storage: Storage,

    /// How the pyramid splits what is left after a sample (thesis 4.3).
    #[arg(long, value_enum, default_value_t = Split::Larger)]
    split: Split,

    /// How the pyramid finds the level of a sample (thesis 4.3, 6.3.5).
    #[arg(long, value_enum, default_value_t = Matching::Bits)]
    matching: Matching,

    /// A variation of the method that the thesis leaves to future work (6.2.5, 6.3.5, 6.4.5); the radii stay the same.
    #[arg(long, value_enum)]
    variation: Option<Variation>,

    /// Run the thesis's listings with their printed faults, or without.
    #[arg(long, value_enum, default_value_t = Fidelity::Corrected)]
    fidelity: Fidelity,

    /// Compute even where sums may round or wrap, to see how wrong it gets.
    #[arg(long)]
    allow_inexact: bool,

    /// Compare with the definition on the CPU; exit 1 on a difference.
    #[arg(long)]
    verify: bool,

    /// Also write a map that is 1 where MR ended the search with too few photons, else 0.
    #[arg(long, value_name = "FILE")]
    limited_mask: Option<PathBuf>,

    /// Channel to read if the EXR has several.
    #[arg(long)]
    channel: Option<String>,

    /// OpenGL device: auto, egl, egl:INDEX, osmesa, or part of a renderer's name.
    #[arg(long, default_value_t = DeviceChoice::Auto)]
    device: DeviceChoice,

    /// Print one JSON object instead of a table.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Fidelity {
    /// Without the faults.
    Corrected,
    /// With the faults, made well defined.
    AsPrinted,
}

#[derive(Serialize)]
struct Report<'a> {
    version: &'static str,
    map: MapReport<'a>,
    output: &'a Path,
    settings: Settings,
    device: &'a DeviceInfo,
    plan: Plan,
    radius: RadiusSummary,
    stages: Vec<Stage>,
    #[serde(skip_serializing_if = "Option::is_none")]
    verify: Option<Difference>,
}

#[derive(Serialize)]
struct MapReport<'a> {
    file: &'a Path,
    size: [u32; 2],
    photons: u64,
    max_count: u32,
}

#[derive(Serialize)]
struct Stage {
    stage: &'static str,
    query_ms: f64,
    wall_ms: f64,
}

impl Stage {
    fn new(stage: &'static str, sample: Sample) -> Self {
        let milliseconds = |time: std::time::Duration| 1e3 * time.as_secs_f64();
        Self { stage, query_ms: milliseconds(sample.query), wall_ms: milliseconds(sample.wall) }
    }
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    // What can be refused without computing is refused first.
    let settings = settings(args);
    settings.validate()?;
    for path in [Some(&args.output), args.limited_mask.as_ref()].into_iter().flatten() {
        Format::of(path)?;
        check_writable(path)?;
    }
    let gl = context::open(&args.device)?;
    let options = ReadOptions {
        channel: args.channel.as_deref(),
        max_side: gl.info().max_texture_size,
        ..ReadOptions::default()
    };
    let counts = read_counts(&args.map, &options)?;

    let density = DensityMap::upload(&gl, &counts, CountBounds::of(&counts, settings.search))?;
    let mut pipeline = RadiusPipeline::new(&gl, counts.size(), density.format(), settings)?;
    let plan = pipeline.plan(&density)?;
    let ((), build) = gl::time(&gl, || pipeline.build(&density))?;
    let (radii, search) = gl::time(&gl, || pipeline.search(&density))?;
    let radii = reference::Radii {
        radius: radii.read()?,
        limited: radii.read_limited()?.unwrap_or_else(|| unreachable!("the settings ask for the mask")),
    };

    let verify = if args.verify {
        let definition = reference::radius_by_table(&counts, settings.search);
        Some(Difference::between(&radii.radius, &definition.radius)?)
    } else {
        None
    };
    write_radius(args, &settings, gl.info(), &radii.radius)?;
    if let Some(path) = &args.limited_mask {
        let mask = radii.limited.map(u32::from);
        write_counts(path, "limited", &mask, &attributes(args, &settings, gl.info()))?;
    }

    let report = Report {
        version: env!("CARGO_PKG_VERSION"),
        map: MapReport {
            file: &args.map,
            size: counts.size().to_array(),
            photons: total_photons(&counts),
            max_count: counts.values().iter().copied().max().unwrap_or(0),
        },
        output: &args.output,
        settings,
        device: gl.info(),
        plan,
        radius: RadiusSummary::of(&radii),
        stages: vec![Stage::new("build", build), Stage::new("search", search)],
        verify,
    };
    if args.json {
        output::print_json(&report)?;
    } else {
        print_report(&report)?;
    }
    let differs = report.verify.is_some_and(|difference| !difference.is_none());
    Ok(if differs { Outcome::Differs } else { Outcome::Done })
}

fn settings(args: &Args) -> Settings {
    Settings {
        search: Search {
            min_photons: args.min_photons,
            max_radius: args.max_radius,
            edges: args.edges,
            order: args.search,
        },
        method: args.method,
        split: args.split,
        matching: args.matching,
        sat_samples: args.sat_samples,
        storage: args.storage,
        variation: args.variation,
        faults: match args.fidelity {
            Fidelity::Corrected => Faults::NONE,
            Fidelity::AsPrinted => Faults::AS_PRINTED,
        },
        exactness: if args.allow_inexact { Exactness::Waived } else { Exactness::Required },
        limited_mask: true,
    }
}

fn write_radius(args: &Args, settings: &Settings, device: &DeviceInfo, radius: &Image<u32>) -> Result<()> {
    match Format::of(&args.output)? {
        Format::Png => {
            let title = format!("Radius of a box with {} photons", args.min_photons);
            let picture = Picture { title: &title, unit: "pixels", range: Some(1..=args.max_radius) };
            write_picture(&args.output, radius, &picture)?;
        }
        Format::Exr | Format::Npy => {
            write_counts(&args.output, "radius", radius, &attributes(args, settings, device))?;
        }
    }
    Ok(())
}

/// Every setting, the renderer and the version.
fn attributes(args: &Args, settings: &Settings, device: &DeviceInfo) -> Vec<Attribute> {
    let settings = serde_json::to_value(settings).unwrap_or_default();
    let mut attributes = vec![
        Attribute::text("varikernel.version", env!("CARGO_PKG_VERSION")),
        Attribute::text("varikernel.map", args.map.display().to_string()),
        Attribute::text("varikernel.renderer", &device.renderer),
        Attribute::text("varikernel.driver", &device.version),
    ];
    attributes.extend(flatten("varikernel", &settings));
    attributes
}

/// `{"search": {"edges": "zero"}}` as `("varikernel.search.edges", "zero")`.
fn flatten(prefix: &str, value: &serde_json::Value) -> Vec<Attribute> {
    match value {
        serde_json::Value::Object(fields) => {
            fields.iter().flat_map(|(name, value)| flatten(&format!("{prefix}.{name}"), value)).collect()
        }
        serde_json::Value::String(text) => vec![Attribute::text(prefix, text)],
        serde_json::Value::Number(number) => match number.as_i64() {
            Some(number) => vec![Attribute::integer(prefix, number)],
            None => vec![Attribute::text(prefix, number.to_string())],
        },
        other => vec![Attribute::text(prefix, other.to_string())],
    }
}

fn print_report(report: &Report<'_>) -> Result<()> {
    let RadiusSummary { min, mean, median, max, limited_share } = report.radius;
    let [width, height] = report.map.size;
    let mut facts = vec![
        ("map", format!("{}, {width} x {height} pixels", report.map.file.display())),
        ("photons", format!("{}, at most {} in a pixel", report.map.photons, report.map.max_count)),
        ("renderer", report.device.renderer.clone()),
        ("radius", format!("{min} to {max} pixels, mean {mean:.3}, median {median}")),
        ("limited", format!("{:.3} % found too few photons", 100.0 * limited_share)),
        ("exact", if report.plan.exact { "yes" } else { "not proved" }.to_owned()),
    ];
    for Stage { stage, query_ms, wall_ms } in &report.stages {
        facts
            .push((stage, format!("{query_ms:.3} ms by GPU query, {wall_ms:.3} ms by the clock, first run")));
    }
    if let Some(difference) = &report.verify {
        facts.push(("verify", format!("against the definition: {difference}")));
    }
    facts.push(("written", report.output.display().to_string()));
    output::print_facts(&facts)
}
