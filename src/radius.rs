//! The search: density map and structure in, radius map out (thesis 3.5).

use std::ops::RangeInclusive;

use glam::UVec2;

use crate::error::Result;
use crate::exactness;
use crate::gl::{Gl, Pass, Program, ShaderSource, TextureFormat, glsl};
use crate::maps::{DensityMap, RadiusMap};
use crate::settings::{Edges, Method, Order, Settings};
use crate::structure::{self, Structure};

const SEARCH: &str = "radius search";

/// The search of one method and the map that it fills.
#[derive(Debug)]
pub(crate) struct RadiusSearch {
    program: Program,
    radii: RadiusMap,
    /// The radii that each pass tries.
    passes: Vec<RangeInclusive<u32>>,
    /// What the passes after the first need: a program that goes on, and a map that takes turns.
    continued: Option<(Program, RadiusMap)>,
    settings: Settings,
}

impl RadiusSearch {
    pub(crate) fn new(
        gl: &Gl,
        size: UVec2,
        density: TextureFormat,
        settings: &Settings,
        passes: Vec<RangeInclusive<u32>>,
    ) -> Result<Self> {
        let map = || RadiusMap::new(gl, size, settings.limited_mask);
        let continued = if passes.len() > 1 {
            let source = search_source(density, settings, Continued::Yes);
            Some((Program::new(gl, &source)?, map()?))
        } else {
            None
        };
        let program = Program::new(gl, &search_source(density, settings, Continued::No))?;
        Ok(Self { program, radii: map()?, passes, continued, settings: *settings })
    }

    /// Searches every pixel.
    pub(crate) fn estimate(&mut self, density: &DensityMap, structure: &Structure) -> Result<&RadiusMap> {
        let settings = &self.settings;
        pass(settings, &self.program, &self.passes[0], density, structure).fill(self.radii.target())?;
        if let Some((program, spare)) = &mut self.continued {
            for radii in &self.passes[1..] {
                pass(settings, program, radii, density, structure)
                    .read("found_before", self.radii.as_texture())
                    .fill(spare.target())?;
                std::mem::swap(&mut self.radii, spare);
            }
        }
        Ok(&self.radii)
    }

    pub(crate) fn radii(&self) -> &RadiusMap {
        &self.radii
    }
}

/// What every pass of the search reads and sets.
fn pass<'a>(
    settings: &Settings,
    program: &'a Program,
    radii: &RangeInclusive<u32>,
    density: &'a DensityMap,
    structure: &'a Structure,
) -> Pass<'a> {
    let search = settings.search;
    let pass = Pass::new(SEARCH, program)
        .set("map_size", density.size().as_ivec2())
        .set("min_photons", search.min_photons)
        .set("max_radius", search.max_radius.cast_signed());
    let pass = structure.read_by(pass, density);
    if search.order == Order::Forward && settings.method != Method::NaiveMipmap {
        pass.set("first_radius", radii.start().cast_signed()).set("last_radius", radii.end().cast_signed())
    } else {
        pass
    }
}

/// Whether a search goes on where an earlier pass found nothing.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Continued {
    No,
    Yes,
}

/// One search and one counter.
pub(crate) fn search_source(
    density: TextureFormat,
    settings: &Settings,
    continued: Continued,
) -> ShaderSource {
    let search = settings.search;
    let source = ShaderSource::new(SEARCH)
        .define_if(search.edges == Edges::Zero, "EDGES_ZERO")
        .define_if(settings.faults.float_ratio, "FAULT_FLOAT_RATIO")
        .define_if(exactness::needs_wide_products(settings), "WIDE_PRODUCTS")
        .define_if(settings.limited_mask, "LIMITED_MASK")
        .define_if(continued == Continued::Yes, "CONTINUED");
    let source = match search.order {
        Order::Forward => source.define("ORDER_FORWARD", 1_u32),
        Order::Binary => source,
    };
    let source = source.file(glsl!("common/enough.glsl"));
    structure::counter(source, density, settings).file(match settings.method {
        Method::NaiveMipmap => glsl!("naive_mipmap.frag"),
        _ => glsl!("radius.frag"),
    })
}
