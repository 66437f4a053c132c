//! `varikernel figures`: the thesis's Figures 1.2 to 1.4 and ours, on one sheet with their errors.

mod regions;

use std::io::Write;
use std::path::PathBuf;

use anyhow::{Result, bail};
use serde::Serialize;
use varikernel::image::{
    Picture, Tile, check_writable, contact_sheet, picture_of, write_atomically, write_colours,
};
use varikernel::light::TablesStage;
use varikernel::photon::TraceSettings;
use varikernel::render::{Layers, Progress, Renderer};
use varikernel::scene::Scene;
use varikernel::settings::{Estimate, KernelRadius, MAX_PICTURE_RADIUS, PictureSettings};
use varikernel::{Gl, Image};
use varikernel_lab::{LightError, PictureError, ReferenceHalves};

use self::regions::{RegionErrors, Regions};
use super::numbers::whole_checked_later;
use super::photons::load;
use super::render::{Bar, Source};
use super::words::in_words_of_options;
use super::{Outcome, device, output};

/// Fixed radii that are tried for the best one.
const RADII: [u32; 12] = [1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 24, 32];
/// How much too large Figure 1.3 is.
const TOO_LARGE: u32 = 4;

/// The thesis's Figures 1.2 to 1.4 and ours, with the error of each.
///
/// Draws one scene with the best fixed radius (Figure 1.2), one four times as large (1.3), one pixel (1.4),
/// variable ones, and by tables, from the same photons. Errors are those of indirect light against a
/// reference: the photons of each pixel alone, averaged over other seeds; they are also given for the caustics
/// alone, where the reference's indirect irradiance is more than three times its median, and for the other
/// diffuse pixels, the walls; not if the median is 0. The folder gets figures.png, figures.json and each
/// picture.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Folder to write to; made if it is missing.
    #[arg(short, long, default_value = "figures", value_name = "FOLDER")]
    #[arg(help_heading = "Input and output")]
    output: PathBuf,

    #[command(flatten)]
    source: Source,

    /// Seeds that the reference is averaged over.
    #[arg(long, default_value_t = 32, value_name = "NUMBER", allow_negative_numbers = true)]
    #[arg(value_parser = whole_checked_later(2..=u32::MAX))]
    #[arg(help_heading = "Photons")]
    reference_seeds: u32,

    /// Print one JSON object instead of a table.
    #[arg(long)]
    #[arg(help_heading = "Input and output")]
    json: bool,
}

/// One picture of the sheet.
#[derive(Serialize)]
struct Figure {
    name: &'static str,
    /// Splats of this radius, or light from tables.
    #[serde(flatten)]
    way: Way,
    error: PictureError,
    #[serde(flatten)]
    regions: RegionErrors,
    energy_error: f64,
}

/// How a picture's photons become light.
#[derive(Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case", tag = "light", content = "radius")]
enum Way {
    Splat(KernelRadius),
    Tables,
}

/// A fixed radius that was tried.
#[derive(Serialize)]
struct FixedRadius {
    radius: u32,
    error: PictureError,
    #[serde(flatten)]
    regions: RegionErrors,
}

/// The content of figures.json.
#[derive(Serialize)]
struct Report {
    version: &'static str,
    scene: String,
    photons: TraceSettings,
    settings: PictureSettings,
    renderer: String,
    reference_seeds: u32,
    /// How far two halves of the reference's seeds are apart, halved: its own noise. SSIM and FLIP are of the
    /// halves.
    reference_noise: PictureError,
    /// The same in each region.
    reference_noise_of_regions: RegionErrors,
    figures: Vec<Figure>,
    /// Pixels of the caustics, and of the walls.
    region_pixels: [usize; 2],
    /// Every fixed radius that was tried: from 1 up to the first that is worse than the one before by both
    /// measures, in the whole picture and on the walls.
    fixed: Vec<FixedRadius>,
}

