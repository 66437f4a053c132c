//! What a counter reads: one file per section of the thesis.
//!
//! Each answers "how many photons are in this box?" for a search, except the naive mipmap, which does not
//! answer that question and has a search of its own.
//!
//! # As printed
//! The listings have faults, which [`Faults`](crate::settings::Faults) can switch on, made well defined by
//! letting reads outside the texture give 0:
//!
//! | fault | printed | meant | effect |
//! |---|---|---|---|
//! | `clamp_to_63` | `clamp(.., 0, 63)` | the map's size | right at 64² only |
//! | `border_test` | `ll.x > 0`, `ll.y > 0` | `>= 0` | boxes from column or row 1 count column or row 0 as well |
//! | `corner_test` | `!(ll.x < 0 && ll.y < 0)` | both `>= 0` | with `border_test`, a corner is added that nothing took away |
//! | `swapped_axes` | horizontal passes move y | x | too few passes for one side if the map is not square |
//! | `sample_stride` | offset 2^pass, s - 1 more samples along x | s^pass, s - 2 along the axis | the table is wrong for s > 2 |
//! | `forgotten_strip` | 4.3, first listing: `if(all(range))` | `if(range[..])` | a strip one pixel wide or high is not counted |
//! | `float_ratio` | 4.4: outside over inside area, in f32 | S T >= n I | wrong for the rare n at which rounding decides: 1875 and 1925 of the first 2000, at MR 32 |
//!
//! The first five are of 4.2. Alone, `corner_test` only adds reads outside of the table, which do nothing.
//! What each fault gives is predicted by [`reference::as_printed`](crate::reference::as_printed), the last
//! one where the driver divides as IEEE 754 does, which GLSL does not promise.

mod brute_force;
mod mipmap;
mod pyramid;
mod summed_area_table;

use glam::UVec2;

use crate::error::{Error, Result};
use crate::gl::{Gl, Pass, ShaderSource, TargetShape, Targets, Texture, TextureFormat, glsl};
use crate::maps::DensityMap;
use crate::maps::Rectangle;
use crate::maps::exactness::{self, Plan};
use crate::settings::{Edges, Method, Settings, Storage};

pub(crate) use pyramid::largest_level;
pub use pyramid::{most_blocks, stack_size};
pub(crate) use summed_area_table::scan;

/// The intermediate structure of one method, allocated for one size.
#[derive(Debug)]
pub(crate) enum Tables {
    /// The density map itself.
    BruteForce(brute_force::BruteForce),
    /// A mipmap chain: summed (naive or split into blocks) or averaged by the driver.
    Mipmap(Box<mipmap::Mipmap>),
    /// A summed-area table.
    SummedAreaTable(Box<summed_area_table::SummedAreaTable>),
}

impl Tables {
    pub(crate) fn new(gl: &Gl, size: UVec2, density: TextureFormat, settings: &Settings) -> Result<Self> {
        Ok(match settings.method {
            Method::BruteForce => Self::BruteForce(brute_force::BruteForce::default()),
            Method::NaiveMipmap | Method::AveragedMipmap | Method::Pyramid => {
                Self::Mipmap(Box::new(mipmap::Mipmap::new(gl, size, density, settings)?))
            }
            Method::SummedAreaTable => Self::SummedAreaTable(Box::new(
                summed_area_table::SummedAreaTable::new(gl, size, density, settings)?,
            )),
        })
    }

    /// What a structure for maps of `size` allocates, in the order in which [`resize`](Self::resize) takes
    /// it.
    pub(crate) fn shapes(size: UVec2, settings: &Settings) -> Vec<TargetShape> {
        match settings.method {
            Method::BruteForce => Vec::new(),
            Method::NaiveMipmap | Method::AveragedMipmap | Method::Pyramid => {
                mipmap::Mipmap::shapes(size, settings)
            }
            Method::SummedAreaTable => summed_area_table::SummedAreaTable::shapes(size, settings),
        }
    }

    /// What it allocates more when photons are added for the first time.
    pub(crate) fn addition_shapes(size: UVec2, settings: &Settings) -> Vec<TargetShape> {
        match settings.method {
            Method::SummedAreaTable => summed_area_table::SummedAreaTable::addition_shapes(size, settings),
            _ => Vec::new(),
        }
    }

    /// Takes targets for maps of another size; it holds nothing then.
    pub(crate) fn resize(&mut self, size: UVec2, targets: &mut Targets) {
        match self {
            Self::BruteForce(_) => (),
            Self::Mipmap(mipmap) => mipmap.resize(targets),
            Self::SummedAreaTable(table) => table.resize(size, targets),
        }
    }

