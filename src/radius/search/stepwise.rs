//! The thesis's searches (3.5): radius by radius, or halving the range; every pixel by itself.

use std::ops::RangeInclusive;

use glam::UVec2;

use super::{Continued, of_pixels, search_source};
use crate::error::Result;
use crate::gl::{Gl, Pass, Program, TargetShape, Targets, TextureFormat};
use crate::maps::RadiusMap;
use crate::maps::{Changed, Frame, Rectangle};
use crate::radius::tables::Tables;
use crate::settings::{Method, Order, Settings};

/// One program, or two where a renderer's limits call for several passes.
#[derive(Debug)]
pub(super) struct Stepwise {
    program: Program,
    /// The radii that each pass tries.
    passes: Vec<RangeInclusive<u32>>,
    /// What the passes after the first need: a program that goes on, and a map that takes turns.
    continued: Option<(Program, RadiusMap)>,
    settings: Settings,
}

impl Stepwise {
    pub(super) fn new(
        gl: &Gl,
        size: UVec2,
        density: TextureFormat,
        settings: &Settings,
        passes: Vec<RangeInclusive<u32>>,
    ) -> Result<Self> {
        let continued = if passes.len() > 1 {
            let source = search_source(density, settings, Continued::Yes);
            let spare = Targets::new(gl, &shapes(size, settings, passes.len()))?.take();
            Some((Program::new(gl, &source)?, RadiusMap::of(spare)))
        } else {
            None
        };
        let program = Program::new(gl, &search_source(density, settings, Continued::No))?;
        Ok(Self { program, passes, continued, settings: *settings })
    }

    pub(super) fn passes(&self) -> usize {
        self.passes.len()
    }

    pub(super) fn resize(&mut self, targets: &mut Targets) {
        if let Some((_, spare)) = &mut self.continued {
            *spare = RadiusMap::of(targets.take());
        }
    }

    pub(super) fn estimate(
        &mut self,
        frame: &Frame<'_>,
        tables: &Tables,
        found: &mut RadiusMap,
    ) -> Result<()> {
        let settings = &self.settings;
        let map_size = frame.density.size();
        let region = match frame.changed {
            // Two maps take turns where there are several passes, so that neither holds what did not change.
            Changed::Rectangle { first, size } if self.continued.is_none() => {
                Rectangle::inside(map_size, first, size)
                    .map(|changed| changed.grown(settings.search.max_radius, map_size))
            }
            _ => Some(Rectangle::whole(map_size)),
        };
        let Some(region) = region else { return Ok(()) };
        of_radii(settings, &self.program, &self.passes[0], frame, tables).fill_between(
            region.first,
            region.end,
            found.target(),
        )?;
        if let Some((program, spare)) = &mut self.continued {
            for radii in &self.passes[1..] {
                let pass = of_radii(settings, program, radii, frame, tables);
                pass.read("found_before", found.as_texture()).fill(spare.target())?;
                std::mem::swap(found, spare);
            }
        }
        Ok(())
    }
}

/// A map that takes turns, if there are several passes.
pub(super) fn shapes(size: UVec2, settings: &Settings, passes: usize) -> Vec<TargetShape> {
    if passes > 1 { vec![RadiusMap::shape(size, settings.limited_mask)] } else { Vec::new() }
}

/// A pass that tries `radii`.
fn of_radii<'a>(
    settings: &Settings,
    program: &'a Program,
    radii: &RangeInclusive<u32>,
    frame: &Frame<'a>,
    tables: &'a Tables,
) -> Pass<'a> {
    let pass = of_pixels(settings, program, frame, tables);
    if settings.search.order == Order::Forward && settings.method != Method::NaiveMipmap {
        pass.set("first_radius", radii.start().cast_signed()).set("last_radius", radii.end().cast_signed())
    } else {
        pass
    }
}
