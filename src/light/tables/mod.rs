//! Light gathered from summed-area tables, each pixel as wide as a test of noise allows: no radii are
//! searched and no photon is drawn as a kernel.
//!
//! - A pixel's irradiance is the flux of a box around it over the area that the box sees, four fetches each.
//!   The box ends where the face ends along its row and column ([`face_maps`]); its corners may lie on others.
//! - Boxes have radii of 0, 1, 2, 4, ... 64 pixels. Each is compared with the one before: where the light
//!   differs by no more than noise would make it, the wider one is better. Tests are pooled over a box twice
//!   as wide, since that of one pixel is noise itself; between widths light is mixed.
//! - There is no n: where photons are many or light changes, boxes stay small.
//! - Exact: sums of whole numbers modulo 2^32, the same whatever the order of the photons (see
//!   [`FluxMap`]). Quotients are f32.
//! - Tiles that no photon is in reach of cost nothing but tables.
//! - Cost: whatever the number of photons and the widths. Memory: 195 bytes a pixel.
//!
//! After F. Rousselle, C. Knaus, M. Zwicker, "Adaptive sampling and reconstruction using greedy error
//! minimization" (2011), on the tables of F. Crow (1984).

mod face_maps;
mod summed_table;

use glam::UVec2;

use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, StateGuard, Target, TargetShape, Targets, Texture, TextureFormat,
    TextureShape, bytes_of, glsl,
};
use crate::maps::{FluxMap, IrradianceMap, RadiusMap, SurfaceMaps};
use face_maps::FaceMaps;
use summed_table::{Channels, RowSums, ScanPrograms, SummedTable};

const POINTS: &str = "flux of pixels";
const TEST_FINE: &str = "test of noise, narrow";
const TEST_COARSE: &str = "test of noise, wide";
const POOL: &str = "pooled tests of noise";
const GATHER: &str = "light from tables";
const SMOOTH: &str = "smooth light";
const WIDTHS: &str = "widths of light";
/// Pixels of the side of a tile that is left out where no photon is in reach.
const TILE_SIDE: u32 = 64;
/// As far as light goes: the widest box, then the widest that it is smoothed over, and a pixel whose
/// neighbour's shares hold for it.
const REACH: u32 = TablesStage::WIDEST + MOST_SMOOTH + 2;
/// The widest box that light is smoothed over, by its radius in pixels.
const MOST_SMOOTH: u32 = 16;
/// As many steps of light a pixel as such a box can sum in 32 bits.
const MOST_STEPS: u32 = u32::MAX / ((2 * MOST_SMOOTH + 1) * (2 * MOST_SMOOTH + 1));
/// Light up to so many times what the picture's photons give its pixels in the mean is smoothed.
const BRIGHTEST: u32 = 256;

/// Boxes of pixels and sums over them.
const BOX: (&str, &str) = glsl!("light/tables/box.glsl");
/// Shares of widths.
const POOLED: (&str, &str) = glsl!("light/tables/pooled.glsl");
/// What a test is held against.
const THRESHOLD: (&str, &str) = glsl!("light/tables/threshold.glsl");
/// Rounding by chance.
const DITHER: (&str, &str) = glsl!("light/tables/dither.glsl");

/// Gathers light from tables into maps of one size.
#[derive(Debug)]
pub struct TablesStage {
    gl: Gl,
    one: ScanPrograms,
    four: ScanPrograms,
    points_program: Program,
    tests: [Program; 2],
    pool: Program,
    gather: Program,
    smooth: Program,
    widths: Program,
    faces: FaceMaps,
    maps: Maps,
}

/// What depends on the size beside the faces.
#[derive(Debug)]
struct Maps {
    points: Target,
    /// For tables of each pixel, and of every second.
    rows: [RowSums; 2],
    flux_table: SummedTable,
    /// Of narrow boxes at each pixel, and of wide ones at every second.
    ratios: [Target; 2],
    /// The first then holds sums of light: tests are done with when there is light.
    ratio_tables: [SummedTable; 2],
    /// How far each width's test lets it be mixed in, at every second pixel.
    shares: Target,
    /// Light, and the same in whole steps.
    gathered: Target,
    irradiance: IrradianceMap,
    radii: RadiusMap,
}

