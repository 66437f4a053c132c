//! How a call ended: a status for the program, a text for people.

use std::any::Any;
use std::cell::RefCell;
use std::ffi::{CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::error::Error;

/// How a call ended.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// All went well.
    Ok = 0,
    /// A pointer or texture name is null, or a struct has the size of another version.
    InvalidArgument = 1,
    /// The handle was made on another thread.
    WrongThread = 2,
    /// No OpenGL context is current on this thread.
    NoContext = 3,
    /// The context is older than OpenGL 3.3 core.
    Version = 4,
    /// A setting is outside its range; the text names it.
    Setting = 5,
    /// A map is larger than the device's textures.
    TooLarge = 6,
    /// A texture does not fit: another target, format or size; a mask that is not expected.
    Mismatch = 7,
    /// The radii could be wrong, since sums might wrap; nothing was drawn. The text says what would be exact.
    Inexact = 8,
    /// The driver refused a shader; the text has its log.
    Shader = 9,
    /// GL_OUT_OF_MEMORY; what was there before is as it was.
    OutOfMemory = 10,
    /// The driver lost the context, or the host gave it up: destroy the handles, and make all anew in a new
    /// context.
    ContextLost = 11,
    /// Another GL error; the text names it.
    OpenGl = 12,
    /// A mistake of the library, reported on stderr as well. A pipeline is of no more use then; destroy it.
    Internal = 13,
}

/// Why a call failed.
pub(super) struct Failure {
    status: Status,
    text: String,
}

impl Failure {
    pub(super) fn new(status: Status, text: impl Into<String>) -> Self {
        Self { status, text: text.into() }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let status = match &error {
            Error::Setting { .. } => Status::Setting,
            Error::Inexact { .. } => Status::Inexact,
            Error::TooLarge { .. } => Status::TooLarge,
            Error::Mismatch { .. } => Status::Mismatch,
            Error::Version { .. } => Status::Version,
            Error::Shader { .. } => Status::Shader,
            Error::OutOfMemory { .. } => Status::OutOfMemory,
            Error::ContextLost => Status::ContextLost,
            Error::Gl { .. } | Error::HostState { .. } => Status::OpenGl,
            Error::NoContext { .. } | Error::MissingCommand { .. } | Error::WrongContext => Status::NoContext,
            // Nothing here reads files, has scenes with lights, lets a caller name uniforms or needs a query.
            Error::File { .. }
            | Error::NoLight
            | Error::UnknownUniform { .. }
            | Error::QueryRunning { .. } => Status::Internal,
        };
        Self::new(status, error.to_string())
    }
}

thread_local! {
    /// The one thing that is not in a handle: a call that makes none has no handle to keep its text in.
    static LAST_ERROR: RefCell<CString> = RefCell::default();
}

/// What went wrong in the last call on this thread that failed: what, where, and what to do; "" if none did.
///
/// Never null, UTF-8, one or several lines. Valid until the next failing call on this thread.
#[unsafe(no_mangle)]
pub extern "C" fn varikernel_last_error() -> *const c_char {
    LAST_ERROR.try_with(|text| text.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

/// Runs what a call does, and turns how it ended into a status and a text. No panic gets through.
pub(super) fn answer(work: impl FnOnce() -> Result<(), Failure>) -> Status {
    // What a panic may leave half done is a pipeline, which is gone then: see `Pipeline::with`.
    let ended = catch_unwind(AssertUnwindSafe(work));
    let failure = match ended {
        Ok(Ok(())) => return Status::Ok,
        Ok(Err(failure)) => failure,
        Err(payload) => Failure::new(Status::Internal, format!("internal error: {}", panic_text(&*payload))),
    };
    // A driver's log may hold a zero byte, where C would stop reading.
    let text = CString::new(failure.text.replace('\0', " ")).unwrap_or_default();
    // While the thread ends, there is nobody left to read it.
    let _ = LAST_ERROR.try_with(|last| *last.borrow_mut() = text);
    failure.status
}

fn panic_text(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("a panic without words")
}
