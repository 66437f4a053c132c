//! `varikernel radius`: density map in, radius map out.

mod report;

use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow, bail};
use clap::ValueEnum as _;
use varikernel::context::{self, DeviceChoice};
use varikernel::gl::{self, DeviceInfo};
use varikernel::image::{Attribute, Format, Picture, ReadOptions, read_counts, write_counts, write_picture};
use varikernel::measure::{Difference, RadiusSummary, total_photons};
use varikernel::planner::{self, Census, Choice};
use varikernel::settings::{
    Edges, Exactness, Faults, Matching, Method, Order, SatBuild, SatSamples, Search, Settings, Split,
    Storage, Variation,
};
use varikernel::{
    Certificate, CountBounds, DensityMap, Error, Frame, Image, Mask, RadiusPipeline, reference,
};

use super::{Outcome, output};
use report::{MapReport, Report, Timing};

/// Find, for each pixel, the smallest box that holds at least n photons.
#[derive(Debug, clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub(crate) struct Args {
    /// Photon density map, counts per pixel: EXR (one f16, f32 or u32 channel), PNG (8 or 16-bit grey) or NPY.
    map: PathBuf,

    /// Radius map to write: .exr (u32 channel "radius", settings as attributes), .npy (u32), or .png (a picture).
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,

    /// n: photons that a box has to hold, at least 1.
    #[arg(short = 'n', long, default_value_t = 25, value_name = "N", value_parser = whole_number)]
    #[arg(allow_negative_numbers = true)]
    min_photons: u32,

    /// MR: the radius at which the search ends, in pixels, 1 to 32767; pixels that find too few photons get it.
    #[arg(short = 'r', long, default_value_t = 32, value_name = "MR", value_parser = whole_number)]
    #[arg(allow_negative_numbers = true)]
    max_radius: u32,

    /// What counts outside the map (thesis 3.1).
    #[arg(long, value_enum, default_value_t = Edges::Scale)]
    edges: Edges,

    /// How photons in a box are counted (thesis 3.2 to 3.4): auto lets a planner choose by the map, or name one of
    /// brute-force, naive-mipmap, averaged-mipmap, pyramid, sat.
    #[arg(long, default_value = "auto", value_parser = method, value_name = "METHOD")]
    method: MethodChoice,

    /// Order in which radii are tried (thesis 3.5); the naive mipmap has its own. [default: the planner's; with a named
    /// method, bracketed for sat in whole numbers without faults, else binary]
    #[arg(long, value_enum)]
    search: Option<Order>,

    /// How the summed-area table is built: by doubling (thesis 4.2) or by a scan. [default: scan; with a fault or a float:
    /// doubling]
    #[arg(long, value_enum)]
    sat_build: Option<SatBuild>,

    /// Samples a pass when the summed-area table is built by doubling (thesis 4.2).
    /// [default: 4]
    #[arg(long, value_enum)]
    sat_samples: Option<SatSamples>,

    /// Number in which sums are kept; u16 is for the summed-area table, where no box holds 2^16 photons; f16 (up to 2^11 in
    /// all), f32-minus-mean and f32-minus-whole-mean (never proved, so with --allow-inexact only) are for measurements of it.
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

    /// Run with these printed faults only.
    #[arg(long, value_enum, value_delimiter = ',', conflicts_with = "fidelity")]
    fault: Vec<Fault>,

    /// Compute even where sums may round or wrap, to see how wrong it gets.
    #[arg(long)]
    allow_inexact: bool,

    /// Compare with the definition on the CPU; exit 1 on a difference.
    #[arg(long)]
    verify: bool,

    /// Prove the result on the GPU: each radius by two boxes, each table entry by the counts; exit 1 if something is not
    /// proved. For the summed-area table.
    #[arg(long, conflicts_with_all = ["allow_inexact", "mask"])]
    certify: bool,

    /// Also write a map that is 1 where MR ended the search with too few photons, else 0.
    #[arg(long, value_name = "FILE")]
    limited_mask: Option<PathBuf>,

    /// Map of the pixels that need a radius: those that are 0 in it get 0, and cost next to nothing.
    #[arg(long, value_name = "FILE")]
    mask: Option<PathBuf>,

    /// Channel to read if the EXR has several.
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,

    /// OpenGL device: auto, egl, egl:INDEX, osmesa, or part of a renderer's name.
    #[arg(long, default_value_t = DeviceChoice::Auto)]
    device: DeviceChoice,

    /// Print one JSON object instead of a table.
    #[arg(long)]
    json: bool,
}

