//! `varikernel render`: a scene in, a picture out.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use glam::UVec2;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use varikernel::context::{self, DeviceChoice};
use varikernel::gl::DeviceInfo;
use varikernel::image::{Attribute, Format, LayerFile, ToneMap, check_writable, write_colours};
use varikernel::photon::TraceSettings;
use varikernel::render::{Account, Layers, Progress, Reference, Renderer};
use varikernel::scene::Scene;
use varikernel::settings::{DirectLight, Estimate, FirstBounce, Kernel, PictureSettings, RadiusChoice};
use varikernel::{Error, Gl, Image};

use super::photons::{load, parse_count};
use super::synth::parse_size;
use super::{Outcome, output};

/// A reference that takes long is saved as often as this.
const SAVE_EVERY: Duration = Duration::from_secs(20);

/// Render a scene by photons whose kernels fit their density.
///
/// Direct light is traced with soft shadows; all other light is photons, drawn over as many pixels as it takes to hold n of
/// them. What is seen in mirrors and through glass is gathered around each place that is seen there.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    pub(super) source: Source,

    /// Picture to write: .exr (linear, with layers), or .png (tone-mapped).
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,

    /// Width of the kernels: `variable`, or `fixed:PIXELS` for the same everywhere.
    #[arg(long, default_value = "variable", value_parser = parse_radius, value_name = "RADIUS")]
    radius: RadiusChoice,

    /// Let each pixel gather the photons around it, instead of drawing each photon over the pixels around it.
    #[arg(long)]
    gather: bool,

    /// With --gather: take (c - 1) / c of what c photons give, as a radius that ends at a photon asks for.
    #[arg(long, requires = "gather")]
    count_correction: bool,

    /// Make a reference: each pixel keeps its own photons only, averaged over this many seeds, saved as it goes.
    #[arg(long, value_name = "SEEDS", num_args = 0..=1, default_missing_value = "16")]
    #[arg(conflicts_with_all = ["gather", "radius"])]
    reference: Option<u32>,

    /// How direct light finds what is in its way: by shadow rays, or by shadow maps around --light-samples places on each
    /// area light (thesis 2.2).
    #[arg(long, value_enum, default_value_t = DirectLight::Traced)]
    direct: DirectLight,

    /// How photons find what they meet first: by a ray each, or from maps rasterised from the lights (thesis 2.6.1).
    #[arg(long, value_enum, default_value_t = FirstBounce::Rays)]
    first_bounce: FirstBounce,

    /// Print one JSON object instead of a table.
    #[arg(long)]
    json: bool,
}

/// What is rendered, and with how many photons; `figures` takes the same.
#[derive(Debug, clap::Args)]
pub(super) struct Source {
    /// A scene file, or one of: cornell-glass, cornell-boxes, cornell-empty, mirror-ring, water.
    #[arg(default_value = "cornell-glass")]
    pub(super) scene: PathBuf,

    /// Columns and rows.
    #[arg(long, default_value = "512x512", value_parser = parse_size, value_name = "WIDTHxHEIGHT")]
    pub(super) size: UVec2,

    /// Photons that leave the lights; 1e6 is a million.
    #[arg(long, default_value = "1e6", value_parser = parse_count, value_name = "NUMBER")]
    pub(super) photons: u32,

    /// Diffuse landings after which a photon is followed no further.
    #[arg(long, default_value_t = 8, value_name = "NUMBER")]
    pub(super) bounces: u32,

    /// A whole number; the same seed gives the same picture.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true)]
    pub(super) seed: u64,

    /// n: photons that a kernel has to hold, at least 1.
    #[arg(short = 'n', long, default_value_t = 400, value_name = "N", allow_negative_numbers = true)]
    pub(super) min_photons: u32,

    /// MR: the largest radius, in pixels, 1 to 96.
    #[arg(short = 'r', long, default_value_t = 64, value_name = "MR", allow_negative_numbers = true)]
    pub(super) max_radius: u32,

    /// Falloff of a kernel from its middle to its edge.
    #[arg(long, value_enum, default_value_t = Kernel::Silverman)]
    pub(super) kernel: Kernel,

    /// Shadow rays for each pixel and area light; places with shadow maps on each, with --direct shadow-map.
    #[arg(long, default_value_t = 16, value_name = "NUMBER")]
    pub(super) light_samples: u32,

    /// Brightness of a PNG, in stops: each doubles the light [default: what suits the picture].
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true)]
    pub(super) exposure: Option<f32>,

    /// OpenGL device: auto, egl, egl:INDEX, osmesa, or part of a renderer's name.
    #[arg(long, default_value_t = DeviceChoice::Auto)]
    pub(super) device: DeviceChoice,
}

