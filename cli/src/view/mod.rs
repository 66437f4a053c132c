//! `varikernel view`: a window on a scene or a map, and the first host of the library.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "pixels, photons and milliseconds on a screen"
)]

mod app;
mod camera;
mod choices;
mod engine;
mod input;
mod keys;
mod middle;
mod panels;
mod passes;
mod readout;
mod screen;
mod state;
mod times;
mod views;

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use varikernel::context::window;
use varikernel::glam::UVec2;
use varikernel::image::{Format, check_writable};
use varikernel::settings::{Edges, Kernel, KernelRadius, MAX_RADIUS_LIMIT, Method, Order};

use super::light::Light;
use super::numbers::{fraction, whole};
use super::photons::parse_count;
use super::render::parse_radius;
use super::synth::parse_size;
use super::{Outcome, device};
use app::{App, Wishes};
use choices::Choices;
use state::Beside;
use views::View;

const AFTER_HELP: &str = "\
Keys and mouse:
  drag, right drag, wheel   turn the camera, move it sideways, nearer and farther
  R                         the camera back to where the scene put it
  Space                     pause, go on
  1 to 7                    picture, indirect, direct, density, radius, limited, error
  B, S                      snapshot beside the picture; radius map beside it, or nothing
  P, Ctrl+S                 save the picture; save the settings
  F1, Q                     all keys; quit
Scenes, maps, references (a picture as EXR or PNG) and saved settings (JSON) may be dropped on the window.
Without a display, `varikernel render` and `varikernel radius` make the same files.";

/// Open a window on a scene or a map: the picture live, every stage of it, and all settings.
///
/// Photons are traced frame after frame while nothing moves; with a software renderer, fewer in each, so that
/// the window answers.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Args {
    /// A scene file, one of cornell-glass, cornell-boxes, cornell-empty, mirror-ring, water, still-life,
    /// thin-things, a map (EXR, PNG or NPY, counts per pixel), or settings that the window saved (JSON).
    #[arg(default_value = "cornell-glass", value_name = "SCENE|MAP")]
    source: PathBuf,

    /// Columns and rows of a scene's picture.
    #[arg(long, default_value = "512x512", value_parser = parse_size, value_name = "WIDTHxHEIGHT")]
    #[arg(help_heading = "Picture")]
    size: UVec2,

    /// Columns and rows of the window.
    #[arg(long, default_value = "1340x830", value_parser = parse_size, value_name = "WIDTHxHEIGHT")]
    #[arg(help_heading = "Window")]
    window: UVec2,

    /// How a scene's photons become light; options about kernels are for splat and gather.
    #[arg(long, value_enum, default_value_t = Light::Tables)]
    #[arg(help_heading = "Light")]
    light: Light,

    /// n: photons that a kernel or box has to hold [default: 400 for scenes, 25 for maps].
    #[arg(short = 'n', long, value_name = "N")]
    #[arg(value_parser = whole(1..=u32::MAX), allow_negative_numbers = true)]
    #[arg(help_heading = "Kernels")]
    min_photons: Option<u32>,

    /// MR: the largest radius, in pixels [default: 64 for scenes, 32 for maps].
    #[arg(short = 'r', long, value_name = "MR", value_parser = whole(1..=MAX_RADIUS_LIMIT))]
    #[arg(allow_negative_numbers = true)]
    #[arg(help_heading = "Kernels")]
    max_radius: Option<u32>,

    /// Width of the kernels: `variable`, or `fixed:PIXELS` for the same everywhere [default: variable].
    #[arg(long, value_parser = parse_radius, value_name = "RADIUS")]
    #[arg(help_heading = "Kernels")]
    radius: Option<KernelRadius>,

    /// Falloff of a kernel from its middle to its edge [default: silverman].
    #[arg(long, value_enum)]
    #[arg(help_heading = "Kernels")]
    kernel: Option<Kernel>,

    /// Photons of each frame [default: as many as frames of 100 ms have time for].
    #[arg(long, value_parser = parse_count, value_name = "NUMBER", allow_negative_numbers = true)]
    #[arg(help_heading = "Photons")]
    photons_per_frame: Option<u32>,

    /// A whole number; the same seed and photons of each frame give the same picture.
    #[arg(long, default_value_t = 1, value_parser = whole(0..=u64::MAX), allow_negative_numbers = true)]
    #[arg(help_heading = "Photons")]
    seed: u64,

    /// Brightness, in stops: each doubles the light [default: what suits the picture].
    #[arg(long, value_name = "STOPS", value_parser = fraction::<f32>("-1.5"), allow_negative_numbers = true)]
    #[arg(help_heading = "Picture")]
    exposure: Option<f32>,

    /// What is shown first.
    #[arg(long, value_enum)]
    #[arg(help_heading = "Window")]
    view: Option<View>,

    /// What is shown beside it.
    #[arg(long, value_enum, value_name = "VIEW")]
    #[arg(help_heading = "Window")]
    beside: Option<View>,

    /// Where the line between the two is, as a share of the picture's width.
    #[arg(long, default_value_t = 0.5, value_name = "SHARE")]
    #[arg(value_parser = parse_share, allow_negative_numbers = true)]
    #[arg(help_heading = "Window")]
    split: f32,

    /// A picture of the same size that errors are taken against: EXR or PNG.
    #[arg(long, value_name = "FILE")]
    #[arg(help_heading = "Window")]
    reference: Option<PathBuf>,

    /// Stop after so many frames' photons.
    #[arg(long, value_name = "NUMBER", value_parser = whole(1..=u32::MAX), allow_negative_numbers = true)]
    #[arg(help_heading = "Window")]
    frames: Option<u32>,

    /// Save the window as PNG after --frames, and quit.
    #[arg(long, value_name = "FILE", requires = "frames")]
    #[arg(help_heading = "Window")]
    screenshot: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    let choices = choices(args)?;
    if let Some(exposure) = choices.exposure.filter(|exposure| !exposure.is_finite()) {
        bail!("--exposure {exposure} is not possible: give a number of stops");
    }
    if let Some(path) = &args.screenshot {
        if Format::of(path)? != Format::Png {
            bail!("{}: a window is saved as PNG\nhelp: use a file name that ends in .png", path.display());
        }
        check_writable(path)?;
    }
    // A file that is not there is reported before a window opens.
    if !is_settings(&args.source) {
        check_source(Path::new(&choices.source))?;
    }
    let headless = "a window needs a display; `varikernel render` and `varikernel radius` make the same \
                    files without one";
    device::check_for_crashes()?;
    let event_loop = window::event_loop().context(headless)?;
    let wishes = Wishes {
        choices,
        window: args.window.to_array(),
        view: args.view,
        beside: args.beside.map_or(Beside::Nothing, Beside::View),
        split: args.split,
        reference: args.reference.clone(),
        frames: args.frames,
        screenshot: args.screenshot.clone(),
    };
    let mut app = App::new(wishes);
    event_loop.run_app(&mut app).context("the window's events stopped coming")?;
    app.result()?;
    Ok(Outcome::Done)
}

