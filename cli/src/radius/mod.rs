//! `varikernel radius`: density map in, radius map out.

mod report;

use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow, bail};
use varikernel::context::DeviceChoice;
use varikernel::gl::DeviceInfo;
use varikernel::image::Difference;
use varikernel::image::{
    self, Attribute, Format, Picture, ReadOptions, read_counts, write_counts, write_picture,
};
use varikernel::radius::Census;
use varikernel::radius::planner::{self, Decision};
use varikernel::settings::{Exactness, Laboratory, Rule, Settings, Storage};
use varikernel::{
    Certificate, CountBounds, DensityMap, Error, Frame, Image, Mask, RadiusPipeline, reference,
};
use varikernel_lab::{RadiusSummary, total_photons};

use super::method_options::MethodOptions;
use super::words::in_words_of_options;
use super::{Outcome, device, output};
use report::{MapReport, Report, Timing};

/// Find, for each pixel, the smallest box that holds at least n photons, or the widest that is even.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub(crate) struct Args {
    /// Photon density map, counts per pixel: EXR (one f16, f32 or u32 channel), PNG (8 or 16-bit grey) or
    /// NPY.
    map: PathBuf,

    /// Radius map to write: .exr (u32 channel "radius", settings as attributes), .npy (u32), or .png (a
    /// picture).
    #[arg(short, long, value_name = "FILE")]
    #[arg(help_heading = "Input and output")]
    output: PathBuf,

    #[command(flatten)]
    method: MethodOptions,

    /// Compute even where sums may round or wrap, to see how wrong it gets.
    #[arg(long)]
    #[arg(help_heading = "Exactness")]
    allow_inexact: bool,

    /// Compare with the definition on the CPU; exit 1 on a difference.
    #[arg(long)]
    #[arg(help_heading = "Exactness")]
    verify: bool,

    /// Prove the result on the GPU: each radius by two boxes, each table entry by the counts; exit 1 if
    /// something is not proved. For the summed-area table.
    #[arg(long, conflicts_with_all = ["allow_inexact", "mask"])]
    #[arg(help_heading = "Exactness")]
    certify: bool,

    /// Also write a map that is 1 where MR ended the search with too few photons (by the rule even: with a
    /// density that is even still), else 0.
    #[arg(long, value_name = "FILE")]
    #[arg(help_heading = "Input and output")]
    limited_mask: Option<PathBuf>,

    /// Map of the pixels that need a radius: those that are 0 in it get 0, and cost next to nothing. EXR,
    /// NPY, or any PNG, 1 bit and colours too: black pixels are 0, and so are wholly transparent ones.
    #[arg(long, value_name = "FILE")]
    #[arg(help_heading = "Input and output")]
    mask: Option<PathBuf>,

    /// Channel to read if the EXR has several.
    #[arg(long, value_name = "NAME")]
    #[arg(help_heading = "Input and output")]
    channel: Option<String>,

    /// OpenGL device: auto, egl, egl:INDEX, osmesa, or part of a renderer's name.
    #[arg(long, default_value_t = DeviceChoice::Auto)]
    device: DeviceChoice,

    /// Print one JSON object instead of a table.
    #[arg(long)]
    #[arg(help_heading = "Input and output")]
    json: bool,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    // What can be refused without computing is refused first.
    args.method.check_rule()?;
    let settings = settings(args);
    let explain = |error| explain(error, &args.map);
    settings.validate().map_err(explain)?;
    if args.certify {
        Certificate::check_possible(&settings).map_err(explain)?;
    }
    check_files(args)?;
    let options = ReadOptions { channel: args.channel.as_deref(), ..ReadOptions::default() };
    let counts = read_counts(&args.map, &options)?;
    tracing::info!(map = %args.map.display(), size = %counts.size(), "read");
    let gl = device::open(&args.device)?;
    tracing::info!(renderer = gl.info().renderer, "opened");
    check_fits(args, &counts, gl.info())?;

    let bounds = match settings.storage {
        Storage::U16 => CountBounds::of_boxes(&counts, settings.search),
        _ => CountBounds::of(&counts, settings.search),
    };
    let decision = planned(args, settings, &counts, bounds);
    let settings = decision.as_ref().map_or(settings, |decision| decision.settings);
    let density = DensityMap::upload(&gl, &counts, bounds)?;
    let mut pipeline =
        RadiusPipeline::new(&gl, counts.size(), density.format(), settings).map_err(explain)?;
    let plan = pipeline.plan(&density).map_err(explain)?;
    let mask = args.mask.as_ref().map(|path| read_mask(path, &counts)).transpose()?;
    let mask_on_gpu = mask.as_ref().map(|mask| Mask::upload(&gl, mask)).transpose()?;
    let frame = Frame { mask: mask_on_gpu.as_ref(), ..Frame::new(&density) };
    let (radii, [build, search]) = pipeline.update_timed(&frame)?;
    let radii = reference::Radii {
        radius: radii.read()?,
        limited: radii.read_limited()?.unwrap_or_else(|| unreachable!("the settings ask for the mask")),
    };
    let certificate = args.certify.then(|| pipeline.certify(&density)).transpose().map_err(explain)?;

    let verify = if args.verify {
        let definition = match settings.rule {
            Rule::Even => reference::even(&counts, settings.search),
            _ => reference::radius_by_table(&counts, settings.search),
        };
        let definition = match &mask {
            Some(mask) => definition.where_needed(mask),
            None => definition,
        };
        Some((
            Difference::between(&radii.radius, &definition.radius)?,
            Difference::between(&radii.limited, &definition.limited)?,
        ))
    } else {
        None
    };
    let (verify, verify_limited) = verify.unzip();
    write_radius(args, &settings, gl.info(), &radii.radius)?;
    if let Some(path) = &args.limited_mask {
        let mask = radii.limited.map(u32::from);
        write_counts(path, "limited", &mask, &attributes(args, &settings, gl.info()))?;
    }

    tracing::info!(output = %args.output.display(), "written");

    let report = Report {
        version: env!("CARGO_PKG_VERSION"),
        map: MapReport {
            file: &args.map,
            size: counts.size().to_array(),
            photons: total_photons(&counts),
            max_count: counts.values().iter().copied().max().unwrap_or(0),
        },
        output: &args.output,
        limited_mask: args.limited_mask.as_deref(),
        settings,
        planned: decision.as_ref().map(|decision| decision.reason.as_str()),
        device: gl.info(),
        plan,
        radius: RadiusSummary::of(&radii),
        stages: vec![Timing::new("build", build), Timing::new("search", search)],
        certificate,
        verify,
        verify_limited,
    };
    if args.json {
        output::print_json(&report)?;
    } else {
        report::print(&report)?;
    }
    let mut differences = [&report.verify, &report.verify_limited].into_iter().flatten();
    let differs = differences.any(|difference| !difference.is_none());
    let is_unproved = certificate.is_some_and(|certificate| !certificate.is_proved());
    Ok(if differs || is_unproved { Outcome::Differs } else { Outcome::Done })
}

