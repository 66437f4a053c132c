//! What tables need of a camera alone: the area that each pixel sees, its table, and how far each pixel's
//! face goes on.

use glam::UVec2;

use super::summed_table::{Channels, RowSums, ScanPrograms, SummedTable};
use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, Target, TargetShape, Targets, Texture, TextureFormat, TextureShape, glsl,
};
use crate::maps::SurfaceMaps;

const LOG_AREAS: &str = "logarithms of areas";
const FOLD: &str = "sum of logarithms";
const AREAS: &str = "areas of pixels";
const LINKS: &str = "neighbours on a face";
const LONGER: &str = "longer extents";
const BENT: &str = "extents on curves";
/// Sides of the blocks whose logarithms one texel sums.
const BLOCK: u32 = 32;
/// Units of the pixels' geometric mean area, or about: 2^13 of a power of two.
pub(super) const MEAN_AREA: u32 = 8192;
/// The longest extent is 2 to this.
const DOUBLINGS: u32 = 7;

/// Areas and extents of one camera.
#[derive(Debug)]
pub(super) struct FaceMaps {
    programs: [Program; 6],
    maps: Maps,
    is_known: bool,
}

/// What depends on the size.
#[derive(Debug)]
struct Maps {
    /// Smaller and smaller ones; the last is one texel.
    log_areas: Vec<Target>,
    /// Units of area, and what flux is weighed with.
    areas: Target,
    rows: RowSums,
    table: SummedTable,
    /// Two that take turns.
    extents: [Target; 2],
}

impl Maps {
    /// In the order of [`FaceMaps::shapes`].
    fn take(size: UVec2, targets: &mut Targets) -> Self {
        Self {
            log_areas: fold_sizes(size).map(|_| targets.take()).collect(),
            areas: targets.take(),
            rows: RowSums::take(size, targets),
            table: SummedTable::take(size, targets),
            extents: [targets.take(), targets.take()],
        }
    }
}

impl FaceMaps {
    pub(super) fn new(gl: &Gl, size: UVec2, targets: &mut Targets) -> Result<Self> {
        let [log_areas, fold, areas, links, longer, bent] = sources().map(|source| Program::new(gl, &source));
        Ok(Self {
            programs: [log_areas?, fold?, areas?, links?, longer?, bent?],
            maps: Maps::take(size, targets),
            is_known: false,
        })
    }

    pub(super) fn shapes(size: UVec2) -> Vec<TargetShape> {
        let fold = |size| vec![TextureShape::new(LOG_AREAS, TextureFormat::Rgba32Float, size)];
        let extents = || vec![TextureShape::new("extents of faces", TextureFormat::Rgba8Uint, size)];
        let mut shapes: Vec<TargetShape> = fold_sizes(size).map(fold).collect();
        shapes.push(vec![
            TextureShape::new(AREAS, TextureFormat::R32Uint, size),
            TextureShape::new("weights of areas", TextureFormat::R32Float, size),
        ]);
        shapes.extend(RowSums::shapes(Channels::One, size));
        shapes.extend(SummedTable::shapes(Channels::One, size));
        shapes.extend([extents(), extents()]);
        shapes
    }

    pub(super) fn resize(&mut self, size: UVec2, targets: &mut Targets) {
        self.maps = Maps::take(size, targets);
        self.is_known = false;
    }

    /// The camera or what it sees has changed.
    pub(super) fn forget(&mut self) {
        self.is_known = false;
    }

    /// Makes all of it, unless it is known.
    pub(super) fn update(&mut self, surfaces: &SurfaceMaps, one: &ScanPrograms) -> Result<()> {
        if self.is_known {
            return Ok(());
        }
        let [log_areas, fold, areas, links, longer, bent] = &self.programs;
        let of_areas = |label, program| {
            let view = surfaces.view();
            surfaces
                .read_places_by(Pass::new(label, program))
                .set("pixel_side", view.pixel_side())
                .set("camera", view.position())
        };
        let map_size = surfaces.size().as_ivec2();
        let maps = &mut self.maps;
        of_areas(LOG_AREAS, log_areas).set("map_size", map_size).fill(&mut maps.log_areas[0])?;
        for index in 1..maps.log_areas.len() {
            let (smaller, larger) = maps.log_areas.split_at_mut(index);
            Pass::new(FOLD, fold).read("sums", smaller[index - 1].texture()).fill(&mut larger[0])?;
        }
        surfaces
            .read_places_by(Pass::new(LINKS, links))
            .set("map_size", map_size)
            .fill(&mut maps.extents[0])?;
        of_areas(AREAS, areas)
            .read("log_areas", maps.log_areas[maps.log_areas.len() - 1].texture())
            .read("links", maps.extents[0].texture())
            .set("map_size", map_size)
            .fill(&mut maps.areas)?;
        maps.table.build(one, &mut maps.rows, maps.areas.texture())?;
        let [extents, spare] = &mut maps.extents;
        for doubling in 0..DOUBLINGS {
            Pass::new(LONGER, longer)
                .read("shorter", extents.texture())
                .set("most", 1_i32 << doubling)
                .fill(spare)?;
            std::mem::swap(extents, spare);
        }
        Pass::new(BENT, bent)
            .read("normal", surfaces.normal())
            .read("chains", extents.texture())
            .fill(spare)?;
        std::mem::swap(extents, spare);
        self.is_known = true;
        Ok(())
    }

    /// One texel, for the unit of areas.
    pub(super) fn log_areas(&self) -> &Texture {
        self.maps.log_areas[self.maps.log_areas.len() - 1].texture()
    }

    /// In units, of each pixel.
    pub(super) fn areas(&self) -> &Texture {
        self.maps.areas.texture()
    }

    /// What flux is multiplied with.
    pub(super) fn weights(&self) -> &Texture {
        &self.maps.areas.textures()[1]
    }

    /// Sums of areas.
    pub(super) fn table(&self) -> &Texture {
        self.maps.table.texture()
    }

    pub(super) fn extents(&self) -> &Texture {
        self.maps.extents[0].texture()
    }
}

/// The sizes of sums of blocks, down to one texel.
fn fold_sizes(size: UVec2) -> impl Iterator<Item = UVec2> {
    let smaller = |size: UVec2| (size + BLOCK - 1) / BLOCK;
    std::iter::successors(Some(smaller(size)), move |&size| (size.max_element() > 1).then(|| smaller(size)))
}

/// The shaders in the order of the passes.
pub(super) fn sources() -> [ShaderSource; 6] {
    let extents = |label| ShaderSource::new(label).targets([TextureFormat::Rgba8Uint]);
    let surfaces = glsl!("common/surfaces.glsl");
    let face = glsl!("light/tables/face_maps/face.glsl");
    let block = |label| ShaderSource::new(label).targets([TextureFormat::Rgba32Float]).define("BLOCK", BLOCK);
    [
        block(LOG_AREAS).file(surfaces).file(glsl!("light/tables/face_maps/log_areas.frag")),
        block(FOLD).file(glsl!("light/tables/face_maps/fold.frag")),
        ShaderSource::new(AREAS)
            .targets([TextureFormat::R32Uint, TextureFormat::R32Float])
            .file(surfaces)
            .file(glsl!("light/tables/area_unit.glsl"))
            .file(glsl!("light/tables/face_maps/areas.frag")),
        extents(LINKS).file(surfaces).file(face).file(glsl!("light/tables/face_maps/links.frag")),
        extents(LONGER).file(glsl!("light/tables/face_maps/longer.frag")),
        extents(BENT).file(surfaces).file(face).file(glsl!("light/tables/face_maps/bent.frag")),
    ]
}
