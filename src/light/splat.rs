//! Photons and radii to irradiance: each photon drawn as its kernel (thesis 2.6.2).
//!
//! - The kernel is a disc on the photon's surface with the area of the box that the radius map found, so that
//!   it holds about as many photons; it is flat along the normal and foreshortened as its surface is.
//! - Energy: a first draw sums, for each photon, its weights over the pixels that it covers, times their
//!   areas; a second spreads the photon's power over that sum. What would fall past the picture's edge,
//!   behind something or around a corner goes to the pixels that are covered, so that the picture holds
//!   exactly the power of its photons.
//! - Leaks: a kernel ends where the surface ends or turns by more than 60 degrees, so over such edges nothing
//!   gets at all: at box edges, in corners and where a box stands on the floor (`tests/gpu/leaks.rs`, every
//!   face of the Cornell box with its boxes). Along one face a kernel does not see what stands on it: of the
//!   floor's light 0.6 % arrives on the other side of a box (96 x 96 pixels, 30,000 photons, n = 400), the
//!   more the wider the kernels are: 6.9 % at 3 times the width. It is 0 on all other surfaces.
//! - Cost: about 4 (2 R + 1)² / π fragments a photon, and as many fetches for the sums. Memory: 32 bytes a
//!   pixel, and 256 KiB.
//! - Rounding: blending adds in f32, where a sum of N alike kernels is off by up to N 2^-25 of itself. So the
//!   kernels of 2^16 photons are summed apart, and then added: 10^6 on one pixel are off by 5.5e-4 if all are
//!   alike, where one sum was off by 5.4e-3, and by 4e-8 if they are mixed, where it was 2.7e-5; less than
//!   2^-9 up to the 10^7 that were measured (`splat-sum` of `varikernel stress`). It costs less than times
//!   vary (4 %). The last bits depend on the order of the photons.
//! - Against the thesis: the falloff is a formula instead of a 1D texture, and its sums are taken as drawn.

use glam::{UVec2, Vec4};

use super::kernel_pass::{check, read_radius, source};
use crate::error::Result;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, StateGuard, Target, TargetShape, Targets, TextureFormat, TextureShape,
    bytes_of, glsl,
};
use crate::maps::{IrradianceMap, KernelRadii, PhotonPoints, SurfaceMaps};
use crate::settings::{IrradianceSettings, KernelRadius};

const COVERED: &str = "splat covered";
const SPREAD: &str = "splat spread";
const ADDITION: &str = "splat addition";

/// Columns of the table of covered areas.
const TABLE_SIDE: u32 = 1 << 8;

/// Draws photons with one kernel into maps of one size.
#[derive(Debug)]
pub struct SplatStage {
    gl: Gl,
    covered: Program,
    spread: Program,
    addition: Program,
    /// Of which kind its radii are.
    radius: KernelRadius,
    /// The covered area of each photon of a chunk.
    table: Target,
    /// What the chunk's kernels add up to, before it is added to all.
    of_chunk: Target,
    irradiance: IrradianceMap,
}

