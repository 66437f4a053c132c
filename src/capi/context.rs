//! The host's OpenGL context, taken through a loader.

use std::ffi::{CStr, c_char, c_void};
use std::thread::{self, ThreadId};

use super::{Failure, Status, answer, check_place, given, out_of_range};
use crate::error::Error;
use crate::gl::{Gl, StatePolicy};

/// Finds an OpenGL command by name in the context that is current: eglGetProcAddress, glfwGetProcAddress,
/// SDL_GL_GetProcAddress, wglGetProcAddress with its fallback. Null where there is no such command. `user` is
/// passed on.
///
/// It must not throw, and is called by varikernel_context_create alone.
pub type Loader = Option<unsafe extern "C" fn(name: *const c_char, user: *mut c_void) -> *mut c_void>;

/// state_policy: each call asks the driver for what it touches, and puts it back. Fits any host.
pub const VARIKERNEL_STATE_RESTORE: u32 = 0;

/// state_policy: the host guarantees for OpenGL's defaults when a call starts, and finds them afterwards, but
/// for the viewport. Faster: 90 to 165 questions less a call.
pub const VARIKERNEL_STATE_DEFAULTS: u32 = 1;

/// An OpenGL context of the host: its commands, and what pipelines share.
pub struct Context(pub(super) Home);

type GetString = unsafe extern "system" fn(name: u32) -> *const u8;

/// Where a handle may be used.
#[derive(Clone)]
pub(super) struct Home {
    thread: ThreadId,
    get_string: GetString,
    gl: Gl,
}

impl Home {
    /// OpenGL, if this is the thread, and the context is there.
    pub(super) fn gl(&self) -> Result<&Gl, Failure> {
        self.check_thread()?;
        if self.gl.is_lost() {
            return Err(Error::ContextLost.into());
        }
        self.check_current()?;
        Ok(&self.gl)
    }

    /// Whether what belongs here can be freed: with OpenGL, or without it after the context has gone.
    pub(super) fn check_drop(&self) -> Result<(), Failure> {
        self.check_thread()?;
        if self.gl.is_lost() { Ok(()) } else { self.check_current() }
    }

    fn check_current(&self) -> Result<(), Failure> {
        check_current(self.get_string)?;
        if self.gl.is_current() { Ok(()) } else { Err(Error::WrongContext.into()) }
    }

    fn abandon(&self) -> Result<(), Failure> {
        self.check_thread()?;
        self.gl.abandon();
        Ok(())
    }

    fn check_thread(&self) -> Result<(), Failure> {
        if thread::current().id() == self.thread {
            return Ok(());
        }
        let text = "the handle belongs to the thread that made it, and this is another";
        Err(Failure::new(Status::WrongThread, text))
    }
}

/// Frees what a pointer of C owns, on its thread, with its context or after that has gone; null is fine.
///
/// # Safety
/// `pointer` is null, or came from a box and was not destroyed.
pub(super) unsafe fn destroy<T>(pointer: *mut T, home: impl FnOnce(&T) -> &Home) -> Status {
    answer(|| {
        // SAFETY: guaranteed by the caller.
        let Some(value) = (unsafe { pointer.as_ref() }) else {
            return Ok(());
        };
        home(value).check_drop()?;
        // SAFETY: guaranteed by the caller.
        drop(unsafe { Box::from_raw(pointer) });
        Ok(())
    })
}

fn check_current(get_string: GetString) -> Result<(), Failure> {
    // SAFETY: glGetString takes any value; without a context it returns null.
    if unsafe { get_string(glow::VERSION) }.is_null() {
        let text = "no OpenGL context is current on this thread\nhelp: make the one current that the \
                    handle was made in";
        return Err(Failure::new(Status::NoContext, text));
    }
    Ok(())
}

/// Takes the OpenGL context that is current on this thread, 3.3 core or newer; no extension is needed.
///
/// `*context` is the host's to destroy. `user` may be null and is not used later. `state_policy` is one of
/// VARIKERNEL_STATE_... and holds for all that is made of the handle; handles of both kinds may be used side
/// by side.
///
/// Fails with NO_CONTEXT, VERSION, SETTING, INVALID_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_context_create(
    loader: Loader,
    user: *mut c_void,
    state_policy: u32,
    context: *mut *mut Context,
) -> Status {
    answer(|| {
        check_place(context, "context")?;
        let policy = match state_policy {
            VARIKERNEL_STATE_RESTORE => StatePolicy::Restore,
            VARIKERNEL_STATE_DEFAULTS => StatePolicy::Defaults,
            other => return Err(out_of_range("state_policy", other, "it is one of VARIKERNEL_STATE_...")),
        };
        let loader = loader.ok_or_else(|| super::null("loader"))?;
        // SAFETY: the host's loader takes a name and what the host gave with it.
        let load = |name: &CStr| unsafe { loader(name.as_ptr(), user) }.cast_const();
        let get_string = load(c"glGetString");
        if get_string.is_null() {
            return Err(Error::no_current_context("the loader does not know glGetString").into());
        }
        // SAFETY: the host guarantees that this is the address of glGetString, which has this type.
        let get_string = unsafe { std::mem::transmute::<*const c_void, GetString>(get_string) };
        check_current(get_string)?;
        // SAFETY: a context is current, and `Home::gl` asks before each use whether one is.
        let gl = unsafe { Gl::from_loader(load) }?.with_state_policy(policy);
        let home = Home { thread: thread::current().id(), get_string, gl };
        // SAFETY: the host gives a pointer to write to.
        unsafe { context.write(Box::into_raw(Box::new(Context(home)))) };
        Ok(())
    })
}

/// Tells the bytes of textures and buffers that the library holds by this handle and all that was made of it.
///
/// Fails with WRONG_THREAD, NO_CONTEXT, CONTEXT_LOST, INVALID_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_memory_held(context: *const Context, bytes: *mut u64) -> Status {
    answer(|| {
        check_place(bytes, "bytes")?;
        // SAFETY: the host gives a handle that was not destroyed, or null.
        let gl = unsafe { given(context, "context") }?.0.gl()?;
        // SAFETY: the host gives a pointer to write to.
        unsafe { bytes.write(gl.texture_bytes() + gl.buffer_bytes()) };
        Ok(())
    })
}

/// Says that the OpenGL context has gone, or is about to: nothing made of this handle calls OpenGL from now
/// on. Destroying then frees memory alone, and all other calls answer CONTEXT_LOST.
///
/// Fails with WRONG_THREAD, INVALID_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_context_abandon(context: *const Context) -> Status {
    answer(|| {
        // SAFETY: the host gives a handle that was not destroyed, or null.
        unsafe { given(context, "context") }?.0.abandon()
    })
}

/// Frees a context; null is fine. Pipelines made in it stay usable: the last of them frees what they share.
///
/// Fails with WRONG_THREAD and NO_CONTEXT, and frees nothing then; see varikernel_context_abandon.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_context_destroy(context: *mut Context) -> Status {
    // SAFETY: the host gives a handle that `varikernel_context_create` made and that was not destroyed, or
    // null.
    unsafe { destroy(context, |context| &context.0) }
}