impl Source {
    pub(super) fn trace(&self) -> TraceSettings {
        let (photons, bounces, seed) = (self.photons, self.bounces, self.seed);
        TraceSettings { photons, bounces, seed, ..TraceSettings::default() }
    }

    pub(super) fn picture(&self) -> PictureSettings {
        PictureSettings {
            size: self.size,
            min_photons: self.min_photons,
            max_radius: self.max_radius,
            kernel: self.kernel,
            light_samples: self.light_samples,
            seed: self.seed,
            ..PictureSettings::default()
        }
    }

    /// Refuses an exposure that is no number.
    pub(super) fn check_exposure(&self) -> Result<()> {
        match self.exposure {
            Some(exposure) if !exposure.is_finite() => {
                bail!("--exposure {exposure} is not possible: give a number of stops")
            }
            _ => Ok(()),
        }
    }

    pub(super) fn tone_map(&self, picture: &Image<[f32; 3]>) -> ToneMap {
        let fitting = ToneMap::fitting(picture);
        ToneMap { exposure: self.exposure.unwrap_or(fitting.exposure), ..fitting }
    }
}

/// The answer of `--json`.
#[derive(Serialize)]
struct Report<'a> {
    version: &'static str,
    scene: &'a str,
    output: &'a Path,
    settings: PictureSettings,
    photons: TraceSettings,
    device: &'a DeviceInfo,
    account: Account,
    energy_error: f64,
    seconds: f64,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    check_output(&args.output)?;
    args.source.check_exposure()?;
    let trace = args.source.trace();
    let settings = PictureSettings {
        radius: args.radius,
        first_bounce: args.first_bounce,
        direct: args.direct,
        estimate: if args.gather {
            Estimate::Gather { count_correction: args.count_correction }
        } else {
            Estimate::Splat
        },
        ..args.source.picture()
    };
    settings.validate().and_then(|()| trace.validate()).map_err(in_words_of_options)?;
    let scene = load(&args.source.scene)?;
    let gl = context::open(&args.source.device)?;

    if let Some(seeds) = args.reference {
        return render_reference(args, &gl, &scene, &settings, seeds);
    }

    let begun = Instant::now();
    let bar = Bar::new();
    let mut renderer = Renderer::new(&gl, &scene, &settings, &trace, &mut |progress| bar.show(progress))
        .map_err(in_words_of_options)?;
    bar.show(Progress { stage: "picture", done: 0.0 });
    let (layers, account) = renderer.picture(&settings)?;
    bar.finish();
    write(args, &layers, &attributes(args, &scene.title))?;
    let report = Report {
        version: env!("CARGO_PKG_VERSION"),
        scene: &scene.title,
        output: &args.output,
        settings,
        photons: trace,
        device: gl.info(),
        account,
        energy_error: account.energy_error(),
        seconds: begun.elapsed().as_secs_f64(),
    };
    if args.json {
        output::print_json(&report)?;
    } else {
        print(&report)?;
    }
    Ok(Outcome::Done)
}

/// Averages seeds, and writes the picture again where the last time is long ago.
fn render_reference(
    args: &Args,
    gl: &Gl,
    scene: &Scene,
    settings: &PictureSettings,
    seeds: u32,
) -> Result<Outcome> {
    if seeds == 0 {
        bail!("--reference 0 is not possible: a mean takes at least 1 seed");
    }
    let trace = args.source.trace();
    let bar = Bar::new();
    let mut reference = Reference::new(gl, scene, settings, &mut |progress| bar.show(progress))?;
    let mut saved = Instant::now();
    let mut attributes = attributes(args, &scene.title);
    attributes.push(Attribute::integer("varikernel.reference_seeds", seeds));
    for seed in 0..seeds {
        let trace = TraceSettings { seed: trace.seed.wrapping_add(u64::from(seed)), ..trace };
        let mut show = |Progress { done, .. }: Progress| {
            let done = (f64::from(seed) + done) / f64::from(seeds);
            bar.show(Progress { stage: "reference", done });
        };
        reference.add_seed(scene, &trace, &mut show).map_err(in_words_of_options)?;
        if seed + 1 == seeds || saved.elapsed() > SAVE_EVERY {
            write(args, &reference.picture()?, &attributes)?;
            saved = Instant::now();
        }
    }
    bar.finish();
    if args.json {
        let report = serde_json::json!({
            "version": env!("CARGO_PKG_VERSION"),
            "scene": scene.title,
            "output": args.output,
            "photons": trace,
            "reference_seeds": seeds,
        });
        output::print_json(&report)?;
    } else {
        output::print_facts(&[
            ("scene", scene.title.clone()),
            ("reference", format!("{seeds} seeds of {} photons", trace.photons)),
            ("written", args.output.display().to_string()),
        ])?;
    }
    Ok(Outcome::Done)
}

