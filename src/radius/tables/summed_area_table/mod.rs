//! Summed-area table (thesis 3.4, 4.2): entry (x, y) is the sum of all counts up to and including column x,
//! row y.
//!
//! Two builds: [`doubling`], the thesis's, and [`scan`], ours.
//!
//! - A box: 4 fetches, fewer at the map's lower left; ⌈log2 MR⌉ boxes for a binary search, R for a forward
//!   one, about two for a bracketed one.
//! - Memory: the table (4 bytes an entry, 2 in u16) beside the density map, and what its build needs.
//! - Exact: u32 and u16 while each box holds less than 2^32 or 2^16, even where the table wraps; f32 while
//!   the total is at most 2^24, f16 while it is at most 2^11; less the mean, f32 is not proved for any map.
//! - u16 against u32, on llvmpipe at 512² to 2048²: a scan 2 to 18 % faster, but a bracketed search 4 to 11 %
//!   slower and a binary one 24 to 28 %, since its texels are widened when read. It saves memory there, not
//!   time.
//! - Against the thesis: u32 is the default, which its drivers did not support; reads outside the table,
//!   which GLSL leaves undefined, are tested for.
//! - Variation (6.4.5): [`Variation::UnconditionalFetches`] takes 4 fetches everywhere.
//!
//! The listings' faults are described in the module above, since all methods have some.

mod doubling;
pub(crate) mod scan;

use glam::UVec2;

use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, Target, TargetShape, Targets, Texture, TextureFormat, TextureShape, glsl,
};
use crate::maps::DensityMap;
use crate::maps::Rectangle;
use crate::maps::exactness::Plan;
use crate::settings::{SatBuild, Settings, Storage, Variation};

const ADDITION: &str = "sat addition";

/// A table and what fills it.
#[derive(Debug)]
pub(crate) struct SummedAreaTable {
    table: Target,
    build: Build,
    /// What adding photons needs, from the first time on.
    addition: Option<Addition>,
    /// What was taken from each count, if the storage is one without the mean.
    mean: Option<f32>,
    settings: Settings,
}

/// A table of added photons, and one that takes turns with that of all.
#[derive(Debug)]
struct Addition {
    program: Program,
    /// None after a resize.
    tables: Option<[Target; 2]>,
}

#[derive(Debug)]
enum Build {
    Doubling(Box<doubling::Doubling>),
    Scan(Box<scan::Scan>),
}

impl SummedAreaTable {
    pub(super) fn new(gl: &Gl, size: UVec2, density: TextureFormat, settings: &Settings) -> Result<Self> {
        Ok(Self {
            table: Target::of(gl, &table_shape(size, settings))?,
            build: match settings.laboratory.sat_build {
                SatBuild::Doubling => {
                    Build::Doubling(Box::new(doubling::Doubling::new(gl, size, density, settings)?))
                }
                SatBuild::Scan => Build::Scan(Box::new(scan::Scan::new(gl, size, density, settings)?)),
            },
            addition: None,
            mean: None,
            settings: *settings,
        })
    }

    pub(super) fn shapes(size: UVec2, settings: &Settings) -> Vec<TargetShape> {
        let mut shapes = vec![table_shape(size, settings)];
        shapes.extend(match settings.laboratory.sat_build {
            SatBuild::Doubling => doubling::shapes(size, settings),
            SatBuild::Scan => scan::shapes(size),
        });
        shapes
    }

    pub(super) fn addition_shapes(size: UVec2, settings: &Settings) -> Vec<TargetShape> {
        vec![table_shape(size, settings); 2]
    }

    pub(super) fn resize(&mut self, size: UVec2, targets: &mut Targets) {
        self.table = targets.take();
        match &mut self.build {
            Build::Doubling(doubling) => doubling.resize(targets),
            Build::Scan(scan) => scan.resize(size, targets),
        }
        if let Some(addition) = &mut self.addition {
            addition.tables = None;
        }
    }

    /// Fills the table from a density map, of which `changed` differs from the one before.
    pub(super) fn build(&mut self, density: &DensityMap, plan: Plan, changed: Rectangle) -> Result<()> {
        self.mean = mean(density, &self.settings);
        self.build.fill(density, plan, changed, self.mean, &mut self.table)
    }

