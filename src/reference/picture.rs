//! Density, splat and gather as nested loops in f64: each photon is tested against each pixel (thesis 2.1,
//! 2.6.2).
//!
//! The same terms as in `glsl/common/surfaces.glsl`, `photon.glsl` and `kernel.glsl`, without their bounds.

use std::f64::consts::PI;

use glam::{DVec3, UVec2};

use crate::image::Image;
use crate::photon::PhotonPoint;
use crate::settings::Kernel;
use crate::view::View;

/// The kernel's extent along the normal, as a share of its radius.
const THICKNESS: f64 = 0.2;
/// A disc is as large as if it were seen at this cosine where it is seen at a smaller one.
const LEAST_COSINE: f64 = 0.1;
/// The least cosine between the normals of places that share their light.
const LEAST_AGREEMENT: f64 = 0.5;
/// What a photon's own pixel gets in any case.
const LEAST_AT_HOME: f64 = 1e-3;

/// What each pixel of a view shows, as the g-buffer holds it.
#[derive(Clone, Debug)]
pub struct Shown {
    /// The camera and the size.
    pub view: View,
    /// Places in scene units, and the depth along the view.
    pub position: Image<[f32; 4]>,
    /// Normals towards the camera, and the surface's number.
    pub normal: Image<[f32; 4]>,
}

#[derive(Clone, Copy)]
struct Surface {
    position: DVec3,
    depth: f64,
    normal: DVec3,
    /// Whole, so that equality means the same surface.
    number: i32,
}

impl Shown {
    fn at(&self, pixel: UVec2) -> Surface {
        let [x, y, z, depth] = self.position.at(pixel.x, pixel.y).map(f64::from);
        let [normal_x, normal_y, normal_z, _] = self.normal.at(pixel.x, pixel.y).map(f64::from);
        let number = whole(self.normal.at(pixel.x, pixel.y)[3]);
        Surface {
            position: DVec3::new(x, y, z),
            depth,
            normal: DVec3::new(normal_x, normal_y, normal_z),
            number,
        }
    }

    fn pixels(&self) -> impl Iterator<Item = UVec2> + use<> {
        let UVec2 { x: width, y: height } = self.position.size();
        (0..height).flat_map(move |y| (0..width).map(move |x| UVec2::new(x, y)))
    }

    /// Area that a pixel covers on its surface, in square scene units; 0 where no diffuse surface is seen.
    #[must_use]
    pub fn area(&self, pixel: UVec2) -> f64 {
        let surface = self.at(pixel);
        if surface.number > 0 { self.area_on(surface, 1e-3) } else { 0.0 }
    }

    fn area_on(&self, surface: Surface, least_cosine: f64) -> f64 {
        let sight = surface.position - self.view.position().as_dvec3();
        let slant = surface.normal.dot(sight).abs().max(least_cosine * sight.length());
        f64::from(self.view.pixel_side()).powi(2) * surface.depth.powi(3) / slant
    }

    /// The pixel of a photon, if it contributes there.
    fn home(&self, photon: &PhotonPoint) -> Option<UVec2> {
        let pixel = self.view.pixel_of(photon.position)?;
        let surface = self.at(pixel);
        let before = surface.normal.dot(photon.position.as_dvec3() - surface.position).abs();
        let contributes = surface.number == whole(photon.surface)
            && surface.normal.dot(photon.normal.as_dvec3()) > LEAST_AGREEMENT
            && before <= 0.5 * f64::from(self.view.pixel_side()) * surface.depth;
        contributes.then_some(pixel)
    }

    fn kernel_on(&self, position: DVec3, surface: Surface, radius: u32) -> Disc {
        let sight = (surface.position - self.view.position().as_dvec3()).normalize();
        let flat = sight - sight.dot(surface.normal) * surface.normal;
        let other = if surface.normal.x.abs() < 0.5 { DVec3::X } else { DVec3::Y };
        let along = if flat.length_squared() > 1e-8 {
            flat.normalize()
        } else {
            surface.normal.cross(other).normalize()
        };
        let pixel = f64::from(self.view.pixel_side()) * surface.depth;
        let disc = f64::from(2 * radius + 1) * (self.area_on(surface, LEAST_COSINE) / PI).sqrt();
        let lying = disc.max(pixel / sight.dot(surface.normal).abs().max(LEAST_COSINE * 0.1));
        Disc {
            position,
            surface,
            axes: [surface.normal.cross(along) / disc, along / lying, surface.normal / (THICKNESS * disc)],
        }
    }
}

/// A surface's number, which is whole.
fn whole(number: f32) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^24 surfaces")]
    let number = number as i32;
    number
}

