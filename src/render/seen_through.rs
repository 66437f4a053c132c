//! Indirect light in mirrors and through glass: photons gathered around the places that are seen there.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use super::add;
use super::nearest::{PhotonGrid, Width};
use super::sight::Place;
use crate::image::Image;
use crate::settings::{IrradianceSettings, Kernel, KernelRadius, Search};
use crate::view::View;

/// How wide the disc of a place in a mirror or behind glass is, in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) enum Wanted {
    /// Up to the n-th photon, and at most as for this radius.
    Holding(u32, u32),
    /// As for this radius.
    Fixed(u32),
}

impl Wanted {
    /// As wide as the kernels of photons that are seen straight.
    pub(super) fn of(settings: &IrradianceSettings) -> Self {
        let Search { min_photons, max_radius, .. } = settings.radii.search;
        match settings.radius {
            KernelRadius::Variable => Self::Holding(min_photons, max_radius),
            KernelRadius::Fixed(radius) => Self::Fixed(radius),
        }
    }
}

/// Indirect light in mirrors and through glass: the photons around each place that is seen there.
pub(super) fn seen_through(
    view: &View,
    bent: &[Place],
    grid: Option<&PhotonGrid>,
    wanted: Wanted,
    kernel: Kernel,
) -> Image<[f32; 4]> {
    let mut light = Image::filled(view.size(), [0.0; 4]);
    let Some(grid) = grid else { return light };
    let found: Vec<DVec3> = bent
        .par_iter()
        .map(|place| {
            // The disc of the same area as a box of that radius, if the place were seen straight.
            let disc = |radius: u32| {
                f64::from(2 * radius + 1) * f64::from(view.pixel_side()) * place.distance / PI.sqrt()
            };
            let width = match wanted {
                Wanted::Holding(photons, most) => {
                    Width::Holding { photons: photons as usize, at_most: disc(most) }
                }
                Wanted::Fixed(radius) => Width::Fixed(disc(radius)),
            };
            place.share.as_dvec3() * grid.irradiance(place, width, kernel) / PI
        })
        .collect();
    for (place, radiance) in bent.iter().zip(found) {
        add(&mut light, place.pixel, radiance);
    }
    light
}
