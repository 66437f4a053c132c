//! The bracketed search: bounds for the radii of tiles, of blocks inside them, then the pixels.
//!
//! For a block of side b, let the *outer* box of radius r be the union of its pixels' boxes, and the *inner*
//! box what they have in common. Let L be the smallest radius whose outer box holds enough: no pixel's radius
//! is smaller. The inner box of radius L + b - 1 is the outer box of L, so no pixel's radius is larger than
//! that. One search for L thus leaves b candidates for every pixel of the block; for a block inside a larger
//! one, of side B, it starts with B - b + 1. Where an edge is in reach and the count is scaled, the inside
//! area differs from pixel to pixel: L is tested with the least, and the upper bound is searched with the
//! most. Both tests are monotone in r, as is the pixel's own between them, so that the result is the
//! definition's.
//!
//! A tile of 64 x 64 pixels also says which programs its pixels take, and the vertex stage draws nothing for
//! the others:
//!
//! | class | what is known | its pixels |
//! |---|---|---|
//! | unreached | no box of MR holds enough, or the mask excludes all | are set in one clear |
//! | dense | n in 16 pixels on the average | try 1, 2, ... |
//! | inner | no edge in reach, or edges are zero | brackets of 8, of 2, one box each: no loop, no branch |
//! | edge | scaled counts | brackets of 8, of 2, with loops |
//! | kept | no changed pixel within the radii of the frame before | stay as they are |
//!
//! - Cost, inner: 4 fetches for each of 6 boxes in 64 pixels, 3 in 4, and 1 a pixel, whatever the density and
//!   MR. Dense: 1 to 2 boxes a pixel. Unreached: nothing. Edge: as inner and about half as much again.
//! - Memory: 4 bytes a block, 5 a tile: 0.27 of the map together.
//! - Exact while a box of radius MR + 32 does not wrap, since outer boxes are larger than those of pixels.
//!
//! Tried, and not taken (llvmpipe, 1024², in probe passes):
//!
//! - the four nearest of a coarse grid, |R(p) - R(q)| <= distance: 2.2 to 3.8 in a first trial; they take as
//!   many fetches as a box and leave up to 5 candidates;
//! - the same blocks without classes, with loops everywhere: 3.4 to 4.1, since a loop costs 0.7 there,
//!   entered or not;
//! - blocks of 4 in place of 2, two boxes a pixel: 2.1 to 2.4 for the pixels alone, against 1.3 to 1.6;
//! - tiles of 32: fewer pixels near edges, but quads of 4 x 4 and 16 x 16 fragments on the way: 0.3 more;
//! - skipping the box of a pixel whose bracket is decided: llvmpipe computes both sides of every branch.

mod class;

use glam::UVec2;

use self::class::{Class, define_classes};
use super::mask_tiles::{self, MaskTiles};
use super::{of_pixels, search_source, unreached};
use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, Target, TargetShape, Targets, Texture, TextureFormat, TextureShape, glsl,
};
use crate::maps::RadiusMap;
use crate::maps::{Changed, Frame, Rectangle};
use crate::radius::tables::{self, Tables};
use crate::settings::{BRACKET_TILE_SIDE as TILE_SIDE, Edges, Order, Search, Settings};

const TILE: &str = "radius tiles";
const BLOCKS: &str = "radius blocks";

/// Pixels of the sides of the blocks inside, each with the side of what it lies in.
const BLOCK_SIDES: [(u32, u32); 2] = [(TILE_SIDE, 8), (8, FINEST_SIDE)];
/// Pixels of the side of the smallest blocks: 2, so that two radii are left for a pixel.
const FINEST_SIDE: u32 = 2;

/// Brackets of tiles and blocks, and the programs that fill them and the map.
#[derive(Debug)]
pub(super) struct Bracketed {
    /// Brackets and classes, of this frame and of the one before.
    tiles: Target,
    tiles_before: Target,
    tile: [Program; Before::ALL.len()],
    mask_tiles: Option<MaskTiles>,
    blocks: Vec<Blocks>,
    pixels: Vec<(Class, Program)>,
    /// One more than MR stands for "not even MR", which only the mask wants to know.
    last_radius: u32,
    settings: Settings,
}

/// The brackets of blocks of one size.
#[derive(Debug)]
struct Blocks {
    target: Target,
    programs: Vec<Program>,
}

