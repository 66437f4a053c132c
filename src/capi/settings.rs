//! What is asked, as a plain struct of C.

use super::{Failure, Status, answer, check_place, check_size, flag, out_of_range};
use crate::settings::{Edges, Order, Planning, Rule, Search, Settings};

/// rule: the smallest box that holds at least n photons.
pub const VARIKERNEL_RULE_NEAREST: u32 = 0;

/// rule: the widest box over which the density is even but for noise, with a radius of 0, 1, 2, 4, ... MR,
/// which is a power of two of at most 64. There is no n and no order; with VARIKERNEL_EDGES_ZERO the map's
/// edge is one of the density.
pub const VARIKERNEL_RULE_EVEN: u32 = 1;

/// edges: nothing is outside the map.
pub const VARIKERNEL_EDGES_ZERO: u32 = 0;

/// edges: outside is as much, per area, as the box holds inside.
pub const VARIKERNEL_EDGES_SCALE: u32 = 1;

/// order: halving the few radii that bounds for tiles and blocks leave; fast whatever MR and density.
pub const VARIKERNEL_ORDER_BRACKETED: u32 = 0;

/// order: 1, 2, 3, ...; the fastest where radii are small.
pub const VARIKERNEL_ORDER_FORWARD: u32 = 1;

/// order: halving 1 to MR.
pub const VARIKERNEL_ORDER_BINARY: u32 = 2;

/// order: chosen for each frame by the photons of the ones before, without waiting. Memory grows when an
/// order is first used.
pub const VARIKERNEL_ORDER_ADAPTIVE: u32 = 3;

/// What is asked of a pipeline. Fill it with varikernel_settings_default, then change what you like.
///
/// Boxes are counted in a summed-area table, exact or refused. The order of the search changes no radius.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlainSettings {
    /// sizeof(varikernel_settings), by which another version's struct is told.
    pub struct_size: u32,
    /// By which rule a radius is found: VARIKERNEL_RULE_... Default VARIKERNEL_RULE_NEAREST.
    pub rule: u32,
    /// n: photons that a box has to hold, at least 1. Default 25. Not asked for by VARIKERNEL_RULE_EVEN.
    pub min_photons: u32,
    /// MR: where the search ends, in pixels, 1 to 32767. Pixels that find too few photons get it. Default 32.
    /// With VARIKERNEL_RULE_EVEN a power of two from 1 to 64.
    pub max_radius: u32,
    /// What a box holds outside the map: VARIKERNEL_EDGES_... Default VARIKERNEL_EDGES_SCALE.
    pub edges: u32,
    /// In which order radii are tried: VARIKERNEL_ORDER_... Default VARIKERNEL_ORDER_BRACKETED. Not asked for
    /// by VARIKERNEL_RULE_EVEN, which refuses VARIKERNEL_ORDER_ADAPTIVE alone.
    pub order: u32,
    /// 1 for a texture that marks the pixels that MR ended, with too few photons or a density that is even
    /// still, else 0. Default 0.
    pub limited_mask: u32,
    /// 1 if frames may bring a mask of the pixels that need a radius, else 0. Default 0.
    pub masked: u32,
}

const SIZE: usize = size_of::<PlainSettings>();

/// Fills `settings` with the defaults. `size` is sizeof(varikernel_settings).
///
/// Fails with INVALID_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_settings_default(settings: *mut PlainSettings, size: u32) -> Status {
    answer(|| {
        check_place(settings, "settings")?;
        check_size("varikernel_settings", size, SIZE)?;
        let usual = Settings::default();
        let Search { min_photons, max_radius, edges, order } = usual.search;
        let plain = PlainSettings {
            struct_size: size,
            rule: match usual.rule {
                Rule::Nearest => VARIKERNEL_RULE_NEAREST,
                Rule::Even => VARIKERNEL_RULE_EVEN,
            },
            min_photons,
            max_radius,
            edges: write_edges(edges),
            order: match order {
                Order::Bracketed => VARIKERNEL_ORDER_BRACKETED,
                Order::Forward => VARIKERNEL_ORDER_FORWARD,
                Order::Binary => VARIKERNEL_ORDER_BINARY,
            },
            limited_mask: usual.limited_mask.into(),
            masked: usual.masked.into(),
        };
        // SAFETY: the host gives a pointer to write to.
        unsafe { settings.write(plain) };
        Ok(())
    })
}

impl PlainSettings {
    /// The settings; ranges that the library checks are left to it.
    pub(super) fn read(&self) -> Result<Settings, Failure> {
        check_size("varikernel_settings", self.struct_size, SIZE)?;
        let rule = match self.rule {
            VARIKERNEL_RULE_NEAREST => Rule::Nearest,
            VARIKERNEL_RULE_EVEN => Rule::Even,
            other => return Err(out_of_range("rule", other, "it is one of VARIKERNEL_RULE_...")),
        };
        let edges = read_edges(self.edges)?;
        let (order, planning) = match self.order {
            VARIKERNEL_ORDER_BRACKETED => (Order::Bracketed, Planning::AsAsked),
            VARIKERNEL_ORDER_FORWARD => (Order::Forward, Planning::AsAsked),
            VARIKERNEL_ORDER_BINARY => (Order::Binary, Planning::AsAsked),
            VARIKERNEL_ORDER_ADAPTIVE => (Order::Bracketed, Planning::EachFrame),
            other => return Err(out_of_range("order", other, "it is one of VARIKERNEL_ORDER_...")),
        };
        Ok(Settings {
            rule,
            search: Search { min_photons: self.min_photons, max_radius: self.max_radius, edges, order },
            limited_mask: flag("limited_mask", self.limited_mask)?,
            masked: flag("masked", self.masked)?,
            planning,
            ..Settings::default()
        })
    }
}

/// An edge rule by its number.
pub(super) fn read_edges(value: u32) -> Result<Edges, Failure> {
    match value {
        VARIKERNEL_EDGES_ZERO => Ok(Edges::Zero),
        VARIKERNEL_EDGES_SCALE => Ok(Edges::Scale),
        other => Err(out_of_range("edges", other, "it is one of VARIKERNEL_EDGES_...")),
    }
}

/// The number of an edge rule.
pub(super) fn write_edges(edges: Edges) -> u32 {
    match edges {
        Edges::Zero => VARIKERNEL_EDGES_ZERO,
        Edges::Scale => VARIKERNEL_EDGES_SCALE,
    }
}
