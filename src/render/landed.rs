//! Photons of all surfaces, kept as the light in mirrors and through glass asks for them.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use super::nearest::{PhotonGrid, Width};
use super::photon_sums::PhotonSums;
use super::sight::Place;
use super::widened::widened;
use crate::photon::PhotonPoint;
use crate::settings::{Estimate, IrradianceSettings, Kernel, KernelRadius, Search};
use crate::view::View;

/// How wide the disc of a place in a mirror or behind glass is, in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) enum Wanted {
    /// Up to the n-th photon, and at most as for this radius.
    Holding(u32, u32),
    /// As for this radius.
    Fixed(u32),
    /// As wide as a test of noise allows.
    Tested,
}

impl Wanted {
    /// As what is seen straight.
    pub(super) fn of(settings: &IrradianceSettings) -> Self {
        let Search { min_photons, max_radius, .. } = settings.radii.search;
        match (settings.estimate, settings.radius) {
            (Estimate::Tables, _) => Self::Tested,
            (_, KernelRadius::Variable) => Self::Holding(min_photons, max_radius),
            (_, KernelRadius::Fixed(radius)) => Self::Fixed(radius),
        }
    }
}

/// Photons in an order.
#[derive(Debug)]
pub(super) enum Landed {
    /// For discs that the n-th photon or a radius ends.
    InCells(PhotonGrid),
    /// For those that a test of noise ends.
    Summed(PhotonSums),
}

impl Landed {
    pub(super) fn new(photons: &[PhotonPoint], wanted: Wanted) -> Self {
        match wanted {
            Wanted::Holding(..) | Wanted::Fixed(_) => Self::InCells(PhotonGrid::new(photons)),
            Wanted::Tested => Self::Summed(PhotonSums::new(photons)),
        }
    }

    /// Irradiance at each place; places are in the order of their pixels.
    pub(super) fn irradiance(
        &mut self,
        view: &View,
        places: &[Place],
        wanted: Wanted,
        kernel: Kernel,
    ) -> Vec<DVec3> {
        // The disc of the same area as a box of that radius, if the place were seen straight.
        let disc = |place: &Place, radius: u32| {
            f64::from(2 * radius + 1) * f64::from(view.pixel_side()) * place.distance / PI.sqrt()
        };
        match wanted {
            Wanted::Tested => widened(view, places, self.summed()),
            Wanted::Holding(photons, most) => {
                let (cells, photons) = (self.in_cells(), photons as usize);
                let width = |place| Width::Holding { photons, at_most: disc(place, most) };
                places.par_iter().map(|place| cells.irradiance(place, width(place), kernel)).collect()
            }
            Wanted::Fixed(radius) => {
                let cells = self.in_cells();
                let width = |place| Width::Fixed(disc(place, radius));
                places.par_iter().map(|place| cells.irradiance(place, width(place), kernel)).collect()
            }
        }
    }

    fn in_cells(&mut self) -> &PhotonGrid {
        if let Self::Summed(sums) = self {
            *self = Self::InCells(PhotonGrid::new(sums.photons()));
        }
        match self {
            Self::InCells(grid) => grid,
            Self::Summed(_) => unreachable!("just sorted into cells"),
        }
    }

    fn summed(&mut self) -> &PhotonSums {
        if let Self::InCells(grid) = self {
            *self = Self::Summed(PhotonSums::new(grid.photons()));
        }
        match self {
            Self::Summed(sums) => sums,
            Self::InCells(_) => unreachable!("just summed"),
        }
    }
}