impl Maps {
    /// In the order of [`TablesStage::shapes`].
    fn take(size: UVec2, targets: &mut Targets) -> Self {
        Self {
            points: targets.take(),
            rows: [size, halved(size)].map(|size| RowSums::take(size, targets)),
            flux_table: SummedTable::take(size, targets),
            ratios: [targets.take(), targets.take()],
            ratio_tables: [SummedTable::take(size, targets), SummedTable::take(halved(size), targets)],
            shares: targets.take(),
            gathered: targets.take(),
            irradiance: IrradianceMap::of(targets.take()),
            radii: RadiusMap::of(targets.take()),
        }
    }
}

impl TablesStage {
    /// The widest box that light is gathered from, by its radius in pixels.
    pub const WIDEST: u32 = 64;

    /// Allocates and compiles for maps of `size`.
    ///
    /// # Errors
    /// [`Error::TooLarge`](crate::Error::TooLarge); [`Error::Shader`](crate::Error::Shader) if the driver
    /// refuses a shader; [`Error::Gl`](crate::Error::Gl) when memory runs out.
    pub fn new(gl: &Gl, size: UVec2) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let [points, fine, coarse, pool, gather, smooth, widths] = sources();
        let targets = &mut Targets::new(gl, &Self::shapes(size))?;
        Ok(Self {
            gl: gl.clone(),
            one: ScanPrograms::new(gl, Channels::One)?,
            four: ScanPrograms::new(gl, Channels::Four)?,
            points_program: Program::new(gl, &points)?,
            tests: [Program::new(gl, &fine)?, Program::new(gl, &coarse)?],
            pool: Program::new(gl, &pool)?,
            gather: Program::new(gl, &gather)?,
            smooth: Program::new(gl, &smooth)?,
            widths: Program::new(gl, &widths)?,
            faces: FaceMaps::new(gl, size, targets)?,
            maps: Maps::take(size, targets),
        })
    }

    /// What depends on the size.
    pub(super) fn shapes(size: UVec2) -> Vec<TargetShape> {
        let four = |label, size| vec![TextureShape::new(label, TextureFormat::Rgba32Uint, size)];
        let table = |size| SummedTable::shapes(Channels::Four, size);
        let of_shares = |label| TextureShape::new(label, TextureFormat::Rgba32Float, halved(size));
        let mut shapes = FaceMaps::shapes(size);
        shapes.push(four(POINTS, size));
        shapes
            .extend([size, halved(size)].into_iter().flat_map(|size| RowSums::shapes(Channels::Four, size)));
        shapes.extend(table(size));
        shapes.extend([four(TEST_FINE, size), four(TEST_COARSE, halved(size))]);
        shapes.extend([table(size), table(halved(size))].concat());
        shapes.push(["narrow shares", "wide shares"].map(of_shares).to_vec());
        shapes.push(vec![
            TextureShape::new(GATHER, TextureFormat::Rgba32Float, size),
            TextureShape::new("steps of light", TextureFormat::Rgba32Uint, size),
        ]);
        shapes.extend([IrradianceMap::shape(size), RadiusMap::shape(size, false)]);
        shapes
    }

    /// Bytes of the textures for maps of `size`.
    pub(super) fn bytes(size: UVec2) -> u64 {
        // Two textures of one texel each stand for nothing before a line.
        bytes_of(&Self::shapes(size)) + 20
    }

    /// Goes on with other targets.
    pub(super) fn resize(&mut self, size: UVec2, targets: &mut Targets) {
        self.faces.resize(size, targets);
        self.maps = Maps::take(size, targets);
    }

    /// The camera or what it sees has changed: areas and extents are made anew by the next
    /// [`gather`](Self::gather).
    pub fn forget_camera(&mut self) {
        self.faces.forget();
    }

    /// Gathers at every pixel from the flux of each pixel's photons. Areas and extents are those of before,
    /// unless they were [forgotten](Self::forget_camera).
    ///
    /// # Errors
    /// [`Error::Mismatch`](crate::Error::Mismatch) if a map has another size; [`Error::Gl`](crate::Error::Gl)
    /// if the driver fails.
    pub fn gather(&mut self, surfaces: &SurfaceMaps, flux: &FluxMap) -> Result<&IrradianceMap> {
        surfaces.check_size(self.maps.irradiance.size())?;
        let [low, high] = flux.as_textures();
        surfaces.check_size(low.size())?;
        let _state = StateGuard::new(&self.gl)?;
        self.faces.update(surfaces, &self.one)?;

        Pass::new(POINTS, &self.points_program)
            .read("low", low)
            .read("high", high)
            .read("weights", self.faces.weights())
            .fill(&mut self.maps.points)?;
        self.maps.flux_table.build(&self.four, &mut self.maps.rows[0], self.maps.points.texture())?;
        let (size, flux_table) = (self.maps.irradiance.size(), self.maps.flux_table.texture());

        let units = flux.units();
        let square = f64::from(units.square_root).powi(2);
        #[expect(clippy::cast_possible_truncation, reason = "quotients within the range of f32")]
        let (square_unit, usual_square) =
            ((square / f64::from(units.power).powi(2)) as f32, (flux.totals().mean_square() / square) as f32);
        let [fine, coarse] = &mut self.maps.ratios;
        for (label, program, target) in
            [(TEST_FINE, &self.tests[0], &mut *fine), (TEST_COARSE, &self.tests[1], &mut *coarse)]
        {
            let pass = Pass::new(label, program)
                .read("extents", self.faces.extents())
                .read("area_table", self.faces.table())
                .set("square_unit", square_unit)
                .set("usual_square", usual_square);
            let pass = if label == TEST_FINE {
                pass.read("points", self.maps.points.texture()).read("areas", self.faces.areas())
            } else {
                pass
            };
            fill_lit(pass, flux_table, size, target)?;
        }
        let tables = self.maps.ratio_tables.iter_mut().zip(&mut self.maps.rows);
        for ((table, rows), ratios) in tables.zip(&self.maps.ratios) {
            table.build(&self.four, rows, ratios.texture())?;
        }
        let pool = Pass::new(POOL, &self.pool)
            .read("extents", self.faces.extents())
            .read("fine_tests", self.maps.ratio_tables[0].texture())
            .read("coarse_tests", self.maps.ratio_tables[1].texture());
        fill_lit(pool, flux_table, size, &mut self.maps.shares)?;
        let [narrow, wide] = self.maps.shares.textures() else { unreachable!("two attachments") };
        let gather = Pass::new(GATHER, &self.gather)
            .read("normal", surfaces.normal())
            .read("extents", self.faces.extents())
            .read("area_table", self.faces.table())
            .read("fine_tests", self.maps.ratio_tables[0].texture())
            .read("narrow_shares", narrow)
            .read("wide_shares", wide);
        fill_lit(gather, flux_table, size, &mut self.maps.gathered)?;
        let light_table = &mut self.maps.ratio_tables[0];
        light_table.build(&self.four, &mut self.maps.rows[0], &self.maps.gathered.textures()[1])?;
        let smooth = Pass::new(SMOOTH, &self.smooth)
            .read("gathered", self.maps.gathered.texture())
            .read("extents", self.faces.extents())
            .read("light_table", light_table.texture())
            .read("log_areas", self.faces.log_areas())
            .set("flux_unit", units.power);
        fill_lit(smooth, flux_table, size, self.maps.irradiance.target())?;
        Pass::new(WIDTHS, &self.widths)
            .read("irradiance", self.maps.irradiance.as_texture())
            .fill(self.maps.radii.target())?;
        self.gl.check("gathering light from tables")?;
        Ok(&self.maps.irradiance)
    }

    /// How wide each pixel's light was gathered, in pixels; 0 where nothing is lit.
    #[must_use]
    pub fn radii(&self) -> &RadiusMap {
        &self.maps.radii
    }

    /// What was gathered last.
    #[must_use]
    pub fn irradiance(&self) -> &IrradianceMap {
        &self.maps.irradiance
    }
}