impl SplatStage {
    /// Allocates and compiles for maps of `size`, still dark, and for the kernel and the kind of radii of
    /// `settings`: from a map, or the same everywhere, whatever that radius is.
    ///
    /// # Errors
    /// [`Error::TooLarge`](crate::Error::TooLarge); [`Error::Shader`](crate::Error::Shader) if the driver
    /// refuses a shader; [`Error::Gl`](crate::Error::Gl) when memory runs out.
    pub fn new(gl: &Gl, size: UVec2, settings: &IrradianceSettings) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let [covered, spread, addition] = sources(settings);
        let mut targets = Targets::new(gl, &Self::shapes(size))?;
        let of_chunk = targets.take();
        let mut irradiance = IrradianceMap::of(targets.take());
        irradiance.target().clear_floats(&[Vec4::ZERO]);
        Ok(Self {
            gl: gl.clone(),
            covered: Program::new(gl, &covered)?,
            spread: Program::new(gl, &spread)?,
            addition: Program::new(gl, &addition)?,
            radius: settings.radius,
            table: Target::of(gl, &vec![table()])?,
            of_chunk,
            irradiance,
        })
    }

    /// What depends on the size: the sum of a chunk, and of all.
    pub(crate) fn shapes(size: UVec2) -> [TargetShape; 2] {
        [vec![TextureShape::new(SPREAD, TextureFormat::Rgba32Float, size)], IrradianceMap::shape(size)]
    }

    /// Bytes of the textures for maps of `size`, and of the table.
    pub(crate) fn bytes(size: UVec2) -> u64 {
        table().bytes() + bytes_of(&Self::shapes(size))
    }

    /// Goes on with other targets, still dark.
    pub(crate) fn resize(&mut self, targets: &mut Targets) {
        self.of_chunk = targets.take();
        self.irradiance = IrradianceMap::of(targets.take());
        self.irradiance.target().clear_floats(&[Vec4::ZERO]);
    }

    /// Forgets all light.
    ///
    /// # Errors
    /// [`Error::HostState`](crate::Error::HostState), [`Error::WrongContext`](crate::Error::WrongContext).
    pub fn clear(&mut self) -> Result<()> {
        let _state = StateGuard::new(&self.gl)?;
        self.irradiance.target().clear_floats(&[Vec4::ZERO]);
        Ok(())
    }

    /// Spreads all photons, and nothing else.
    ///
    /// # Errors
    /// As [`add`](Self::add).
    pub fn splat(
        &mut self,
        surfaces: &SurfaceMaps,
        photons: &PhotonPoints,
        radius: KernelRadii<'_>,
    ) -> Result<&IrradianceMap> {
        self.clear()?;
        self.add(surfaces, photons, radius)
    }

    /// Spreads photons and adds them to the light that is there.
    ///
    /// # Errors
    /// [`Error::Mismatch`](crate::Error::Mismatch) if surfaces or radii have another size, or the radius is
    /// fixed and the stage's is not, or the other way round; [`Error::Gl`](crate::Error::Gl) if the driver
    /// fails.
    pub fn add(
        &mut self,
        surfaces: &SurfaceMaps,
        photons: &PhotonPoints,
        radius: KernelRadii<'_>,
    ) -> Result<&IrradianceMap> {
        check(surfaces, self.irradiance.size(), radius, self.radius)?;
        let _state = StateGuard::new(&self.gl)?;
        let camera = surfaces.view().position();
        for chunk in photons.chunks() {
            self.table.clear_floats(&[Vec4::ZERO]);
            self.of_chunk.clear_floats(&[Vec4::ZERO]);
            let pass = surfaces.read_by(Pass::new(COVERED, &self.covered)).set("camera", camera);
            read_radius(pass, radius)
                .set("table_size", UVec2::splat(TABLE_SIDE).as_ivec2())
                .add_points(chunk, &mut self.table)?;
            let pass = surfaces.read_by(Pass::new(SPREAD, &self.spread)).set("camera", camera);
            read_radius(pass, radius)
                .read("covered", self.table.texture())
                .add_quads(chunk, &mut self.of_chunk)?;
            Pass::new(ADDITION, &self.addition)
                .read("of_chunk", self.of_chunk.texture())
                .add(self.irradiance.target())?;
        }
        self.gl.check("splatting photons")?;
        Ok(&self.irradiance)
    }

    /// The light of all photons so far.
    #[must_use]
    pub fn irradiance(&self) -> &IrradianceMap {
        &self.irradiance
    }
}

/// The covered areas of a chunk's photons.
fn table() -> TextureShape {
    TextureShape::new(COVERED, TextureFormat::R32Float, UVec2::splat(TABLE_SIDE))
}

fn with_photon_kernel(source: ShaderSource) -> ShaderSource {
    source
        .vertex_file(glsl!("common/surfaces.glsl"))
        .vertex_file(glsl!("common/photon.glsl"))
        .vertex_file(glsl!("common/kernel.glsl"))
        .vertex_file(glsl!("common/photon_kernel.glsl"))
        .vertex_file(glsl!("common/kernel_radius.glsl"))
}

/// The shaders of a splat.
pub(super) fn sources(settings: &IrradianceSettings) -> [ShaderSource; 3] {
    [
        with_photon_kernel(source(COVERED, settings))
            .targets([TextureFormat::R32Float])
            .vertex_file(glsl!("light/splat/covered.vert"))
            .file(glsl!("light/splat/covered.frag")),
        with_photon_kernel(source(SPREAD, settings))
            .targets([TextureFormat::Rgba32Float])
            .vertex_file(glsl!("light/splat/spread.vert"))
            .file(glsl!("common/surfaces.glsl"))
            .file(glsl!("common/kernel.glsl"))
            .file(glsl!("common/photon_kernel.glsl"))
            .file(glsl!("light/splat/spread.frag")),
        ShaderSource::new(ADDITION)
            .targets([TextureFormat::Rgba32Float])
            .file(glsl!("light/splat/addition.frag")),
    ]
}
