//! Indirect light in mirrors and through glass: photons gathered around the places that are seen there.

use std::f64::consts::PI;

use super::add;
use super::landed::{Landed, Wanted};
use super::sight::Place;
use crate::image::Image;
use crate::settings::Kernel;
use crate::view::View;

/// Indirect light in mirrors and through glass: the photons around each place that is seen there.
pub(super) fn seen_through(
    view: &View,
    bent: &[Place],
    landed: Option<&mut Landed>,
    wanted: Wanted,
    kernel: Kernel,
) -> Image<[f32; 4]> {
    let mut light = Image::filled(view.size(), [0.0; 4]);
    let Some(landed) = landed else { return light };
    for (place, irradiance) in bent.iter().zip(landed.irradiance(view, bent, wanted, kernel)) {
        add(&mut light, place.pixel, place.share.as_dvec3() * irradiance / PI);
    }
    light
}