/// Refuses what is neither .exr nor .png, and what can't be written.
pub(super) fn check_output(path: &Path) -> Result<()> {
    if Format::of(path)? == Format::Npy {
        bail!(
            "{}: a picture is written as EXR or PNG\nhelp: use a file name that ends in .exr or .png",
            path.display()
        );
    }
    Ok(check_writable(path)?)
}

pub(super) fn in_words_of_options(error: Error) -> anyhow::Error {
    match error {
        Error::Setting { name, value, reason } => {
            anyhow::anyhow!("--{} {value} is not possible: {reason}", name.replace('_', "-"))
        }
        other => other.into(),
    }
}

/// A bar that names the stage.
pub(super) struct Bar(ProgressBar);

impl Bar {
    pub(super) fn new() -> Self {
        let style = ProgressStyle::with_template("{msg:14} {wide_bar} {percent} %");
        let bar = ProgressBar::new(1000);
        Self(bar.with_style(style.unwrap_or_else(|error| unreachable!("a fixed template: {error}"))))
    }

    pub(super) fn show(&self, progress: Progress) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of 1000")]
        self.0.set_position((1000.0 * progress.done) as u64);
        self.0.set_message(progress.stage);
    }

    pub(super) fn finish(&self) {
        self.0.finish_and_clear();
    }
}

fn write(args: &Args, layers: &Layers, attributes: &[Attribute]) -> Result<()> {
    let path = &args.output;
    if Format::of(path)? == Format::Png {
        return Ok(write_colours(path, &args.source.tone_map(&layers.beauty).apply(&layers.beauty))?);
    }
    let (rgb, xyz) = (['R', 'G', 'B'], ['X', 'Y', 'Z']);
    #[expect(clippy::cast_precision_loss, reason = "radii are at most 96")]
    let radius = layers.radius.map(|radius| radius as f32);
    let file = LayerFile::new(layers.beauty.size())
        .colours("", rgb, &layers.beauty)
        .colours("direct", rgb, &layers.direct)
        .colours("indirect", rgb, &layers.indirect)
        .colours("albedo", rgb, &layers.albedo)
        .colours("normal", xyz, &layers.normal)
        .values("density", &layers.density)
        .values("radius", &radius)
        .values("limited", &layers.limited.map(f32::from))
        .values("depth", &layers.depth);
    Ok(file.write(path, attributes)?)
}

/// What made the picture, for its file.
fn attributes(args: &Args, scene: &str) -> Vec<Attribute> {
    let source = &args.source;
    vec![
        Attribute::text("varikernel.scene", scene),
        Attribute::integer("varikernel.photons", source.photons),
        Attribute::integer("varikernel.bounces", source.bounces),
        Attribute::text("varikernel.seed", source.seed.to_string()),
        Attribute::integer("varikernel.min_photons", source.min_photons),
        Attribute::integer("varikernel.max_radius", source.max_radius),
        Attribute::text("varikernel.radius", format!("{:?}", args.radius)),
        Attribute::text("varikernel.kernel", format!("{:?}", source.kernel)),
        Attribute::text("varikernel.version", env!("CARGO_PKG_VERSION")),
    ]
}

fn print(report: &Report<'_>) -> Result<()> {
    let Account { emitted, landings, uploaded, contributing, fragments, limited_share, .. } = report.account;
    #[expect(clippy::cast_precision_loss, reason = "counts are below 2^53")]
    let share = 100.0 * contributing as f64 / (landings as f64).max(1.0);
    output::print_facts(&[
        ("scene", report.scene.to_owned()),
        ("renderer", report.device.renderer.clone()),
        ("photons", format!("{emitted} with {landings} landings, {uploaded} uploaded")),
        ("contributing", format!("{contributing}, {share:.1} % of the landings")),
        (
            "fragments",
            format!("{:.1} a contributing photon", fragments / (contributing_or_one(contributing))),
        ),
        ("limited", format!("{:.3} % of the pixels found too few photons", 100.0 * limited_share)),
        ("energy", format!("kept to {:.1e}", report.energy_error)),
        ("time", format!("{:.1} s", report.seconds)),
        ("written", report.output.display().to_string()),
    ])
}

#[expect(clippy::cast_precision_loss, reason = "counts are below 2^53")]
fn contributing_or_one(count: u64) -> f64 {
    count.max(1) as f64
}

/// `variable` or `fixed:3`.
fn parse_radius(text: &str) -> Result<RadiusChoice> {
    if text == "variable" {
        return Ok(RadiusChoice::Variable);
    }
    match text.strip_prefix("fixed:").and_then(|pixels| pixels.parse().ok()) {
        Some(pixels) => Ok(RadiusChoice::Fixed(pixels)),
        None => bail!("give `variable`, or `fixed:` and a whole number of pixels"),
    }
}
