//! GL_TIME_ELAPSED beside the wall clock (thesis 5.1).

use std::time::{Duration, Instant};

use glam::UVec2;
use glow::HasContext as _;

use super::query::Query;
use super::{Gl, StateGuard, Target, Texture, TextureFormat};
use crate::error::Result;

/// Query and clock may differ by this share of the clock's time...
const MARGIN_SHARE: f64 = 0.05;
/// ...or by this much, which is what submitting and waiting may take, whichever is more.
const MARGIN: Duration = Duration::from_micros(250);

/// One timed piece of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Sample {
    /// The time by GL_TIME_ELAPSED.
    pub query: Duration,
    /// The time by the clock, from before the first command to after the last is finished.
    pub wall: Duration,
}

impl Sample {
    /// Whether query and clock contradict each other, so that one of them is wrong.
    ///
    /// The margin is 5 % of the clock's time, and at least 0.25 ms. The clock encloses the work, so that a
    /// query beyond it by more than the margin is wrong on any device; so is a query of nothing at all. On a
    /// software renderer both measure the same processor, and a query that falls short by more than the
    /// margin is wrong as well. On a GPU it may fall short by any amount: the clock includes submission and
    /// the way back.
    #[must_use]
    pub fn is_suspect(self, software: bool) -> bool {
        let margin = self.wall.mul_f64(MARGIN_SHARE).max(MARGIN);
        let too_long = self.query > self.wall + margin;
        let too_short = software && self.query + margin < self.wall;
        too_long || too_short || self.query.is_zero()
    }
}

/// A query that can be used again and again; timing allocates nothing.
///
/// No other GL_TIME_ELAPSED query may be running while it times: nested ones are an error in OpenGL. What is
/// timed runs under the host's own state.
#[derive(Debug)]
pub struct Timer {
    gl: Gl,
    query: Query,
    /// llvmpipe stamps the begin of a query while it rasterises the current frame: too late if that frame is
    /// the timed work, and never if there is none. There, a frame of one pixel is put before the begin and
    /// another finished right after it.
    llvmpipe_frame: Option<Target>,
}

impl Timer {
    /// Makes the query.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`](crate::Error::OutOfMemory).
    pub fn new(gl: &Gl) -> Result<Self> {
        let _state = StateGuard::new(gl)?;
        let llvmpipe_frame = if gl.info().is_llvmpipe() {
            let pixel = Texture::new(gl, TextureFormat::R32Uint, UVec2::ONE, 1)?;
            Some(Target::single(gl, pixel)?.labelled(&["frame before a timed one"]))
        } else {
            None
        };
        Ok(Self { gl: gl.clone(), query: Query::of_time(gl)?, llvmpipe_frame })
    }

    /// Runs `work`, waits for it, and says how long it took on the GPU and by the clock.
    ///
    /// # Errors
    /// Those of `work`; [`Error::QueryRunning`](crate::Error::QueryRunning) while a query of the host times,
    /// without running `work`; [`Error::Gl`](crate::Error::Gl) if the query fails.
    pub fn time<T>(&mut self, work: impl FnOnce() -> Result<T>) -> Result<(T, Sample)> {
        self.begin()?;
        let start = Instant::now();
        let result = work();
        self.query.end();
        if let Some(glow) = self.gl.live() {
            // SAFETY: the context is current while the handle lives.
            unsafe { glow.finish() };
        }
        let wall = start.elapsed();
        let nanoseconds = self.query.result();
        let result = result?;
        self.gl.check("timing")?;
        Ok((result, Sample { query: Duration::from_nanos(nanoseconds), wall }))
    }

    /// Begins the query, with nothing before it left to do.
    fn begin(&mut self) -> Result<()> {
        let _state = StateGuard::new(&self.gl)?;
        let glow = self.gl.current()?;
        if let Some(frame) = &mut self.llvmpipe_frame {
            frame.clear(&[0]);
        }
        // SAFETY: the context is current while the handle lives.
        unsafe { glow.finish() };
        self.gl.check("preparing a time query")?;
        self.query.begin()?;
        if let Some(frame) = &mut self.llvmpipe_frame {
            frame.clear(&[0]);
            // SAFETY: as above.
            unsafe { glow.finish() };
        }
        Ok(())
    }
}

/// Times `work` once, with a [`Timer`] of its own.
///
/// # Errors
/// As [`Timer::new`] and [`Timer::time`].
pub fn time<T>(gl: &Gl, work: impl FnOnce() -> Result<T>) -> Result<(T, Sample)> {
    Timer::new(gl)?.time(work)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(query_us: u64, wall_us: u64) -> Sample {
        Sample { query: Duration::from_micros(query_us), wall: Duration::from_micros(wall_us) }
    }

    #[test]
    fn margins_by_hand() {
        // 5 % of 100 ms are 5 ms.
        assert!(!sample(96_000, 100_000).is_suspect(true));
        assert!(sample(94_000, 100_000).is_suspect(true));
        assert!(!sample(104_000, 100_000).is_suspect(true));
        // Short work may differ by a quarter of a millisecond.
        assert!(!sample(100, 340).is_suspect(true));
        assert!(sample(100, 360).is_suspect(true));
    }

    #[test]
    fn on_a_gpu_only_a_query_longer_than_the_clock_or_of_nothing_is_suspect() {
        assert!(!sample(10, 100_000).is_suspect(false));
        assert!(sample(106_000, 100_000).is_suspect(false));
        assert!(sample(0, 100).is_suspect(false));
    }
}