    /// Fills the structure from a density map, of which `changed` differs from the one before.
    pub(crate) fn build(&mut self, density: &DensityMap, plan: Plan, changed: Rectangle) -> Result<()> {
        match self {
            Self::BruteForce(brute_force) => {
                brute_force.take(plan);
                Ok(())
            }
            Self::Mipmap(mipmap) => mipmap.build(density, plan),
            Self::SummedAreaTable(table) => table.build(density, plan, changed),
        }
    }

    /// Adds the photons of a density map to those that are there.
    ///
    /// # Errors
    /// [`Error::Setting`] for a method without a table.
    pub(crate) fn add(&mut self, density: &DensityMap, plan: Plan) -> Result<()> {
        match self {
            Self::SummedAreaTable(table) => table.add(density, plan),
            Self::BruteForce(_) | Self::Mipmap(_) => Err(Error::Setting {
                name: "method",
                value: "without a summed-area table".to_owned(),
                reason: "photons can be added to a table only; give the map of all photons".to_owned(),
            }),
        }
    }

    /// The texture of a summed-area table.
    pub(crate) fn table(&self) -> Option<&Texture> {
        match self {
            Self::BruteForce(_) | Self::Mipmap(_) => None,
            Self::SummedAreaTable(table) => Some(table.texture()),
        }
    }

    /// Gives the search pass what the method's counter reads.
    pub(crate) fn read_by<'a>(&'a self, pass: Pass<'a>, density: &'a DensityMap) -> Pass<'a> {
        match self {
            Self::BruteForce(brute_force) => brute_force.read_by(pass, density),
            Self::Mipmap(mipmap) => mipmap.read_by(pass),
            Self::SummedAreaTable(table) => table.read_by(pass),
        }
    }
}

/// The shaders that build the structure.
pub(crate) fn build_sources(density: TextureFormat, settings: &Settings) -> Vec<ShaderSource> {
    match settings.method {
        Method::BruteForce => Vec::new(),
        Method::NaiveMipmap | Method::AveragedMipmap | Method::Pyramid => {
            mipmap::build_sources(density, settings)
        }
        Method::SummedAreaTable => summed_area_table::build_sources(density, settings),
    }
}

/// Adds the method's `count_in_box`, and what it needs, to the search shader.
pub(crate) fn counter(source: ShaderSource, density: TextureFormat, settings: &Settings) -> ShaderSource {
    match settings.method {
        Method::BruteForce => brute_force::counter(source, density, settings),
        Method::NaiveMipmap => number(source, settings),
        Method::AveragedMipmap | Method::Pyramid => pyramid::counter(source, settings),
        Method::SummedAreaTable => summed_area_table::counter(source, settings),
    }
}

/// Adds the edge rule, by which a count is enough or not.
pub(crate) fn edge_rule(source: ShaderSource, settings: &Settings) -> ShaderSource {
    let source = source.define_if(settings.search.edges == Edges::Zero, "EDGES_ZERO");
    let source = if exactness::needs_wide_products(settings) {
        source.define("WIDE_PRODUCTS", 1_u32).file(glsl!("common/product.glsl"))
    } else {
        source
    };
    source.file(glsl!("common/enough.glsl"))
}

/// The number in which the method's sums are kept.
pub(crate) fn storage(settings: &Settings) -> Storage {
    match settings.method {
        // glGenerateMipmap is for filterable formats.
        Method::AveragedMipmap => Storage::F32,
        _ => settings.storage,
    }
}

/// The texture format of the sums.
fn format(settings: &Settings) -> TextureFormat {
    match storage(settings) {
        Storage::F32 | Storage::F32MinusMean | Storage::F32MinusWholeMean => TextureFormat::R32Float,
        Storage::F16 => TextureFormat::R16Float,
        Storage::U32 => TextureFormat::R32Uint,
        Storage::U16 => TextureFormat::R16Uint,
    }
}

/// Adds the number type of the sums.
fn number(source: ShaderSource, settings: &Settings) -> ShaderSource {
    let storage = storage(settings);
    source
        .define_if(!storage.is_integer(), "SUM_FLOAT")
        .define_if(storage == Storage::U16, "SUM_U16")
        .define_if(storage == Storage::F16, "SUM_F16")
        .define_if(matches!(storage, Storage::F32MinusMean | Storage::F32MinusWholeMean), "SUM_MINUS_MEAN")
        .file(glsl!("common/sum.glsl"))
}

/// Adds access to the density map, in the number type of the sums.
pub(crate) fn density_access(
    source: ShaderSource,
    density: TextureFormat,
    settings: &Settings,
) -> ShaderSource {
    let source = source.define_if(density == TextureFormat::R32Float, "DENSITY_F32");
    number(source, settings).file(glsl!("common/density.glsl"))
}

/// The shader that copies a density map into level 0 of a structure.
fn seed_source(label: &str, density: TextureFormat, settings: &Settings) -> ShaderSource {
    let source = ShaderSource::new(label).targets([format(settings)]);
    density_access(source, density, settings).file(glsl!("radius/tables/seed.frag"))
}