/// What the planner decides, where nothing else is asked for.
fn planned(args: &Args, settings: Settings, counts: &Image<u32>, bounds: CountBounds) -> Option<Decision> {
    args.method
        .is_free()
        .then(|| planner::decide(&settings, counts.size(), Some(&Census::of(counts)), bounds))
}

/// A mask of the map's size, 1 where a radius is needed.
fn read_mask(path: &Path, counts: &Image<u32>) -> Result<Image<u8>> {
    let mask = image::read_mask(path)?;
    if mask.size() != counts.size() {
        bail!(
            "{}: the mask is {} x {} pixels, and the map {} x {}\nhelp: give one of the map's size",
            path.display(),
            mask.size().x,
            mask.size().y,
            counts.size().x,
            counts.size().y
        );
    }
    Ok(mask)
}

/// An error of the library, with the option to change and the file concerned.
fn explain(error: Error, map: &Path) -> anyhow::Error {
    match error {
        Error::Inexact { reason, remedy } => anyhow!(
            "{}: the result would not be exact: {reason}\nhelp: {remedy}, or add --allow-inexact to see \
             how wrong it gets",
            map.display()
        ),
        other => in_words_of_options(other),
    }
}

/// Refuses outputs that can't be written, and ones that would replace the map, the mask or each other.
fn check_files(args: &Args) -> Result<()> {
    for path in [Some(&args.output), args.limited_mask.as_ref()].into_iter().flatten() {
        Format::of(path)?;
    }
    let outputs =
        [("--output", Some(args.output.as_path())), ("--limited-mask", args.limited_mask.as_deref())];
    if let Some(mask) = &args.mask {
        output::check_files(("the mask", mask), &outputs)?;
    }
    output::check_files(("the map", &args.map), &outputs)
}

fn check_fits(args: &Args, counts: &Image<u32>, device: &DeviceInfo) -> Result<()> {
    let (size, limit) = (counts.size(), device.max_texture_size);
    if size.max_element() > limit {
        bail!(
            "{}: {} x {} pixels, larger than the textures of {}, at most {limit} a side\n\
             help: give a smaller map, cut it into parts, or choose another --device",
            args.map.display(),
            size.x,
            size.y,
            device.renderer
        );
    }
    Ok(())
}

/// The settings by the arguments; where the planner may decide, its decision without a map.
fn settings(args: &Args) -> Settings {
    let exactness = if args.allow_inexact { Exactness::Waived } else { Exactness::Required };
    let asked = args.method.settings();
    let laboratory = Laboratory { exactness, ..asked.laboratory };
    Settings { limited_mask: true, masked: args.mask.is_some(), laboratory, ..asked }
}

fn write_radius(args: &Args, settings: &Settings, device: &DeviceInfo, radius: &Image<u32>) -> Result<()> {
    match Format::of(&args.output)? {
        Format::Png => {
            let (title, least) = match settings.rule {
                Rule::Even => ("Radius of a box of even density".to_owned(), 0),
                _ => (format!("Radius of a box with {} photons", settings.search.min_photons), 1),
            };
            let range = Some(least..=settings.search.max_radius);
            let picture = Picture { title: &title, unit: "pixels", range };
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
