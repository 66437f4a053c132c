//! Which context is current, by the platform's own name for it.

use std::ffi::{CStr, c_void};

use super::loader::command;

type GetCurrentContext = unsafe extern "system" fn() -> *const c_void;

/// The context that the commands are of, as its platform names it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Home {
    get_current_context: GetCurrentContext,
    context: *const c_void,
}

impl Home {
    /// Of the context that is current, where the loader knows its platform.
    pub(super) fn of(loader: &mut impl FnMut(&CStr) -> *const c_void) -> Option<Self> {
        // Some loaders make up a command for every name, as GLX's does, or for those that begin with "gl".
        let is_of_glx = !loader(c"eglGetNoContextAtAll").is_null();
        let makes_up_gl = !is_of_glx && !loader(c"glXGetNoContextAtAll").is_null();
        let platforms: [(&CStr, bool); 5] = [
            (c"eglGetCurrentContext", !is_of_glx),
            (c"OSMesaGetCurrentContext", !is_of_glx),
            (c"wglGetCurrentContext", !is_of_glx),
            (c"CGLGetCurrentContext", !is_of_glx),
            (c"glXGetCurrentContext", !makes_up_gl),
        ];
        platforms.into_iter().filter(|&(_, is_known)| is_known).find_map(|(name, _)| {
            let get_current_context = command!(loader, name, GetCurrentContext)?;
            // SAFETY: the command takes nothing, and may be called at any time.
            let context = unsafe { get_current_context() };
            // Another platform's context is none of this one.
            (!context.is_null()).then_some(Self { get_current_context, context })
        })
    }

    /// Whether it is current on this thread.
    pub(super) fn is_current(self) -> bool {
        // SAFETY: the command takes nothing, and may be called at any time.
        unsafe { (self.get_current_context)() == self.context }
    }
}
