//! When a result is exact: which sums fit which storage, decided before anything is computed.
//!
//! Three facts carry the rules (S counts the photons of a box, T is its area, I its area inside the map):
//!
//! 1. An unsigned table that wraps still gives the right S while the *box* holds less than 2^32, since the
//!    four texels are added modulo 2^32; the total does not matter (`u32-wraps`). In 16 bits, the same holds
//!    of 2^16 (`u16-wraps`).
//! 2. `min(count, n)` in place of each count changes no radius: a box with a pixel of n or more holds enough
//!    either way, and in the others nothing is clamped (`clamped-counts`). Then S <= n I, so T n < 2^32
//!    (2^16) is enough for any map at all.
//! 3. f32 holds every whole number up to 2^24; a table in f32 is exact while its *total*, its largest entry,
//!    stays there (`f32-total`), and a pyramid or a brute-force sum while each box does. In f16, the same
//!    holds of 2^11 (`f16-total`).
//!
//! The rule of even density compares counts that are not clamped: fact 1 alone is for it.
//!
//! The scaled test S T >= n I needs products only where S < n, so they fit 32 bits while T n < 2^32; past
//! that the shaders multiply in two words (`wide-products`).
//!
//! So what is accepted is right (`accepted-is-exact`, `default-is-exact`), all else is refused by [`plan`],
//! and by a render in place of its map (`refused-first`), and one photon past the limits of u32, u16, f32 and
//! f16 can give wrong radii (`limits-are-real`). The names are those of the promises that `varikernel stress`
//! tests, and of its rows.

use glam::UVec2;

use crate::error::{Error, Result};
use crate::image::Image;
use crate::settings::{Exactness, Faults, Method, Order, Rule, Search, Settings, Storage};

/// Upper bounds for the sums in a density map, and the question that they were found for; what is not known
/// is [`u64::MAX`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CountBounds {
    /// The sum of all counts.
    pub total: u64,
    /// The sum of any box of [`max_radius`](Self::max_radius).
    pub densest_box: u64,
    /// The same with each count clamped to [`min_photons`](Self::min_photons).
    pub densest_clamped_box: u64,
    /// The largest radius that the boxes' bounds hold for; the total bounds larger ones.
    pub max_radius: u32,
    /// The largest n that the clamped bound holds for.
    pub min_photons: u32,
}

impl CountBounds {
    /// Nothing is known: only n and MR can prove exactness.
    pub const UNKNOWN: Self = Self::total_at_most(u64::MAX);

    /// At most `total` photons are in the map: a host knows how many it has drawn.
    #[must_use]
    pub const fn total_at_most(total: u64) -> Self {
        Self {
            total,
            densest_box: total,
            densest_clamped_box: total,
            max_radius: u32::MAX,
            min_photons: u32::MAX,
        }
    }

    /// The bounds of these photons and others together.
    #[must_use]
    pub fn with(self, others: Self) -> Self {
        Self {
            total: self.total.saturating_add(others.total),
            densest_box: self.densest_box.saturating_add(others.densest_box),
            densest_clamped_box: self.densest_clamped_box.saturating_add(others.densest_clamped_box),
            max_radius: self.max_radius.min(others.max_radius),
            min_photons: self.min_photons.min(others.min_photons),
        }
    }

    /// The bounds of `density` itself; boxes are summed only where the total does not decide.
    #[must_use]
    pub fn of(density: &Image<u32>, search: Search) -> Self {
        Self::where_total_exceeds(F32_MAX, U32_MAX, density, search)
    }

    /// As [`of`](Self::of), but close enough for [`Storage::U16`]: boxes are summed unless the whole map fits
    /// one.
    #[must_use]
    pub fn of_boxes(density: &Image<u32>, search: Search) -> Self {
        Self::where_total_exceeds(U16_MAX, U16_MAX, density, search)
    }

    /// Sums boxes where the total exceeds `total_limit`, and boxes of clamped counts where those exceed
    /// `box_limit`.
    fn where_total_exceeds(total_limit: u64, box_limit: u64, density: &Image<u32>, search: Search) -> Self {
        let total = density.values().iter().map(|&count| u64::from(count)).sum();
        if total <= total_limit {
            return Self::total_at_most(total);
        }
        let densest = |counts: &Image<u32>| {
            crate::reference::Table::new(counts).densest_box(search.largest_counted_radius())
        };
        let densest_box = densest(density);
        let densest_clamped_box = if densest_box <= box_limit {
            densest_box
        } else {
            densest(&density.map(|count| count.min(search.min_photons)))
        };
        Self {
            total,
            densest_box,
            densest_clamped_box,
            max_radius: search.largest_counted_radius(),
            min_photons: search.min_photons,
        }
    }

    /// The bound for any box that `settings` can ask for.
    fn box_of(&self, settings: &Settings) -> u64 {
        // The naive mipmap's last block is larger than a box of MR.
        let holds =
            largest_counted_radius(settings) <= self.max_radius && settings.method != Method::NaiveMipmap;
        if holds { self.densest_box.min(self.total) } else { self.total }
    }

