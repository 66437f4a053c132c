//! A table built by a work-efficient scan: each count is read twice and each entry written twice, whatever
//! the size.
//!
//! A fragment works on a tile of 4 x 8 texels and writes through several draw buffers, since one that writes
//! a single entry has little to share with its neighbours:
//!
//! 1. the sums of each tile's 8 rows and 4 columns;
//! 2. and 3. a scan of these along rows (what lies left of each tile), then along columns (what lies left
//!    of and below it): sums of groups of elements, then runs of 8 with all groups and elements before them;
//! 4. the entries of each tile, 8 layers of GL_RGBA32UI;
//! 5. the entries in one plain texture, which every search reads.
//!
//! - Passes: 7 at any size. Fetches per texel: 1 + 1 of the map, about 1/3 in between, 1 to unpack.
//! - Memory: the table, its packed form of the same size, and 3/8 + 3/8 of that for the sums in between.
//! - Exact: as any table in u32 or u16; sums wrap alike in every order. Those in between are u32.
//!
//! Tried, and not taken (llvmpipe, 1024², in copies, CPU time):
//!
//! - searching the packed form directly: 0.8 to 1.2 for unpacking are saved, but a probe takes a third longer
//!   (3.3 against 2.5), and every search but one of a dense map takes two or more;
//! - 8 layers of GL_R32UI, a column of 8 texels a fragment: 0.87 to write what 0.82 does here, a probe takes
//!   an eighth longer (2.8), and the rows' sums are no longer shared by the 4 columns of a tile;
//! - rows first in runs of 32, then columns in runs of 8: 0.65 and 0.64, as much as steps 1 and 4, but what
//!   lies below a run is then known only after the second, so that unpacking takes another fetch;
//! - choosing a component by index in place of conditions: 1.3 to 1.9 for unpacking, against 0.8 to 1.2;
//! - a pass of its own that adds up the groups: two passes more, and no less time from 64² to 2048².
//!
//! After Harris, Sengupta and Owens, "Parallel Prefix Sum (Scan) with CUDA" (GPU Gems 3, chapter 39), with
//! draw buffers in the place of shared memory.

use std::ops::Range;
use std::rc::Rc;

use glam::UVec2;

use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, Target, TargetShape, Targets, Texture, TextureFormat, TextureShape, glsl,
};
use crate::maps::DensityMap;
use crate::maps::Rectangle;
use crate::maps::exactness::Plan;
use crate::radius::tables;
use crate::settings::Settings;

/// Texels of a tile.
const TILE: UVec2 = UVec2::new(4, 8);
/// Elements, or rows, that a fragment writes: one for each draw buffer.
const RUN: u32 = 8;

const TILE_SUMS: &str = "sat tile sums";
const GROUP_SUMS: &str = "sat group sums";
const ELEMENTS_BEFORE: &str = "sat elements before";
const TILES: &str = "sat tiles";
const UNPACK: &str = "sat unpack";

/// The passes that fill a table, and what lies between them.
#[derive(Debug)]
pub(crate) struct Scan {
    tile_sums: Stage,
    rows: Direction,
    columns: Direction,
    tiles: Stage,
    unpack: Rc<Program>,
}

impl Scan {
    pub(crate) fn new(gl: &Gl, size: UVec2, density: TextureFormat, settings: &Settings) -> Result<Self> {
        let mut targets = Targets::new(gl, &shapes(size))?;
        Ok(Self {
            tile_sums: Stage::new(gl, &tile_sums_source(density, settings), &mut targets)?,
            rows: Direction::new(gl, Axis::Rows, grid(size), &mut targets)?,
            columns: Direction::new(gl, Axis::Columns, grid(size), &mut targets)?,
            tiles: Stage::new(gl, &tiles_source(density, settings), &mut targets)?,
            unpack: Rc::new(Program::new(gl, &unpack_source(settings))?),
        })
    }

    /// For maps of another size beside these, by the same programs.
    pub(crate) fn beside(&self, gl: &Gl, size: UVec2) -> Result<Self> {
        let mut targets = Targets::new(gl, &shapes(size))?;
        Ok(Self {
            tile_sums: self.tile_sums.beside(&mut targets),
            rows: self.rows.beside(grid(size), &mut targets),
            columns: self.columns.beside(grid(size), &mut targets),
            tiles: self.tiles.beside(&mut targets),
            unpack: Rc::clone(&self.unpack),
        })
    }

    pub(crate) fn resize(&mut self, size: UVec2, targets: &mut Targets) {
        self.tile_sums.target = targets.take();
        self.rows.resize(grid(size), targets);
        self.columns.resize(grid(size), targets);
        self.tiles.target = targets.take();
    }

