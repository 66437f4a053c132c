//! What was counted and timed, for the claims to be judged by.

use super::counted::{self, PyramidCost};
use super::listings::{self, FaultRow, FloatRow};
use super::quantity::Measurements;
use varikernel::error::Result;
use varikernel::image::Difference;
use varikernel::image::Image;
use varikernel::reference;
use varikernel::settings::{Edges, Search};

/// Forward against binary at one density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrderPoint {
    /// The map's mean radius, which is the mean number of forward probes.
    pub mean_radius: f64,
    /// Median of the forward search, in milliseconds.
    pub forward_ms: f64,
    /// Median of the binary search.
    pub binary_ms: f64,
}

/// One cost with and without a change, on one map.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Gain {
    /// The claim that it answers: `scale-cost` or one of [`super::claims::Group::Future`].
    pub id: String,
    /// What was run, in a few words: size, n, MR.
    pub what: String,
    /// Median without the change, in milliseconds.
    pub before_ms: f64,
    /// Median with it.
    pub after_ms: f64,
    /// Pixels that the change gets wrong.
    pub wrong_pixels: u64,
}

/// Radii of one rule against those of another.
#[derive(Clone, Debug, PartialEq)]
pub struct LargerSmaller {
    /// Pixels with a larger radius.
    pub larger: u64,
    /// Pixels with a smaller radius.
    pub smaller: u64,
    /// All pixels.
    pub pixels: u64,
}

impl LargerSmaller {
    /// `ours` against `usual`, pixel by pixel.
    ///
    /// # Errors
    /// If their sizes differ.
    pub fn between(ours: &Image<u32>, usual: &Image<u32>) -> Result<Self> {
        let difference = Difference::between(ours, usual)?;
        let pairs = ours.values().iter().zip(usual.values());
        let larger = pairs.filter(|(ours, usual)| ours > usual).count() as u64;
        Ok(Self { larger, smaller: difference.wrong_pixels - larger, pixels: difference.pixels })
    }
}

/// All that claims are judged by; what is empty was not measured.
#[derive(Clone, Debug, Default)]
pub struct Evidence {
    /// Fetches and stack depths.
    pub pyramid_costs: Vec<PyramidCost>,
    /// Which radii each fault makes wrong, on [`Evidence::map`] and on one on which each fault shows.
    pub faults: Vec<FaultRow>,
    /// Which radii a table in f32 makes wrong on it.
    pub floats: Vec<FloatRow>,
    /// Radii with nothing outside against scaled ones, on it.
    pub edges: Option<LargerSmaller>,
    /// The map, by its name.
    pub map: String,
    /// The tables' cells.
    pub measurements: Measurements,
    /// Forward against binary as the density falls.
    pub orders: Vec<OrderPoint>,
    /// Averaged mipmaps against exact radii.
    pub averaged: Option<LargerSmaller>,
    /// What changes gain.
    pub gains: Vec<Gain>,
}

/// Odd factors that take a map of a few million photons below and past 2^24.
const FLOAT_FACTORS: [u32; 5] = [1, 5, 9, 65, 1025];

impl Evidence {
    /// What answers a claim by its name, if that was timed.
    pub(super) fn gain(&self, id: &str) -> Option<&Gain> {
        self.gains.iter().find(|gain| gain.id == id)
    }

    /// All that needs neither clock nor OpenGL, on `density`.
    ///
    /// # Errors
    /// None that a map can cause.
    pub fn counted(density: &Image<u32>, map: impl Into<String>, search: Search) -> Result<Self> {
        let radii = |edges| reference::radius_by_table(density, Search { edges, ..search }).radius;
        let map = map.into();
        let oblong = listings::fault_rows(&listings::oblong_map(), listings::OBLONG_MAP, search)?;
        Ok(Self {
            pyramid_costs: counted::pyramid_costs(counted::MAX_RADIUS),
            faults: listings::fault_rows(density, &map, search)?.into_iter().chain(oblong).collect(),
            floats: listings::float_rows(density, search, &FLOAT_FACTORS)?,
            edges: Some(LargerSmaller::between(&radii(Edges::Zero), &radii(Edges::Scale))?),
            map,
            ..Self::default()
        })
    }
}
