//! What is asked of the search: the rule, n, MR, edges, method and storage, and beside them the thesis's
//! laboratory.
//!
//! Plain structs with public fields; [`Settings::default`] is exact and fast, [`Settings::thesis`] is what
//! the thesis ran.

mod faults;
#[cfg(feature = "serde")]
mod file;
mod irradiance;
mod kernel;
mod laboratory;
mod method;
mod names;
#[cfg(feature = "scene")]
mod picture;
mod pixel_filter;
mod question;
mod validate;

pub use faults::Faults;
pub use irradiance::{Estimate, IrradianceSettings};
pub use kernel::{Kernel, KernelRadius, MAX_PICTURE_RADIUS};
pub use laboratory::{Exactness, Laboratory, Matching, SatBuild, SatSamples, Split, Variation};
pub use method::{Method, Storage};
#[cfg(feature = "scene")]
pub use picture::{DirectLight, FirstBounce, MOST_ANTIALIAS, MOST_LIGHT_SAMPLES, PictureSettings};
pub use pixel_filter::PixelFilter;
pub(crate) use question::{BRACKET_TILE_SIDE, EVEN_STEPS, MOST_EVEN_STEPS, even_step};
pub use question::{Edges, MAX_EVEN_RADIUS, MAX_RADIUS_LIMIT, Order, Planning, Rule, Search};

/// Everything that a [`RadiusPipeline`](crate::RadiusPipeline) needs to know beside the map's size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "file::Fields", into = "file::Fields"))]
pub struct Settings {
    /// By which rule radii are found.
    pub rule: Rule,
    /// The question.
    pub search: Search,
    /// How boxes are counted.
    pub method: Method,
    /// The number in which sums are kept; the averaged mipmap is always f32.
    pub storage: Storage,
    /// Whether the pixels that found too few photons within MR are marked in a second plane.
    pub limited_mask: bool,
    /// Whether a frame may come with a [`Mask`](crate::Mask) of the pixels that need a radius; without one,
    /// all do.
    pub masked: bool,
    /// Who chooses method, build and order.
    pub planning: Planning,
    /// What the thesis measures, and no host has to decide.
    pub laboratory: Laboratory,
}

impl Default for Settings {
    /// The summed-area table in u32, built by a scan, with a bracketed search: exact, for n = 25 and MR = 32.
    fn default() -> Self {
        Self {
            rule: Rule::Nearest,
            search: Search { min_photons: 25, max_radius: 32, edges: Edges::Scale, order: Order::Bracketed },
            method: Method::SummedAreaTable,
            storage: Storage::U32,
            limited_mask: false,
            masked: false,
            planning: Planning::AsAsked,
            laboratory: Laboratory::default(),
        }
    }
}

impl Settings {
    /// The usual settings of a method: [`Settings::default`] for the table; the others have no bracketed
    /// search.
    #[must_use]
    pub fn of(method: Method) -> Self {
        Self { method, ..Self::default() }.with_usual_build_and_order()
    }

    /// With the build and the order that are usual for method, storage and faults: a scan and brackets for a
    /// summed-area table of whole numbers without faults, else doubling and halving, as the thesis has them.
    #[must_use]
    pub fn with_usual_build_and_order(self) -> Self {
        let has_brackets = self.method == Method::SummedAreaTable
            && self.laboratory.faults == Faults::NONE
            && self.storage.is_integer();
        let usual = if has_brackets { Self::default() } else { Self::thesis() };
        Self {
            search: Search { order: usual.search.order, ..self.search },
            laboratory: Laboratory { sat_build: usual.laboratory.sat_build, ..self.laboratory },
            ..self
        }
    }

    /// The thesis's fastest: a summed-area table in f32, 4 samples a pass, MR = 32 (Figure 5.1), n = 25
    /// (Figure 3.2).
    #[must_use]
    pub fn thesis() -> Self {
        let usual = Self::default();
        Self {
            search: Search { order: Order::Binary, ..usual.search },
            storage: Storage::F32,
            laboratory: Laboratory {
                matching: Matching::Modulo,
                sat_build: SatBuild::Doubling,
                ..usual.laboratory
            },
            ..usual
        }
    }
}
