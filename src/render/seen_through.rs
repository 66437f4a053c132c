//! Indirect light in mirrors and through glass: photons gathered around the places that are seen there.

use std::f64::consts::PI;

use glam::DVec3;

use super::add;
use super::landed::{Landed, Wanted};
use super::sight::Place;
use crate::image::Image;
use crate::settings::Kernel;
use crate::view::View;

/// Indirect light in mirrors and through glass: the photons around each place that is seen there, as
/// irradiance at each place, and what pixels see of it.
pub(super) fn seen_through(
    view: &View,
    bent: &[Place],
    landed: Option<&mut Landed>,
    wanted: Wanted,
    kernel: Kernel,
) -> (Vec<DVec3>, Image<[f32; 4]>) {
    let mut light = Image::filled(view.size(), [0.0; 4]);
    let Some(landed) = landed else { return (vec![DVec3::ZERO; bent.len()], light) };
    let irradiance = landed.irradiance(view, bent, wanted, kernel);
    for (place, &irradiance) in bent.iter().zip(&irradiance) {
        add(&mut light, place.pixel, place.share.as_dvec3() * irradiance / PI);
    }
    (irradiance, light)
}
