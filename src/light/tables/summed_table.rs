//! A summed-area table of four numbers a texel, or of one: entry (x, y) is the sum of all texels up to and
//! including column x, row y, modulo 2^32.
//!
//! - Rows first, then columns of their sums. Along each line runs of 8 are summed, then runs of these sums,
//!   until one run is left; from there back, each run is written with all before it, through 8 draw buffers.
//! - The table is layered as it is drawn: entry (x, y) is in layer y mod 8 at (x, y / 8). Readers fetch it
//!   there (`light/tables/box.glsl`), since unpacking would write it once more.
//! - Fetches: each texel twice and its sum along the row twice, 1/7 more for the sums of runs.
//! - Memory: the table and 1/7 for the sums of runs; as much once more for the sums along rows, which tables
//!   of one size share.
//!
//! The tables of the radius search pack four columns in a texel; with four numbers there is nothing to pack.

use glam::UVec2;

use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, Target, TargetShape, Targets, Texture, TextureFormat, TextureShape, glsl,
};

const RUN_SUMS: &str = "light table run sums";
const RUNS: &str = "light table runs";
/// Texels of a run: one for each draw buffer.
const RUN: u32 = 8;

/// The programs of all tables of one kind.
#[derive(Debug)]
pub(super) struct ScanPrograms {
    rows: [Program; 2],
    /// The first level of columns reads the rows' layers.
    first_columns: [Program; 2],
    columns: [Program; 2],
    /// Read where there is nothing before.
    nothing: Texture,
}

impl ScanPrograms {
    pub(super) fn new(gl: &Gl, channels: Channels) -> Result<Self> {
        let programs = |axis, is_layered| -> Result<[Program; 2]> {
            let [sums, runs] = sources(channels, axis, is_layered);
            Ok([Program::new(gl, &sums)?, Program::new(gl, &runs)?])
        };
        Ok(Self {
            rows: programs(Axis::Rows, false)?,
            first_columns: programs(Axis::Columns, true)?,
            columns: programs(Axis::Columns, false)?,
            nothing: Texture::of(gl, TextureShape::layered("nothing", channels.format(), UVec2::ONE, 1))?
                .labelled("nothing"),
        })
    }
}

/// Numbers of a texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Channels {
    One,
    Four,
}