fn parse_share(text: &str) -> Result<f32> {
    match text.parse() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => bail!("give a number from 0 to 1"),
    }
}

fn is_settings(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}

/// Refuses a scene or map that is not there.
fn check_source(path: &Path) -> Result<()> {
    if Format::of(path).is_ok() {
        varikernel::image::read_counts(path, &varikernel::image::ReadOptions::default())?;
    } else {
        super::photons::load(path)?;
    }
    Ok(())
}

/// The options about kernels that were given.
fn kernel_options(args: &Args) -> impl Iterator<Item = &'static str> {
    let given = [
        (args.min_photons.is_some(), "-n"),
        (args.max_radius.is_some(), "-r"),
        (args.radius.is_some(), "--radius"),
        (args.kernel.is_some(), "--kernel"),
    ];
    given.into_iter().filter_map(|(is_given, option)| is_given.then_some(option))
}

fn choices(args: &Args) -> Result<Choices> {
    if is_settings(&args.source) {
        return Choices::load(&args.source);
    }
    let is_map = Format::of(&args.source).is_ok();
    if !is_map {
        args.light.check_kernels(kernel_options(args))?;
    }
    let (n, max) = if is_map { (25, 32) } else { (400, 64) };
    let (variable, fixed_radius) = match args.radius {
        None | Some(KernelRadius::Variable) => (true, 2),
        Some(KernelRadius::Fixed(radius)) => (false, radius),
    };
    Ok(Choices {
        source: args.source.to_string_lossy().into_owned(),
        size: args.size.to_array(),
        light: args.light,
        variable,
        fixed_radius,
        min_photons: args.min_photons.unwrap_or(n),
        max_radius: args.max_radius.unwrap_or(max),
        kernel: args.kernel.unwrap_or(Kernel::Silverman),
        method: Method::SummedAreaTable,
        order: Order::Bracketed,
        edges: Edges::Scale,
        photons_per_frame: args.photons_per_frame.unwrap_or(20_000),
        adapt: args.photons_per_frame.is_none(),
        frame_milliseconds: 100,
        photons: 50_000_000,
        bounces: None,
        seed: args.seed,
        exposure: args.exposure,
        camera: None,
    })
}
