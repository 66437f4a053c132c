//! Radii that are not searched at every pixel: approximations that the study compares with the exact ones.
//!
//! - *Half density*: photons of 2 x 2 pixels are one texel; radii are searched there, up to MR / 2. A box of
//!   radius r there is 2 (2 r + 1) pixels wide, so that the radius here is 2 r - 1 or 2 r; 2 r - 1/2 is
//!   interpolated and rounded.
//! - *Grid*: a table of all counts, but a search at every k-th pixel of every k-th row only, interpolated
//!   between.
//!
//! Both are wrong where radii change faster than the places lie; neither is ever a default.

use glam::UVec2;

use crate::error::Result;
use crate::gl::{Gl, Pass, Program, ShaderSource, StateGuard, Target, Texture, TextureFormat, glsl};
use crate::image::Image;
use crate::maps::DensityMap;
use crate::maps::Rectangle;
use crate::maps::exactness::{self, CountBounds};
use crate::radius::RadiusPipeline;
use crate::radius::search::{GridSearch, grid_source};
use crate::radius::tables::Tables;
use crate::settings::{Search, Settings};

const HALF_DENSITY: &str = "half density";
const INTERPOLATION: &str = "interpolated radii";
/// Pixels between the places of the grids that the study compares.
pub const GRID_STEPS: [u32; 2] = [4, 8];

/// An approximation for maps of one size in GL_R32UI, and the radii that it found last.
#[derive(Debug)]
pub struct Approximation {
    gl: Gl,
    first: First,
    interpolation: Program,
    max_radius: u32,
    radii: Target,
}

/// How the fewer radii are found.
#[derive(Debug)]
enum First {
    HalfDensity { program: Program, half: Target, density: Box<DensityMap>, pipeline: Box<RadiusPipeline> },
    Grid { step: u32, settings: Settings, tables: Tables, search: Box<GridSearch> },
}

impl Approximation {
    /// By half the density.
    ///
    /// # Errors
    /// [`Error::TooLarge`](crate::Error::TooLarge), [`Error::Shader`](crate::Error::Shader), or
    /// [`Error::OutOfMemory`](crate::Error::OutOfMemory).
    pub fn half_density(gl: &Gl, density: &DensityMap, search: Search) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let size = (density.size() + 1) / 2;
        let half = Target::single(gl, Texture::new(gl, TextureFormat::R32Uint, size, 1)?)?
            .labelled(&["half the density"]);
        // Boxes there are others than those that the bounds are of; the total is the same.
        let bounds = CountBounds::total_at_most(density.bounds().total);
        let coarse = DensityMap::borrow(gl, half.texture().name(), bounds)?;
        let settings = Settings {
            search: Search { max_radius: search.max_radius.div_ceil(2), ..search },
            ..Settings::default()
        };
        let first = First::HalfDensity {
            program: Program::new(gl, &half_density_source())?,
            half,
            density: Box::new(coarse),
            pipeline: Box::new(RadiusPipeline::new(gl, size, TextureFormat::R32Uint, settings)?),
        };
        Self::new(gl, density.size(), search, first)
    }

    /// By a grid with a place every `step` pixels.
    ///
    /// # Errors
    /// [`Error::TooLarge`](crate::Error::TooLarge), [`Error::Shader`](crate::Error::Shader), or
    /// [`Error::OutOfMemory`](crate::Error::OutOfMemory).
    pub fn grid(gl: &Gl, density: &DensityMap, search: Search, step: u32) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let settings = Settings { search, ..Settings::default() };
        let (size, format) = (density.size(), density.format());
        let first = First::Grid {
            step,
            settings,
            tables: Tables::new(gl, size, format, &settings)?,
            search: Box::new(GridSearch::new(gl, size, format, &settings, step)?),
        };
        Self::new(gl, size, search, first)
    }

    fn new(gl: &Gl, size: UVec2, search: Search, first: First) -> Result<Self> {
        let radii = Target::single(gl, Texture::new(gl, TextureFormat::R32Uint, size, 1)?)?
            .labelled(&["interpolated radii"]);
        let interpolation = Program::new(gl, &interpolation_source())?;
        gl.check("setting up an approximation")?;
        Ok(Self { gl: gl.clone(), first, interpolation, max_radius: search.max_radius, radii })
    }

    /// Finds all radii of a map of the size that this was made for.
    ///
    /// # Errors
    /// As [`RadiusPipeline::render`].
    pub fn render(&mut self, density: &DensityMap) -> Result<()> {
        let _state = StateGuard::new(&self.gl)?;
        let (places, spacing, first_place, factor, summand) = match &mut self.first {
            First::HalfDensity { program, half, density: coarse, pipeline } => {
                Pass::new(HALF_DENSITY, program)
                    .read("finer", density.as_texture())
                    .set("finer_size", density.size().as_ivec2())
                    .fill(half)?;
                // Its middle lies between two pixels.
                (pipeline.render(coarse)?.as_texture(), 2, 0.5, 2.0, -0.5)
            }
            First::Grid { step, settings, tables, search } => {
                let plan = exactness::plan(settings, density.size(), density.bounds())?;
                tables.build(density, plan, Rectangle::whole(density.size()))?;
                search.estimate(density, tables)?;
                #[expect(clippy::cast_precision_loss, reason = "a few pixels")]
                let first_place = (*step / 2) as f32;
                (search.radii(), *step, first_place, 1.0, 0.0)
            }
        };
        Pass::new(INTERPOLATION, &self.interpolation)
            .read("places", places)
            .set("places_size", places.size().as_ivec2())
            .set("spacing", spacing.cast_signed())
            .set("first_place", first_place)
            .set("factor", factor)
            .set("summand", summand)
            .set("max_radius", self.max_radius.cast_signed())
            .fill(&mut self.radii)?;
        self.gl.check("approximating radii")
    }

    /// Reads back what was found last.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn read(&self) -> Result<Image<u32>> {
        let _state = StateGuard::new(&self.gl)?;
        let radii = self.radii.texture().read(0);
        self.gl.check("reading approximated radii back")?;
        Ok(radii)
    }
}

fn half_density_source() -> ShaderSource {
    ShaderSource::new(HALF_DENSITY)
        .targets([TextureFormat::R32Uint])
        .file(glsl!("common/sum.glsl"))
        .file(glsl!("radius/tables/summed_mipmap.frag"))
}

fn interpolation_source() -> ShaderSource {
    ShaderSource::new(INTERPOLATION)
        .targets([TextureFormat::R32Uint])
        .file(glsl!("measure/interpolated_radii.frag"))
}

/// The shaders of every approximation.
#[must_use]
pub fn sources(settings: &Settings) -> Vec<ShaderSource> {
    let grids = GRID_STEPS.map(|step| grid_source(TextureFormat::R32Uint, settings, step));
    [half_density_source(), interpolation_source()].into_iter().chain(grids).collect()
}