/// A kernel: its middle, the surface that it lies on, and its axes over their half lengths.
struct Disc {
    position: DVec3,
    surface: Surface,
    axes: [DVec3; 3],
}

impl Disc {
    fn weight(&self, kernel: Kernel, at: Surface) -> f64 {
        if at.number != self.surface.number || at.normal.dot(self.surface.normal) <= LEAST_AGREEMENT {
            return 0.0;
        }
        let away = at.position - self.position;
        kernel.profile(self.axes.iter().map(|axis| away.dot(*axis).powi(2)).sum())
    }
}

/// Photons that contribute to each pixel.
#[must_use]
pub fn photon_density(shown: &Shown, photons: &[PhotonPoint]) -> Image<u32> {
    let mut counts = Image::filled(shown.position.size(), 0);
    for pixel in photons.iter().filter_map(|photon| shown.home(photon)) {
        counts.set(pixel.x, pixel.y, counts.at(pixel.x, pixel.y) + 1);
    }
    counts
}

/// Irradiance, where each photon spreads its power over what its kernel covers with the radius of its own
/// pixel.
#[must_use]
pub fn splat(shown: &Shown, photons: &[PhotonPoint], radius: &Image<u32>, kernel: Kernel) -> Image<[f64; 3]> {
    let mut irradiance = Image::filled(shown.position.size(), [0.0; 3]);
    for photon in photons {
        let Some(home) = shown.home(photon) else { continue };
        let disc = shown.kernel_on(photon.position.as_dvec3(), shown.at(home), radius.at(home.x, home.y));
        let weight = |pixel: UVec2| {
            let weight = disc.weight(kernel, shown.at(pixel));
            if pixel == home { weight.max(LEAST_AT_HOME) } else { weight }
        };
        let covered: f64 = shown
            .pixels()
            .map(|pixel| (pixel, weight(pixel)))
            .filter(|(_, weight)| *weight > 0.0)
            .map(|(pixel, weight)| weight * shown.area(pixel))
            .sum();
        for pixel in shown.pixels() {
            let share = weight(pixel) / covered;
            let before = DVec3::from(irradiance.at(pixel.x, pixel.y));
            irradiance.set(pixel.x, pixel.y, (before + share * photon.power.as_dvec3()).to_array());
        }
    }
    irradiance
}

/// Irradiance, where each pixel gathers the power of the pixels that its kernel covers, and how many photons
/// it found.
#[must_use]
pub fn gather(
    shown: &Shown,
    photons: &[PhotonPoint],
    radius: &Image<u32>,
    kernel: Kernel,
) -> (Image<[f64; 3]>, Image<u32>) {
    let (power, counts) = (photon_power(shown, photons), photon_density(shown, photons));
    let mut found = counts.map(|_| 0);
    let irradiance = Image::from_fn(shown.position.size(), |x, y| {
        let pixel = UVec2::new(x, y);
        let (irradiance, photons) = gather_at(shown, pixel, &power, &counts, radius.at(x, y), kernel);
        found.set(x, y, photons);
        irradiance
    });
    (irradiance, found)
}

/// Power of the photons that contribute to each pixel, linear RGB.
#[must_use]
pub fn photon_power(shown: &Shown, photons: &[PhotonPoint]) -> Image<[f64; 3]> {
    let mut power = Image::filled(shown.position.size(), [0.0; 3]);
    for photon in photons {
        let Some(UVec2 { x, y }) = shown.home(photon) else { continue };
        power.set(x, y, (DVec3::from(power.at(x, y)) + photon.power.as_dvec3()).to_array());
    }
    power
}

/// What [`gather`] gives at one pixel, from the power and the density of the photons.
#[must_use]
pub fn gather_at(
    shown: &Shown,
    pixel: UVec2,
    power: &Image<[f64; 3]>,
    density: &Image<u32>,
    radius: u32,
    kernel: Kernel,
) -> ([f64; 3], u32) {
    let surface = shown.at(pixel);
    if surface.number <= 0 {
        return ([0.0; 3], 0);
    }
    let disc = shown.kernel_on(surface.position, surface, radius);
    let (mut gathered, mut area, mut photons) = (DVec3::ZERO, 0.0, 0);
    for UVec2 { x, y } in shown.pixels() {
        let pixel = UVec2::new(x, y);
        let weight = disc.weight(kernel, shown.at(pixel));
        if weight > 0.0 {
            gathered += weight * DVec3::from(power.at(x, y));
            area += weight * shown.area(pixel);
            photons += density.at(x, y);
        }
    }
    ((gathered / area).to_array(), photons)
}
