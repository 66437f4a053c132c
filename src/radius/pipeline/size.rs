//! What depends on a pipeline's size: the memory that it takes, and maps of another size.

use glam::UVec2;

use super::{RadiusPipeline, planned};
use crate::error::{Error, Result};
use crate::gl::{DeviceInfo, StateGuard, Targets, bytes_of};
use crate::maps::Mask;
use crate::radius::certificate;
use crate::radius::driver_limits;
use crate::radius::frame_planner::FramePlanner;
use crate::radius::search::RadiusSearch;
use crate::radius::tables::Tables;
use crate::settings::{Order, Planning, Rule, Search, Settings};

/// Bytes of textures and buffers, known before they are made: every level and layer, as large as its format
/// says, as [`Gl::texture_bytes`](crate::Gl::texture_bytes) and [`Gl::buffer_bytes`](crate::Gl::buffer_bytes)
/// count them. A driver may add to it; programs are not counted, nor are maps and masks, which are the
/// host's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct MemoryRequired {
    /// What `new` and `resize` allocate.
    pub at_creation: u64,
    /// What searches of all other orders take, each allocated when
    /// [`set_order`](RadiusPipeline::set_order) or the planner of each frame asks for it the first time; 0 for
    /// [`Rule::Even`], which has no order.
    pub other_orders: u64,
    /// What adding photons ([`Changed::Added`](crate::Changed::Added)) takes, from the first time on.
    pub additions: u64,
    /// What [`certify`](RadiusPipeline::certify) takes, from the first time on.
    pub certificate: u64,
}

impl MemoryRequired {
    /// When everything was used.
    #[must_use]
    pub fn at_most(self) -> u64 {
        self.at_creation + self.other_orders + self.additions + self.certificate
    }
}

impl RadiusPipeline {
    /// The memory of a pipeline for maps of `size`, without a context: on any renderer that has no limits of
    /// its own, which are all but Mesa's llvmpipe with a long forward search by another method than the
    /// summed-area table; see [`memory_required_on`](Self::memory_required_on).
    ///
    /// # Errors
    /// [`Error::Setting`] outside a setting's range.
    pub fn memory_required(size: UVec2, settings: &Settings) -> Result<MemoryRequired> {
        memory(size, settings, |_| Ok(1))
    }

    /// As [`memory_required`](Self::memory_required), on a renderer that is known: to the byte on any.
    ///
    /// # Errors
    /// Those of [`new`](Self::new) that do not need the driver: [`Error::Setting`] and [`Error::TooLarge`].
    pub fn memory_required_on(
        device: &DeviceInfo,
        size: UVec2,
        settings: &Settings,
    ) -> Result<MemoryRequired> {
        check_fits(device, size)?;
        // The naive mipmap is larger than the map.
        for texture in Tables::shapes(size, &resolved(size, settings)).iter().flatten() {
            check_fits(device, texture.size)?;
        }
        memory(size, settings, |settings| Ok(driver_limits::passes(device, settings)?.len()))
    }

    /// From now on for maps of `size`: programs stay, textures are made anew, and the next frame starts from
    /// nothing. The same size is free, and changes nothing.
    ///
    /// Nothing is compiled. The new textures are made before the old ones are freed, so that both take memory
    /// for a moment. What was allocated on demand (other orders apart) is allocated anew when it is used
    /// again. A texture that the host has borrowed ([`RadiusMap::texture`](crate::RadiusMap::texture)) is
    /// gone: ask again.
    ///
    /// # Errors
    /// [`Error::TooLarge`], [`Error::OutOfMemory`], [`Error::ContextLost`], [`Error::Gl`]: but for a lost
    /// context, the pipeline then goes on at its old size, with what it held.
    pub fn resize(&mut self, size: UVec2) -> Result<()> {
        if size == self.size {
            return self.gl.current().map(drop);
        }
        check_fits(self.gl.info(), size)?;
        let _state = StateGuard::new(&self.gl)?;
        let mut shapes = Tables::shapes(size, &self.settings);
        let resting = self.resting.iter().map(|(_, search)| search);
        for search in [&self.search].into_iter().chain(resting) {
            shapes.extend(search.shapes_at(size));
        }
        let mut targets = Targets::new(&self.gl, &shapes)?;
        let of_planner = self.planner.as_ref().map(|planner| planner.targets_at(size)).transpose()?;
        self.gl.check("resizing a radius pipeline")?;

        self.size = size;
        self.built = None;
        self.searched = None;
        self.tables.resize(size, &mut targets);
        self.search.resize(size, &mut targets);
        for (_, search) in &mut self.resting {
            search.resize(size, &mut targets);
        }
        self.certifier.resize();
        if let (Some(planner), Some(targets)) = (&mut self.planner, of_planner) {
            planner.resize(size, targets);
        }
        targets.finish();
        Ok(())
    }

    /// Columns and rows of the maps.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.size
    }
}

/// Refuses maps that the device has no textures for.
pub(crate) fn check_fits(device: &DeviceInfo, size: UVec2) -> Result<()> {
    let limit = device.max_texture_size;
    if size.max_element() > limit {
        return Err(Error::TooLarge { size, limit });
    }
    check_size(size)
}

fn check_size(size: UVec2) -> Result<()> {
    if size.min_element() == 0 {
        return Err(Error::Setting {
            name: "size",
            value: format!("{} x {}", size.x, size.y),
            reason: "a map has at least one pixel".to_owned(),
        });
    }
    Ok(())
}

/// The settings as a pipeline starts with them.
fn resolved(size: UVec2, settings: &Settings) -> Settings {
    planned(size, settings).map_or(*settings, |decision| decision.settings)
}

/// `passes` says how many a search takes.
fn memory(
    size: UVec2,
    settings: &Settings,
    passes: impl Fn(&Settings) -> Result<usize>,
) -> Result<MemoryRequired> {
    check_size(size)?;
    let settings = &resolved(size, settings);
    let of_planner = match settings.planning {
        Planning::AsAsked => 0,
        Planning::EachFrame => FramePlanner::bytes(size),
    };
    let of_every_pixel = if settings.masked { Mask::BYTES_OF_EVERY_PIXEL } else { 0 };
    let search = |settings: &Settings| {
        settings.validate()?;
        Ok(bytes_of(&RadiusSearch::shapes(size, settings, passes(settings)?)))
    };
    let other_orders = Order::ALL
        .into_iter()
        .filter(|&order| settings.rule == Rule::Nearest && order != settings.search.order)
        .map(|order| Settings { search: Search { order, ..settings.search }, ..*settings })
        // An order that is refused takes nothing.
        .filter_map(|settings| search(&settings).ok());
    Ok(MemoryRequired {
        at_creation: search(settings)?
            + bytes_of(&Tables::shapes(size, settings))
            + of_planner
            + of_every_pixel,
        other_orders: other_orders.sum(),
        additions: bytes_of(&Tables::addition_shapes(size, settings)),
        certificate: bytes_of(&certificate::shapes(size, settings)),
    })
}
