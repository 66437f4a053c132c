//! Photons to density map: one point for each photon, added up (thesis 2.1).
//!
//! - A photon counts if it contributes: it lies in the picture, on the surface that its pixel shows, on the side that is
//!   seen, and before or behind that surface's plane by at most half a pixel.
//! - Cost: one draw of points; nothing is sorted. Memory: 20 bytes a pixel.
//! - Exact: additive blending of ones into GL_R32F counts to 2^24 a pixel, where adding 1 stops to count; a map that gets
//!   there is refused (`blended-counts` of `varikernel stress`). The order of the photons changes no count, and so no radius
//!   (`order-of-photons`).
//! - Beside the counts it adds up the photons' power, for estimates that gather, in f32: of N alike photons on a pixel the sum is
//!   off by up to N 2^-25 of itself.

use glam::{UVec2, Vec4};

use crate::error::{Error, Result};
use crate::exactness::CountBounds;
use crate::gl::{
    Gl, Pass, Program, ShaderSource, StateGuard, Target, Texture, TextureFormat, Vertices, glsl,
};
use crate::image::Image;
use crate::maps::{DensityMap, PhotonPoints, SurfaceMaps};

const LABEL: &str = "density";

/// Where adding 1 to an f32 stops to count.
const MOST: f32 = 16_777_216.0;

/// The maps of one size that photons are added to.
#[derive(Debug)]
pub(crate) struct DensityStage {
    gl: Gl,
    program: Program,
    /// Counts, and power with the count again.
    target: Target,
    drawn: u64,
}

impl DensityStage {
    pub(crate) fn new(gl: &Gl, size: UVec2) -> Result<Self> {
        let _state = StateGuard::new(gl);
        let textures = vec![
            Texture::new(gl, TextureFormat::R32Float, size, 1)?,
            Texture::new(gl, TextureFormat::Rgba32Float, size, 1)?,
        ];
        let mut target = Target::new(gl, textures)?.labelled(&["density map", "power of photons"]);
        target.clear_floats(&[Vec4::ZERO; 2]);
        Ok(Self { gl: gl.clone(), program: Program::new(gl, &source())?, target, drawn: 0 })
    }

    /// Forgets all photons.
    pub(crate) fn clear(&mut self) {
        let _state = StateGuard::new(&self.gl);
        self.target.clear_floats(&[Vec4::ZERO; 2]);
        self.drawn = 0;
    }

    /// Counts photons in.
    pub(crate) fn add(&mut self, surfaces: &SurfaceMaps, photons: &PhotonPoints) -> Result<()> {
        let _state = StateGuard::new(&self.gl);
        for chunk in photons.chunks() {
            self.add_chunk(surfaces, chunk)?;
        }
        self.gl.check("drawing photons")
    }

    fn add_chunk(&mut self, surfaces: &SurfaceMaps, chunk: &Vertices) -> Result<()> {
        self.drawn += u64::from(chunk.count());
        surfaces.read_by(Pass::new(LABEL, &self.program)).add_points(chunk, &mut self.target)
    }

    /// The counts.
    ///
    /// # Errors
    /// [`Error::Inexact`] if a pixel holds 2^24 photons.
    pub(crate) fn map(&self) -> Result<DensityMap> {
        #[expect(clippy::cast_precision_loss, reason = "compared with 2^24 only")]
        if self.drawn as f32 >= MOST && self.read_counts()?.values().iter().any(|&count| count >= MOST) {
            return Err(Error::Inexact {
                reason: "a pixel holds 2^24 photons or more, where additive blending stops to count"
                    .to_owned(),
                remedy: "take fewer photons or a larger picture".to_owned(),
            });
        }
        DensityMap::borrow(&self.gl, self.target.texture().name(), CountBounds::total_at_most(self.drawn))
    }

    /// Photons of each pixel.
    pub(crate) fn read_counts(&self) -> Result<Image<f32>> {
        let _state = StateGuard::new(&self.gl);
        let counts = self.target.texture().read(0);
        self.gl.check("reading a density map back")?;
        Ok(counts)
    }

    /// Power of each pixel's photons, linear RGB, and their count.
    pub(crate) fn read_power(&self) -> Result<Image<[f32; 4]>> {
        let _state = StateGuard::new(&self.gl);
        let power = self.target.textures()[1].read(0);
        self.gl.check("reading a power map back")?;
        Ok(power)
    }

    /// The texture behind [`read_power`](Self::read_power).
    pub(crate) fn power(&self) -> &Texture {
        &self.target.textures()[1]
    }
}

pub(crate) fn source() -> ShaderSource {
    ShaderSource::new(LABEL)
        .vertex_file(glsl!("common/surfaces.glsl"))
        .vertex_file(glsl!("common/photon.glsl"))
        .vertex_file(glsl!("density.vert"))
        .file(glsl!("density.frag"))
}
