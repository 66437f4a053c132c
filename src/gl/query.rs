//! Queries: what OpenGL counts or times between a begin and an end.

use glow::HasContext as _;

use super::{Gl, error_name, gl_error};
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
    /// [`Error::Gl`] when memory runs out.
    pub(crate) fn of_fragments(gl: &Gl) -> Result<Self> {
        Self::new(gl, glow::SAMPLES_PASSED)
    }

    /// Nanoseconds: those of GL_TIME_ELAPSED.
    ///
    /// # Errors
    /// [`Error::Gl`] when memory runs out.
    pub(super) fn of_time(gl: &Gl) -> Result<Self> {
        Self::new(gl, glow::TIME_ELAPSED)
    }

    fn new(gl: &Gl, target: u32) -> Result<Self> {
        // SAFETY: the context is current while the handle lives.
        let name = unsafe { gl.glow().create_query() }.map_err(|what| gl_error(gl.glow(), &what))?;
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
        // SAFETY: the context is current while the handle lives.
        let code = unsafe {
            self.gl.glow().begin_query(self.target, self.name);
            self.gl.glow().get_error()
        };
        match code {
            glow::NO_ERROR => Ok(()),
            // The name is of this kind and not running, so that only another one can be in the way.
            glow::INVALID_OPERATION => Err(Error::QueryRunning { kind: self.kind() }),
            _ => {
                Err(Error::Gl { code: error_name(code), what: format!("beginning a {} query", self.kind()) })
            }
        }
    }

    /// The name of the GL enum.
    fn kind(&self) -> &'static str {
        if self.target == glow::TIME_ELAPSED { "GL_TIME_ELAPSED" } else { "GL_SAMPLES_PASSED" }
    }

    /// Ends what [`begin`](Self::begin) began.
    pub(super) fn end(&self) {
        // SAFETY: the context is current while the handle lives.
        unsafe { self.gl.glow().end_query(self.target) };
    }

    /// Waits for the result.
    pub(super) fn result(&self) -> u64 {
        let glow = self.gl.glow();
        let mut result = 0_u64;
        let address = (&raw mut result).expose_provenance();
        // SAFETY: no query buffer is bound, so the "offset" is the address of the result. (glow's plain reader of u64
        // wants a 4.5 command.)
        unsafe {
            // A host's context may be newer than 3.3 and hold one.
            let query_buffer = self.gl.has_query_buffers().then(|| {
                let bound = glow.get_parameter_buffer(glow::QUERY_BUFFER_BINDING);
                glow.bind_buffer(glow::QUERY_BUFFER, None);
                bound
            });
            glow.get_query_parameter_u64_with_offset(self.name, glow::QUERY_RESULT, address);
            if let Some(bound) = query_buffer {
                glow.bind_buffer(glow::QUERY_BUFFER, bound);
            }
        }
        result
    }
}

impl Drop for Query {
    fn drop(&mut self) {
        // SAFETY: the context is current while the handle lives, and the name is ours.
        unsafe { self.gl.glow().delete_query(self.name) };
    }
}
