//! Photons to density map: one point for each photon, added up (thesis 2.1).
//!
//! - A photon counts if it contributes: it lies in the picture, on the surface that its pixel shows, on the
//!   side that is seen, and before or behind that surface's plane by at most half a pixel.
//! - Cost: one draw of points; nothing is sorted. Memory: 20 bytes a pixel.
//! - Exact: additive blending of ones into GL_R32F counts to 2^24 a pixel, where adding 1 stops to count; a
//!   map that gets there is refused (`blended-counts` of `varikernel stress`). The order of the photons
//!   changes no count, and so no radius (`order-of-photons`).
//! - Beside the counts it adds up the photons' power, for estimates that gather, in f32: of N alike photons
//!   on a pixel the sum is off by up to N 2^-25 of itself.

use glam::{UVec2, Vec4};

use crate::error::{Error, Result};
use crate::gl::{
    Gl, Pass, Program, ShaderSource, StateGuard, Target, TargetShape, Targets, TextureFormat, TextureShape,
    glsl,
};
use crate::image::Image;
use crate::maps::CountBounds;
use crate::maps::{DensityMap, PhotonPoints, PowerMap, SurfaceMaps};

const LABEL: &str = "density";

/// Where adding 1 to an f32 stops to count.
const MOST: u64 = 1 << 24;

/// Counts photons into maps of one size.
#[derive(Debug)]
pub struct DensityStage {
    gl: Gl,
    program: Program,
    /// Counts, and power with the count again.
    target: Target,
    /// The counts, with the number of photons drawn as their bounds.
    map: DensityMap,
    power: PowerMap,
    /// Photons drawn, and the fullest pixel, when the counts were read last.
    read: (u64, u64),
}

impl DensityStage {
    /// Allocates and compiles for maps of `size`, still without photons: GL_R32F for counts, GL_RGBA32F for
    /// power.
    ///
    /// # Errors
    /// [`Error::TooLarge`]; [`Error::Shader`] if the driver refuses the shader; [`Error::Gl`] when memory
    /// runs out.
    pub fn new(gl: &Gl, size: UVec2) -> Result<Self> {
        let _state = StateGuard::new(gl);
        let mut target = Target::of(gl, &Self::shape(size))?;
        target.clear_floats(&[Vec4::ZERO; 2]);
        let (map, power) = maps(&target);
        Ok(Self { gl: gl.clone(), program: Program::new(gl, &source())?, target, map, power, read: (0, 0) })
    }

    /// The counts, and the power with the count again.
    pub(crate) fn shape(size: UVec2) -> TargetShape {
        vec![
            TextureShape::new("density map", TextureFormat::R32Float, size),
            TextureShape::new("power of photons", TextureFormat::Rgba32Float, size),
        ]
    }

    /// Goes on with another target, without photons.
    pub(crate) fn resize(&mut self, targets: &mut Targets) {
        self.target = targets.take();
        (self.map, self.power) = maps(&self.target);
        self.clear();
    }

    /// Forgets all photons.
    pub fn clear(&mut self) {
        let _state = StateGuard::new(&self.gl);
        self.target.clear_floats(&[Vec4::ZERO; 2]);
        self.map.set_bounds(CountBounds::total_at_most(0));
        self.read = (0, 0);
    }

    /// Counts photons in, beside those that are there.
    ///
    /// The counts are read back, which waits for the GPU, only when 2^24 photons more were drawn than the
    /// fullest pixel leaves room for.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if the surfaces have another size; [`Error::Inexact`] if a pixel holds 2^24
    /// photons; [`Error::Gl`] if the driver fails.
    pub fn add(&mut self, surfaces: &SurfaceMaps, photons: &PhotonPoints) -> Result<&DensityMap> {
        surfaces.check_size(self.map.size())?;
        let drawn = self.drawn() + photons.count();
        // First, so that the bounds hold also where drawing fails half-way.
        self.map.set_bounds(CountBounds::total_at_most(drawn));
        let state = StateGuard::new(&self.gl);
        for chunk in photons.chunks() {
            surfaces.read_by(Pass::new(LABEL, &self.program)).add_points(chunk, &mut self.target)?;
        }
        self.gl.check("drawing photons")?;
        drop(state);
        let (drawn_then, fullest_then) = self.read;
        if drawn - drawn_then + fullest_then >= MOST {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count up to 2^24")]
            let fullest =
                self.read_counts()?.values().iter().fold(0.0_f32, |most, &count| most.max(count)) as u64;
            self.read = (drawn, fullest);
            if fullest >= MOST {
                return Err(Error::Inexact {
                    reason: "a pixel holds 2^24 photons or more, where additive blending stops to count"
                        .to_owned(),
                    remedy: "take fewer photons or a larger picture".to_owned(),
                });
            }
        }
        Ok(&self.map)
    }

    /// The counts: photons of each pixel.
    #[must_use]
    pub fn map(&self) -> &DensityMap {
        &self.map
    }

    /// Photons drawn, seen or not.
    #[must_use]
    pub fn drawn(&self) -> u64 {
        self.map.bounds().total
    }

    /// Photons of each pixel, read back; waits for the GPU.
    ///
    /// # Errors
    /// [`Error::Gl`] if the driver fails.
    pub fn read_counts(&self) -> Result<Image<f32>> {
        let _state = StateGuard::new(&self.gl);
        let counts = self.target.texture().read(0);
        self.gl.check("reading a density map back")?;
        Ok(counts)
    }

    /// Power of each pixel's photons, and their count again.
    #[must_use]
    pub fn power(&self) -> &PowerMap {
        &self.power
    }
}

/// What the planes of a target hold.
fn maps(target: &Target) -> (DensityMap, PowerMap) {
    (DensityMap::of_stage(target.texture()), PowerMap::of_stage(&target.textures()[1]))
}

/// The shader that the stage compiles.
pub(crate) fn source() -> ShaderSource {
    ShaderSource::new(LABEL)
        .targets([TextureFormat::R32Float, TextureFormat::Rgba32Float])
        .vertex_file(glsl!("common/surfaces.glsl"))
        .vertex_file(glsl!("common/photon.glsl"))
        .vertex_file(glsl!("light/density.vert"))
        .file(glsl!("light/density.frag"))
}