pub(crate) fn run(args: &Args) -> Result<Outcome> {
    let source = &args.source;
    if args.reference_seeds < 2 {
        bail!(
            "--reference-seeds {} is not possible: the noise is found from two halves; give at least 2",
            args.reference_seeds
        );
    }
    output::make_folder(&args.output)?;
    check_writable(&args.output.join("figures.png"))?;
    source.check_exposure()?;
    let (settings, trace) = (source.picture(), source.trace());
    settings.validate().and_then(|()| trace.validate()).map_err(in_words_of_options)?;
    let scene = load(&source.scene)?;
    let gl = device::open(&source.device)?;

    let bar = Bar::new();
    let reference = references(args, &gl, &scene, &bar).map_err(in_words_of_options)?;
    let beauty = reference.mean(|layers| &layers.beauty);
    // All pictures are as bright as suits the reference.
    let tone_map = source.tone_map(&beauty);
    let indirect = reference.mean(|layers| &layers.indirect);
    let reference_noise = reference.noise();

    let renderer = Renderer::new(&gl, &scene, &settings, &trace, &mut |progress| bar.show(progress))
        .map_err(in_words_of_options)?;
    let regions = Regions::new(&reference.halves[0].albedo, &reference.mean(|layers| &layers.irradiance));
    let region_pixels = regions.sizes();
    let reference_noise_of_regions = regions.noise(reference.halves.each_ref().map(|half| &half.indirect));
    let mut studio = Studio { renderer, settings, indirect, beauty: beauty.clone(), regions };
    let fixed = studio.fixed_radii(&bar)?;
    let best = fixed
        .iter()
        .min_by(|a, b| a.error.rmse.total_cmp(&b.error.rmse))
        .map_or_else(|| unreachable!("at least one radius was tried"), |best| best.radius);
    let too_large = (best * TOO_LARGE).min(MAX_PICTURE_RADIUS);
    let (mut figures, mut tiles) = (Vec::new(), Vec::new());
    let mut reference = Some(Tile {
        picture: tone_map.apply(&beauty),
        caption: vec![format!("Reference, {} seeds", args.reference_seeds), errors(reference_noise)],
    });
    for (name, file, way) in [
        ("Figure 1.2, well chosen", "figure_1_2.png", Way::Splat(KernelRadius::Fixed(best))),
        ("Figure 1.3, too large", "figure_1_3.png", Way::Splat(KernelRadius::Fixed(too_large))),
        ("Figure 1.4, too small", "figure_1_4.png", Way::Splat(KernelRadius::Fixed(1))),
        ("Variable", "variable.png", Way::Splat(KernelRadius::Variable)),
        ("Tables", "tables.png", Way::Tables),
    ] {
        let (layers, figure) = studio.draw(name, way)?;
        let picture = tone_map.apply(&layers.beauty);
        write_colours(&args.output.join(file), &picture)?;
        tiles.push(Tile { picture, caption: caption(&figure, settings.min_photons) });
        let (title, widest) = match way {
            Way::Splat(KernelRadius::Fixed(_)) => ("", None),
            Way::Splat(KernelRadius::Variable) => ("Its radius map", Some(settings.max_radius)),
            Way::Tables => ("Its widths", Some(TablesStage::WIDEST)),
        };
        if let Some(widest) = widest {
            let colours = Picture { range: Some(1..=widest), ..Picture::default() };
            let caption = vec![title.to_owned(), format!("1 (dark) to {widest} pixels (red)")];
            tiles.push(Tile { picture: picture_of(&layers.radius, &colours), caption });
            // Beside the first of them.
            tiles.extend(reference.take());
        }
        figures.push(figure);
    }
    bar.finish();
    write_colours(&args.output.join("figures.png"), &contact_sheet(&tiles, 3))?;
    let report = Report {
        version: env!("CARGO_PKG_VERSION"),
        scene: scene.title.clone(),
        photons: trace,
        settings,
        renderer: gl.info().renderer.clone(),
        reference_seeds: args.reference_seeds,
        reference_noise,
        reference_noise_of_regions,
        figures,
        region_pixels,
        fixed,
    };
    let text = serde_json::to_string_pretty(&report)?;
    write_atomically(&args.output.join("figures.json"), |file| Write::write_all(file, text.as_bytes()))?;
    if args.json {
        output::print_json(&report)?;
    } else {
        print(&report, args)?;
    }
    Ok(Outcome::Done)
}

/// Two halves of seeds that no picture uses.
fn references(args: &Args, gl: &Gl, scene: &Scene, bar: &Bar) -> varikernel::Result<ReferenceHalves> {
    let (settings, trace) = (args.source.picture(), args.source.trace());
    let of_seed =
        |number: u32| TraceSettings { seed: trace.seed.wrapping_add(1 + u64::from(number)), ..trace };
    let seeds = args.reference_seeds;
    ReferenceHalves::new(gl, scene, &settings, seeds, of_seed, &mut |done| {
        bar.show(Progress { stage: "reference", done: f64::from(done) / f64::from(seeds) });
        Ok(())
    })
}

