//! What comes out of a picture, pixel by pixel.

use crate::image::Image;

/// A picture and what led to it, pixel by pixel. Colours are linear RGB radiance. `beauty`, `direct` and
/// `indirect` are of pixels' areas, as [`antialias`](crate::settings::PictureSettings::antialias) asks; all
/// else is of their middles.
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
    /// 1 where MR ended the search with too few photons, else 0; with a fixed radius nothing is searched, and
    /// all are 0.
    pub limited: Image<u8>,
    /// Of length 1 towards the camera; 0 where nothing is seen.
    pub normal: Image<[f32; 3]>,
    /// Depth along the view, in scene units; 0 where nothing is seen.
    pub depth: Image<f32>,
    /// Reflectance of diffuse surfaces.
    pub albedo: Image<[f32; 3]>,
}
