//! The units of time: a copy and a probe.
//!
//! Milliseconds hold for one machine in one state. A time in copies, measured in the same run at the same
//! size, can be compared between machines: it is the time in multiples of a pass that reads and writes each
//! texel once.

use glam::UVec2;

use crate::error::{Error, Result};
use crate::gl::{Gl, Pass, Program, ShaderSource, StateGuard, Target, Texture, TextureFormat, glsl};
use crate::image::Image;
use crate::maps::DensityMap;

/// Which unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unit {
    /// One R32UI texel read and written.
    Copy,
    /// Four texels read, added and written: what one radius costs a summed-area table at least.
    Probe,
}

impl Unit {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Copy, Self::Probe];

    /// Its shader.
    #[must_use]
    pub fn source(self) -> ShaderSource {
        ShaderSource::new(self.label()).targets([TextureFormat::R32Uint]).file(match self {
            Self::Copy => glsl!("measure/copy.frag"),
            Self::Probe => glsl!("measure/probe.frag"),
        })
    }

    fn label(self) -> &'static str {
        match self {
            Self::Copy => "copy",
            Self::Probe => "probe",
        }
    }

    /// The result of the pass for `counts`, on the CPU.
    #[must_use]
    pub fn expected(self, counts: &Image<u32>) -> Image<u32> {
        match self {
            Self::Copy => counts.clone(),
            Self::Probe => Image::from_fn(counts.size(), |x, y| {
                let (left, bottom) = (x.saturating_sub(4), y.saturating_sub(4));
                let right = (x + 3).min(counts.size().x - 1);
                let top = (y + 3).min(counts.size().y - 1);
                let (plus, minus) = (
                    counts.at(right, top).wrapping_add(counts.at(left, bottom)),
                    counts.at(left, top).wrapping_add(counts.at(right, bottom)),
                );
                plus.wrapping_sub(minus)
            }),
        }
    }
}

/// A full-screen pass over a density map in GL_R32UI, as cheap as its work allows.
#[derive(Debug)]
pub struct UnitPass {
    gl: Gl,
    unit: Unit,
    program: Program,
    target: Target,
}

impl UnitPass {
    /// Compiles and allocates.
    ///
    /// # Errors
    /// [`Error::TooLarge`], [`Error::Shader`], or [`Error::OutOfMemory`].
    pub fn new(gl: &Gl, unit: Unit, size: UVec2) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let program = Program::new(gl, &unit.source())?;
        let target =
            Target::single(gl, Texture::new(gl, TextureFormat::R32Uint, size, 1)?)?.labelled(&["unit pass"]);
        Ok(Self { gl: gl.clone(), unit, program, target })
    }

    /// Draws once.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if the map is of another size or format, [`Error::Gl`] if the driver fails.
    pub fn run(&mut self, density: &DensityMap) -> Result<()> {
        if density.size() != self.target.size() || density.format() != TextureFormat::R32Uint {
            let text = |size: UVec2, format: TextureFormat| format!("{size} {}", format.name());
            return Err(Error::Mismatch {
                what: "density map of a unit pass",
                expected: text(self.target.size(), TextureFormat::R32Uint),
                got: text(density.size(), density.format()),
            });
        }
        let _state = StateGuard::new(&self.gl)?;
        let mut pass = Pass::new(self.unit.label(), &self.program).read("density", density.as_texture());
        if self.unit == Unit::Probe {
            pass = pass.set("map_size", density.size().as_ivec2());
        }
        pass.fill(&mut self.target)?;
        self.gl.check("drawing a unit pass")
    }

    /// Reads back what the last [`run`](Self::run) drew.
    ///
    /// # Errors
    /// [`Error::Gl`] if the driver fails.
    pub fn read(&self) -> Result<Image<u32>> {
        let _state = StateGuard::new(&self.gl)?;
        let image = self.target.texture().read(0);
        self.gl.check("reading a unit pass back")?;
        Ok(image)
    }
}
