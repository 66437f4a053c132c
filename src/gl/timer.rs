//! GL_TIME_ELAPSED beside the wall clock (thesis 5.1).

use std::time::{Duration, Instant};

use glam::UVec2;
use glow::HasContext as _;

use super::{Gl, StateGuard, Target, Texture, TextureFormat, gl_error};
use crate::error::Result;

/// One timed piece of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Sample {
    /// What GL_TIME_ELAPSED says.
    pub query: Duration,
    /// What the clock says, from before the first command to after the last is finished.
    pub wall: Duration,
}

/// Runs `work`, waits for it, and says how long it took on the GPU and by the clock.
///
/// llvmpipe stamps the begin of a query while it rasterises the frame in hand: too late if that frame is the timed
/// work, and never if there is none. There, a frame of one pixel is put before the begin and another finished right
/// after it.
/// No other GL_TIME_ELAPSED query may be running: nested ones are an error in OpenGL.
///
/// # Errors
/// Those of `work`, and [`Error::Gl`](crate::Error::Gl) if the query fails.
pub fn time<T>(gl: &Gl, work: impl FnOnce() -> Result<T>) -> Result<(T, Sample)> {
    let glow = gl.glow();
    let _state = StateGuard::new(gl);
    let llvmpipe_frame = if gl.info().is_llvmpipe() {
        Some(Target::single(gl, Texture::new(gl, TextureFormat::R32Uint, UVec2::ONE, 1)?)?)
    } else {
        None
    };
    // SAFETY: the context is current while the handle lives.
    let query = unsafe { glow.create_query() }.map_err(|what| gl_error(glow, &what))?;
    // SAFETY: as above; the query is deleted on every way out.
    unsafe {
        if let Some(frame) = &llvmpipe_frame {
            frame.clear();
        }
        glow.finish();
        glow.begin_query(glow::TIME_ELAPSED, query);
        if let Some(frame) = &llvmpipe_frame {
            frame.clear();
            glow.finish();
        }
    }
    let start = Instant::now();
    let result = work();
    let mut nanoseconds = 0_u64;
    // SAFETY: no query buffer is bound in a 3.3 context, so the "offset" is the address of the result.
    // (glow's plain reader of u64 wants a 4.5 command.)
    let wall = unsafe {
        glow.end_query(glow::TIME_ELAPSED);
        glow.finish();
        let wall = start.elapsed();
        let address = (&raw mut nanoseconds).expose_provenance();
        glow.get_query_parameter_u64_with_offset(query, glow::QUERY_RESULT, address);
        glow.delete_query(query);
        wall
    };
    let result = result?;
    gl.check("timing")?;
    Ok((result, Sample { query: Duration::from_nanos(nanoseconds), wall }))
}
