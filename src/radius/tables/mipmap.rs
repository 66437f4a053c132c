//! Mipmaps of a density map (thesis 3.3): summed by passes of ours, or averaged by the driver.
//!
//! - Summed: a copy into level 0, then one pass a level, each texel the sum of four below; ⌊log2 side⌋ passes
//!   over a third of the map's pixels in all, 4 fetches each. Memory: 4/3 of the map.
//! - Averaged (4.3): a copy into level 0 in GL_R32F and glGenerateMipmap, whose filter OpenGL does not fix. A
//!   box of 2 x 2 averages exactly for sides that are powers of two and totals below 2^24 (the average of
//!   four whole numbers needs two more bits a level, the sum of a block none); other sides are filtered as
//!   the driver likes, and the radii are then approximate, on either side.
//! - Naive (3.3.1): the summed chain over sides rounded up to powers of two, so that every pixel has a texel
//!   on every level. The found radius r says that a block of side 2 r around the pixel holds enough; the
//!   exact radius is therefore at most 2 r - 1 (edges zero), and may be any amount smaller than r.
//!
//! A chain that is not rounded up loses the last column or row of an odd side on the next level. That is
//! right for counting boxes: a texel is only read where its whole block is inside the box, hence inside the
//! map.
//!
//! Against the thesis: any size instead of powers of two.

use glam::UVec2;

use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, Target, TargetShape, Targets, TextureFormat, TextureShape, glsl,
};
use crate::maps::DensityMap;
use crate::maps::exactness::Plan;
use crate::settings::{Method, Settings};

use super::pyramid;

const SEED: &str = "mipmap seed";
const SUM: &str = "mipmap sum";

/// A chain of levels from the density map up to one texel.
#[derive(Debug)]
pub(crate) struct Mipmap {
    chain: Target,
    seed: Program,
    levels: Levels,
    /// The highest level that the search may read.
    top_level: u32,
    settings: Settings,
}

/// How the levels above the first are filled.
#[derive(Debug)]
enum Levels {
    Summed(Program),
    AveragedByDriver,
}

impl Mipmap {
    pub(super) fn new(gl: &Gl, size: UVec2, density: TextureFormat, settings: &Settings) -> Result<Self> {
        let chain = Targets::new(gl, &Self::shapes(size, settings))?.take();
        let top_level = top_level(chain.texture().levels(), settings);
        let levels = match settings.method {
            Method::AveragedMipmap => Levels::AveragedByDriver,
            _ => Levels::Summed(Program::new(gl, &sum_source(settings))?),
        };
        let seed = Program::new(gl, &super::seed_source(SEED, density, settings))?;
        Ok(Self { chain, seed, levels, top_level, settings: *settings })
    }

    pub(super) fn shapes(size: UVec2, settings: &Settings) -> Vec<TargetShape> {
        let base = match settings.method {
            Method::NaiveMipmap => UVec2::new(size.x.next_power_of_two(), size.y.next_power_of_two()),
            _ => size,
        };
        let levels = base.max_element().ilog2() + 1;
        vec![vec![TextureShape::with_levels("mipmap of sums", super::format(settings), base, levels)]]
    }

    pub(super) fn resize(&mut self, targets: &mut Targets) {
        self.chain = targets.take();
        self.top_level = top_level(self.chain.texture().levels(), &self.settings);
    }

    pub(super) fn build(&mut self, density: &DensityMap, plan: Plan) -> Result<()> {
        Pass::new(SEED, &self.seed)
            .read("density", density.as_texture())
            .set("count_limit", plan.count_limit)
            .set("map_size", density.size().as_ivec2())
            .fill(&mut self.chain)?;
        match &self.levels {
            Levels::AveragedByDriver => self.chain.generate_mipmaps(),
            Levels::Summed(sum) => {
                for level in 1..self.chain.texture().levels() {
                    let finer_size = self.chain.texture().level_size(level - 1).as_ivec2();
                    Pass::new(SUM, sum).set("finer_size", finer_size).fill_from_level_below(
                        "finer",
                        &mut self.chain,
                        level,
                    )?;
                }
            }
        }
        Ok(())
    }

    pub(super) fn read_by<'a>(&'a self, pass: Pass<'a>) -> Pass<'a> {
        pass.read("pyramid", self.chain.texture()).set("top_level", self.top_level.cast_signed())
    }
}

/// A box never holds a block larger than itself; the naive column goes up to the end.
fn top_level(levels: u32, settings: &Settings) -> u32 {
    match settings.method {
        Method::NaiveMipmap => levels - 1,
        _ => (levels - 1).min(pyramid::largest_level(settings.search.max_radius)),
    }
}

pub(super) fn build_sources(density: TextureFormat, settings: &Settings) -> Vec<ShaderSource> {
    let mut sources = vec![super::seed_source(SEED, density, settings)];
    if settings.method != Method::AveragedMipmap {
        sources.push(sum_source(settings));
    }
    sources
}

fn sum_source(settings: &Settings) -> ShaderSource {
    super::number(ShaderSource::new(SUM).targets([super::format(settings)]), settings)
        .file(glsl!("radius/tables/summed_mipmap.frag"))
}
