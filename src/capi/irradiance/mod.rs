//! Photons and a g-buffer in, irradiance texture out.

mod frame;
mod photon_buffer;
mod settings;

use glam::UVec2;

use super::{
    Context, Failure, Handle, Status, answer, check_place, check_size, destroy, flag, given, out_of_range,
    texture,
};
use crate::light::IrradiancePipeline;
use crate::maps::RadiusMap;
use crate::maps::{HostDepth, PositionMaker};
use crate::settings::Estimate;
use frame::{Kept, PlainIrradianceFrame};
use settings::PlainIrradianceSettings;

/// Photons and surfaces in, irradiance out, for one size and one set of settings.
pub struct Irradiance(Handle<Stages>);

/// Where places come from.
enum Positions {
    /// A texture of the host.
    Given,
    /// A depth buffer of the host; with what was made for it, once it was seen.
    FromDepth(Option<Box<(HostDepth, PositionMaker)>>),
}

struct Stages {
    size: UVec2,
    pipeline: Box<IrradiancePipeline>,
    positions: Positions,
}

/// Allocates and compiles for surfaces of `width` x `height` pixels. Takes milliseconds to seconds; frames
/// only draw.
///
/// `*irradiance` is the host's to destroy, before or after `context`. `settings` may be null for the
/// defaults.
///
/// Fails with SETTING, TOO_LARGE, SHADER, OUT_OF_MEMORY, OPEN_GL, INVALID_ARGUMENT, WRONG_THREAD, NO_CONTEXT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_irradiance_create(
    context: *const Context,
    width: u32,
    height: u32,
    settings: *const PlainIrradianceSettings,
    irradiance: *mut *mut Irradiance,
) -> Status {
    answer(|| {
        check_place(irradiance, "irradiance")?;
        // SAFETY: the host gives a handle that was not destroyed, or null.
        let context = unsafe { given(context, "context") }?;
        let gl = context.0.gl()?;
        // SAFETY: the host gives settings or null.
        let settings = unsafe { settings.as_ref() }.map(PlainIrradianceSettings::read).transpose()?;
        let (settings, has_depth) = settings.unwrap_or_default();
        let size = UVec2::new(width, height);
        let pipeline = Box::new(IrradiancePipeline::new(gl, size, settings)?);
        let positions = if has_depth { Positions::FromDepth(None) } else { Positions::Given };
        let made = Irradiance(Handle::new(context, Stages { size, pipeline, positions }));
        // SAFETY: the host gives a pointer to write to.
        unsafe { irradiance.write(Box::into_raw(Box::new(made))) };
        Ok(())
    })
}