impl Bracketed {
    pub(super) fn new(gl: &Gl, size: UVec2, density: TextureFormat, settings: &Settings) -> Result<Self> {
        let mut targets = Targets::new(gl, &shapes(size, settings))?;
        let programs = |sources: Vec<ShaderSource>| {
            sources.iter().map(|source| Program::new(gl, source)).collect::<Result<Vec<_>>>()
        };
        let blocks = BLOCK_SIDES.map(|(wider_side, side)| {
            Ok(Blocks {
                target: targets.take(),
                programs: programs(block_sources(density, settings, wider_side, side))?,
            })
        });
        let [nothing, changed, added] =
            Before::ALL.map(|before| Program::new(gl, &tile_source(density, settings, before)));
        let pixels = pixel_sources(density, settings);
        let classes: Vec<_> = pixels.iter().map(|&(class, _)| class).collect();
        let pixels = programs(pixels.into_iter().map(|(_, source)| source).collect())?;
        Ok(Self {
            tiles: targets.take(),
            tiles_before: targets.take(),
            tile: [nothing?, changed?, added?],
            mask_tiles: if settings.masked { Some(MaskTiles::new(gl, &mut targets)?) } else { None },
            blocks: blocks.into_iter().collect::<Result<_>>()?,
            pixels: classes.into_iter().zip(pixels).collect(),
            last_radius: settings.search.max_radius + u32::from(settings.limited_mask),
            settings: *settings,
        })
    }

    pub(super) fn resize(&mut self, targets: &mut Targets) {
        for blocks in &mut self.blocks {
            blocks.target = targets.take();
        }
        (self.tiles, self.tiles_before) = (targets.take(), targets.take());
        self.mask_tiles.iter_mut().for_each(|mask_tiles| mask_tiles.resize(targets));
    }

    pub(super) fn estimate(
        &mut self,
        frame: &Frame<'_>,
        tables: &Tables,
        radii: &mut RadiusMap,
    ) -> Result<()> {
        let search = self.settings.search;
        let map_size = frame.density.size();
        let of_blocks = |label, program| {
            let pass = Pass::new(label, program)
                .set("map_size", map_size.as_ivec2())
                .set("min_photons", search.min_photons);
            tables.read_by(pass, frame.density)
        };

        std::mem::swap(&mut self.tiles, &mut self.tiles_before);
        let (before, changed) = Before::of(frame, map_size);
        let mut pass =
            of_blocks(TILE, &self.tile[before as usize]).set("last_radius", self.last_radius.cast_signed());
        if let (Some(tiles), Some(mask)) = (&mut self.mask_tiles, frame.mask) {
            pass = pass.read("tile_mask", tiles.reduce(mask)?);
        }
        if before != Before::Nothing {
            pass = pass
                .read("brackets_before", self.tiles_before.texture())
                .set("changed_first", changed.first.as_ivec2())
                .set("changed_end", changed.end.as_ivec2());
        }
        pass.fill(&mut self.tiles)?;

        let [tile_brackets, classes] = self.tiles.textures() else { unreachable!("made with two") };
        let mut wider = tile_brackets;
        for Blocks { target, programs } in &mut self.blocks {
            for program in &*programs {
                in_tiles(of_blocks(BLOCKS, program).read("wider", wider), classes).fill(target)?;
            }
            wider = target.texture();
        }

        // A clear takes no heed of what is kept.
        let clears = before == Before::Nothing && !frame.leaves_out_pixels();
        if clears {
            unreached::clear(&self.settings, radii);
        }
        for (class, program) in &self.pixels {
            let pass = match class {
                Class::Unreached if clears => continue,
                Class::Unreached => {
                    unreached::pass(&self.settings, program, frame).set("map_size", map_size.as_ivec2())
                }
                Class::Dense => of_pixels(&self.settings, program, frame, tables)
                    .set("first_radius", 1)
                    .set("last_radius", search.max_radius.cast_signed()),
                _ => of_pixels(&self.settings, program, frame, tables).read("brackets", wider),
            };
            in_tiles(pass, classes).fill(radii.target())?;
        }
        Ok(())
    }
}

/// Brackets of blocks, then of tiles with their classes, of this frame and of the one before; reduced masks.
pub(super) fn shapes(size: UVec2, settings: &Settings) -> Vec<TargetShape> {
    let texture = |label, format, side: u32| TextureShape::new(label, format, (size + side - 1) / side);
    let blocks = |side| vec![texture("brackets of blocks", TextureFormat::R32Uint, side)];
    let mut shapes = BLOCK_SIDES.map(|(_, side)| blocks(side)).to_vec();
    let tiles = vec![
        texture("brackets of tiles", TextureFormat::R32Uint, TILE_SIDE),
        texture("classes of tiles", TextureFormat::R8Uint, TILE_SIDE),
    ];
    shapes.extend([tiles.clone(), tiles]);
    if settings.masked {
        shapes.extend(mask_tiles::shapes(size));
    }
    shapes
}

/// What is known of the tiles before their search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Before {
    /// Nothing.
    Nothing,
    /// Its radii in the frame before, valid where no changed pixel is within them.
    Changed,
    /// The same, and that no radius has become larger.
    Added,
}

impl Before {
    const ALL: [Self; 3] = [Self::Nothing, Self::Changed, Self::Added];