    /// Adds the photons of a density map to those of the table: the table of a sum is the sum of the tables.
    pub(super) fn add(&mut self, density: &DensityMap, plan: Plan) -> Result<()> {
        let gl = self.table.texture().gl().clone();
        let addition = match self.addition.take() {
            Some(addition) => addition,
            None => Addition { program: Program::new(&gl, &addition_source(&self.settings))?, tables: None },
        };
        let Addition { program, tables } = self.addition.insert(addition);
        let made = if let Some(tables) = tables.take() {
            tables
        } else {
            let shapes = Self::addition_shapes(self.table.size(), &self.settings);
            let mut targets = Targets::new(&gl, &shapes)?;
            [targets.take(), targets.take()]
        };
        let [added, spare] = tables.insert(made);
        let of_added = mean(density, &self.settings);
        self.build.fill(density, plan, Rectangle::whole(density.size()), of_added, added)?;
        self.mean = self.mean.zip(of_added).map(|(before, added)| before + added);
        Pass::new(ADDITION, program)
            .read("before", self.table.texture())
            .read("added", added.texture())
            .fill(spare)?;
        std::mem::swap(&mut self.table, spare);
        Ok(())
    }

    pub(super) fn texture(&self) -> &Texture {
        self.table.texture()
    }

    pub(super) fn read_by<'a>(&'a self, pass: Pass<'a>) -> Pass<'a> {
        let pass = pass.read("table", self.table.texture());
        let pass = match self.mean {
            Some(mean) => pass.set("mean", mean),
            None => pass,
        };
        if self.settings.laboratory.faults.in_table_sampling() {
            pass.set("table_size", self.table.size().as_ivec2())
        } else {
            pass
        }
    }
}

impl Build {
    fn fill(
        &mut self,
        density: &DensityMap,
        plan: Plan,
        changed: Rectangle,
        mean: Option<f32>,
        table: &mut Target,
    ) -> Result<()> {
        match self {
            // Two textures take turns, so that neither holds what did not change.
            Self::Doubling(doubling) => doubling.build(density, plan, mean, table),
            Self::Scan(scan) => scan.build(density, plan, changed, table),
        }
    }
}

fn table_shape(size: UVec2, settings: &Settings) -> TargetShape {
    vec![TextureShape::new("summed-area table", super::format(settings), size)]
}

/// What the storage takes from each count: the mean of the map, as far as its total is known.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "rounding is what it is about"
)]
fn mean(density: &DensityMap, settings: &Settings) -> Option<f32> {
    let (pixels, total) = (density.size().as_dvec2().element_product(), density.bounds().total);
    let mean = if total == u64::MAX { 0.0 } else { total as f64 / pixels };
    match settings.storage {
        Storage::F32MinusMean => Some(mean as f32),
        Storage::F32MinusWholeMean => Some(mean.round() as f32),
        Storage::F32 | Storage::U32 | Storage::U16 | Storage::F16 => None,
    }
}

pub(super) fn build_sources(density: TextureFormat, settings: &Settings) -> Vec<ShaderSource> {
    let mut sources = match settings.laboratory.sat_build {
        SatBuild::Doubling => doubling::sources(density, settings),
        SatBuild::Scan => scan::sources(density, settings),
    };
    sources.push(addition_source(settings));
    sources
}

fn addition_source(settings: &Settings) -> ShaderSource {
    super::number(ShaderSource::new(ADDITION).targets([super::format(settings)]), settings)
        .file(glsl!("radius/tables/summed_area_table/add_tables.frag"))
}

pub(super) fn counter(source: ShaderSource, settings: &Settings) -> ShaderSource {
    let faults = settings.laboratory.faults;
    let source = source
        .define_if(faults.in_table_sampling(), "BOX_UNCLIPPED")
        .define_if(faults.clamp_to_63, "FAULT_CLAMP_TO_63")
        .define_if(faults.border_test, "FAULT_BORDER_TEST")
        .define_if(faults.corner_test, "FAULT_CORNER_TEST");
    super::number(source, settings).file(if faults.in_table_sampling() {
        glsl!("radius/tables/summed_area_table/count_as_printed.glsl")
    } else if settings.laboratory.variation == Some(Variation::UnconditionalFetches) {
        glsl!("radius/tables/summed_area_table/count_unconditional_fetches.glsl")
    } else {
        glsl!("radius/tables/summed_area_table/count.glsl")
    })
}
