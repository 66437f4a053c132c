//! States of a host under which no call can work, and that cannot be saved and put back.

use glow::HasContext as _;

use crate::error::{Error, Result};
use crate::gl::Gl;

/// GL_LIST_INDEX, of compatibility contexts.
const LIST_INDEX: u32 = 0x0B33;

/// Transform feedback of the host that was paused.
#[derive(Debug)]
pub(super) struct Feedback(Gl);

impl Feedback {
    /// Goes on with it, once the host's program is current again.
    pub(super) fn resume(self) {
        let Some(glow) = self.0.live() else { return };
        // SAFETY: the context is current; it was paused by `none`, and the host's objects are bound again.
        unsafe { glow.resume_transform_feedback() };
    }
}

/// Looks for what would make a call fail, or change what the host has; pauses transform feedback.
///
/// # Errors
/// [`Error::HostState`], with nothing changed.
pub(super) fn none(gl: &Gl) -> Result<Option<Feedback>> {
    let glow = gl.current()?;
    // SAFETY: the context is current while the handle lives; lists exist in compatibility contexts.
    if gl.extent().is_compatible && unsafe { glow.get_parameter_i32(LIST_INDEX) } != 0 {
        return refuse("a display list is open, which would record the call", "call glEndList before");
    }
    // SAFETY: as above; what is current is a program.
    let is_deleted = unsafe {
        glow.get_parameter_program(glow::CURRENT_PROGRAM)
            .is_some_and(|program| glow.get_program_parameter_i32(program, glow::DELETE_STATUS) != 0)
    };
    if is_deleted {
        return refuse(
            "the current program is marked for deletion, and would be gone after the call",
            "call glUseProgram with another program, or 0, before",
        );
    }
    if is_rendering_conditionally(gl, glow)? {
        return refuse(
            "conditional rendering is on, which may drop what the call draws",
            "call glEndConditionalRender before",
        );
    }
    feedback(gl, glow)
}

/// OpenGL has no question for it, but allows no other to begin meanwhile. False where nothing tells.
fn is_rendering_conditionally(gl: &Gl, glow: &glow::Context) -> Result<bool> {
    let Some(commands) = gl.commands().conditional_render.filter(|_| gl.extent().tells_errors) else {
        return Ok(false);
    };
    let Some(query) = ended_query(gl, glow)? else { return Ok(false) };
    // SAFETY: the context is current, and has these commands; what begins ends at once.
    unsafe {
        (commands.begin)(query.0.get(), glow::QUERY_NO_WAIT);
        match glow.get_error() {
            glow::NO_ERROR => (commands.end)(),
            glow::INVALID_OPERATION => return Ok(true),
            // An error of something else, which is told here.
            other => {
                (commands.end)();
                return Err(gl.error(other, "what tells of conditional rendering", None));
            }
        }
    }
    Ok(false)
}

/// Makes what [`none`] asks with, where nothing of the host's is in the way yet.
///
/// # Errors
/// Those of OpenGL.
pub(in crate::gl) fn prepare(gl: &Gl) -> Result<()> {
    if gl.commands().conditional_render.is_some() && gl.extent().tells_errors {
        gl.forget_errors();
        ended_query(gl, gl.current()?)?;
    }
    Ok(())
}

/// A query with a result. None while one of the host's runs that is of its kind.
fn ended_query(gl: &Gl, glow: &glow::Context) -> Result<Option<glow::Query>> {
    let kept = &gl.inner.ended_query;
    if kept.get().is_some() {
        return Ok(kept.get());
    }
    // SAFETY: the context is current.
    unsafe {
        let query = glow.create_query().map_err(|what| gl.failure(&what))?;
        glow.begin_query(glow::ANY_SAMPLES_PASSED, query);
        let code = glow.get_error();
        if code == glow::INVALID_OPERATION {
            glow.delete_query(query);
            return Ok(None);
        }
        glow.end_query(glow::ANY_SAMPLES_PASSED);
        kept.set(Some(query));
        if code != glow::NO_ERROR {
            return Err(gl.error(code, "what tells of conditional rendering", None));
        }
    }
    Ok(kept.get())
}

fn feedback(gl: &Gl, glow: &glow::Context) -> Result<Option<Feedback>> {
    // SAFETY: the context is current, and of a version that has these states.
    unsafe {
        if gl.commands().pauses_feedback {
            let is_on = |parameter| glow.get_parameter_i32(parameter) != 0;
            if is_on(glow::TRANSFORM_FEEDBACK_ACTIVE) && !is_on(glow::TRANSFORM_FEEDBACK_PAUSED) {
                glow.pause_transform_feedback();
                return Ok(Some(Feedback(gl.clone())));
            }
            return Ok(None);
        }
        if !gl.extent().tells_errors {
            return Ok(None);
        }
        // OpenGL 3.3 does not tell, but allows no other program meanwhile.
        let program = glow.get_parameter_program(glow::CURRENT_PROGRAM);
        glow.use_program(None);
        match glow.get_error() {
            glow::NO_ERROR => glow.use_program(program),
            glow::INVALID_OPERATION => {
                return refuse(
                    "transform feedback is on, which would record what the call draws",
                    "call glEndTransformFeedback before",
                );
            }
            other => return Err(gl.error(other, "what tells of transform feedback", None)),
        }
    }
    Ok(None)
}

fn refuse<T>(state: &'static str, remedy: &'static str) -> Result<T> {
    Err(Error::HostState { state, remedy })
}
