//! Density texture in, radius texture out.

use glam::UVec2;

use super::{
    Context, Failure, Handle, PlainFrame, PlainSettings, Status, answer, check_place, destroy, given,
};
use crate::error::Error;
use crate::gl::TextureFormat;
use crate::maps::Frame;
use crate::radius::RadiusPipeline;
use crate::settings::Planning;

/// Density map in, radius map out, for one size and one set of settings.
pub struct Pipeline(Handle<Box<RadiusPipeline>>);

/// Tells the memory that a pipeline takes, before it is made: bytes of textures and buffers, as large as
/// their formats say.
///
/// `*at_creation` is what varikernel_pipeline_create and varikernel_pipeline_resize allocate; `*at_most` adds
/// what is allocated on demand, by VARIKERNEL_CHANGED_ADDED and, for VARIKERNEL_ORDER_ADAPTIVE, by each
/// order; the pointer may be null. `settings` may be null for the defaults.
///
/// Fails with SETTING, TOO_LARGE, INVALID_ARGUMENT, WRONG_THREAD, NO_CONTEXT, CONTEXT_LOST.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_pipeline_memory_required(
    context: *const Context,
    width: u32,
    height: u32,
    settings: *const PlainSettings,
    at_creation: *mut u64,
    at_most: *mut u64,
) -> Status {
    answer(|| {
        check_place(at_creation, "at_creation")?;
        // SAFETY: the host gives a handle that was not destroyed, or null.
        let gl = unsafe { given(context, "context") }?.0.gl()?;
        // SAFETY: the host gives settings or null.
        let settings = unsafe { settings.as_ref() }.map(PlainSettings::read).transpose()?.unwrap_or_default();
        let (device, size) = (gl.info(), UVec2::new(width, height));
        let required = RadiusPipeline::memory_required_on(device, size, &settings)?;
        let of_orders = match settings.planning {
            Planning::AsAsked => 0,
            Planning::EachFrame => required.other_orders,
        };
        if !at_most.is_null() {
            // SAFETY: the host gives a pointer to write to, or null.
            unsafe { at_most.write(required.at_creation + required.additions + of_orders) };
        }
        // SAFETY: the host gives a pointer to write to.
        unsafe { at_creation.write(required.at_creation) };
        Ok(())
    })
}

/// Allocates and compiles for density maps of `width` x `height` pixels in `density_format`: GL_R32F, as
/// additive blending of points fills it, GL_R32UI, GL_R16UI or GL_R8UI. Takes milliseconds to seconds; frames
/// only draw.
///
/// `*pipeline` is the host's to destroy, before or after `context`. `settings` may be null for the defaults.
///
/// Fails with SETTING, TOO_LARGE, MISMATCH for another format, SHADER, OUT_OF_MEMORY, OPEN_GL,
/// INVALID_ARGUMENT, WRONG_THREAD, NO_CONTEXT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_pipeline_create(
    context: *const Context,
    width: u32,
    height: u32,
    density_format: u32,
    settings: *const PlainSettings,
    pipeline: *mut *mut Pipeline,
) -> Status {
    answer(|| {
        check_place(pipeline, "pipeline")?;
        // SAFETY: the host gives a handle that was not destroyed, or null.
        let context = unsafe { given(context, "context") }?;
        let gl = context.0.gl()?;
        // SAFETY: the host gives settings or null.
        let settings = unsafe { settings.as_ref() }.map(PlainSettings::read).transpose()?.unwrap_or_default();
        let format = read_format(density_format)?;
        let made = RadiusPipeline::new(gl, UVec2::new(width, height), format, settings)?;
        let made = Pipeline(Handle::new(context, Box::new(made)));
        // SAFETY: the host gives a pointer to write to.
        unsafe { pipeline.write(Box::into_raw(Box::new(made))) };
        Ok(())
    })
}

