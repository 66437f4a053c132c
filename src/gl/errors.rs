//! OpenGL's errors as the library's, and whether the context is still there.
//!
//! A handle whose context is lost stays lost. All code in this folder calls OpenGL through [`Gl::current`] or
//! [`Gl::live`], so that nothing is called from then on, not even to delete.

use glow::HasContext as _;

use super::Gl;
use crate::error::{Error, Result};

impl Gl {
    /// Gives the context up, which the host is about to destroy, or has destroyed: from now on nothing that
    /// was made from this handle or its clones calls OpenGL. Drops delete nothing (the objects went with
    /// their context), and every other call answers [`Error::ContextLost`].
    ///
    /// Objects that are dropped while their context is current do not need this. Those dropped later do:
    /// OpenGL commands without a current context do nothing on Mesa, may crash elsewhere, and while another
    /// context is current they would delete that one's objects of the same names.
    ///
    /// The library calls it when the driver reports GL_CONTEXT_LOST.
    pub fn abandon(&self) {
        self.inner.lost.set(true);
    }

    /// Whether the context is lost, or was given up by [`abandon`](Self::abandon).
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.inner.lost.get()
    }

    /// Whether the context of this handle is current on this thread; true where the loader cannot tell: it has
    /// to know eglGetCurrentContext, glXGetCurrentContext or their like. Otherwise calls answer
    /// [`Error::WrongContext`], and drops delete nothing.
    #[must_use]
    pub fn is_current(&self) -> bool {
        self.inner.commands.is_at_home()
    }

    /// The context, to be called.
    ///
    /// # Errors
    /// [`Error::ContextLost`], [`Error::WrongContext`].
    pub(crate) fn current(&self) -> Result<&glow::Context> {
        if self.is_lost() {
            return Err(Error::ContextLost);
        }
        self.live().ok_or(Error::WrongContext)
    }

    /// The context, if it is there and current: for drops, and for commands whose failure a later
    /// [`check`](Self::check) reports. Under another context names mean other things.
    pub(super) fn live(&self) -> Option<&glow::Context> {
        (!self.is_lost() && self.is_current()).then_some(&*self.inner.glow)
    }

    /// The oldest pending GL error as our error, if there is one.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], [`Error::ContextLost`], or [`Error::Gl`] with the enum's name.
    pub(crate) fn check(&self, what: &str) -> Result<()> {
        self.check_allocation(what, None)
    }

    /// As [`check`](Self::check), after `bytes` of memory were asked for.
    pub(super) fn check_allocation(&self, what: &str, bytes: Option<u64>) -> Result<()> {
        // SAFETY: the context is current while the handle lives and is not lost.
        match unsafe { self.current()?.get_error() } {
            glow::NO_ERROR => Ok(()),
            code => {
                self.forget_errors();
                Err(self.error(code, what, bytes))
            }
        }
    }

    /// glow returned no name: the GL error says why.
    pub(crate) fn failure(&self, what: &str) -> Error {
        // SAFETY: the context is current where an object was just asked for.
        let code = self.live().map_or(glow::CONTEXT_LOST, |glow| unsafe { glow.get_error() });
        self.error(code, what, None)
    }

    /// What glGetError answered.
    pub(super) fn error(&self, code: u32, what: &str, bytes: Option<u64>) -> Error {
        match code {
            _ if self.is_lost() => Error::ContextLost,
            glow::CONTEXT_LOST => {
                self.abandon();
                Error::ContextLost
            }
            glow::OUT_OF_MEMORY => {
                // What was requested is already counted, and about to be dropped.
                let held = self.texture_bytes() + self.buffer_bytes() - bytes.unwrap_or(0);
                Error::OutOfMemory { what: what.to_owned(), bytes, held }
            }
            _ => Error::Gl { code: error_name(code), what: what.to_owned() },
        }
    }

    /// Clears errors of earlier calls, the host's for instance, so that they are not attributed to the call
    /// that follows.
    pub(crate) fn forget_errors(&self) {
        // A lost context returns an error at each call; so may one that is broken otherwise.
        for _ in 0..16 {
            let Some(glow) = self.live() else { return };
            // SAFETY: the context is current while the handle lives and is not lost.
            match unsafe { glow.get_error() } {
                glow::NO_ERROR => return,
                glow::CONTEXT_LOST => self.abandon(),
                code => tracing::warn!(code = error_name(code), "an OpenGL error was already pending"),
            }
        }
    }
}

/// The name of a glGetError code.
pub(super) fn error_name(code: u32) -> String {
    match code {
        glow::INVALID_ENUM => "GL_INVALID_ENUM".to_owned(),
        glow::INVALID_VALUE => "GL_INVALID_VALUE".to_owned(),
        glow::INVALID_OPERATION => "GL_INVALID_OPERATION".to_owned(),
        glow::INVALID_FRAMEBUFFER_OPERATION => "GL_INVALID_FRAMEBUFFER_OPERATION".to_owned(),
        glow::OUT_OF_MEMORY => "GL_OUT_OF_MEMORY".to_owned(),
        glow::CONTEXT_LOST => "GL_CONTEXT_LOST".to_owned(),
        _ => format!("{code:#06x}"),
    }
}

/// As [`Gl::failure`], while there is no handle yet.
pub(super) fn gl_error(glow: &glow::Context, what: &str) -> Error {
    // SAFETY: the context is current where an object was just asked for.
    let code = unsafe { glow.get_error() };
    Error::Gl { code: error_name(code), what: what.to_owned() }
}
