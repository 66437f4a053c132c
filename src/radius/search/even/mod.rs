//! The widest box over which the density is even but for noise
//! ([`Rule::Even`](crate::settings::Rule::Even)): not in the thesis.
//!
//! Radii are 0, 1, 2, 4, ... up to MR. How far the box of each is from the density of the one before is
//! tested in the summed-area table of the photons, and these *departures* are summed in tables of their own,
//! so that their mean over any box takes four fetches. The definition, [`reference::even`](crate::reference::even),
//! derives the test.
//!
//! - Radii up to 8 are tested at each pixel, two of them in one number. The wider one has the lower 18 bits,
//!   as many as its sum over 33 x 33 pixels takes; what is above falls away. Over the 9 x 9 pixels of the
//!   narrower one nothing is carried into its 14 bits, which hold its sum as well.
//! - Wider ones are tested at one pixel in a square of a quarter of the radius, and share a texture.
//! - Cost: five boxes in the first table, up to one a radius in those of departures, two scans of the whole
//!   map and one of an eighth of it, whatever the density. A mask saves the last pass alone, since pixels
//!   beside it are tested too; a frame that changed in a rectangle is tested as a whole.
//! - Memory: 25 bytes a pixel beside the first table and the radii.
//! - Exact: numbers of 32 and 64 bits throughout, while no box of MR holds 2^32 photons.

use glam::UVec2;

use super::of_mask;
use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, Target, TargetShape, Targets, Texture, TextureFormat, TextureShape, glsl,
};
use crate::maps::exactness::Plan;
use crate::maps::{DensityMap, Frame, RadiusMap, Rectangle};
use crate::radius::tables::scan::{self, Scan};
use crate::radius::tables::{self, Tables};
use crate::settings::{EVEN_STEPS, Edges, MAX_EVEN_RADIUS, MOST_EVEN_STEPS, Settings, even_step};

const NARROW: &str = "narrow departures";
const WIDE: &str = "wide departures";
const RADII: &str = "even radii";
/// The tables of narrow boxes, as the shader of radii knows them.
const TABLES: [&str; 2] = ["of_1_and_4", "of_2_and_8"];
/// Bits of the lower of two sums in a number: those of the departures of radius 8 in a box of 33 x 33 pixels.
const LOWER_BITS: u32 = 18;

/// The tests of maps of one size.
#[derive(Debug)]
pub(super) struct Even {
    narrow: Program,
    radii: Program,
    departures: Target,
    tables: Vec<Target>,
    scan: Scan,
    wide: Option<Wide>,
    settings: Settings,
}

/// The tests of wide boxes.
#[derive(Debug)]
struct Wide {
    program: Program,
    departures: Target,
    table: Target,
    scan: Scan,
}

impl Even {
    pub(super) fn new(gl: &Gl, size: UVec2, density: TextureFormat, settings: &Settings) -> Result<Self> {
        let mut targets = Targets::new(gl, &shapes_of_tests(size, settings))?;
        let scan = Scan::new(gl, size, TextureFormat::R32Uint, &Settings::default())?;
        Ok(Self {
            narrow: Program::new(gl, &narrow_source(density, settings))?,
            radii: Program::new(gl, &radii_source(settings))?,
            departures: targets.take(),
            tables: tables(settings).map(|_| targets.take()).collect(),
            wide: match wide_size(size, settings) {
                Some(size) => Some(Wide {
                    program: Program::new(gl, &wide_source(density, settings))?,
                    departures: targets.take(),
                    table: targets.take(),
                    scan: scan.beside(gl, size)?,
                }),
                None => None,
            },
            scan,
            settings: *settings,
        })
    }

    pub(super) fn resize(&mut self, size: UVec2, targets: &mut Targets) {
        self.departures = targets.take();
        self.tables.iter_mut().for_each(|table| *table = targets.take());
        if let Some(wide) = &mut self.wide {
            (wide.departures, wide.table) = (targets.take(), targets.take());
        }
        self.scan.resize(size, targets);
        if let (Some(wide), Some(size)) = (&mut self.wide, wide_size(size, &self.settings)) {
            wide.scan.resize(size, targets);
        }
    }

    pub(super) fn estimate(
        &mut self,
        frame: &Frame<'_>,
        tables_of_photons: &Tables,
        radii: &mut RadiusMap,
    ) -> Result<()> {
        let map_size = frame.density.size().as_ivec2();
        let of_boxes = |label, program| {
            let pass = Pass::new(label, program).set("map_size", map_size);
            tables_of_photons.read_by(pass, frame.density)
        };
        of_boxes(NARROW, &self.narrow).fill(&mut self.departures)?;
        for (table, departures) in self.tables.iter_mut().zip(self.departures.textures()) {
            sum(&mut self.scan, departures, table)?;
        }
        let mut pass = Pass::new(RADII, &self.radii).set("map_size", map_size);
        for (name, table) in tables(&self.settings).zip(&self.tables) {
            pass = pass.read(name, table.texture());
        }
        if let Some(Wide { program, departures, table, scan }) = &mut self.wide {
            of_boxes(WIDE, program).fill(departures)?;
            sum(scan, departures.texture(), table)?;
            pass = pass.read("of_wide", table.texture());
        }
        of_mask(pass, frame).fill(radii.target())
    }
}

