//! The search: density map and structure in, radius map out (thesis 3.5).

mod bracketed;
mod even;
mod grid;
mod mask_tiles;
mod stepwise;
mod unreached;

pub(crate) use grid::{GridSearch, source as grid_source};

use std::ops::RangeInclusive;

use glam::UVec2;

use crate::error::Result;
use crate::gl::{Gl, Pass, Program, ShaderSource, Target, TargetShape, Targets, TextureFormat, glsl};
use crate::maps::Frame;
use crate::maps::RadiusMap;
use crate::radius::tables::{self, Tables};
use crate::settings::{Method, Order, Rule, Settings};

const SEARCH: &str = "radius search";

/// The search of one method and the map that it fills.
#[derive(Debug)]
pub(crate) struct RadiusSearch {
    way: Way,
    radii: RadiusMap,
    /// For maps without a photon.
    unreached: Program,
    settings: Settings,
}

/// By rule and order.
#[derive(Debug)]
enum Way {
    Stepwise(Box<stepwise::Stepwise>),
    Bracketed(Box<bracketed::Bracketed>),
    Even(Box<even::Even>),
}

impl RadiusSearch {
    pub(crate) fn new(
        gl: &Gl,
        size: UVec2,
        density: TextureFormat,
        settings: &Settings,
        passes: Vec<RangeInclusive<u32>>,
    ) -> Result<Self> {
        let way = match (settings.rule, settings.search.order) {
            (Rule::Even, _) => Way::Even(Box::new(even::Even::new(gl, size, density, settings)?)),
            (Rule::Nearest, Order::Forward | Order::Binary) => {
                Way::Stepwise(Box::new(stepwise::Stepwise::new(gl, size, density, settings, passes)?))
            }
            (Rule::Nearest, Order::Bracketed) => {
                Way::Bracketed(Box::new(bracketed::Bracketed::new(gl, size, density, settings)?))
            }
        };
        Ok(Self {
            way,
            radii: RadiusMap::of(Target::of(gl, &RadiusMap::shape(size, settings.limited_mask))?),
            unreached: Program::new(gl, &unreached::source(settings))?,
            settings: *settings,
        })
    }

    /// What a search of that many passes allocates for maps of `size`, in the order in which
    /// [`resize`](Self::resize) takes it.
    pub(crate) fn shapes(size: UVec2, settings: &Settings, passes: usize) -> Vec<TargetShape> {
        let mut shapes = match (settings.rule, settings.search.order) {
            (Rule::Even, _) => even::shapes(size, settings),
            (Rule::Nearest, Order::Forward | Order::Binary) => stepwise::shapes(size, settings, passes),
            (Rule::Nearest, Order::Bracketed) => bracketed::shapes(size, settings),
        };
        shapes.push(RadiusMap::shape(size, settings.limited_mask));
        shapes
    }

    /// What it would allocate for another size.
    pub(crate) fn shapes_at(&self, size: UVec2) -> Vec<TargetShape> {
        let passes = match &self.way {
            Way::Stepwise(stepwise) => stepwise.passes(),
            Way::Bracketed(_) | Way::Even(_) => 1,
        };
        Self::shapes(size, &self.settings, passes)
    }

    /// Takes targets for maps of another size; it holds no radii then.
    pub(crate) fn resize(&mut self, size: UVec2, targets: &mut Targets) {
        match &mut self.way {
            Way::Stepwise(stepwise) => stepwise.resize(targets),
            Way::Bracketed(bracketed) => bracketed.resize(targets),
            Way::Even(even) => even.resize(size, targets),
        }
        self.radii = RadiusMap::of(targets.take());
    }

    /// Searches the pixels whose radius can differ from what the map holds.
    pub(crate) fn estimate(&mut self, frame: &Frame<'_>, tables: &Tables) -> Result<()> {
        match &mut self.way {
            Way::Stepwise(stepwise) => stepwise.estimate(frame, tables, &mut self.radii),
            Way::Bracketed(bracketed) => bracketed.estimate(frame, tables, &mut self.radii),
            Way::Even(even) => even.estimate(frame, tables, &mut self.radii),
        }
    }

    /// Gives every pixel what it has where there is no photon.
    pub(crate) fn find_nothing(&mut self, frame: &Frame<'_>) -> Result<()> {
        unreached::fill(&self.settings, &self.unreached, frame, &mut self.radii)
    }

    pub(crate) fn radii(&self) -> &RadiusMap {
        &self.radii
    }
}

/// What every pass over the pixels reads and sets.
fn of_pixels<'a>(
    settings: &Settings,
    program: &'a Program,
    frame: &Frame<'a>,
    tables: &'a Tables,
) -> Pass<'a> {
    let pass = Pass::new(SEARCH, program)
        .set("map_size", frame.density.size().as_ivec2())
        .set("min_photons", settings.search.min_photons)
        .set("max_radius", settings.search.max_radius.cast_signed());
    of_mask(tables.read_by(pass, frame.density), frame)
}

/// Adds the frame's mask, if it has one.
fn of_mask<'a>(pass: Pass<'a>, frame: &Frame<'a>) -> Pass<'a> {
    match frame.mask {
        Some(mask) => pass.read("mask", mask.texture()),
        None => pass,
    }
}

/// Whether a search goes on where an earlier pass found nothing.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Continued {
    No,
    Yes,
}

/// Every shader that a search of these settings may compile.
pub(crate) fn search_sources(density: TextureFormat, settings: &Settings) -> Vec<ShaderSource> {
    let one_pass = search_source(density, settings, Continued::No);
    let mut sources = match (settings.rule, settings.search.order) {
        (Rule::Even, _) => even::sources(density, settings),
        (Rule::Nearest, Order::Forward) if settings.method != Method::NaiveMipmap => {
            vec![one_pass, search_source(density, settings, Continued::Yes)]
        }
        (Rule::Nearest, Order::Forward | Order::Binary) => vec![one_pass],
        (Rule::Nearest, Order::Bracketed) => bracketed::sources(density, settings),
    };
    sources.push(unreached::source(settings));
    sources
}

/// One search and one counter.
fn search_source(density: TextureFormat, settings: &Settings, continued: Continued) -> ShaderSource {
    let source = ShaderSource::new(SEARCH)
        .variant_if(continued == Continued::Yes, "continued")
        .targets(RadiusMap::formats(settings.limited_mask))
        .define_if(settings.laboratory.faults.float_ratio, "FAULT_FLOAT_RATIO")
        .define_if(settings.limited_mask, "LIMITED_MASK")
        .define_if(settings.masked, "MASKED")
        .define_if(continued == Continued::Yes, "CONTINUED");
    let source = match settings.search.order {
        Order::Forward => source.define("ORDER_FORWARD", 1_u32),
        Order::Binary => source,
        Order::Bracketed => source.define("ORDER_BRACKETED", 1_u32),
    };
    let source = tables::edge_rule(source.file(glsl!("common/mask.glsl")), settings);
    tables::counter(source, density, settings).file(match settings.method {
        Method::NaiveMipmap => glsl!("radius/search/naive_mipmap.frag"),
        _ => glsl!("radius/search/stepwise.frag"),
    })
}
