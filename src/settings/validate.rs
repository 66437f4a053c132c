//! Which settings go together.

use super::{
    Faults, Laboratory, MAX_EVEN_RADIUS, MAX_RADIUS_LIMIT, Method, Order, Planning, Rule, SatBuild, Search,
    Settings, Storage, Variation,
};
use crate::error::{Error, Result};

/// The largest [`Search::max_radius`] of the naive mipmap, whose blocks have up to four times that side.
const NAIVE_MAX_RADIUS: u32 = 16_384;

fn refuse(name: &'static str, value: impl Into<String>, reason: impl Into<String>) -> Result<()> {
    Err(Error::Setting { name, value: value.into(), reason: reason.into() })
}

impl Settings {
    /// Checks every range, and that the variation fits.
    ///
    /// # Errors
    /// [`Error::Setting`] with the field's name.
    pub fn validate(&self) -> Result<()> {
        self.validate_question()?;
        self.validate_storage()?;
        self.validate_order()?;
        if self.rule == Rule::Even {
            self.validate_even()?;
        }
        self.laboratory.variation.map_or(Ok(()), |variation| self.validate_variation(variation))
    }

    fn validate_question(&self) -> Result<()> {
        let Search { min_photons, max_radius, .. } = self.search;
        if min_photons == 0 {
            return refuse("min_photons", "0", "it is at least 1, since every box holds 0 photons");
        }
        if max_radius == 0 || max_radius > MAX_RADIUS_LIMIT {
            return refuse(
                "max_radius",
                max_radius.to_string(),
                format!(
                    "it goes from 1, where the search starts, to {MAX_RADIUS_LIMIT}, where the area (2 MR + \
                     1)² still fits 32 bits"
                ),
            );
        }
        if self.method == Method::NaiveMipmap && max_radius > NAIVE_MAX_RADIUS {
            return refuse(
                "max_radius",
                max_radius.to_string(),
                format!(
                    "the naive mipmap goes up to {NAIVE_MAX_RADIUS}: the area of its last \
                     block must fit 32 bits"
                ),
            );
        }
        Ok(())
    }

    /// What goes with [`Rule::Even`].
    fn validate_even(&self) -> Result<()> {
        let max_radius = self.search.max_radius;
        if max_radius > MAX_EVEN_RADIUS || !max_radius.is_power_of_two() {
            return refuse(
                "max_radius",
                max_radius.to_string(),
                format!("the rule even tries radii of 0, 1, 2, 4, ...: give 1, 2, 4, ... {MAX_EVEN_RADIUS}"),
            );
        }
        if self.method != Method::SummedAreaTable {
            return refuse(
                "method",
                self.method.name(),
                "the rule even counts boxes of all sizes in the summed-area table alone; choose that method",
            );
        }
        if self.storage != Storage::U32 {
            return refuse(
                "storage",
                self.storage.name(),
                "the rule even decides in whole numbers of 32 bits; keep the sums in u32",
            );
        }
        if self.planning != Planning::AsAsked {
            return refuse(
                "planning",
                "each-frame",
                "it chooses the order in which radii are tried, and the rule even has none",
            );
        }
        let Laboratory { variation, faults, .. } = self.laboratory;
        if let Some(variation) = variation {
            return refuse("variation", variation.name(), "it is for the rule nearest");
        }
        if faults != Faults::NONE {
            return refuse("faults", "of the listings", "they are of the rule nearest");
        }
        Ok(())
    }

    fn validate_storage(&self) -> Result<()> {
        let Laboratory { sat_build, faults, .. } = self.laboratory;
        let is_table = self.method == Method::SummedAreaTable;
        if sat_build == SatBuild::Scan && !self.storage.is_integer() && is_table {
            return refuse(
                "sat_build",
                sat_build.name(),
                "a scan adds integers; keep the sums in u32, or build by doubling",
            );
        }
        let refuse = |reason| refuse("storage", self.storage.name(), reason);
        match self.storage.is_for_tables_alone() {
            true if !is_table => {
                refuse("only the summed-area table is kept in it; keep the sums in u32 or f32")
            }
            true if faults != Faults::NONE => refuse("the listings keep plain sums; run them in u32 or f32"),
            _ => Ok(()),
        }
    }

    fn validate_order(&self) -> Result<()> {
        let order = self.search.order;
        let refuse = |reason| refuse("order", order.name(), reason);
        match order {
            Order::Bracketed if self.method != Method::SummedAreaTable => refuse(
                "only the summed-area table counts boxes of all shapes at one price; choose that method",
            ),
            Order::Bracketed if self.laboratory.faults != Faults::NONE => {
                refuse("its bounds hold without the faults of the listings alone; search in binary order")
            }
            _ => Ok(()),
        }
    }

    fn validate_variation(&self, variation: Variation) -> Result<()> {
        let refuse = |reason: String| refuse("variation", variation.name(), reason);
        let (varied, method) = (variation.method(), self.method);
        if method != varied {
            return refuse(format!("it varies the method {}, not {}", varied.name(), method.name()));
        }
        if variation == Variation::ReusedSums && self.search.order != Order::Forward {
            return refuse("it is for a forward search, which grows the box that it has summed".to_owned());
        }
        if self.laboratory.faults != Faults::NONE {
            return refuse("it varies the method without the faults of the listings".to_owned());
        }
        Ok(())
    }
}
