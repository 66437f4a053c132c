//! What every pass with a kernel checks, reads and defines.

use glam::UVec2;

use crate::error::{Error, Result};
use crate::gl::{Pass, ShaderSource};
use crate::maps::{KernelRadii, SurfaceMaps};
use crate::settings::{IrradianceSettings, KernelRadius};

/// How far a kernel may reach, in pixels: a square of that is what llvmpipe's loops finish (65,535 turns).
const MAX_REACH: u32 = 126;

/// Checks what kernels are drawn with; `expected` is what their stage was made for.
pub(super) fn check(
    surfaces: &SurfaceMaps,
    size: UVec2,
    radius: KernelRadii<'_>,
    expected: KernelRadius,
) -> Result<()> {
    surfaces.check_size(size)?;
    let what = "radius of the kernels";
    match radius {
        _ if radius.is_fixed() != expected.is_fixed() => {
            let in_words = |fixed: bool| if fixed { "a fixed one" } else { "a radius map" }.to_owned();
            Err(Error::Mismatch {
                what,
                expected: in_words(expected.is_fixed()),
                got: in_words(radius.is_fixed()),
            })
        }
        KernelRadii::Map(map) if map.size() != size => Err(Error::size(what, size, map.size())),
        _ => Ok(()),
    }
}

/// Gives a pass what `common/kernel_radius.glsl` reads.
pub(super) fn read_radius<'a>(pass: Pass<'a>, radius: KernelRadii<'a>) -> Pass<'a> {
    match radius {
        KernelRadii::Map(map) => pass.read("radii", map.as_texture()),
        KernelRadii::Fixed(radius) => pass.set("fixed_radius", radius),
    }
}

/// A shader that draws or gathers with such kernels.
pub(super) fn source(label: &str, settings: &IrradianceSettings) -> ShaderSource {
    ShaderSource::new(label)
        .define(settings.kernel.define(), 1_u32)
        .define("MAX_REACH", MAX_REACH)
        .define_if(settings.radius.is_fixed(), "FIXED_RADIUS")
}
