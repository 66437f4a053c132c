//! What a host, a file or a driver can cause.

use std::path::PathBuf;

use glam::UVec2;

/// The library's result.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Everything that can go wrong through no fault of this library.
///
/// A message says what happened and where; a line that starts with `help:` says what to do. Bugs of the
/// library are panics, not errors.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file that can't be read, written or taken as what it claims to be.
    #[error("{}: {problem}\nhelp: {remedy}", path.display())]
    File {
        /// The file, as the caller named it.
        path: PathBuf,
        /// What is wrong with it, and where inside it.
        problem: String,
        /// What the caller can do about it.
        remedy: String,
    },

    /// A scene that sends no light.
    #[error(
        "no light of the scene shines\nhelp: give it one, such as [lights.lamp] with quad and radiance, or a \
         material with emission"
    )]
    NoLight,

    /// A setting outside its range.
    #[error("{name} = {value} is not possible: {reason}")]
    Setting {
        /// The field's name, as in [`crate::settings`].
        name: &'static str,
        /// The value that was asked for.
        value: String,
        /// The range, and why it ends there.
        reason: String,
    },

    /// The answer could be wrong by rounding or wrapping, and inexact answers are not allowed.
    #[error("the result would not be exact: {reason}\nhelp: {remedy}")]
    Inexact {
        /// Which number exceeds which limit.
        reason: String,
        /// Settings that give an exact answer.
        remedy: String,
    },

    /// A map larger than the device's textures.
    #[error("a map of {} x {} is larger than this device's textures, at most {limit} a side", size.x, size.y)]
    TooLarge {
        /// The size that was asked for.
        size: UVec2,
        /// GL_MAX_TEXTURE_SIZE.
        limit: u32,
    },

    /// A texture or map that does not fit where it was given.
    #[error("{what}: expected {expected}, got {got}")]
    Mismatch {
        /// Which input.
        what: &'static str,
        /// What it has to be; GL enums by name.
        expected: String,
        /// What it is; GL enums by name.
        got: String,
    },

    /// The context is older than OpenGL 3.3 core.
    #[error(
        "this needs OpenGL 3.3 core, but the context is \"{version}\" on \"{renderer}\"\n\
         help: ask for 3.3 core where the context is made, update the driver, or take another device"
    )]
    Version {
        /// GL_VERSION.
        version: String,
        /// GL_RENDERER.
        renderer: String,
    },

    /// A shader that the driver refused.
    #[error("the driver refused the shader of pass \"{label}\":\n{log}\n{source_text}")]
    Shader {
        /// The pass's label.
        label: String,
        /// The driver's words.
        log: String,
        /// The source with line numbers and file names.
        source_text: String,
    },

    /// A pass set or read a name that its program lacks.
    #[error("pass \"{label}\" has no uniform \"{name}\"; it has: {known}")]
    UnknownUniform {
        /// The pass's label.
        label: String,
        /// The name that was set.
        name: String,
        /// The names that the program has.
        known: String,
    },

    /// OpenGL reported an error.
    #[error("OpenGL answered {code} to {what}")]
    Gl {
        /// The name of the GL enum.
        code: String,
        /// What was asked of it.
        what: String,
    },

    /// A call that counts or times by a query of its own, while one of that kind is running, which goes on
    /// undisturbed.
    #[error(
        "a {kind} query is running, and OpenGL has one at a time\n\
         help: end it before gl::Timer (GL_TIME_ELAPSED) or a certificate (GL_SAMPLES_PASSED), \
         or leave those out"
    )]
    QueryRunning {
        /// The name of the GL enum.
        kind: &'static str,
    },

    /// A state of the host's context under which no call can work, and that cannot be put back; nothing was
    /// drawn or changed.
    #[error("{state}\nhelp: {remedy}")]
    HostState {
        /// Which, and what it would do.
        state: &'static str,
        /// What the host can do about it.
        remedy: &'static str,
    },

    /// GL_OUT_OF_MEMORY. What the call had made is freed, and what was there before is as it was.
    #[error(
        "OpenGL has no memory left for {what}{}; this library holds {held} bytes in this context\n\
         help: ask for a smaller map, choose a method that holds less (`memory_required` says how much), or \
         drop pipelines and maps that are no longer used",
        bytes.map_or(String::new(), |bytes| format!(": {bytes} bytes"))
    )]
    OutOfMemory {
        /// What was asked of it.
        what: String,
        /// How many bytes were asked for, where that is known.
        bytes: Option<u64>,
        /// Bytes of the textures and buffers that this library holds in the context.
        held: u64,
    },

    /// The driver lost the context, as after a reset of the GPU, or the host gave it up
    /// ([`Gl::abandon`](crate::Gl::abandon)). All objects in it are gone.
    #[error(
        "the OpenGL context is lost, and with it all maps and pipelines made in it\n\
         help: make a new context, load it anew (`Gl::from_loader`), and make everything again"
    )]
    ContextLost,

    /// A loader that does not find all of OpenGL 3.3 core, in a context of that version.
    #[error(
        "the loader does not find {command}, which OpenGL 3.3 core has\n\
         help: pass on what your window library or platform finds, such as eglGetProcAddress, for every name"
    )]
    MissingCommand {
        /// The command's name.
        command: String,
    },

    /// Another context is current on this thread, or none, where the loader can tell: it has
    /// eglGetCurrentContext or its like. Nothing was called.
    #[error(
        "the OpenGL context that this was made in is not current on this thread\n\
         help: make it current around each call and around drops; if it is gone, say so before (`Gl::abandon`, \
         varikernel_context_abandon)"
    )]
    WrongContext,

    /// No context could be made on any device that was tried.
    #[error("{reason}\nhelp: {remedy}")]
    NoContext {
        /// What was tried, and what came of it.
        reason: String,
        /// What the caller can do about it.
        remedy: String,
    },
}

impl Error {
    /// What has one size, where another is needed.
    pub(crate) fn size(what: &'static str, expected: UVec2, got: UVec2) -> Self {
        let in_words = |size: UVec2| format!("{} x {}", size.x, size.y);
        Self::Mismatch { what, expected: in_words(expected), got: in_words(got) }
    }

    /// No context is current where one has to be.
    pub(crate) fn no_current_context(reason: &str) -> Self {
        let remedy = "make the context current on this thread first, and give its own loader";
        Self::NoContext { reason: reason.to_owned(), remedy: remedy.to_owned() }
    }

    /// A file error; see [`Error::File`].
    #[cfg(feature = "files")]
    #[must_use]
    pub fn file(path: impl Into<PathBuf>, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::File { path: path.into(), problem: problem.into(), remedy: remedy.into() }
    }
}