/// Fills the tiles of a map of `size` that a photon is in reach of, or a target of every second pixel and row
/// of it; the others are 0.
fn fill_lit<'a>(pass: Pass<'a>, flux_table: &'a Texture, size: UVec2, target: &mut Target) -> Result<()> {
    let grid = (size + TILE_SIDE - 1) / TILE_SIDE;
    pass.read("flux_table", flux_table)
        .set("map_size", size.as_ivec2())
        .set("tile_columns", grid.x.cast_signed())
        .triangles(2 * grid.x * grid.y)
        .over_zeros()
        .fill(target)
}

/// Every second pixel of every second row.
fn halved(size: UVec2) -> UVec2 {
    size.map(|side| side.div_ceil(2))
}

/// The shaders of each frame beside those of tables, in the order of the passes.
fn sources() -> [ShaderSource; 7] {
    let four = |label| ShaderSource::new(label).targets([TextureFormat::Rgba32Uint]);
    // In lit tiles of a target with a texel for each `step`-th pixel.
    let lit = |source: ShaderSource, step: u32| {
        source
            .define("TILE_SIDE", TILE_SIDE)
            .define("REACH", REACH)
            .define("STEP", step)
            .vertex_file(BOX)
            .vertex_file(glsl!("light/tables/lit_tiles.vert"))
            .file(BOX)
    };
    let test = |label, step| lit(four(label), step).file(THRESHOLD).file(glsl!("light/tables/noise.glsl"));
    let of_light = |label, formats: &[TextureFormat]| ShaderSource::new(label).targets(formats.to_vec());
    let in_steps = |source: ShaderSource| {
        source
            .define("MOST_STEPS", MOST_STEPS)
            .define("BRIGHTEST", BRIGHTEST)
            .define("MEAN_AREA", face_maps::MEAN_AREA)
            .file(glsl!("light/tables/steps.glsl"))
    };
    [
        four(POINTS).file(glsl!("light/tables/points.frag")),
        test(TEST_FINE, 1).file(DITHER).file(glsl!("light/tables/test_fine.frag")),
        test(TEST_COARSE, 2).file(glsl!("light/tables/test_coarse.frag")),
        lit(of_light(POOL, &[TextureFormat::Rgba32Float; 2]), 2)
            .file(THRESHOLD)
            .file(POOLED)
            .file(glsl!("light/tables/pool.frag")),
        in_steps(lit(of_light(GATHER, &[TextureFormat::Rgba32Float, TextureFormat::Rgba32Uint]), 1))
            .define("WIDEST", TablesStage::WIDEST)
            .file(DITHER)
            .file(THRESHOLD)
            .file(POOLED)
            .file(glsl!("light/tables/gather.frag")),
        in_steps(lit(of_light(SMOOTH, &[TextureFormat::Rgba32Float]), 1))
            .define("MOST_SMOOTH", MOST_SMOOTH)
            .file(glsl!("light/tables/area_unit.glsl"))
            .file(glsl!("light/tables/smooth.frag")),
        ShaderSource::new(WIDTHS).targets([TextureFormat::R32Uint]).file(glsl!("light/tables/widths.frag")),
    ]
}

/// All shaders of light from tables.
pub(super) fn all_sources() -> Vec<ShaderSource> {
    summed_table::all_sources().into_iter().chain(face_maps::sources()).chain(sources()).collect()
}
