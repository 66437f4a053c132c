//! Photons to density map: one point for each photon, added up (thesis 2.1).
//!
//! - A photon counts if it contributes: it lies in the picture, on the surface that its pixel shows, on the
//!   side that is seen, and before or behind that surface's plane by at most half a pixel.
//! - Cost: one draw of points; nothing is sorted. Memory: 20 bytes a pixel.
//! - Exact: additive blending of ones into GL_R32F counts to 2^24 a pixel, where adding 1 stops to count; a
//!   map that gets there is refused (`blended-counts` of `varikernel stress`). The order of the photons
//!   changes no count, and so no radius (`order-of-photons`).
//! - Beside the counts it adds up the photons' power. For estimates that gather, in f32: of N alike photons
//!   on a pixel the sum is off by up to N 2^-25 of itself. For light from tables, in whole units whose sums
//!   are exact (see [`FluxMap`]): 16 bytes a pixel more.

use glam::{UVec2, Vec4};

use crate::error::{Error, Result};
use crate::gl::{
    Gl, Pass, Program, ShaderSource, StateGuard, Target, TargetShape, Targets, TextureFormat, TextureShape,
    glsl,
};
use crate::image::Image;
use crate::maps::CountBounds;
use crate::maps::{DensityMap, FluxMap, FluxUnits, PhotonPoints, PhotonTotals, PowerMap, SurfaceMaps};

const LABEL: &str = "density";
const COARSER: &str = "coarser units";

/// Where adding 1 to an f32 stops to count.
const MOST: u64 = 1 << 24;

/// Counts photons into maps of one size.
#[derive(Debug)]
pub struct DensityStage {
    gl: Gl,
    program: Program,
    /// Counts, and what else is added up.
    target: Target,
    /// The counts, with the number of photons drawn as their bounds.
    map: DensityMap,
    beside: Beside,
    /// Photons drawn, and the fullest pixel, when the counts were read last.
    read: (u64, u64),
}

/// What is added up beside the counts.
#[derive(Debug)]
enum Beside {
    /// Power, and the count again.
    Power(PowerMap),
    /// Power in whole units, with what makes units coarser.
    Flux(Box<(FluxMap, Program)>),
}

impl DensityStage {
    /// Allocates and compiles for maps of `size`, still without photons: GL_R32F for counts, GL_RGBA32F for
    /// power.
    ///
    /// # Errors
    /// [`Error::TooLarge`]; [`Error::Shader`] if the driver refuses the shader; [`Error::Gl`] when memory
    /// runs out.
    pub fn new(gl: &Gl, size: UVec2) -> Result<Self> {
        Self::of_kind(gl, size, false)
    }

