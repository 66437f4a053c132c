//! A radius map proves itself: no reference, no second search, nothing read back but two numbers.
//!
//! Counts never shrink as a box grows, and neither does the share that the scaled test asks for. So R is the
//! smallest radius whose box holds enough if, and only if, the box of R does (or R is MR) and that of R - 1
//! does not (or R is 1): two boxes a pixel. Both are counted in the summed-area table, which is proved as
//! well: it is the table of the counts if each count is the sum that the table gives for that one pixel,
//! modulo 2^32 or 2^16 where entries wrap. [`exactness`] says that the boxes themselves do not. Together, the
//! density map alone proves radii and table.
//!
//! - Cost: two passes and a wait for their result. Radii: 8 fetches of the table and 1 of the radius a pixel,
//!   2.2 probe passes on llvmpipe at 1024², whatever the map, MR and edge rule. Table: 5 fetches, 1.2 probe
//!   passes.
//! - Memory: one byte a pixel, allocated with the first proof.
//! - Proved pixels are discarded, and a GL_SAMPLES_PASSED query counts the others.

use glam::UVec2;

use crate::error::{Error, Result};
use crate::gl::{
    Gl, Pass, Program, Query, ShaderSource, Target, TargetShape, TextureFormat, TextureShape, glsl,
};
use crate::maps::exactness::{self, Plan};
use crate::maps::{DensityMap, RadiusMap};
use crate::radius::tables::{self, Tables};
use crate::settings::{Exactness, Faults, Laboratory, Method, Rule, Settings};

const RADII: &str = "certify radii";
const ENTRIES: &str = "certify entries";

/// What could not be proved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Certificate {
    /// Pixels whose radius is not proved, or whose place in the mask of limited pixels.
    pub unproved_radii: u64,
    /// Pixels whose count is not what the summed-area table gives for them. A single wrong entry shows in up
    /// to four, itself and those after it; with none, all entries are right.
    pub wrong_entries: u64,
}

impl Certificate {
    /// Whether all radii are those of the definition.
    #[must_use]
    pub fn is_proved(self) -> bool {
        self.unproved_radii == 0 && self.wrong_entries == 0
    }

    /// Refuses settings whose results are not proved by this.
    ///
    /// # Errors
    /// [`Error::Setting`] for another rule than [`Rule::Nearest`], and for other methods than the summed-area
    /// table, whose boxes cost the same at any radius.
    pub fn check_possible(settings: &Settings) -> Result<()> {
        if settings.rule != Rule::Nearest {
            return Err(Error::Setting {
                name: "rule",
                value: settings.rule.name().to_owned(),
                reason:
                    "two boxes certify a radius that is the smallest to hold n; compare this one with its \
                         definition"
                        .to_owned(),
            });
        }
        if settings.method == Method::SummedAreaTable {
            return Ok(());
        }
        Err(Error::Setting {
            name: "method",
            value: settings.method.name().to_owned(),
            reason: "two boxes in a summed-area table certify a radius; choose that method, or certify the \
                     map by a pipeline of it"
                .to_owned(),
        })
    }

    /// How the counts of `density` are taken in, where that leaves no sum in doubt.
    ///
    /// # Errors
    /// [`Error::Inexact`] if a sum could round or wrap, whether or not the settings waive that.
    pub(crate) fn plan(settings: &Settings, density: &DensityMap) -> Result<Plan> {
        let mut settings = faultless(settings);
        settings.laboratory.exactness = Exactness::Required;
        exactness::plan(&settings, density.size(), density.bounds())
    }
}

/// Certifies maps of one size for one set of settings.
#[derive(Debug)]
pub(crate) struct Certifier {
    gl: Gl,
    density_format: TextureFormat,
    settings: Settings,
    /// Made for the first map, and anew for one with a mask after one without.
    passes: Option<Passes>,
}

#[derive(Debug)]
struct Passes {
    with_limited: bool,
    radii: Program,
    entries: Program,
    /// Never written to; a draw needs one. None after a resize.
    target: Option<Target>,
    unproved: Query,
}