    /// What a frame vouches for, and where it changes something.
    fn of(frame: &Frame<'_>, map_size: UVec2) -> (Self, Rectangle) {
        let whole = Rectangle::whole(map_size);
        match frame.changed {
            Changed::Everything | Changed::Nothing => (Self::Nothing, whole),
            Changed::Added => (Self::Added, whole),
            Changed::Rectangle { first, size } => {
                let nowhere = Rectangle { first: map_size, end: map_size };
                (Self::Changed, Rectangle::inside(map_size, first, size).unwrap_or(nowhere))
            }
        }
    }
}

/// Draws the tiles of the program's class.
fn in_tiles<'a>(pass: Pass<'a>, classes: &'a Texture) -> Pass<'a> {
    let grid = classes.size();
    pass.read("tile_classes", classes)
        .set("tile_columns", grid.x.cast_signed())
        .triangles(2 * grid.x * grid.y)
}

/// Every shader of the search.
pub(super) fn sources(density: TextureFormat, settings: &Settings) -> Vec<ShaderSource> {
    let mut sources = Before::ALL.map(|before| tile_source(density, settings, before)).to_vec();
    if settings.masked {
        sources.push(mask_tiles::source());
    }
    for (wider_side, side) in BLOCK_SIDES {
        sources.extend(block_sources(density, settings, wider_side, side));
    }
    sources.extend(pixel_sources(density, settings).into_iter().map(|(_, source)| source));
    sources
}

/// The brackets and classes of tiles.
fn tile_source(density: TextureFormat, settings: &Settings, before: Before) -> ShaderSource {
    let source = define_classes(ShaderSource::new(TILE))
        .variant_if(before == Before::Changed, "changed")
        .variant_if(before == Before::Added, "added")
        .targets([TextureFormat::R32Uint, TextureFormat::R8Uint])
        .define_if(settings.masked, "MASKED")
        .define_if(before != Before::Nothing, "CHANGED")
        .define_if(before == Before::Added, "ONLY_ADDED");
    of_block(source, density, settings, TILE_SIDE).file(glsl!("radius/search/bracketed/tile.frag"))
}

/// The brackets of blocks, for each class that needs them.
fn block_sources(
    density: TextureFormat,
    settings: &Settings,
    wider_side: u32,
    side: u32,
) -> Vec<ShaderSource> {
    let of_class = |class: Class| {
        let source = class
            .define(ShaderSource::new(BLOCKS))
            .variant(side.to_string())
            .targets([TextureFormat::R32Uint])
            .define("TILE_SIDE", TILE_SIDE)
            .define("WIDER_SIDE", wider_side)
            .define("WIDER_SIDE_LOG2", wider_side.ilog2())
            .vertex_file(glsl!("common/tiles.vert"));
        if class == Class::Inner {
            // One step halves the radii that are left.
            let steps = (wider_side - side + 1).next_power_of_two().ilog2();
            of_block(source.define("STEPS", steps), density, &without_edges(settings), side)
                .file(glsl!("radius/search/bracketed/inner.frag"))
        } else {
            of_block(source, density, settings, side).file(glsl!("radius/search/bracketed/edge.frag"))
        }
    };
    Class::WITH_BLOCKS.into_iter().filter(|class| class.occurs(settings)).map(of_class).collect()
}

/// Adds the edge rule, the counter, and the boxes around a block.
fn of_block(source: ShaderSource, density: TextureFormat, settings: &Settings, side: u32) -> ShaderSource {
    let source = source.define("SIDE", side).define("SIDE_LOG2", side.ilog2());
    let source = tables::edge_rule(source, settings);
    tables::counter(source, density, settings).file(glsl!("radius/search/bracketed/block.glsl"))
}

/// The pixels of each class that is drawn.
fn pixel_sources(density: TextureFormat, settings: &Settings) -> Vec<(Class, ShaderSource)> {
    let of_class = |class: Class| {
        let settings = match class {
            Class::Dense => {
                let search = Search { order: Order::Forward, ..settings.search };
                Settings { search, ..*settings }
            }
            Class::Inner => without_edges(settings),
            Class::Unreached | Class::Edge | Class::Kept => *settings,
        };
        let source = match class {
            Class::Unreached => unreached::source(&settings),
            _ => search_source(density, &settings, super::Continued::No),
        };
        let source = class
            .define(source)
            .define("TILE_SIDE", TILE_SIDE)
            .define("SIDE", 1_u32)
            .define("WIDER_SIDE_LOG2", FINEST_SIDE.ilog2())
            .vertex_file(glsl!("common/tiles.vert"));
        (class, source)
    };
    let classes = [Class::Unreached, Class::Dense, Class::Inner, Class::Edge].into_iter();
    classes.filter(|class| class.occurs(settings)).map(of_class).collect()
}

/// The same question where no edge is in reach.
fn without_edges(settings: &Settings) -> Settings {
    Settings { search: Search { edges: Edges::Zero, ..settings.search }, ..*settings }
}