    /// The same with each count clamped to n, which [`Rule::Even`] does not have.
    fn clamped_box_of(&self, settings: &Settings) -> u64 {
        let search = settings.search;
        let holds = settings.rule == Rule::Nearest
            && search.largest_counted_radius() <= self.max_radius
            && search.min_photons <= self.min_photons
            && settings.method != Method::NaiveMipmap;
        if holds { self.densest_clamped_box } else { u64::MAX }
    }
}

const U32_MAX: u64 = u32::MAX as u64;
const U16_MAX: u64 = u16::MAX as u64;
const F32_MAX: u64 = 1 << 24;
const F16_MAX: u64 = 1 << 11;

/// How counts are taken in so that the sums stay right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Plan {
    /// Larger counts are taken as this many; n where clamping is what makes the sums fit.
    pub count_limit: u32,
    /// Whether every radius is proved equal to the definition (always so unless waived or the method
    /// approximates).
    pub exact: bool,
}

/// Decides how the counts of a map of `size` are taken in.
///
/// # Errors
/// [`Error::Inexact`] where [`Exactness::Required`] cannot be had.
pub fn plan(settings: &Settings, size: UVec2, bounds: CountBounds) -> Result<Plan> {
    let faultless = settings.reaching_faults() == Faults::NONE;
    let unclamped = Plan { count_limit: u32::MAX, exact: settings.method.is_exact() && faultless };
    let inexact = |reason: String, remedy: &str| match settings.laboratory.exactness {
        Exactness::Required => Err(Error::Inexact { reason, remedy: remedy.to_owned() }),
        Exactness::Waived => Ok(Plan { exact: false, ..unclamped }),
    };
    let search = settings.search;
    let densest_box = bounds.box_of(settings);
    match (settings.method, settings.storage) {
        (Method::AveragedMipmap, _) => Ok(unclamped),
        (_, Storage::U32 | Storage::U16) => {
            let (bits, limit, remedy) = match (settings.storage, search.order) {
                _ if settings.rule == Rule::Even => (32, U32_MAX, "lower MR, or scale the counts down"),
                (Storage::U16, _) => (16, U16_MAX, "keep the table in u32 (storage u32), or lower n or MR"),
                (_, Order::Bracketed) => {
                    (32, U32_MAX, "search in binary order, whose boxes are smaller, or lower n or MR")
                }
                _ => (32, U32_MAX, "lower n or MR, or scale the counts down"),
            };
            let clamped_by_n = match settings.rule {
                Rule::Nearest => largest_area(settings, size).saturating_mul(search.min_photons.into()),
                // A larger count is another density.
                Rule::Even => u64::MAX,
            };
            let clamped_box = clamped_by_n.min(bounds.clamped_box_of(settings));
            if densest_box <= limit {
                Ok(unclamped)
            } else if clamped_box <= limit {
                Ok(Plan { count_limit: search.min_photons, ..unclamped })
            } else {
                inexact(
                    format!(
                        "a box of radius {} may hold {} photons, and {bits}-bit sums end at {limit}",
                        search.max_radius,
                        known(clamped_box.min(densest_box))
                    ),
                    remedy,
                )
            }
        }
        (_, Storage::F32MinusMean | Storage::F32MinusWholeMean) => inexact(
            "a table in f32 from which the mean was subtracted is not proved exact for any map".to_owned(),
            "keep the table in u32 (storage u32)",
        ),
        (Method::SummedAreaTable, Storage::F32 | Storage::F16) => {
            let limit = if settings.storage == Storage::F16 { F16_MAX } else { F32_MAX };
            if bounds.total <= limit {
                return Ok(unclamped);
            }
            inexact(
                format!(
                    "a table in {} is exact up to {limit} photons in all, and the map may hold {}",
                    settings.storage.name(),
                    known(bounds.total)
                ),
                "keep the table in u32 (storage u32)",
            )
        }
        (Method::BruteForce | Method::NaiveMipmap | Method::Pyramid, Storage::F32)
            if densest_box > F32_MAX =>
        {
            inexact(
                format!(
                    "sums in f32 are exact up to {F32_MAX}, and a box of radius {} may hold {} photons",
                    search.max_radius,
                    known(densest_box)
                ),
                "keep the sums in u32 (storage u32)",
            )
        }
        (_, Storage::F32 | Storage::F16) => Ok(unclamped),
    }
}

/// Whether the products of the scaled test need more than 32 bits.
pub(crate) fn needs_wide_products(settings: &Settings) -> bool {
    largest_area(settings, UVec2::MAX) * u64::from(settings.search.min_photons) > U32_MAX
}

/// The radius that no counted box exceeds in area.
fn largest_counted_radius(settings: &Settings) -> u32 {
    match settings.rule {
        Rule::Nearest => settings.search.largest_counted_radius(),
        Rule::Even => settings.search.max_radius,
    }
}

/// The largest T of the search, cut to the map where the area of a sum matters.
fn largest_area(settings: &Settings, size: UVec2) -> u64 {
    let radius = u64::from(largest_counted_radius(settings));
    let longest = match settings.method {
        // Blocks of side 2^l with 2^(l-1) < 2 MR.
        Method::NaiveMipmap => 4 * radius,
        _ => 2 * radius + 1,
    };
    longest.min(u64::from(size.x)) * longest.min(u64::from(size.y))
}

fn known(bound: u64) -> String {
    if bound == u64::MAX { "any number of".to_owned() } else { bound.to_string() }
}