/// One of the printed faults; what they do is in the library's documentation of `structure`.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Fault {
    /// Listing 4.2: coordinates clamped to 0..63 whatever the size.
    #[value(name = "clamp-to-63")]
    ClampTo63,
    /// Listing 4.2: `> 0` where `>= 0` is meant.
    BorderTest,
    /// Listing 4.2: the lower left added back too often.
    CornerTest,
    /// Listing 4.2: horizontal and vertical passes swapped.
    SwappedAxes,
    /// Listing 4.2: the extension to more than 2 samples.
    SampleStride,
    /// Listing 4.3: strips that are not counted.
    ForgottenStrip,
    /// Section 4.4: a rounded ratio.
    FloatRatio,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Fidelity {
    /// Without the faults.
    Corrected,
    /// With the faults, made well defined.
    AsPrinted,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    // What can be refused without computing is refused first.
    let settings = settings(args);
    let explain = |error| in_words_of_options(error, &args.map);
    settings.validate().map_err(explain)?;
    if args.certify {
        Certificate::check_possible(&settings).map_err(explain)?;
    }
    check_files(args)?;
    let options = ReadOptions { channel: args.channel.as_deref(), ..ReadOptions::default() };
    let counts = read_counts(&args.map, &options)?;
    tracing::info!(map = %args.map.display(), size = %counts.size(), "read");
    let gl = context::open(&args.device)?;
    tracing::info!(renderer = gl.info().renderer, "opened");
    check_fits(args, &counts, gl.info())?;

    let choice = planned(args, settings, &counts);
    let settings = choice.as_ref().map_or(settings, |choice| choice.settings);
    let bounds = match settings.storage {
        Storage::U16 => CountBounds::of_boxes(&counts, settings.search),
        _ => CountBounds::of(&counts, settings.search),
    };
    let density = DensityMap::upload(&gl, &counts, bounds)?;
    let mut pipeline =
        RadiusPipeline::new(&gl, counts.size(), density.format(), settings).map_err(explain)?;
    let plan = pipeline.plan(&density).map_err(explain)?;
    let mask = args.mask.as_ref().map(|path| read_mask(path, &counts)).transpose()?;
    let mask_on_gpu = mask.as_ref().map(|mask| Mask::upload(&gl, mask)).transpose()?;
    let frame = Frame { mask: mask_on_gpu.as_ref(), ..Frame::new(&density) };
    let ((), build) = gl::time(&gl, || pipeline.build(&density))?;
    let (radii, search) = gl::time(&gl, || pipeline.search_frame(&frame))?;
    let radii = reference::Radii {
        radius: radii.read()?,
        limited: radii.read_limited()?.unwrap_or_else(|| unreachable!("the settings ask for the mask")),
    };
    let certificate = args.certify.then(|| pipeline.certify(&density)).transpose().map_err(explain)?;

    let verify = if args.verify {
        let definition = reference::radius_by_table(&counts, settings.search);
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
        planned: choice.as_ref().map(|choice| choice.reason.as_str()),
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

/// The planner's choice, where nothing else is asked for.
fn planned(args: &Args, settings: Settings, counts: &Image<u32>) -> Option<Choice> {
    let is_free = matches!(args.method, MethodChoice::Auto)
        && (args.search, args.sat_build, args.sat_samples, args.variation) == (None, None, None, None)
        && settings.faults == Faults::NONE
        && settings.storage == Storage::U32;
    is_free.then(|| {
        let bounds = CountBounds::of(counts, settings.search);
        planner::choose(&settings, counts.size(), Some(&Census::of(counts)), bounds)
    })
}

/// A mask of the map's size, 1 where a radius is needed.
fn read_mask(path: &Path, counts: &Image<u32>) -> Result<Image<u8>> {
    let mask = read_counts(path, &ReadOptions::default())?;
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
    Ok(mask.map(|value| u8::from(value != 0)))
}

fn whole_number(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| format!("give a whole number from 1 to {}", u32::MAX))
}

/// An error of the library, with the option to change and the file at fault.
fn in_words_of_options(error: Error, map: &Path) -> anyhow::Error {
    match error {
        Error::Setting { name, value, reason } => {
            anyhow!("--{} {value} is not possible: {reason}", name.replace('_', "-"))
        }
        Error::Inexact { reason, remedy } => anyhow!(
            "{}: the result would not be exact: {reason}\nhelp: {remedy}, or add --allow-inexact to see how wrong it gets",
            map.display()
        ),
        other => other.into(),
    }
}

/// Refuses outputs that can't be written, and ones that would replace the map or each other.
fn check_files(args: &Args) -> Result<()> {
    for path in [Some(&args.output), args.limited_mask.as_ref()].into_iter().flatten() {
        Format::of(path)?;
    }
    let outputs =
        [("--output", Some(args.output.as_path())), ("--limited-mask", args.limited_mask.as_deref())];
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

/// A method, or the planner's choice.
#[derive(Clone, Copy, Debug)]
enum MethodChoice {
    Auto,
    Named(Method),
}

fn method(text: &str) -> Result<MethodChoice, String> {
    if text == "auto" {
        return Ok(MethodChoice::Auto);
    }
    Method::from_str(text, false)
        .map(MethodChoice::Named)
        .map_err(|_| "give auto, brute-force, naive-mipmap, averaged-mipmap, pyramid or sat".to_owned())
}

/// What the arguments ask for; where the planner may choose, its choice without a map.
fn settings(args: &Args) -> Settings {
    let method = match args.method {
        MethodChoice::Auto => Method::SummedAreaTable,
        MethodChoice::Named(method) => method,
    };
    let faults = faults(args);
    // The thesis's listings know neither a scan nor brackets, which are for whole numbers.
    let is_ours = method == Method::SummedAreaTable
        && faults == Faults::NONE
        && args.storage.is_integer()
        && args.sat_samples.is_none();
    let (build, order) =
        if is_ours { (SatBuild::Scan, Order::Bracketed) } else { (SatBuild::Doubling, Order::Binary) };
    Settings {
        search: Search {
            min_photons: args.min_photons,
            max_radius: args.max_radius,
            edges: args.edges,
            order: args.search.unwrap_or(order),
        },
        method,
        split: args.split,
        matching: args.matching,
        sat_build: args.sat_build.unwrap_or(build),
        sat_samples: args.sat_samples.unwrap_or(SatSamples::Four),
        storage: args.storage,
        faults,
        variation: args.variation,
        exactness: if args.allow_inexact { Exactness::Waived } else { Exactness::Required },
        limited_mask: true,
        masked: args.mask.is_some(),
    }
}

fn faults(args: &Args) -> Faults {
    let mut faults = match args.fidelity {
        Fidelity::Corrected => Faults::NONE,
        Fidelity::AsPrinted => Faults::AS_PRINTED,
    };
    for fault in &args.fault {
        *match fault {
            Fault::ClampTo63 => &mut faults.clamp_to_63,
            Fault::BorderTest => &mut faults.border_test,
            Fault::CornerTest => &mut faults.corner_test,
            Fault::SwappedAxes => &mut faults.swapped_axes,
            Fault::SampleStride => &mut faults.sample_stride,
            Fault::ForgottenStrip => &mut faults.forgotten_strip,
            Fault::FloatRatio => &mut faults.float_ratio,
        } = true;
    }
    faults
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
