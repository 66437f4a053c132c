//! Seeded density maps for tests and benchmarks: the same seed gives the same map on every machine.

use glam::{DVec2, UVec2};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use varikernel::image::Image;

/// What the photons are drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Kind {
    /// Photons anywhere, each as likely as the other; 10 a pixel.
    Uniform,
    /// The same with 1 in 20 pixels.
    Sparse,
    /// From none at the left to twice the mean at the right; 10 a pixel.
    Gradient,
    /// The left half, as if in shadow, gets 1 photon for 64 in the right half; 10 a pixel.
    Step,
    /// Parallel light reflected in a ring, as in a cup, over a dim background; 10 a pixel.
    Caustic,
    /// Sparse, and one pixel of 10^9 at a third of the width and half the height.
    Spike,
    /// No photon.
    Empty,
    /// Squares of 8 x 8 pixels, empty ones and ones with twice the mean in each pixel; 10 a pixel.
    Checkerboard,
}

/// Photons in the one bright pixel of [`Kind::Spike`].
const SPIKE: u32 = 1_000_000_000;
/// Side of a square of [`Kind::Checkerboard`], in pixels.
const SQUARE: u32 = 8;
/// Share of the photons of [`Kind::Step`] that land in the left half.
const SHADOW: f64 = 1.0 / 65.0;
/// Share of the photons of [`Kind::Caustic`] that are its background.
const BACKGROUND: f64 = 0.2;

impl Kind {
    /// Photons per pixel, on average, unless asked otherwise.
    #[must_use]
    pub fn usual_density(self) -> f64 {
        match self {
            Self::Sparse | Self::Spike => 0.05,
            Self::Empty => 0.0,
            Self::Uniform | Self::Gradient | Self::Step | Self::Caustic | Self::Checkerboard => 10.0,
        }
    }
}

/// A map of `size` with `density` photons per pixel on average, as far as they are whole.
///
/// # Panics
/// If a side of `size` is zero, or `density` is negative or not finite.
#[must_use]
pub fn map(kind: Kind, size: UVec2, density: f64, seed: u64) -> Image<u32> {
    assert!(density >= 0.0 && density.is_finite(), "{density} photons per pixel");
    let mut random = Pcg64::seed_from_u64(seed);
    let pixels = f64::from(size.x) * f64::from(size.y);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked above, and rounded")]
    let photons = (density * pixels).round() as u64;
    match kind {
        Kind::Empty => Image::filled(size, 0),
        Kind::Checkerboard => {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "saturates, as a count may"
            )]
            let bright = (2.0 * density).round() as u32;
            Image::from_fn(size, |x, y| if (x / SQUARE + y / SQUARE).is_multiple_of(2) { bright } else { 0 })
        }
        Kind::Uniform | Kind::Sparse => scatter(size, photons, || uniform(&mut random)),
        Kind::Spike => {
            let mut map = scatter(size, photons, || uniform(&mut random));
            map.set(size.x / 3, size.y / 2, SPIKE);
            map
        }
        // The density grows with x, so x is distributed as the root of a uniform number.
        Kind::Gradient => scatter(size, photons, || {
            let DVec2 { x, y } = uniform(&mut random);
            DVec2::new(x.sqrt(), y)
        }),
        Kind::Step => scatter(size, photons, || {
            let DVec2 { x, y } = uniform(&mut random);
            let start = if random.random_bool(SHADOW) { 0.0 } else { 0.5 };
            DVec2::new(start + x / 2.0, y)
        }),
        Kind::Caustic => scatter(size, photons, || caustic(&mut random)),
    }
}

/// Adds one for each place, given in the unit square.
fn scatter(size: UVec2, photons: u64, mut place: impl FnMut() -> DVec2) -> Image<u32> {
    let mut map = Image::filled(size, 0_u32);
    for _ in 0..photons {
        let at = (place() * size.as_dvec2()).as_uvec2().min(size - 1);
        map.set(at.x, at.y, map.at(at.x, at.y).saturating_add(1));
    }
    map
}

fn uniform(random: &mut Pcg64) -> DVec2 {
    DVec2::new(random.random(), random.random())
}

/// A ray that comes from the left, is reflected inside a ring and lands anywhere on its way back across it.
fn caustic(random: &mut Pcg64) -> DVec2 {
    if random.random_bool(BACKGROUND) {
        return uniform(random);
    }
    let height = random.random_range(-1.0..1.0_f64);
    let hit = DVec2::new((1.0 - height * height).sqrt(), height);
    let reflected = DVec2::X - 2.0 * DVec2::X.dot(hit) * hit;
    let across = -2.0 * reflected.dot(hit);
    let landing = hit + reflected * across * random.random::<f64>();
    // The ring takes nine tenths of the map.
    landing * 0.45 + 0.5
}