    /// Fills `table` from a density map, of which `changed` differs from the one before.
    ///
    /// Of the sums between, those of the changed tiles and of the lines through them are made anew; of the
    /// entries, those from the first changed one on to the right and above.
    pub(crate) fn build(
        &mut self,
        density: &DensityMap,
        plan: Plan,
        changed: Rectangle,
        table: &mut Target,
    ) -> Result<()> {
        let Self { tile_sums, rows, columns, tiles, unpack } = self;
        let (first, end) = (changed.first / TILE, (changed.end + TILE - 1) / TILE);
        of_map(Pass::new(TILE_SUMS, &tile_sums.program), density, plan).fill_between(
            first,
            end,
            &mut tile_sums.target,
        )?;
        let sums = tile_sums.target.texture();
        rows.scan(2 * first.y..2 * end.y, &[("tile_sums", sums)])?;
        let rows_before = rows.elements_before.target.texture();
        let grid = tile_sums.target.size();
        columns.scan(first.x..grid.x, &[("tile_sums", sums), ("rows_before", rows_before)])?;
        of_map(Pass::new(TILES, &tiles.program), density, plan)
            .read("rows_before", rows_before)
            .read("columns_before", columns.elements_before.target.texture())
            .fill_from(first, &mut tiles.target)?;
        Pass::new(UNPACK, unpack).read("tiles", tiles.target.texture()).fill_from(changed.first, table)
    }
}

/// Columns and rows of tiles.
fn grid(size: UVec2) -> UVec2 {
    (size + TILE - 1) / TILE
}

/// The sums between, in the order of the passes.
pub(crate) fn shapes(size: UVec2) -> Vec<TargetShape> {
    let layered =
        |label, size, layers| vec![TextureShape::layered(label, TextureFormat::Rgba32Uint, size, layers)];
    let mut shapes = vec![layered(TILE_SUMS, grid(size), 3)];
    for axis in [Axis::Rows, Axis::Columns] {
        let Elements { count, lines, group_size } = Elements::of(axis, grid(size));
        let groups = axis.place(count.div_ceil(group_size), lines);
        shapes.push(vec![TextureShape::new(GROUP_SUMS, TextureFormat::Rgba32Uint, groups)]);
        shapes.push(layered(ELEMENTS_BEFORE, axis.place(count.div_ceil(RUN), lines), RUN));
    }
    shapes.push(layered(TILES, grid(size), RUN));
    shapes
}

/// Adds what a pass over the map's counts needs.
fn of_map<'a>(pass: Pass<'a>, density: &'a DensityMap, plan: Plan) -> Pass<'a> {
    pass.read("density", density.as_texture())
        .set("map_size", density.size().as_ivec2())
        .set("count_limit", plan.count_limit)
}

/// A program and the target that it fills.
#[derive(Debug)]
struct Stage {
    program: Rc<Program>,
    target: Target,
}

impl Stage {
    fn new(gl: &Gl, source: &ShaderSource, targets: &mut Targets) -> Result<Self> {
        Ok(Self { program: Rc::new(Program::new(gl, source)?), target: targets.take() })
    }

    fn beside(&self, targets: &mut Targets) -> Self {
        Self { program: Rc::clone(&self.program), target: targets.take() }
    }
}

#[derive(Clone, Copy, Debug)]
enum Axis {
    Rows,
    Columns,
}

impl Axis {
    /// The texel of something `along` the axis, in a line `across` it.
    fn place(self, along: u32, across: u32) -> UVec2 {
        match self {
            Self::Rows => UVec2::new(along, across),
            Self::Columns => UVec2::new(across, along),
        }
    }
}

/// What is scanned along one axis.
#[derive(Clone, Copy, Debug)]
struct Elements {
    /// In each line.
    count: u32,
    lines: u32,
    /// In each group.
    group_size: u32,
}

impl Elements {
    /// For a `grid` of tiles.
    fn of(axis: Axis, grid: UVec2) -> Self {
        let (count, lines) = match axis {
            // Two elements, of four rows each, are in every tile.
            Axis::Rows => (grid.x, 2 * grid.y),
            Axis::Columns => (grid.y, grid.x),
        };
        // As many groups as elements in a group, or nearly: a run then adds fewest of both.
        Self { count, lines, group_size: count.isqrt().next_multiple_of(RUN) }
    }
}

/// The scan of what tiles hold along one axis: four sums an element.
#[derive(Debug)]
struct Direction {
    axis: Axis,
    elements: Elements,
    group_sums: Stage,
    elements_before: Stage,
}

