//! The options that say what is rendered, and with how many photons.

use std::path::PathBuf;

use anyhow::{Result, bail};
use glam::UVec2;
use varikernel::Image;
use varikernel::context::DeviceChoice;
use varikernel::image::ToneMap;
use varikernel::photon::TraceSettings;
use varikernel::settings::{
    Kernel, MAX_PICTURE_RADIUS, MOST_ANTIALIAS, MOST_LIGHT_SAMPLES, PictureSettings, PixelFilter,
};

use crate::numbers::{fraction, whole, whole_checked_later};
use crate::photons::{bounces_help, parse_count};
use crate::synth::parse_size;

/// What is rendered, and with how many photons; `figures` takes the same.
#[derive(Debug, clap::Args)]
pub(crate) struct Source {
    /// A scene file, or one of: cornell-glass, cornell-boxes, cornell-empty, mirror-ring, water, still-life,
    /// thin-things.
    #[arg(default_value = "cornell-glass")]
    pub(crate) scene: PathBuf,

    /// Columns and rows.
    #[arg(long, default_value = "512x512", value_parser = parse_size, value_name = "WIDTHxHEIGHT")]
    #[arg(help_heading = "Picture")]
    pub(crate) size: UVec2,

    /// Photons that leave the lights; 1e6 is a million.
    #[arg(long, default_value = "1e6", value_name = "NUMBER")]
    #[arg(value_parser = parse_count, allow_negative_numbers = true)]
    #[arg(help_heading = "Photons")]
    pub(crate) photons: u32,

    #[arg(help = bounces_help())]
    #[arg(long, value_name = "NUMBER", value_parser = whole_checked_later(1..=u32::MAX))]
    #[arg(allow_negative_numbers = true)]
    #[arg(help_heading = "Photons")]
    pub(crate) bounces: Option<u32>,

    /// A whole number; the same seed gives the same picture.
    #[arg(long, default_value_t = 1, value_parser = whole(0..=u64::MAX), allow_negative_numbers = true)]
    #[arg(help_heading = "Photons")]
    pub(crate) seed: u64,

    /// n: photons that a kernel has to hold, at least 1 [default: 400].
    #[arg(short = 'n', long, value_name = "N", allow_negative_numbers = true)]
    #[arg(value_parser = whole_checked_later(1..=u32::MAX))]
    #[arg(help_heading = "Kernels")]
    pub(crate) min_photons: Option<u32>,

    #[arg(help = format!("MR: the largest radius, in pixels, 1 to {MAX_PICTURE_RADIUS} [default: 64]"))]
    #[arg(short = 'r', long, value_name = "MR", allow_negative_numbers = true)]
    #[arg(value_parser = whole_checked_later(1..=MAX_PICTURE_RADIUS))]
    #[arg(help_heading = "Kernels")]
    pub(crate) max_radius: Option<u32>,

    /// Falloff of a kernel from its middle to its edge [default: silverman].
    #[arg(long, value_enum)]
    #[arg(help_heading = "Kernels")]
    pub(crate) kernel: Option<Kernel>,

    /// Shadow rays of a pixel in penumbra to each area light, up to 16 times as many where they are noisy; places
    /// with shadow maps on each light, with --direct shadow-map. At most 4096.
    #[arg(long, default_value_t = 16, value_name = "NUMBER", allow_negative_numbers = true)]
    #[arg(value_parser = whole_checked_later(1..=MOST_LIGHT_SAMPLES))]
    #[arg(help_heading = "Direct light")]
    pub(crate) light_samples: u32,

    #[arg(help = format!("Samples of a pixel at an edge, 1 to {MOST_ANTIALIAS}; 1 shows what pixels' middles do"))]
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true)]
    #[arg(default_value_t = PictureSettings::default().antialias)]
    #[arg(value_parser = whole_checked_later(1..=MOST_ANTIALIAS))]
    #[arg(help_heading = "Picture")]
    pub(crate) antialias: u32,

    /// How a pixel weighs the light around its middle.
    #[arg(long, value_enum, default_value_t)]
    #[arg(help_heading = "Picture")]
    pub(crate) filter: PixelFilter,

    /// Brightness of a PNG, in stops: each doubles the light [default: what suits the picture].
    #[arg(long, value_name = "STOPS", value_parser = fraction::<f32>("-1.5"), allow_negative_numbers = true)]
    #[arg(help_heading = "Picture")]
    pub(crate) exposure: Option<f32>,

    /// OpenGL device: auto, egl, egl:INDEX, osmesa, or part of a renderer's name.
    #[arg(long, default_value_t = DeviceChoice::Auto)]
    pub(crate) device: DeviceChoice,
}

impl Source {
    pub(crate) fn trace(&self) -> TraceSettings {
        let (photons, bounces, seed) = (self.photons, self.bounces, self.seed);
        TraceSettings { photons, bounces, seed, ..TraceSettings::default() }
    }

    pub(crate) fn picture(&self) -> PictureSettings {
        let usual = PictureSettings::default();
        PictureSettings {
            size: self.size,
            min_photons: self.min_photons.unwrap_or(usual.min_photons),
            max_radius: self.max_radius.unwrap_or(usual.max_radius),
            kernel: self.kernel.unwrap_or(usual.kernel),
            light_samples: self.light_samples,
            antialias: self.antialias,
            filter: self.filter,
            seed: self.seed,
            ..usual
        }
    }

    /// The options about kernels that were given.
    pub(crate) fn kernel_options(&self) -> impl Iterator<Item = &'static str> {
        let given = [
            (self.min_photons.is_some(), "-n"),
            (self.max_radius.is_some(), "-r"),
            (self.kernel.is_some(), "--kernel"),
        ];
        given.into_iter().filter_map(|(is_given, option)| is_given.then_some(option))
    }

    /// Refuses an exposure that is no number.
    pub(crate) fn check_exposure(&self) -> Result<()> {
        match self.exposure {
            Some(exposure) if !exposure.is_finite() => {
                bail!("--exposure {exposure} is not possible: give a number of stops")
            }
            _ => Ok(()),
        }
    }

    pub(crate) fn tone_map(&self, picture: &Image<[f32; 3]>) -> ToneMap {
        let fitting = ToneMap::fitting(picture);
        ToneMap { exposure: self.exposure.unwrap_or(fitting.exposure), ..fitting }
    }
}
