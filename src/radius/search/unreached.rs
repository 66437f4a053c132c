//! Pixels whose box of radius MR holds too few, set without counting.

use super::of_mask;
use crate::error::Result;
use crate::gl::{Pass, Program, ShaderSource, glsl};
use crate::maps::Frame;
use crate::maps::RadiusMap;
use crate::settings::Settings;

const UNREACHED: &str = "radius unreached";

/// Sets every pixel in one clear: cheaper than a draw, but without heed of a mask.
pub(super) fn clear(settings: &Settings, radii: &mut RadiusMap) {
    let unreached = [settings.search.max_radius, 1];
    radii.target().clear(&unreached[..=usize::from(settings.limited_mask)]);
}

/// The pass that sets pixels one by one, or 0 where the mask says so.
pub(super) fn pass<'a>(settings: &Settings, program: &'a Program, frame: &Frame<'a>) -> Pass<'a> {
    of_mask(Pass::new(UNREACHED, program), frame).set("max_radius", settings.search.max_radius.cast_signed())
}

pub(super) fn source(settings: &Settings) -> ShaderSource {
    ShaderSource::new(UNREACHED)
        .targets(RadiusMap::formats(settings.limited_mask))
        .define_if(settings.limited_mask, "LIMITED_MASK")
        .define_if(settings.masked, "MASKED")
        .file(glsl!("common/mask.glsl"))
        .file(glsl!("radius/search/unreached.frag"))
}

/// Sets every pixel.
pub(super) fn fill(
    settings: &Settings,
    program: &Program,
    frame: &Frame<'_>,
    radii: &mut RadiusMap,
) -> Result<()> {
    if frame.leaves_out_pixels() {
        pass(settings, program, frame).fill(radii.target())
    } else {
        clear(settings, radii);
        Ok(())
    }
}