impl Certifier {
    pub(crate) fn new(gl: &Gl, density_format: TextureFormat, settings: &Settings) -> Self {
        Self { gl: gl.clone(), density_format, settings: *settings, passes: None }
    }

    /// Proves `radii` by the table and the table by `density`.
    pub(crate) fn certify(
        &mut self,
        density: &DensityMap,
        plan: Plan,
        tables: &Tables,
        radii: &RadiusMap,
    ) -> Result<Certificate> {
        let search = self.settings.search;
        let Passes { radii: of_radii, entries, target, unproved, .. } = self.passes_for(radii)?;
        let target = target.as_mut().expect("made with the passes");
        let table = tables.table().expect("only tables are certified");
        let pass = Pass::new(RADII, of_radii)
            .read("table", table)
            .read("radii", radii.as_texture())
            .set("map_size", density.size().as_ivec2())
            .set("min_photons", search.min_photons)
            .set("max_radius", search.max_radius);
        let pass = match radii.limited() {
            Some(limited) => pass.read("limited", limited),
            None => pass,
        };
        let unproved_radii = unproved.count(|| pass.fill(target))?;
        let pass = Pass::new(ENTRIES, entries)
            .read("table", table)
            .read("density", density.as_texture())
            .set("count_limit", plan.count_limit);
        let wrong_entries = unproved.count(|| pass.fill(target))?;
        Ok(Certificate { unproved_radii, wrong_entries })
    }

    /// From now on for maps of another size.
    pub(crate) fn resize(&mut self) {
        if let Some(passes) = &mut self.passes {
            passes.target = None;
        }
    }

    fn passes_for(&mut self, radii: &RadiusMap) -> Result<&mut Passes> {
        let with_limited = radii.limited().is_some();
        let mut passes = match self.passes.take() {
            Some(passes) if passes.with_limited == with_limited => passes,
            _ => self.passes(with_limited)?,
        };
        if passes.target.is_none() {
            passes.target = Some(Target::of(&self.gl, &shape(radii.size()))?);
        }
        Ok(self.passes.insert(passes))
    }

    fn passes(&self, with_limited: bool) -> Result<Passes> {
        let Self { gl, density_format, settings, .. } = self;
        Ok(Passes {
            with_limited,
            radii: Program::new(gl, &radii_source(*density_format, settings, with_limited))?,
            entries: Program::new(gl, &entries_source(*density_format, settings))?,
            target: None,
            unproved: Query::of_fragments(gl)?,
        })
    }
}

fn shape(size: UVec2) -> TargetShape {
    vec![TextureShape::new("certificate", TextureFormat::R8Uint, size)]
}

/// What a certificate allocates, where one is possible.
pub(crate) fn shapes(size: UVec2, settings: &Settings) -> Vec<TargetShape> {
    if Certificate::check_possible(settings).is_ok() && !settings.masked {
        vec![shape(size)]
    } else {
        Vec::new()
    }
}

/// The shaders that a certificate may compile.
pub(crate) fn sources(density: TextureFormat, settings: &Settings) -> Vec<ShaderSource> {
    if Certificate::check_possible(settings).is_err() {
        return Vec::new();
    }
    let mut sources = [false, true].map(|limited| radii_source(density, settings, limited)).to_vec();
    sources.push(entries_source(density, settings));
    sources
}

fn radii_source(density: TextureFormat, settings: &Settings, with_limited: bool) -> ShaderSource {
    let source =
        ShaderSource::new(RADII).variant_if(with_limited, "limited").define_if(with_limited, "LIMITED_MASK");
    let source = tables::edge_rule(source, settings);
    tables::counter(source, density, &faultless(settings)).file(glsl!("radius/certificate/radii.frag"))
}

fn entries_source(density: TextureFormat, settings: &Settings) -> ShaderSource {
    tables::density_access(ShaderSource::new(ENTRIES), density, settings)
        .file(glsl!("radius/certificate/entries.frag"))
}

/// The same question, counted as it is meant.
fn faultless(settings: &Settings) -> Settings {
    Settings {
        laboratory: Laboratory { faults: Faults::NONE, variation: None, ..settings.laboratory },
        ..*settings
    }
}