/// Fills a table of all departures.
fn sum(scan: &mut Scan, departures: &Texture, table: &mut Target) -> Result<()> {
    let plan = Plan { count_limit: u32::MAX, exact: true };
    scan.build(&DensityMap::of_stage(departures), plan, Rectangle::whole(departures.size()), table)
}

/// How many radii are tried beside 0.
fn levels(settings: &Settings) -> u32 {
    settings.search.max_radius.ilog2() + 1
}

/// How many of all possible radii are tested at each pixel.
fn narrow_levels() -> u32 {
    (0..=MAX_EVEN_RADIUS.ilog2()).take_while(|level| even_step(1 << level) == 1).map(|_| 1).sum()
}

/// The names of the tables of narrow boxes; there is one for the first radius and one for the second.
fn tables(settings: &Settings) -> impl Iterator<Item = &'static str> {
    TABLES.into_iter().take(levels(settings) as usize)
}

/// The size of a map with a place for each test of a wide box, all of a radius beside those of the one
/// before; none if no such radius is tried.
fn wide_size(size: UVec2, settings: &Settings) -> Option<UVec2> {
    (narrow_levels()..levels(settings))
        .map(|level| size.map(|side| side.div_ceil(even_step(1 << level))))
        .reduce(|all, next| UVec2::new(all.x + next.x, all.y.max(next.y)))
}

fn shapes_of_tests(size: UVec2, settings: &Settings) -> Vec<TargetShape> {
    let plain = |label, size| TextureShape::new(label, TextureFormat::R32Uint, size);
    let mut shapes = vec![tables(settings).map(|_| plain(NARROW, size)).collect()];
    shapes.extend(tables(settings).map(|_| vec![plain("sums of departures", size)]));
    if let Some(size) = wide_size(size, settings) {
        shapes.extend([vec![plain(WIDE, size)], vec![plain("sums of departures", size)]]);
    }
    shapes
}

/// What is allocated, in the order in which [`Even::resize`] takes it.
pub(super) fn shapes(size: UVec2, settings: &Settings) -> Vec<TargetShape> {
    let mut shapes = shapes_of_tests(size, settings);
    shapes.extend(scan::shapes(size));
    shapes.extend(wide_size(size, settings).into_iter().flat_map(scan::shapes));
    shapes
}

/// The shaders in the order of the passes.
pub(super) fn sources(density: TextureFormat, settings: &Settings) -> Vec<ShaderSource> {
    let sums = scan::sources(TextureFormat::R32Uint, &Settings::default());
    let mut sources = vec![narrow_source(density, settings)];
    sources.extend(sums.into_iter().map(|source| source.variant("departures")));
    sources.extend(wide_size(UVec2::ONE, settings).map(|_| wide_source(density, settings)));
    sources.push(radii_source(settings));
    sources
}

fn narrow_source(density: TextureFormat, settings: &Settings) -> ShaderSource {
    let formats = tables(settings).map(|_| TextureFormat::R32Uint);
    of_departures(ShaderSource::new(NARROW).targets(formats), density, settings)
        .file(glsl!("radius/search/even/narrow.frag"))
}

fn wide_source(density: TextureFormat, settings: &Settings) -> ShaderSource {
    of_departures(ShaderSource::new(WIDE).targets([TextureFormat::R32Uint]), density, settings)
        .file(glsl!("radius/search/even/wide.frag"))
}

/// Adds the test of two boxes.
fn of_departures(source: ShaderSource, density: TextureFormat, settings: &Settings) -> ShaderSource {
    let source = with_levels(source, settings)
        .define("MOST_EVEN_STEPS", MOST_EVEN_STEPS)
        .define_if(settings.search.edges == Edges::Zero, "EDGES_ZERO")
        .file(glsl!("common/product.glsl"))
        .file(glsl!("radius/search/even/threshold.glsl"));
    tables::counter(source, density, settings).file(glsl!("radius/search/even/departure.glsl"))
}

fn radii_source(settings: &Settings) -> ShaderSource {
    let source = ShaderSource::new(RADII)
        .targets(RadiusMap::formats(settings.limited_mask))
        .define_if(settings.limited_mask, "LIMITED_MASK")
        .define_if(settings.masked, "MASKED");
    with_levels(source, settings)
        .file(glsl!("common/mask.glsl"))
        .file(glsl!("radius/search/even/threshold.glsl"))
        .file(glsl!("radius/search/even/radii.frag"))
}

/// Adds which radii there are, and the unit of departures.
fn with_levels(source: ShaderSource, settings: &Settings) -> ShaderSource {
    source
        .define("LEVELS", levels(settings))
        .define("NARROW_LEVELS", narrow_levels())
        .define_if(levels(settings) > 1, "SEVERAL_LEVELS")
        .define_if(levels(settings) > narrow_levels(), "WIDE_LEVELS")
        .define("LOWER_BITS", LOWER_BITS)
        .define("EVEN_STEPS_LOG2", EVEN_STEPS.ilog2())
}
