//! The photons around a place, found in a grid of cells: for places that are seen in mirrors and through
//! glass, which no map of the picture holds.

use glam::{DVec3, IVec3, Vec3};

use super::sight::Place;
use crate::photon::PhotonPoint;
use crate::settings::Kernel;

/// Cells along the longest side.
const CELLS: f32 = 128.0;
/// The least cosine between the normals of a photon and a place that it lights.
pub(super) const LEAST_AGREEMENT: f64 = 0.5;

/// How wide the disc around a place is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Width {
    /// Up to the n-th photon, and at most a radius in scene units.
    Holding { photons: usize, at_most: f64 },
    /// A radius in scene units.
    Fixed(f64),
}

/// Photons that tell where most of them are.
const ASKED: usize = 4096;

/// The corners of a box that leaves out at most a hundredth of the photons on each of its sides: a few that
/// land far away would make all cells coarse.
pub(super) fn around_most(photons: &[PhotonPoint]) -> (Vec3, Vec3) {
    let step = photons.len().div_ceil(ASKED).max(1);
    let ends = |axis: usize| {
        let mut at: Vec<f32> = photons.iter().step_by(step).map(|photon| photon.position[axis]).collect();
        at.sort_unstable_by(f32::total_cmp);
        let beyond = at.len() / 100;
        [at.get(beyond), at.iter().rev().nth(beyond)].map(|end| end.copied().unwrap_or_default())
    };
    let [x, y, z] = [ends(0), ends(1), ends(2)];
    (Vec3::new(x[0], y[0], z[0]), Vec3::new(x[1], y[1], z[1]))
}

/// Photons in the order of their cells.
#[derive(Debug)]
pub(super) struct PhotonGrid {
    corner: Vec3,
    cell: f32,
    cells: IVec3,
    /// Where each cell begins, and where the last ends.
    begins: Vec<u32>,
    photons: Vec<PhotonPoint>,
}

impl PhotonGrid {
    /// Sorts photons into cells. The grid holds most of them; those beyond it are in the cells at its border,
    /// which are as near to any place as the photons are, or nearer.
    pub(super) fn new(photons: &[PhotonPoint]) -> Self {
        let (min, max) = around_most(photons);
        let cell = ((max - min).max_element() / CELLS).max(f32::MIN_POSITIVE);
        let cells = ((max - min) / cell).floor().as_ivec3() + 1;
        let mut grid = Self { corner: min, cell, cells, begins: Vec::new(), photons: Vec::new() };
        let count = usize::try_from(cells.element_product()).expect("at most 129 cells a side");
        let mut begins = vec![0_u32; count + 1];
        let at: Vec<usize> = photons.iter().map(|photon| grid.index(grid.cell_of(photon.position))).collect();
        for &cell in &at {
            begins[cell + 1] += 1;
        }
        for cell in 0..count {
            begins[cell + 1] += begins[cell];
        }
        let mut next = begins.clone();
        let mut sorted = photons.to_vec();
        for (photon, &cell) in photons.iter().zip(&at) {
            sorted[next[cell] as usize] = *photon;
            next[cell] += 1;
        }
        (grid.begins, grid.photons) = (begins, sorted);
        grid
    }

    /// In the order of their cells.
    pub(super) fn photons(&self) -> &[PhotonPoint] {
        &self.photons
    }

    fn cell_of(&self, position: Vec3) -> IVec3 {
        ((position - self.corner) / self.cell).floor().as_ivec3().clamp(IVec3::ZERO, self.cells - 1)
    }

    fn index(&self, cell: IVec3) -> usize {
        usize::try_from((cell.z * self.cells.y + cell.y) * self.cells.x + cell.x).expect("inside the grid")
    }

    /// Irradiance at a place by the photons on its surface.
    pub(super) fn irradiance(&self, place: &Place, width: Width, kernel: Kernel) -> DVec3 {
        let (reach, wanted) = match width {
            Width::Holding { photons, at_most } => (at_most, photons),
            Width::Fixed(radius) => (radius, usize::MAX),
        };
        let centre = self.cell_of(place.position.as_vec3());
        let mut found: Vec<(f64, Vec3)> = Vec::new();
        let mut radius_squared = reach * reach;
        for ring in 0.. {
            self.find_in_ring(place, centre, ring, radius_squared, &mut found);
            let complete = f64::from(ring) * f64::from(self.cell);
            if found.len() >= wanted {
                found.select_nth_unstable_by(wanted - 1, |(a, _), (b, _)| a.total_cmp(b));
                radius_squared = radius_squared.min(found[wanted - 1].0);
            }
            if complete * complete >= radius_squared || ring > self.cells.max_element() {
                break;
            }
        }
        if radius_squared == 0.0 {
            return DVec3::ZERO;
        }
        // The photon at which the disc ends is not in it: that makes the estimate right in the mean.
        let inside = found.iter().filter(|(squared, _)| *squared < radius_squared);
        let sum: DVec3 =
            inside.map(|(squared, power)| power.as_dvec3() * kernel.profile(squared / radius_squared)).sum();
        sum / (std::f64::consts::PI * radius_squared * kernel.mean())
    }

    /// Adds the photons of the cells at a distance of `ring` cells.
    fn find_in_ring(
        &self,
        place: &Place,
        centre: IVec3,
        ring: i32,
        radius_squared: f64,
        found: &mut Vec<(f64, Vec3)>,
    ) {
        let (lo, hi) = ((centre - ring).max(IVec3::ZERO), (centre + ring).min(self.cells - 1));
        for z in lo.z..=hi.z {
            for y in lo.y..=hi.y {
                let whole_row = (z - centre.z).abs() == ring || (y - centre.y).abs() == ring;
                let step = if whole_row || ring == 0 { 1 } else { 2 * ring };
                let mut x = if whole_row { lo.x } else { centre.x - ring };
                while x <= hi.x {
                    if x >= lo.x {
                        let cell = self.index(IVec3::new(x, y, z));
                        let photons = self.begins[cell] as usize..self.begins[cell + 1] as usize;
                        for photon in &self.photons[photons] {
                            let squared = photon.position.as_dvec3().distance_squared(place.position);
                            if squared < radius_squared
                                && (photon.surface - place.surface).abs() < 0.5
                                && photon.normal.as_dvec3().dot(place.normal) > LEAST_AGREEMENT
                            {
                                found.push((squared, photon.power));
                            }
                        }
                    }
                    x += step;
                }
            }
        }
    }
}