/// One set of photons, drawn with many radii.
struct Studio {
    renderer: Renderer,
    settings: PictureSettings,
    /// Of the reference.
    indirect: Image<[f32; 3]>,
    beauty: Image<[f32; 3]>,
    regions: Regions,
}

impl Studio {
    fn draw(&mut self, name: &'static str, way: Way) -> Result<(Layers, Figure)> {
        let settings = match way {
            Way::Splat(radius) => PictureSettings { radius, ..self.settings },
            Way::Tables => PictureSettings { estimate: Estimate::Tables, ..self.settings },
        };
        let (layers, account) = self.renderer.picture(&settings)?;
        let error = PictureError::of_light_and_sight(
            [&layers.indirect, &self.indirect],
            [&layers.beauty, &self.beauty],
        );
        let regions = self.regions.errors(&layers.indirect, &self.indirect);
        Ok((layers, Figure { name, way, error, regions, energy_error: account.energy_error() }))
    }

    /// The errors of fixed radii, as far as it makes sense.
    fn fixed_radii(&mut self, bar: &Bar) -> Result<Vec<FixedRadius>> {
        let mut fixed: Vec<FixedRadius> = Vec::new();
        for radius in RADII {
            bar.show(Progress { stage: "fixed radii", done: f64::from(radius) / 32.0 });
            let Figure { error, regions, .. } = self.draw("", Way::Splat(KernelRadius::Fixed(radius)))?.1;
            let is_past = fixed.last().is_some_and(|before| {
                let walls = regions.walls.zip(before.regions.walls);
                let all_worse =
                    error.rmse > before.error.rmse && error.relative_mse > before.error.relative_mse;
                let walls_worse = |(now, before): (LightError, LightError)| {
                    now.rmse > before.rmse && now.relative_mse > before.relative_mse
                };
                all_worse && walls.is_none_or(walls_worse)
            });
            fixed.push(FixedRadius { radius, error, regions });
            // Wide kernels take long, and the error only grows from there on.
            if is_past {
                break;
            }
        }
        Ok(fixed)
    }
}

fn caption(figure: &Figure, min_photons: u32) -> Vec<String> {
    let name = match figure.way {
        Way::Splat(KernelRadius::Fixed(radius)) => format!("{}: radius {radius}", figure.name),
        Way::Splat(KernelRadius::Variable) => format!("{}: n = {min_photons}", figure.name),
        Way::Tables => figure.name.to_owned(),
    };
    let rmse =
        |error: Option<LightError>| error.map_or_else(|| "-".to_owned(), |of| format!("{:.5}", of.rmse));
    let RegionErrors { caustic, walls } = figure.regions;
    vec![name, errors(figure.error), format!("caustic {} walls {}", rmse(caustic), rmse(walls))]
}

fn errors(PictureError { rmse, relative_mse, .. }: PictureError) -> String {
    format!("RMSE {rmse:.5} relMSE {relative_mse:.4}")
}

fn print(report: &Report, args: &Args) -> Result<()> {
    let names = ["picture", "RMSE", "rel. MSE", "SSIM", "FLIP", "caustic", "walls"];
    let mut rows = vec![names.map(str::to_owned)];
    let row = |name: &str, error: PictureError, RegionErrors { caustic, walls }: RegionErrors| {
        let number = |value: f64| format!("{value:.4}");
        let region = |error: Option<LightError>| error.map_or_else(String::new, |of| number(of.rmse));
        let PictureError { rmse, relative_mse, ssim, flip } = error;
        let [rmse, relative_mse, ssim, flip] = [rmse, relative_mse, ssim, flip].map(number);
        [name.to_owned(), rmse, relative_mse, ssim, flip, region(caustic), region(walls)]
    };
    rows.extend(report.figures.iter().map(|figure| row(figure.name, figure.error, figure.regions)));
    rows.extend(report.fixed.iter().map(|of| row(&format!("Radius {}", of.radius), of.error, of.regions)));
    rows.push(row("Reference's own noise", report.reference_noise, report.reference_noise_of_regions));
    output::print_rows(&rows)?;
    output::print(&format!("written: {}", args.output.join("figures.png").display()))
}
