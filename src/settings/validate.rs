//! Which settings go together.

use super::{Faults, MAX_RADIUS_LIMIT, Method, Order, SatBuild, Search, Settings, Storage, Variation};
use crate::error::{Error, Result};

/// The largest [`Search::max_radius`] of the naive mipmap, whose blocks have up to four times that side.
const NAIVE_MAX_RADIUS: u32 = 16_384;

impl Storage {
    /// Whether only the summed-area table, without the listings' faults, is kept in it.
    fn is_for_tables_alone(self) -> bool {
        !matches!(self, Self::F32 | Self::U32)
    }
}

impl Settings {
    /// Checks every range, and that the variation fits.
    ///
    /// # Errors
    /// [`Error::Setting`] with the field's name.
    pub fn validate(&self) -> Result<()> {
        let Search { min_photons, max_radius, .. } = self.search;
        if min_photons == 0 {
            return Err(Error::Setting {
                name: "min_photons",
                value: "0".to_owned(),
                reason: "every box holds 0 photons; ask for at least 1".to_owned(),
            });
        }
        if max_radius == 0 || max_radius > MAX_RADIUS_LIMIT {
            return Err(Error::Setting {
                name: "max_radius",
                value: max_radius.to_string(),
                reason: format!(
                    "it goes from 1, where the search starts, to {MAX_RADIUS_LIMIT}, where the area (2 MR + 1)² \
                     still fits 32 bits"
                ),
            });
        }
        if self.method == Method::NaiveMipmap && max_radius > NAIVE_MAX_RADIUS {
            return Err(Error::Setting {
                name: "max_radius",
                value: max_radius.to_string(),
                reason: format!(
                    "the naive mipmap goes up to {NAIVE_MAX_RADIUS}: the area of its last block must fit 32 bits"
                ),
            });
        }
        if self.sat_build == SatBuild::Scan
            && !self.storage.is_integer()
            && self.method == Method::SummedAreaTable
        {
            return Err(Error::Setting {
                name: "sat_build",
                value: "scan".to_owned(),
                reason: "a scan adds integers; keep the sums in u32, or build by doubling".to_owned(),
            });
        }
        if self.storage.is_for_tables_alone() {
            let refuse = |reason: &str| {
                let value = self.storage.name().to_owned();
                Err(Error::Setting { name: "storage", value, reason: reason.to_owned() })
            };
            if self.method != Method::SummedAreaTable {
                return refuse("only the summed-area table is kept in it; keep the sums in u32 or f32");
            }
            if self.faults != Faults::NONE {
                return refuse("the listings keep plain sums; run them in u32 or f32");
            }
        }
        if self.search.order == Order::Bracketed {
            let refuse = |reason: &str| {
                Err(Error::Setting {
                    name: "search",
                    value: "bracketed".to_owned(),
                    reason: reason.to_owned(),
                })
            };
            if self.method != Method::SummedAreaTable {
                return refuse(
                    "it counts boxes of many shapes, which only the summed-area table does at one price",
                );
            }
            if self.faults != Faults::NONE {
                return refuse("its bounds hold for the listings without their faults");
            }
        }
        if let Some(variation) = self.variation {
            let refuse = |reason: String| {
                Err(Error::Setting { name: "variation", value: format!("{variation:?}"), reason })
            };
            if self.method != variation.method() {
                return refuse(format!("it varies {:?}, not {:?}", variation.method(), self.method));
            }
            if variation == Variation::ReusedSums && self.search.order != Order::Forward {
                return refuse("only a forward search grows the box that it has summed".to_owned());
            }
            if self.faults != Faults::NONE {
                return refuse("it varies the method without the thesis's faults".to_owned());
            }
        }
        Ok(())
    }
}
