//! A table built by recursive doubling between two textures (thesis 3.4.1, 4.2, after Hensley et al. 2005):
//! pass k adds, to each entry, the entries s^k, 2 s^k, ... (s - 1) s^k texels before it, first along x, then
//! along y.
//!
//! - Passes: one copy, then ⌈log_s width⌉ + ⌈log_s height⌉ of s fetches (1024²: 20 passes for s = 2, 10 for
//!   4, 8 for 8, 6 for 16).
//! - Memory: a second table.
//! - Against the thesis: sizes need not be square or powers of s.
//! - Variation (6.4.5): [`Variation::UnfinishedTexels`] leaves s^(k-1) columns or rows out of pass k: all
//!   passes along a side of w together, less than w / (s - 1).

use glam::{IVec2, UVec2};

use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, Target, TargetShape, Targets, TextureFormat, TextureShape, glsl,
};
use crate::maps::DensityMap;
use crate::maps::exactness::Plan;
use crate::radius::tables;
use crate::settings::{SatSamples, Settings, Variation};

const SEED: &str = "sat seed";
const DOUBLING: &str = "sat doubling";

/// The passes that fill a table, and the texture that takes turns with it.
#[derive(Debug)]
pub(super) struct Doubling {
    spare: Target,
    seed: Program,
    step: Program,
    settings: Settings,
}

impl Doubling {
    pub(super) fn new(gl: &Gl, size: UVec2, density: TextureFormat, settings: &Settings) -> Result<Self> {
        Ok(Self {
            spare: Targets::new(gl, &shapes(size, settings))?.take(),
            seed: Program::new(gl, &tables::seed_source(SEED, density, settings))?,
            step: Program::new(gl, &doubling_source(settings))?,
            settings: *settings,
        })
    }

    pub(super) fn resize(&mut self, targets: &mut Targets) {
        self.spare = targets.take();
    }

    /// Fills `table` from a density map.
    pub(super) fn build(
        &mut self,
        density: &DensityMap,
        plan: Plan,
        mean: Option<f32>,
        table: &mut Target,
    ) -> Result<()> {
        let size = density.size();
        let seed = Pass::new(SEED, &self.seed)
            .read("density", density.as_texture())
            .set("count_limit", plan.count_limit)
            .set("map_size", size.as_ivec2());
        match mean {
            Some(mean) => seed.set("mean", mean),
            None => seed,
        }
        .fill(table)?;

        let (horizontal, vertical) = if self.settings.laboratory.faults.swapped_axes {
            (IVec2::Y, IVec2::X)
        } else {
            (IVec2::X, IVec2::Y)
        };
        for (axis, side) in [(horizontal, size.x), (vertical, size.y)] {
            for (index, stride) in strides(self.settings.laboratory.sat_samples, side) {
                let mut pass = Pass::new(DOUBLING, &self.step)
                    .read("table", table.texture())
                    .set("axis", axis)
                    .set("stride", stride);
                if self.settings.reaching_faults().sample_stride {
                    pass = pass.set("printed_offset", 1_i32 << index);
                }
                pass.fill_from(self.origin(axis, index, stride), &mut self.spare)?;
                std::mem::swap(table, &mut self.spare);
            }
        }
        Ok(())
    }

    /// Where a pass starts to draw: at the first texel that is not finished in both textures.
    ///
    /// Along the axis, the entries before s^k are finished when pass k begins, in the texture that it reads.
    /// The one that it draws into is older by a pass: there, those before s^(k-1) are. So the pass copies the
    /// entries in between (all their other samples lie before the table), and both textures are right up to
    /// s^k. The first pass finds nothing of use in the texture that it draws into, the other axis's
    /// unfinished entries or an old frame.
    fn origin(&self, axis: IVec2, index: u32, stride: i32) -> UVec2 {
        if self.settings.laboratory.variation == Some(Variation::UnfinishedTexels) && index > 0 {
            axis.as_uvec2() * (stride.cast_unsigned() / self.settings.laboratory.sat_samples.count())
        } else {
            UVec2::ZERO
        }
    }
}

/// A second table.
pub(super) fn shapes(size: UVec2, settings: &Settings) -> Vec<TargetShape> {
    vec![vec![TextureShape::new("summed-area table", tables::format(settings), size)]]
}

/// Number and stride of the passes over a side: s^0, s^1, ... below the side's length.
fn strides(samples: SatSamples, side: u32) -> impl Iterator<Item = (u32, i32)> {
    let samples = samples.count();
    (0..)
        .map(move |index| (index, samples.pow(index)))
        .take_while(move |&(_, stride)| stride < side)
        .map(|(index, stride)| (index, stride.cast_signed()))
}

pub(super) fn sources(density: TextureFormat, settings: &Settings) -> Vec<ShaderSource> {
    vec![tables::seed_source(SEED, density, settings), doubling_source(settings)]
}

fn doubling_source(settings: &Settings) -> ShaderSource {
    let source = ShaderSource::new(DOUBLING)
        .targets([tables::format(settings)])
        .define("SAMPLES", settings.laboratory.sat_samples.count())
        .define_if(settings.reaching_faults().sample_stride, "FAULT_SAMPLE_STRIDE");
    tables::number(source, settings).file(glsl!("radius/tables/summed_area_table/doubling.frag"))
}
