//! Queries: what OpenGL counts or times between a begin and an end.

use glow::HasContext as _;

use super::Gl;
use crate::error::{Error, Result};

/// A query of one kind, to be used again and again.
///
/// While another query of that kind is running, a host's for instance, it cannot begin.
#[derive(Debug)]
pub(crate) struct Query {
    gl: Gl,
    name: glow::Query,
    target: u32,
}

impl Query {
    /// Fragments that are drawn: those of GL_SAMPLES_PASSED, in framebuffers of one sample a pixel.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(crate) fn of_fragments(gl: &Gl) -> Result<Self> {
        Self::new(gl, glow::SAMPLES_PASSED)
    }

    /// Nanoseconds: those of GL_TIME_ELAPSED.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub(super) fn of_time(gl: &Gl) -> Result<Self> {
        Self::new(gl, glow::TIME_ELAPSED)
    }

    /// Nanoseconds since some moment: those of GL_TIMESTAMP.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`](crate::Error::OutOfMemory).
    pub(super) fn of_moments(gl: &Gl) -> Result<Self> {
        Self::new(gl, glow::TIMESTAMP)
    }

    fn new(gl: &Gl, target: u32) -> Result<Self> {
        // SAFETY: the context is current while the handle lives.
        let name = unsafe { gl.current()?.create_query() }.map_err(|what| gl.failure(&what))?;
        Ok(Self { gl: gl.clone(), name, target })
    }

    /// Counts what `work` draws; waits for the GPU.
    ///
    /// # Errors
    /// Those of `work`, [`Error::QueryRunning`], and [`Error::Gl`] if the query fails.
    pub(crate) fn count(&self, work: impl FnOnce() -> Result<()>) -> Result<u64> {
        self.begin()?;
        let result = work();
        self.end();
        result?;
        let count = self.result();
        self.gl.check("reading a query")?;
        Ok(count)
    }

    /// # Errors
    /// [`Error::QueryRunning`] while another query of the kind is running, which goes on; [`Error::Gl`].
    pub(super) fn begin(&self) -> Result<()> {
        self.gl.check("what comes before a query")?;
        let glow = self.gl.current()?;
        // SAFETY: the context is current while the handle lives.
        let code = unsafe {
            glow.begin_query(self.target, self.name);
            glow.get_error()
        };
        match code {
            glow::NO_ERROR => Ok(()),
            // The name is of this kind and not running, so that only another running query can be the cause.
            glow::INVALID_OPERATION => Err(Error::QueryRunning { kind: self.kind() }),
            _ => Err(self.gl.error(code, &format!("beginning a {} query", self.kind()), None)),
        }
    }

    /// The name of the GL enum.
    fn kind(&self) -> &'static str {
        if self.target == glow::TIME_ELAPSED { "GL_TIME_ELAPSED" } else { "GL_SAMPLES_PASSED" }
    }

    /// Ends what [`begin`](Self::begin) began.
    pub(super) fn end(&self) {
        let Some(glow) = self.gl.live() else { return };
        // SAFETY: the context is current while the handle lives.
        unsafe { glow.end_query(self.target) };
    }

    /// Takes the time at which the GPU has done all commands before this one. No query of another kind is
    /// disturbed.
    pub(super) fn stamp(&self) {
        let Some(glow) = self.gl.live() else { return };
        // SAFETY: the context is current while the handle lives, and the query is one of timestamps.
        unsafe { glow.query_counter(self.name, self.target) };
    }

    /// Whether the result has come; never waits.
    pub(super) fn has_result(&self) -> bool {
        self.get(glow::QUERY_RESULT_AVAILABLE) != 0
    }

    /// Waits for the result; 0 if the context is lost, which [`Gl::check`] reports.
    pub(super) fn result(&self) -> u64 {
        self.get(glow::QUERY_RESULT)
    }

    fn get(&self, parameter: u32) -> u64 {
        let Some(glow) = self.gl.live() else { return 0 };
        let mut result = 0_u64;
        let address = (&raw mut result).expose_provenance();
        // SAFETY: no query buffer is bound, so the "offset" is the address of the result. (glow's plain
        // reader of u64 needs a 4.5 command.)
        unsafe {
            // A host's context may be newer than 3.3 and hold one.
            let query_buffer = self.gl.has_query_buffers().then(|| {
                let bound = glow.get_parameter_buffer(glow::QUERY_BUFFER_BINDING);
                glow.bind_buffer(glow::QUERY_BUFFER, None);
                bound
            });
            glow.get_query_parameter_u64_with_offset(self.name, parameter, address);
            if let Some(bound) = query_buffer {
                glow.bind_buffer(glow::QUERY_BUFFER, bound);
            }
        }
        result
    }
}

impl Drop for Query {
    fn drop(&mut self) {
        let Some(glow) = self.gl.live() else { return };
        // SAFETY: the context is current while the handle lives, and the name is ours.
        unsafe { glow.delete_query(self.name) };
    }
}
