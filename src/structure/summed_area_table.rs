//! Summed-area table (thesis 3.4, 4.2): entry (x, y) is the sum of all counts up to and including column x, row y.
//!
//! Built by recursive doubling between two textures (Hensley et al. 2005): pass k adds, to each entry, the entries
//! s^k, 2 s^k, ... (s - 1) s^k texels before it, first along x, then along y.
//!
//! - Build: one copy, then ⌈log_s width⌉ + ⌈log_s height⌉ passes of s fetches (1024²: 20 passes for s = 2, 10 for 4,
//!   8 for 8, 6 for 16).
//! - A box: 4 fetches, fewer at the map's lower left; ⌈log2 MR⌉ boxes for a binary search, R for a forward one.
//! - Memory: two tables (4 bytes an entry each) beside the density map.
//! - Exact: u32 while each box holds less than 2^32, even where the table wraps; f32 while the total is at most 2^24.
//! - Against the thesis: u32 is the default, which its drivers did not support; sizes need not be square or
//!   powers of s; reads outside the table, which GLSL leaves undefined, are tested for.
//! - Variations (6.4.5): [`Variation::UnconditionalFetches`] takes 4 fetches everywhere;
//!   [`Variation::UnfinishedTexels`] leaves s^(k-1) columns or rows out of pass k: all passes along a side of w
//!   together, less than w / (s - 1).
//!
//! The listings' faults are described in `mod.rs`, since all methods have some.

use glam::{IVec2, UVec2};

use crate::error::Result;
use crate::exactness::Plan;
use crate::gl::{Gl, Pass, Program, ShaderSource, Target, Texture, TextureFormat, glsl};
use crate::maps::DensityMap;
use crate::settings::{SatSamples, Settings, Variation};

const SEED: &str = "sat seed";
const DOUBLING: &str = "sat doubling";

/// A table, and the second texture that takes turns with it.
#[derive(Debug)]
pub(crate) struct SummedAreaTable {
    table: Target,
    spare: Target,
    seed: Program,
    doubling: Program,
    settings: Settings,
}

impl SummedAreaTable {
    pub(super) fn new(gl: &Gl, size: UVec2, density: TextureFormat, settings: &Settings) -> Result<Self> {
        let target = || Target::single(gl, Texture::new(gl, super::format(settings), size, 1)?);
        Ok(Self {
            table: target()?,
            spare: target()?,
            seed: Program::new(gl, &super::seed_source(SEED, density, settings))?,
            doubling: Program::new(gl, &doubling_source(settings))?,
            settings: *settings,
        })
    }

    pub(super) fn build(&mut self, density: &DensityMap, plan: Plan) -> Result<()> {
        let size = density.size();
        Pass::new(SEED, &self.seed)
            .read("density", density.texture())
            .set("count_limit", plan.count_limit)
            .set("map_size", size.as_ivec2())
            .fill(&mut self.table)?;

        let (horizontal, vertical) =
            if self.settings.faults.swapped_axes { (IVec2::Y, IVec2::X) } else { (IVec2::X, IVec2::Y) };
        for (axis, side) in [(horizontal, size.x), (vertical, size.y)] {
            for (index, stride) in strides(self.settings.sat_samples, side) {
                let mut pass = Pass::new(DOUBLING, &self.doubling)
                    .read("table", self.table.texture())
                    .set("axis", axis)
                    .set("stride", stride);
                if self.settings.reaching_faults().sample_stride {
                    pass = pass.set("printed_offset", 1_i32 << index);
                }
                pass.fill_from(self.origin(axis, index, stride), &mut self.spare)?;
                std::mem::swap(&mut self.table, &mut self.spare);
            }
        }
        Ok(())
    }

    /// Where a pass starts to draw: at the first texel that is not finished in both textures.
    ///
    /// Along the axis, the entries before s^k are finished when pass k begins, in the texture that it reads. The one
    /// that it draws into is older by a pass: there, those before s^(k-1) are. So the pass copies the entries in
    /// between (all their other samples lie before the table), and both textures are right up to s^k. The first pass
    /// finds nothing of use in the texture that it draws into, the other axis's unfinished entries or an old frame.
    fn origin(&self, axis: IVec2, index: u32, stride: i32) -> UVec2 {
        if self.settings.variation == Some(Variation::UnfinishedTexels) && index > 0 {
            axis.as_uvec2() * (stride.cast_unsigned() / self.settings.sat_samples.count())
        } else {
            UVec2::ZERO
        }
    }

    pub(super) fn read_by<'a>(&'a self, pass: Pass<'a>) -> Pass<'a> {
        let pass = pass.read("table", self.table.texture());
        if self.settings.faults.in_table_sampling() {
            pass.set("table_size", self.table.size().as_ivec2())
        } else {
            pass
        }
    }
}

/// Number and stride of the passes over a side: s^0, s^1, ... below the side's length.
fn strides(samples: SatSamples, side: u32) -> impl Iterator<Item = (u32, i32)> {
    let samples = samples.count();
    (0..)
        .map(move |index| (index, samples.pow(index)))
        .take_while(move |&(_, stride)| stride < side)
        .map(|(index, stride)| (index, stride.cast_signed()))
}

pub(super) fn build_sources(density: TextureFormat, settings: &Settings) -> Vec<ShaderSource> {
    vec![super::seed_source(SEED, density, settings), doubling_source(settings)]
}

fn doubling_source(settings: &Settings) -> ShaderSource {
    let source = ShaderSource::new(DOUBLING)
        .define("SAMPLES", settings.sat_samples.count())
        .define_if(settings.reaching_faults().sample_stride, "FAULT_SAMPLE_STRIDE");
    super::number(source, settings).file(glsl!("build/summed_area_table.frag"))
}

pub(super) fn counter(source: ShaderSource, settings: &Settings) -> ShaderSource {
    let faults = settings.faults;
    let source = source
        .define_if(faults.in_table_sampling(), "BOX_UNCLIPPED")
        .define_if(faults.clamp_to_63, "FAULT_CLAMP_TO_63")
        .define_if(faults.border_test, "FAULT_BORDER_TEST")
        .define_if(faults.corner_test, "FAULT_CORNER_TEST");
    super::number(source, settings).file(if faults.in_table_sampling() {
        glsl!("count/summed_area_table_as_printed.glsl")
    } else if settings.variation == Some(Variation::UnconditionalFetches) {
        glsl!("count/summed_area_table_unconditional_fetches.glsl")
    } else {
        glsl!("count/summed_area_table.glsl")
    })
}
