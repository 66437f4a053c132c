//! A loader of commands, before anything is loaded: whether a context is current, and what it may not lack.

use std::ffi::{CStr, c_void};

use crate::error::{Error, Result};

/// The command of that name, as a pointer to a function of the given type.
macro_rules! command {
    ($loader:ident, $name:expr, $type:ty) => {{
        let address = $loader($name);
        // SAFETY: the caller of `Gl::from_loader` guarantees that this is the address of the command, which has
        // this type.
        (!address.is_null()).then(|| unsafe { std::mem::transmute::<*const c_void, $type>(address) })
    }};
}
pub(super) use command;

/// Whether a context is current, and a loader finds in it all that is called.
///
/// # Errors
/// [`Error::NoContext`], [`Error::MissingCommand`].
pub(super) fn check(loader: &mut impl FnMut(&CStr) -> *const c_void) -> Result<()> {
    // Of an older context, the version is what is wrong.
    if is_3_3(check_current(loader)?) {
        let missing = REQUIRED.into_iter().find(|command| loader(command).is_null());
        if let Some(command) = missing {
            return Err(Error::MissingCommand { command: command.to_string_lossy().into_owned() });
        }
    }
    Ok(())
}

/// Whether GL_VERSION begins with 3.3 or more.
fn is_3_3(version: &CStr) -> bool {
    let text = version.to_string_lossy();
    let number = text.split(' ').next().unwrap_or_default();
    let mut parts = number.split('.').map(|part| part.parse::<u32>().unwrap_or(0));
    (parts.next().unwrap_or(0), parts.next().unwrap_or(0)) >= (3, 3)
}

/// GL_VERSION. glow panics where no context is current; this returns an error instead.
fn check_current<'a>(loader: &mut impl FnMut(&CStr) -> *const c_void) -> Result<&'a CStr> {
    type GetString = unsafe extern "system" fn(name: u32) -> *const u8;
    let get_string = loader(c"glGetString");
    if get_string.is_null() {
        return Err(Error::no_current_context("the loader does not know glGetString"));
    }
    // SAFETY: the caller of `from_loader` guarantees that this is the address of glGetString.
    let get_string = unsafe { std::mem::transmute::<*const c_void, GetString>(get_string) };
    // SAFETY: glGetString takes any value; without a context it returns null.
    let version = unsafe { get_string(glow::VERSION) };
    if version.is_null() {
        return Err(Error::no_current_context("no OpenGL context is current on this thread"));
    }
    // SAFETY: it is a text that the driver keeps.
    Ok(unsafe { CStr::from_ptr(version.cast()) })
}

/// What a loader has to find: the commands of OpenGL 3.3 core that the library calls.
const REQUIRED: [&CStr; 100] = [
    c"glActiveTexture",
    c"glAttachShader",
    c"glBeginQuery",
    c"glBindBuffer",
    c"glBindFramebuffer",
    c"glBindSampler",
    c"glBindTexture",
    c"glBindVertexArray",
    c"glBlendEquation",
    c"glBlendEquationSeparate",
    c"glBlendFunc",
    c"glBlendFuncSeparate",
    c"glBufferData",
    c"glCheckFramebufferStatus",
    c"glClearBufferfv",
    c"glClearBufferuiv",
    c"glClientWaitSync",
    c"glColorMaski",
    c"glCompileShader",
    c"glCreateProgram",
    c"glCreateShader",
    c"glDeleteBuffers",
    c"glDeleteFramebuffers",
    c"glDeleteProgram",
    c"glDeleteQueries",
    c"glDeleteSamplers",
    c"glDeleteShader",
    c"glDeleteSync",
    c"glDeleteTextures",
    c"glDeleteVertexArrays",
    c"glDepthFunc",
    c"glDepthMask",
    c"glDepthRange",
    c"glDisable",
    c"glDisablei",
    c"glDrawArrays",
    c"glDrawArraysInstanced",
    c"glDrawBuffers",
    c"glEnable",
    c"glEnableVertexAttribArray",
    c"glEnablei",
    c"glEndQuery",
    c"glFenceSync",
    c"glFinish",
    c"glFramebufferTexture2D",
    c"glFramebufferTextureLayer",
    c"glGenBuffers",
    c"glGenFramebuffers",
    c"glGenQueries",
    c"glGenSamplers",
    c"glGenTextures",
    c"glGenVertexArrays",
    c"glGenerateMipmap",
    c"glGetActiveUniform",
    c"glGetBooleani_v",
    c"glGetBufferParameteriv",
    c"glGetBufferSubData",
    c"glGetDoublev",
    c"glGetError",
    c"glGetFloatv",
    c"glGetIntegeri_v",
    c"glGetIntegerv",
    c"glGetProgramInfoLog",
    c"glGetProgramiv",
    c"glGetQueryObjectui64v",
    c"glGetShaderInfoLog",
    c"glGetShaderiv",
    c"glGetStringi",
    c"glGetTexImage",
    c"glGetTexLevelParameteriv",
    c"glGetTexParameteriv",
    c"glGetUniformLocation",
    c"glIsBuffer",
    c"glIsEnabled",
    c"glIsEnabledi",
    c"glLinkProgram",
    c"glPixelStorei",
    c"glPolygonMode",
    c"glQueryCounter",
    c"glReadPixels",
    c"glSamplerParameteri",
    c"glShaderSource",
    c"glStencilFunc",
    c"glStencilFuncSeparate",
    c"glStencilOp",
    c"glStencilOpSeparate",
    c"glTexImage2D",
    c"glTexImage3D",
    c"glTexParameteri",
    c"glTexSubImage2D",
    c"glUniform1f",
    c"glUniform1i",
    c"glUniform1ui",
    c"glUniform2i",
    c"glUniform3f",
    c"glUniformMatrix4fv",
    c"glUseProgram",
    c"glVertexAttribDivisor",
    c"glVertexAttribPointer",
    c"glViewport",
];