    /// The same with power in whole units, for light from tables: GL_R32F for counts, two GL_RGBA32F.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_flux(gl: &Gl, size: UVec2) -> Result<Self> {
        Self::of_kind(gl, size, true)
    }

    pub(crate) fn of_kind(gl: &Gl, size: UVec2, has_flux: bool) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let target = Target::of(gl, &Self::shape(size, has_flux))?;
        let map = DensityMap::of_stage(target.texture());
        let beside = if has_flux {
            Beside::Flux(Box::new((flux_map(&target), Program::new(gl, &coarser_source())?)))
        } else {
            Beside::Power(power_map(&target))
        };
        let program = Program::new(gl, &source(has_flux))?;
        let mut stage = Self { gl: gl.clone(), program, target, map, beside, read: (0, 0) };
        stage.forget();
        Ok(stage)
    }

    /// The counts, and what is added up beside them.
    pub(crate) fn shape(size: UVec2, has_flux: bool) -> TargetShape {
        let beside: &[_] =
            if has_flux { &["flux, low bits", "flux, high bits"] } else { &["power of photons"] };
        let counts = TextureShape::new("density map", TextureFormat::R32Float, size);
        let beside = beside.iter().map(|label| TextureShape::new(label, TextureFormat::Rgba32Float, size));
        std::iter::once(counts).chain(beside).collect()
    }

    /// Whether power is kept in whole units.
    pub(crate) fn has_flux(&self) -> bool {
        matches!(self.beside, Beside::Flux(..))
    }

    /// Goes on with another target, without photons.
    pub(crate) fn resize(&mut self, targets: &mut Targets) {
        self.take(targets.take());
        self.forget();
    }

    /// Goes on with another target of the same shape.
    fn take(&mut self, target: Target) {
        let bounds = self.map.bounds();
        self.target = target;
        self.map = DensityMap::of_stage(self.target.texture());
        self.map.set_bounds(bounds);
        match &mut self.beside {
            Beside::Power(power) => *power = power_map(&self.target),
            Beside::Flux(beside) => {
                let flux = &mut beside.0;
                let (units, totals) = (flux.units(), *flux.totals());
                *flux = flux_map(&self.target);
                flux.set(units, totals);
            }
        }
    }

    /// Forgets all photons.
    ///
    /// # Errors
    /// [`Error::HostState`](crate::Error::HostState), [`Error::WrongContext`](crate::Error::WrongContext).
    pub fn clear(&mut self) -> Result<()> {
        let _state = StateGuard::new(&self.gl)?;
        self.forget();
        Ok(())
    }

    /// The same within a call.
    fn forget(&mut self) {
        self.target.clear_floats(&vec![Vec4::ZERO; self.target.textures().len()]);
        self.map.set_bounds(CountBounds::total_at_most(0));
        self.read = (0, 0);
        if let Beside::Flux(beside) = &mut self.beside {
            let flux = &mut beside.0;
            let none = PhotonTotals::default();
            flux.set(FluxUnits::of(&none), none);
        }
    }

    /// Makes room for the power of more photons.
    fn make_room(&mut self, photons: &PhotonPoints) -> Result<()> {
        let Beside::Flux(beside) = &mut self.beside else { return Ok(()) };
        let (flux, coarser) = &mut **beside;
        let Some(totals) = photons.totals() else {
            return Err(Error::Mismatch {
                what: "photons for light from tables",
                expected: "what they carry together, by PhotonPoints::set_totals".to_owned(),
                got: "a buffer of the host without".to_owned(),
            });
        };
        if !totals.is_finite() {
            return Err(Error::Mismatch {
                what: "photons for light from tables",
                expected: "powers that are finite, and not negative together".to_owned(),
                got: format!("{} {} {} together", totals.power[0], totals.power[1], totals.power[2]),
            });
        }
        let (before, all) = (flux.units(), *flux.totals() + *totals);
        let needed = FluxUnits::of(&all);
        if self.map.bounds().total == 0 {
            flux.set(needed, all);
        } else if needed.max(before) == before {
            flux.set(before, all);
        } else {
            let units = needed.with_room().max(before);
            let mut target = Target::of(&self.gl, &Self::shape(self.map.size(), true))?;
            let [low, high] = flux.as_textures();
            let squares = (before.square_root / units.square_root).powi(2);
            Pass::new(COARSER, coarser)
                .read("counts", self.map.as_texture())
                .read("low", low)
                .read("high", high)
                .set("power_factor", before.power / units.power)
                .set("square_factor", squares)
                .fill(&mut target)?;
            flux.set(units, all);
            self.take(target);
        }
        Ok(())
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
        let state = StateGuard::new(&self.gl)?;
        self.make_room(photons)?;
        let drawn = self.drawn() + photons.count();
        // First, so that the bounds hold also where drawing fails half-way.
        self.map.set_bounds(CountBounds::total_at_most(drawn));
        for chunk in photons.chunks() {
            let pass = surfaces.read_by(Pass::new(LABEL, &self.program));
            match &self.beside {
                Beside::Power(_) => pass,
                Beside::Flux(beside) => {
                    let FluxUnits { power, square_root } = beside.0.units();
                    pass.set("units_of_power", 1.0 / power).set("units_of_root", 1.0 / square_root)
                }
            }
            .add_points(chunk, &mut self.target)?;
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
        let _state = StateGuard::new(&self.gl)?;
        let counts = self.target.texture().read(0);
        self.gl.check("reading a density map back")?;
        Ok(counts)
    }

    /// Power of each pixel's photons, and their count again, unless it is kept in whole units.
    #[must_use]
    pub fn power(&self) -> Option<&PowerMap> {
        match &self.beside {
            Beside::Power(power) => Some(power),
            Beside::Flux(..) => None,
        }
    }

    /// Power of each pixel's photons in whole units, if it is kept so.
    #[must_use]
    pub fn flux(&self) -> Option<&FluxMap> {
        match &self.beside {
            Beside::Power(_) => None,
            Beside::Flux(beside) => Some(&beside.0),
        }
    }
}

fn power_map(target: &Target) -> PowerMap {
    PowerMap::of_stage(&target.textures()[1])
}

fn flux_map(target: &Target) -> FluxMap {
    FluxMap::of_stage(&target.textures()[1], &target.textures()[2])
}

/// The shader that counts photons.
pub(crate) fn source(has_flux: bool) -> ShaderSource {
    let planes = if has_flux { 2 } else { 1 };
    ShaderSource::new(LABEL)
        .variant_if(has_flux, "flux")
        .define_if(has_flux, "FLUX")
        .targets([TextureFormat::R32Float])
        .targets(vec![TextureFormat::Rgba32Float; planes])
        .vertex_file(glsl!("common/surfaces.glsl"))
        .vertex_file(glsl!("common/photon.glsl"))
        .vertex_file(glsl!("light/density/density.vert"))
        .file(glsl!("light/density/density.frag"))
}

/// The shader that makes units coarser.
pub(crate) fn coarser_source() -> ShaderSource {
    ShaderSource::new(COARSER)
        .targets([TextureFormat::R32Float, TextureFormat::Rgba32Float, TextureFormat::Rgba32Float])
        .file(glsl!("light/density/coarser.frag"))
}