impl Channels {
    pub(super) fn format(self) -> TextureFormat {
        match self {
            Self::One => TextureFormat::R32Uint,
            Self::Four => TextureFormat::Rgba32Uint,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Axis {
    Rows,
    Columns,
}

/// A table.
#[derive(Debug)]
pub(super) struct SummedTable {
    columns: Lines,
}

/// Sums along rows: what lies between a table and what it sums, for all tables of one size that are built one
/// after the other.
#[derive(Debug)]
pub(super) struct RowSums(Lines);

impl RowSums {
    /// What they allocate, in the order in which [`take`](Self::take) takes it.
    pub(super) fn shapes(channels: Channels, size: UVec2) -> Vec<TargetShape> {
        Lines::shapes(channels, Axis::Rows, size)
    }

    pub(super) fn take(size: UVec2, targets: &mut Targets) -> Self {
        Self(Lines::take(Axis::Rows, size, targets))
    }
}

/// Sums along one axis, level by level: of runs, and of each element with all before it.
#[derive(Debug)]
struct Lines {
    levels: Vec<Level>,
}

#[derive(Debug)]
struct Level {
    /// Elements of a line.
    count: u32,
    /// Their runs, if there are several.
    run_sums: Option<Target>,
    sums: Target,
}

impl SummedTable {
    /// What it allocates, in the order in which [`take`](Self::take) takes it.
    pub(super) fn shapes(channels: Channels, size: UVec2) -> Vec<TargetShape> {
        Lines::shapes(channels, Axis::Columns, size)
    }

    pub(super) fn take(size: UVec2, targets: &mut Targets) -> Self {
        Self { columns: Lines::take(Axis::Columns, size, targets) }
    }

    /// Sums all of `texels`, by way of `rows` of its size and channels.
    pub(super) fn build(
        &mut self,
        programs: &ScanPrograms,
        RowSums(rows): &mut RowSums,
        texels: &Texture,
    ) -> Result<()> {
        let nothing = &programs.nothing;
        rows.scan(&programs.rows, &programs.rows, texels, nothing)?;
        self.columns.scan(&programs.first_columns, &programs.columns, rows.sums(), nothing)
    }

    /// The table, layered by rows.
    pub(super) fn texture(&self) -> &Texture {
        self.columns.sums()
    }
}

impl Lines {
    fn shapes(channels: Channels, axis: Axis, size: UVec2) -> Vec<TargetShape> {
        let mut shapes = Vec::new();
        for size in level_sizes(axis, size) {
            let runs = runs_of(axis, size);
            if axis.along(runs) > 1 {
                shapes.push(vec![TextureShape::new(RUN_SUMS, channels.format(), runs)]);
            }
            shapes.push(vec![TextureShape::layered(RUNS, channels.format(), runs, RUN)]);
        }
        shapes
    }

    fn take(axis: Axis, size: UVec2, targets: &mut Targets) -> Self {
        let level = |size| Level {
            count: axis.along(size),
            run_sums: (axis.along(runs_of(axis, size)) > 1).then(|| targets.take()),
            sums: targets.take(),
        };
        Self { levels: level_sizes(axis, size).map(level).collect() }
    }

    fn scan(
        &mut self,
        [first_sums, first_runs]: &[Program; 2],
        [next_sums, next_runs]: &[Program; 2],
        texels: &Texture,
        nothing: &Texture,
    ) -> Result<()> {
        for index in 0..self.levels.len() - 1 {
            let (done, rest) = self.levels.split_at_mut(index);
            let level = &mut rest[0];
            let (program, texels) = match done.last() {
                None => (first_sums, texels),
                Some(before) => (next_sums, before.runs()),
            };
            let count = level.count.cast_signed();
            let target = level.run_sums.as_mut().unwrap_or_else(|| unreachable!("more than one run"));
            Pass::new(RUN_SUMS, program).read("texels", texels).set("count", count).fill(target)?;
        }
        for index in (0..self.levels.len()).rev() {
            let (below, rest) = self.levels.split_at_mut(index);
            let (level, above) = rest.split_at_mut(1);
            let (program, texels) = match below.last() {
                None => (first_runs, texels),
                Some(before) => (next_runs, before.runs()),
            };
            Pass::new(RUNS, program)
                .read("texels", texels)
                .read("runs_before", above.first().map_or(nothing, |above| above.sums.texture()))
                .set("count", level[0].count.cast_signed())
                .fill(&mut level[0].sums)?;
        }
        Ok(())
    }

    fn sums(&self) -> &Texture {
        self.levels[0].sums.texture()
    }
}

impl Level {
    fn runs(&self) -> &Texture {
        self.run_sums.as_ref().map_or_else(|| unreachable!("a level above"), Target::texture)
    }
}

impl Axis {
    fn along(self, size: UVec2) -> u32 {
        match self {
            Self::Rows => size.x,
            Self::Columns => size.y,
        }
    }
}

/// Runs of 8 texels along an axis.
fn runs_of(axis: Axis, size: UVec2) -> UVec2 {
    match axis {
        Axis::Rows => UVec2::new(size.x.div_ceil(RUN), size.y),
        Axis::Columns => UVec2::new(size.x, size.y.div_ceil(RUN)),
    }
}

/// The size of each level, until one run is left.
fn level_sizes(axis: Axis, size: UVec2) -> impl Iterator<Item = UVec2> {
    std::iter::successors(Some(size), move |&size| (axis.along(size) > RUN).then(|| runs_of(axis, size)))
}

/// The shaders of one axis.
fn sources(channels: Channels, axis: Axis, is_layered: bool) -> [ShaderSource; 2] {
    let source = |label| {
        ShaderSource::new(label)
            .variant(if axis == Axis::Rows { "rows" } else { "columns" })
            .variant_if(is_layered, "first")
            .variant_if(channels == Channels::One, "one-channel")
            .define_if(channels == Channels::One, "ONE_CHANNEL")
            .define_if(is_layered, "LAYERED")
            .define_if(axis == Axis::Rows, "ALONG_ROWS")
            .file(glsl!("light/tables/summed_table/texel.glsl"))
    };
    let format = channels.format();
    [
        source(RUN_SUMS).targets([format]).file(glsl!("light/tables/summed_table/run_sums.frag")),
        source(RUNS).targets([format; RUN as usize]).file(glsl!("light/tables/summed_table/runs.frag")),
    ]
}

/// All shaders of tables.
pub(super) fn all_sources() -> Vec<ShaderSource> {
    let kinds = [(Axis::Rows, false), (Axis::Columns, true), (Axis::Columns, false)];
    let of = |channels| kinds.into_iter().flat_map(move |(axis, layered)| sources(channels, axis, layered));
    [Channels::One, Channels::Four].into_iter().flat_map(of).collect()
}