/// Finds the light that photons bring to the surfaces: counts them, finds radii, draws a kernel for each; or
/// as settings say by estimate.
///
/// `*irradiance_texture` is a GL_TEXTURE_2D in GL_RGBA32F, a sampler2D in your shaders: power per area in
/// scene units, linear RGB; light that leaves a diffuse surface is albedo / pi of it. `*radius_texture` is as
/// that of varikernel_pipeline_render, or 0 for a fixed radius; of VARIKERNEL_ESTIMATE_TABLES it says how
/// wide each pixel's light was gathered, 0 where nothing is lit. The pointer may be null. Both belong to the
/// handle and hold until its next frame.
///
/// Waits for the GPU only where a pixel may hold 2^24 photons. With from_depth, a shader is compiled when a
/// depth texture is first seen.
///
/// Fails with MISMATCH, INEXACT, SETTING, OUT_OF_MEMORY, CONTEXT_LOST, OPEN_GL, INVALID_ARGUMENT,
/// WRONG_THREAD, NO_CONTEXT; the next frame may succeed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_irradiance_render(
    irradiance: *mut Irradiance,
    frame: *const PlainIrradianceFrame,
    irradiance_texture: *mut u32,
    radius_texture: *mut u32,
) -> Status {
    answer(|| {
        // SAFETY: the host gives a handle that was not destroyed, or null.
        let irradiance = unsafe { given(irradiance, "irradiance") }?;
        // SAFETY: the host gives a frame or null.
        let frame = unsafe { given(frame, "frame") }?;
        check_place(irradiance_texture, "irradiance_texture")?;
        let (light, radius) = irradiance.0.with(|gl, stages| {
            let kept = frame.read_kept()?;
            let pipeline = &mut stages.pipeline;
            if pipeline.settings().estimate == Estimate::Tables && frame.photon_totals.is_null() {
                return Err(Failure::new(
                    Status::InvalidArgument,
                    "photon_totals is null\n\
                     help: light from tables has to know what the photons carry together: call \
                     varikernel_photon_totals_of, or fill in sums of yours; an upper bound will do",
                ));
            }
            let (surfaces, photons) = frame.borrow(gl, stages.size, &mut stages.positions)?;
            match kept {
                Kept::Nothing => pipeline.clear()?,
                Kept::Camera => {
                    pipeline.clear_photons()?;
                    pipeline.clear_light()?;
                }
                Kept::All => (),
            }
            let light = pipeline.add(&surfaces, &photons)?.texture();
            Ok((light, pipeline.radii().map(RadiusMap::texture)))
        })?;
        if !radius_texture.is_null() {
            // SAFETY: the host gives a pointer to write to, or null.
            unsafe { radius_texture.write(radius.map_or(0, |radius| radius.0.get())) };
        }
        // SAFETY: the host gives a pointer to write to.
        unsafe { irradiance_texture.write(light.0.get()) };
        Ok(())
    })
}

/// Tells the memory that irradiance takes, before the handle is made: bytes of textures and buffers, as large
/// as their formats say; surfaces, the positions of a depth buffer (16 bytes a pixel) and photons apart.
/// `settings` may be null for the defaults.
///
/// Fails with SETTING, INVALID_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_irradiance_memory_required(
    width: u32,
    height: u32,
    settings: *const PlainIrradianceSettings,
    bytes: *mut u64,
) -> Status {
    answer(|| {
        check_place(bytes, "bytes")?;
        // SAFETY: the host gives settings or null.
        let settings = unsafe { settings.as_ref() }.map(PlainIrradianceSettings::read).transpose()?;
        let (settings, _) = settings.unwrap_or_default();
        let required = IrradiancePipeline::memory_required(UVec2::new(width, height), &settings)?;
        // SAFETY: the host gives a pointer to write to.
        unsafe { bytes.write(required) };
        Ok(())
    })
}

/// From now on for surfaces of another size, without photons. As varikernel_pipeline_resize.
///
/// Fails with SETTING, TOO_LARGE, OUT_OF_MEMORY, CONTEXT_LOST, OPEN_GL, INVALID_ARGUMENT, WRONG_THREAD,
/// NO_CONTEXT, and the handle then goes on at its old size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_irradiance_resize(
    irradiance: *mut Irradiance,
    width: u32,
    height: u32,
) -> Status {
    answer(|| {
        // SAFETY: the host gives a handle that was not destroyed, or null.
        let irradiance = unsafe { given(irradiance, "irradiance") }?;
        irradiance.0.with(|_, stages| {
            let size = UVec2::new(width, height);
            stages.pipeline.resize(size)?;
            stages.size = size;
            if let Positions::FromDepth(made) = &mut stages.positions {
                *made = None;
            }
            Ok(())
        })
    })
}

/// Frees the handle with its textures; null is fine. As varikernel_pipeline_destroy.
///
/// Fails with WRONG_THREAD and NO_CONTEXT, and frees nothing then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_irradiance_destroy(irradiance: *mut Irradiance) -> Status {
    // SAFETY: the host gives a handle that `varikernel_irradiance_create` made and that was not destroyed, or
    // null.
    unsafe { destroy(irradiance, |irradiance| irradiance.0.home()) }
}
