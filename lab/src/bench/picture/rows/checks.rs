//! Whether the answer of a row is right.

use glam::UVec2;

use varikernel::error::{Error, Result};
use varikernel::image::Image;
use varikernel::maps::FluxUnits;
use varikernel::photon::{Emission, Ends, trace_in_batches};
use varikernel::reference::tables::Tables;
use varikernel::reference::{self, Shown};

use super::{Rows, Work};

/// By how much gathered light may differ from the definition's, as a share of it: a photon on a border counts
/// in either pixel.
const GATHERED: f64 = 2e-3;
/// Pixels at which the definition, which is slow, gathers too.
const SAMPLED: u32 = 61;
/// What a splat may lose or gain of its photons' power, as a share.
const ENERGY: f64 = 1e-4;

impl Rows<'_> {
    /// Whether some pixels gather what the definition says.
    pub(super) fn is_gathered(&mut self) -> Result<bool> {
        let irradiance = self.light_of(Work::Gather)?;
        let radii = self.found_radii()?;
        let power = reference::photon_power(&self.shown, &self.seen);
        let density = reference::photon_density(&self.shown, &self.seen);
        let UVec2 { x: width, y: height } = self.settings.size;
        // An odd step does not stay in one column.
        let step = (width * height / SAMPLED) | 1;
        let mut pairs = Vec::new();
        for index in (0..width * height).step_by(step as usize) {
            let pixel = UVec2::new(index % width, index / width);
            let radius = radii.at(pixel.x, pixel.y);
            let (expected, _) =
                reference::gather_at(&self.shown, pixel, &power, &density, radius, self.settings.kernel);
            pairs.extend(irradiance.at(pixel.x, pixel.y).into_iter().zip(expected));
        }
        Ok(is_light_right(&pairs))
    }

    /// Whether the flux of all pixels is the photons' power.
    pub(super) fn is_flux_right(&mut self) -> Result<bool> {
        self.tables.count()?;
        let flux = self.tables.pipeline().flux().unwrap_or_else(|| unreachable!("made for tables"));
        let power = reference::photon_power(&self.shown, &self.seen);
        let flux = flux.read()?;
        #[expect(clippy::cast_possible_truncation, reason = "what is compared is of f32")]
        let pairs = flux
            .values()
            .iter()
            .zip(power.values())
            .flat_map(|(found, power)| (0..3).map(|colour| (found[colour] as f32, power[colour])));
        Ok(is_light_right(&pairs.collect::<Vec<_>>()))
    }

    /// Whether light from tables is what its definition says.
    pub(super) fn is_tabled(&mut self) -> Result<bool> {
        let found = self.tables.spread()?.read()?;
        let flux = self.tables.pipeline().flux().unwrap_or_else(|| unreachable!("made for tables"));
        let FluxUnits { power, square_root } = flux.units();
        let units = [power, square_root].map(f64::from);
        #[expect(clippy::cast_precision_loss, reason = "a mean")]
        let mean_square = flux.totals().squares / flux.totals().count.max(1) as f64;
        let Shown { view, position, normal } = &self.shown;
        let (given, unit) = Tables::of(view, [position, normal], &flux.read_units()?, units, mean_square);
        let expected = given.gather();
        let pairs = found.values().iter().zip(expected.values());
        let pairs = pairs.flat_map(|(found, expected)| found.iter().copied().zip(expected.light));
        Ok(is_light_right(&pairs.map(|(found, expected)| (found, unit * expected)).collect::<Vec<_>>()))
    }

    /// Whether every photon is followed to an end, and all landings that are tallied are handed out.
    pub(super) fn is_told(&self) -> Result<bool> {
        let mut landings = 0;
        let emission = Emission::new(self.scene, &self.trace)?;
        let tally = trace_in_batches(self.scene, &emission, |photons, _| {
            landings += photons.len() as u64;
            Ok::<(), Error>(())
        })?;
        let Ends { left, absorbed, bounces_used, given_up } = tally.ends;
        let ended = left + absorbed + bounces_used + given_up;
        let asked = u64::from(self.trace.photons);
        Ok(tally.photons == asked && ended == asked && tally.total() == landings && landings > 0)
    }

    /// Whether a splat holds its photons' power.
    pub(super) fn is_whole(&mut self, work: Work, index: usize) -> Result<bool> {
        let irradiance = self.light_of(work)?;
        let account = self.renderer.account(&irradiance)?;
        self.fragments[index] = account.fragments;
        Ok(account.energy_error() < ENERGY)
    }
}

/// Whether as many photons are counted in each pixel as should be, but for those that f32 puts on the other
/// side of a border, or of a surface's edge.
pub(super) fn are_counts_right(counts: &Image<f32>, expected: &Image<u32>, drawn: f64) -> bool {
    let pairs = counts.values().iter().zip(expected.values());
    let apart: f64 = pairs.map(|(&count, &all)| (f64::from(count) - f64::from(all)).abs()).sum();
    apart <= 4.0 + 1e-3 * drawn
}

/// Whether some light is found and it is what is expected.
fn is_light_right(pairs: &[(f32, f64)]) -> bool {
    let apart: f64 = pairs.iter().map(|&(found, expected)| (f64::from(found) - expected).abs()).sum();
    let all: f64 = pairs.iter().map(|&(_, expected)| expected).sum();
    apart <= GATHERED * all && all > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_strays_are_right_and_moved_photons_are_not() {
        let expected = Image::filled(UVec2::splat(10), 100);
        let counts = |moved: f32| {
            let mut counts = Image::filled(UVec2::splat(10), 100.0);
            counts.set(2, 3, 100.0 - moved);
            counts.set(3, 3, 100.0 + moved);
            counts
        };
        // 14 of 10,000 may be apart, and each that moves is so in two pixels.
        assert!(are_counts_right(&counts(7.0), &expected, 1e4));
        assert!(!are_counts_right(&counts(8.0), &expected, 1e4));
    }

    #[test]
    fn light_that_is_off_or_missing_is_wrong() {
        assert!(is_light_right(&[(1.0, 1.001), (3.0, 3.0)]));
        assert!(!is_light_right(&[(1.0, 1.01), (3.0, 3.0)]));
        assert!(!is_light_right(&[(0.0, 0.0), (0.0, 0.0)]), "nothing was compared");
        assert!(!is_light_right(&[(f32::NAN, 1.0), (3.0, 3.0)]));
    }
}
