//! What comes out of a picture: its layers, and an account of its photons and their energy.

use crate::image::Image;

/// A picture and what led to it, pixel by pixel. Colours are linear RGB radiance.
#[derive(Clone, Debug)]
pub struct Layers {
    /// Direct plus indirect light.
    pub beauty: Image<[f32; 3]>,
    /// Lights that are seen, and their light on diffuse surfaces; also in mirrors and through glass.
    pub direct: Image<[f32; 3]>,
    /// Everything else: what photons brought.
    pub indirect: Image<[f32; 3]>,
    /// Indirect irradiance on diffuse surfaces, before their albedo: power per area.
    pub irradiance: Image<[f32; 3]>,
    /// Photons that contribute to each pixel.
    pub density: Image<f32>,
    /// R, in pixels.
    pub radius: Image<u32>,
    /// 1 where MR ended the search with too few photons, else 0; with a fixed radius nothing is searched, and all are 0.
    pub limited: Image<u8>,
    /// Of length 1 towards the camera; 0 where nothing is seen.
    pub normal: Image<[f32; 3]>,
    /// Depth along the view, in scene units; 0 where nothing is seen.
    pub depth: Image<f32>,
    /// Reflectance of diffuse surfaces.
    pub albedo: Image<[f32; 3]>,
}

/// Energy and numbers of one picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Account {
    /// Photons that were emitted.
    pub emitted: u32,
    /// Their diffuse landings.
    pub landings: u64,
    /// Landings inside of the frame that face the camera and are not direct light: these were uploaded.
    pub uploaded: u64,
    /// Those that contribute: visible on the surface that their pixel shows.
    pub contributing: u64,
    /// Power of the contributing photons, linear RGB.
    pub power_in: [f64; 3],
    /// Irradiance times area, summed over the picture.
    pub power_out: [f64; 3],
    /// Fragments that the splat drew; photons that the gather found.
    pub fragments: f64,
    /// Share of the lights' power that reflection would have sent on after the last landing that was asked for: light that the picture
    /// lacks, and what it would have brought at further landings. Mean of the three colours; 0 for photons that the caller traced.
    pub cut_off_share: f64,
    /// Share of pixels on diffuse surfaces whose search MR ended; 0 with a fixed radius, which asks for no search.
    pub limited_share: f64,
}

impl Account {
    /// By how much power out differs from power in, over power in: the worst of the three colours.
    ///
    /// Both are sums of blending in f32. Power in is one sum for each pixel, which of N alike photons on a pixel is off by up to
    /// N 2^-25 of itself; power out is summed more closely. So where a pixel holds 10^5 photons or more, a larger error may be
    /// that of power in.
    #[must_use]
    pub fn energy_error(&self) -> f64 {
        let pairs = self.power_in.iter().zip(self.power_out);
        pairs
            .map(|(&into, out)| if into > 0.0 { ((out - into) / into).abs() } else { out.abs() })
            .fold(0.0, f64::max)
    }
}