impl Direction {
    /// For a `grid` of tiles.
    fn new(gl: &Gl, axis: Axis, grid: UVec2, targets: &mut Targets) -> Result<Self> {
        let [group_sums, elements_before] = scan_sources(axis);
        Ok(Self {
            axis,
            elements: Elements::of(axis, grid),
            group_sums: Stage::new(gl, &group_sums, targets)?,
            elements_before: Stage::new(gl, &elements_before, targets)?,
        })
    }

    fn beside(&self, grid: UVec2, targets: &mut Targets) -> Self {
        Self {
            axis: self.axis,
            elements: Elements::of(self.axis, grid),
            group_sums: self.group_sums.beside(targets),
            elements_before: self.elements_before.beside(targets),
        }
    }

    fn resize(&mut self, grid: UVec2, targets: &mut Targets) {
        self.elements = Elements::of(self.axis, grid);
        self.group_sums.target = targets.take();
        self.elements_before.target = targets.take();
    }

    /// Sums all elements before each in some of the lines, read from `inputs`.
    fn scan(&mut self, lines: Range<u32>, inputs: &[(&'static str, &Texture)]) -> Result<()> {
        let Self { axis, elements, group_sums, elements_before } = self;
        let Elements { count, group_size, .. } = *elements;
        let first = axis.place(0, lines.start);
        let end = |along: u32| axis.place(along, lines.end);
        let (groups, runs) = (count.div_ceil(group_size), count.div_ceil(RUN));
        let counts = (count.cast_signed(), group_size.cast_signed());
        of_elements(Pass::new(GROUP_SUMS, &group_sums.program), inputs, counts).fill_between(
            first,
            end(groups),
            &mut group_sums.target,
        )?;
        of_elements(Pass::new(ELEMENTS_BEFORE, &elements_before.program), inputs, counts)
            .read("group_sums", group_sums.target.texture())
            .fill_between(first, end(runs), &mut elements_before.target)
    }
}

/// Adds what a pass over the elements needs.
fn of_elements<'a>(
    pass: Pass<'a>,
    inputs: &[(&'static str, &'a Texture)],
    (elements, group_size): (i32, i32),
) -> Pass<'a> {
    let pass = pass.set("elements", elements).set("group_size", group_size);
    inputs.iter().fold(pass, |pass, &(name, texture)| pass.read(name, texture))
}

/// The shaders in the order of the passes.
pub(crate) fn sources(density: TextureFormat, settings: &Settings) -> Vec<ShaderSource> {
    let mut sources = vec![tile_sums_source(density, settings)];
    sources.extend([Axis::Rows, Axis::Columns].into_iter().flat_map(scan_sources));
    sources.extend([tiles_source(density, settings), unpack_source(settings)]);
    sources
}

fn tile_sums_source(density: TextureFormat, settings: &Settings) -> ShaderSource {
    tables::density_access(
        ShaderSource::new(TILE_SUMS).targets([TextureFormat::Rgba32Uint; 3]),
        density,
        settings,
    )
    .file(glsl!("radius/tables/summed_area_table/scan/tile_sums.frag"))
}

fn scan_sources(axis: Axis) -> [ShaderSource; 2] {
    let source = |label| {
        let (variant, elements) = match axis {
            Axis::Rows => ("rows", glsl!("radius/tables/summed_area_table/scan/along_rows.glsl")),
            Axis::Columns => ("columns", glsl!("radius/tables/summed_area_table/scan/along_columns.glsl")),
        };
        ShaderSource::new(label).variant(variant).file(elements)
    };
    [
        source(GROUP_SUMS)
            .targets([TextureFormat::Rgba32Uint])
            .file(glsl!("radius/tables/summed_area_table/scan/group_sums.frag")),
        source(ELEMENTS_BEFORE)
            .targets([TextureFormat::Rgba32Uint; 8])
            .file(glsl!("radius/tables/summed_area_table/scan/elements_before.frag")),
    ]
}

fn tiles_source(density: TextureFormat, settings: &Settings) -> ShaderSource {
    tables::density_access(
        ShaderSource::new(TILES).targets([TextureFormat::Rgba32Uint; 8]),
        density,
        settings,
    )
    .file(glsl!("radius/tables/summed_area_table/scan/tiles.frag"))
}

fn unpack_source(settings: &Settings) -> ShaderSource {
    tables::number(ShaderSource::new(UNPACK).targets([tables::format(settings)]), settings)
        .file(glsl!("radius/tables/summed_area_table/scan/unpack.frag"))
}
