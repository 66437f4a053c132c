//! `varikernel render`: a scene in, a picture out.

mod bar;
mod files;
mod reference;
mod report;
mod source;
mod stages;

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use varikernel::image::{Format, check_writable};
use varikernel::render::{Layers, Progress, Renderer};
use varikernel::settings::{DirectLight, Estimate, FirstBounce, KernelRadius, PictureSettings};

pub(super) use bar::Bar;
pub(super) use source::Source;

use self::files::{attributes, write};
use self::report::Report;
use self::stages::Stages;
use super::light::Light;
use super::numbers::whole_checked_later;
use super::photons::load;
use super::words::in_words_of_options;
use super::{Outcome, device, output};

/// Render a scene by photons.
///
/// Direct light is traced with soft shadows; all other light is photons, gathered at each pixel from as many
/// pixels around it as have the same light but for noise, or, with --light splat, drawn over as many pixels as
/// it takes to hold n of them. What is seen in mirrors and through glass is gathered around each place that
/// is seen there.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Picture to write: .exr (linear, with layers), or .png (tone-mapped).
    #[arg(short, long, value_name = "FILE")]
    #[arg(help_heading = "Input and output")]
    output: PathBuf,

    #[command(flatten)]
    pub(super) source: Source,

    /// Width of the kernels: `variable`, or `fixed:PIXELS` for the same everywhere [default: variable].
    #[arg(long, value_parser = parse_radius, value_name = "RADIUS")]
    #[arg(help_heading = "Kernels")]
    radius: Option<KernelRadius>,

    /// How photons become light.
    #[arg(long, value_enum, default_value_t = Light::Tables)]
    #[arg(help_heading = "Light")]
    light: Light,

    /// With --light gather: take (c - 1) / c of what c photons give, as a radius that ends at a photon asks for.
    #[arg(long)]
    #[arg(help_heading = "Kernels")]
    count_correction: bool,

    /// Make a reference: each pixel keeps its own photons only, averaged over this many seeds, saved as it
    /// goes. The seeds are those after --seed, so that it holds no photon of the picture that it is compared
    /// with. Nothing is spread, and pixels show what their middles do, so that options about kernels and
    /// edges are refused.
    #[arg(long, value_name = "SEEDS", num_args = 0..=1, default_missing_value = "16")]
    #[arg(allow_negative_numbers = true)]
    #[arg(value_parser = whole_checked_later(1..=u32::MAX))]
    #[arg(conflicts_with_all = ["light", "radius", "first_bounce", "kernel", "min_photons", "max_radius"])]
    #[arg(conflicts_with_all = ["antialias", "filter"])]
    #[arg(help_heading = "Photons")]
    reference: Option<u32>,

    /// How direct light finds what is in its way: by shadow rays, or by shadow maps around --light-samples
    /// places on each area light (thesis 2.2).
    #[arg(long, value_enum, default_value_t = DirectLight::Traced)]
    #[arg(help_heading = "Direct light")]
    direct: DirectLight,

    /// How photons find what they meet first: by a ray each, or from maps rasterised from the lights (thesis
    /// 2.6.1).
    #[arg(long, value_enum, default_value_t = FirstBounce::Rays)]
    #[arg(help_heading = "Photons")]
    first_bounce: FirstBounce,

    /// Print one JSON object instead of a table.
    #[arg(long)]
    #[arg(help_heading = "Input and output")]
    json: bool,
}

impl Args {
    fn estimate(&self) -> Estimate {
        self.light.estimate(self.count_correction)
    }

    /// Refuses what light from tables does not ask for.
    fn check_kernel_options(&self) -> Result<()> {
        if self.count_correction && self.light != Light::Gather {
            bail!("--count-correction is for gathers\nhelp: add --light gather");
        }
        // A reference refuses them itself.
        let radius = self.radius.map(|_| "--radius");
        self.light.check_kernels(self.source.kernel_options().chain(radius))
    }
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    check_output(&args.output)?;
    args.source.check_exposure()?;
    let trace = args.source.trace();
    let settings = PictureSettings {
        radius: args.radius.unwrap_or(KernelRadius::Variable),
        first_bounce: args.first_bounce,
        direct: args.direct,
        estimate: args.estimate(),
        ..args.source.picture()
    };
    settings.validate().and_then(|()| trace.validate()).map_err(in_words_of_options)?;
    args.check_kernel_options()?;
    let scene = load(&args.source.scene)?;
    let gl = device::open(&args.source.device)?;

    if let Some(seeds) = args.reference {
        return reference::render(args, &gl, &scene, &settings, seeds);
    }

    let bar = Bar::new();
    let mut stages = Stages::new("surfaces");
    let mut show = |progress: Progress| {
        stages.enter(progress.stage);
        bar.show(progress);
    };
    let mut renderer =
        Renderer::new(&gl, &scene, &settings, &trace, &mut show).map_err(in_words_of_options)?;
    show(Progress { stage: "light", done: 0.0 });
    let (layers, account) = renderer.picture(&settings)?;
    bar.finish();
    stages.enter("file");
    write(args, &layers, &attributes(args, &settings, &scene.title))?;
    let stages = stages.end();
    let report = Report {
        version: env!("CARGO_PKG_VERSION"),
        scene: &scene.title,
        output: &args.output,
        settings,
        photons: trace,
        device: gl.info(),
        account,
        energy_error: account.energy_error(),
        mean_radius: mean_radius(&layers),
        seconds: stages.iter().map(|stage| stage.seconds).sum(),
        stages,
    };
    if args.json {
        output::print_json(&report)?;
    } else {
        report::print(&report)?;
    }
    Ok(Outcome::Done)
}

/// Mean radius of the pixels that photons light, in pixels.
fn mean_radius(layers: &Layers) -> f64 {
    let lit = layers
        .radius
        .values()
        .iter()
        .zip(layers.albedo.values())
        .filter(|(_, albedo)| albedo.iter().any(|&share| share > 0.0));
    let (sum, count) =
        lit.fold((0.0, 0.0), |(sum, count), (&radius, _)| (sum + f64::from(radius), count + 1.0));
    sum / f64::max(count, 1.0)
}

/// Refuses what is neither .exr nor .png, and what can't be written.
fn check_output(path: &Path) -> Result<()> {
    if Format::of(path)? == Format::Npy {
        bail!(
            "{}: a picture is written as EXR or PNG\nhelp: use a file name that ends in .exr or .png",
            path.display()
        );
    }
    Ok(check_writable(path)?)
}

/// `variable` or `fixed:3`.
pub(super) fn parse_radius(text: &str) -> Result<KernelRadius> {
    if text == "variable" {
        return Ok(KernelRadius::Variable);
    }
    match text.strip_prefix("fixed:").and_then(|pixels| pixels.parse().ok()) {
        Some(pixels) => Ok(KernelRadius::Fixed(pixels)),
        None => bail!("give `variable`, or `fixed:` and a whole number of pixels"),
    }
}