/// Finds the radii of a frame: draws only, reads nothing back, waits for nothing.
///
/// `*radius_texture` is a GL_TEXTURE_2D in GL_R32UI, a usampler2D in your shaders: radii from 1 to MR in
/// pixels (by VARIKERNEL_RULE_EVEN from 0 on), 0 where the mask says that none is needed. `*limited_texture`
/// is one in GL_R8UI that is 1 where MR ended the search, or 0 if the settings ask for none; the pointer may
/// be null. Both belong to the pipeline, are complete without a sampler, and hold until its next frame. Take the
/// names anew each frame: textures may take turns.
///
/// Fails with MISMATCH, INEXACT, SETTING, OUT_OF_MEMORY, CONTEXT_LOST, OPEN_GL, INVALID_ARGUMENT,
/// WRONG_THREAD, NO_CONTEXT; the next frame may succeed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_pipeline_render(
    pipeline: *mut Pipeline,
    frame: *const PlainFrame,
    radius_texture: *mut u32,
    limited_texture: *mut u32,
) -> Status {
    answer(|| {
        // SAFETY: the host gives a handle that was not destroyed, or null.
        let pipeline = unsafe { given(pipeline, "pipeline") }?;
        // SAFETY: the host gives a frame or null.
        let frame = unsafe { given(frame, "frame") }?;
        check_place(radius_texture, "radius_texture")?;
        let (radius, limited) = pipeline.0.with(|gl, stages| {
            let (density, mask) = frame.borrow(gl)?;
            let changed = frame.read_changed()?;
            let radii = stages.update(&Frame { density: &density, mask: mask.as_ref(), changed })?;
            Ok((radii.texture(), radii.limited_texture()))
        })?;
        if !limited_texture.is_null() {
            let name = limited.map_or(0, |limited| limited.0.get());
            // SAFETY: the host gives a pointer to write to, or null.
            unsafe { limited_texture.write(name) };
        }
        // SAFETY: the host gives a pointer to write to.
        unsafe { radius_texture.write(radius.0.get()) };
        Ok(())
    })
}

/// From now on for density maps of another size, with the same format and settings; the next frame starts
/// from nothing. Nothing is compiled. Textures of earlier frames are gone; the new ones are made before the
/// old ones are freed.
///
/// Fails with SETTING, TOO_LARGE, OUT_OF_MEMORY, CONTEXT_LOST, OPEN_GL, INVALID_ARGUMENT, WRONG_THREAD,
/// NO_CONTEXT, and the pipeline then goes on at its old size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_pipeline_resize(
    pipeline: *mut Pipeline,
    width: u32,
    height: u32,
) -> Status {
    answer(|| {
        // SAFETY: the host gives a handle that was not destroyed, or null.
        let pipeline = unsafe { given(pipeline, "pipeline") }?;
        pipeline.0.with(|_, stages| Ok(stages.resize(UVec2::new(width, height))?))
    })
}

/// Draws a frame of a map without photons, waits for it, and forgets it: what a driver puts off until a shader
/// first draws is done when this returns. Worth its time while a host loads, after
/// varikernel_pipeline_create and varikernel_pipeline_resize. Takes the memory of one more density map meanwhile.
///
/// Fails with OUT_OF_MEMORY, CONTEXT_LOST, OPEN_GL, INVALID_ARGUMENT, WRONG_THREAD, NO_CONTEXT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_pipeline_warm_up(pipeline: *mut Pipeline) -> Status {
    answer(|| {
        // SAFETY: the host gives a handle that was not destroyed, or null.
        let pipeline = unsafe { given(pipeline, "pipeline") }?;
        pipeline.0.with(|_, stages| Ok(stages.warm_up()?))
    })
}

/// Frees a pipeline with its textures; null is fine.
///
/// Fails with WRONG_THREAD and NO_CONTEXT, and frees nothing then; see varikernel_context_abandon.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_pipeline_destroy(pipeline: *mut Pipeline) -> Status {
    // SAFETY: the host gives a handle that `varikernel_pipeline_create` made and that was not destroyed, or
    // null.
    unsafe { destroy(pipeline, |pipeline| pipeline.0.home()) }
}

/// A format by the value of its GL enum.
fn read_format(value: u32) -> Result<TextureFormat, Failure> {
    match value {
        glow::R32F => Ok(TextureFormat::R32Float),
        glow::R32UI => Ok(TextureFormat::R32Uint),
        glow::R16UI => Ok(TextureFormat::R16Uint),
        glow::R8UI => Ok(TextureFormat::R8Uint),
        other => Err(Error::Mismatch {
            what: "density_format",
            expected: "GL_R32F, GL_R32UI, GL_R16UI or GL_R8UI".to_owned(),
            got: format!("{other:#06x}"),
        }
        .into()),
    }
}
