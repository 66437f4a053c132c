//! The only code that calls OpenGL: programs, textures, passes, timers, saved state.
//!
//! Nothing here depends on photons. Every object deletes its GL name when dropped, and every object holds a
//! [`Gl`], so a context that the library opened itself outlives all that was made in it.

#![expect(
    unsafe_code,
    reason = "OpenGL is a C interface; rule 8 of CONTRIBUTING.md confines it to this module"
)]

mod commands;
mod device_info;
mod errors;
mod fragment_test;
mod home;
mod interface;
mod label;
mod loader;
mod pass;
mod preprocessor;
mod program;
mod query;
mod readback;
mod shader_source;
mod shape;
mod stage_times;
mod state;
mod targets;
#[doc = include_str!("state_contract.md")]
pub mod state_contract {}
mod texture;
mod texture_format;
mod timer;
mod vertices;

pub use device_info::DeviceInfo;
pub(crate) use fragment_test::{FragmentTest, fill_where};
pub use interface::{Interface, ShaderStage, Variable};
pub(crate) use pass::{Pass, Target};
pub(crate) use program::Program;
pub(crate) use query::Query;
pub(crate) use readback::Readback;
pub use shader_source::ShaderSource;
pub(crate) use shader_source::glsl;
pub(crate) use shape::{TargetShape, TextureShape, bytes_of};
pub use stage_times::StageTimes;
pub(crate) use state::StateGuard;
pub use state::StatePolicy;
pub(crate) use targets::Targets;
pub(crate) use texture::Texture;
pub use texture_format::TextureFormat;
pub use timer::{Sample, Timer, time};
pub(crate) use vertices::Vertices;

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::ffi::{CStr, c_void};
use std::fmt;
use std::rc::{Rc, Weak};
use std::sync::Arc;

use glow::HasContext as _;

use crate::error::{Error, Result};
use commands::{Commands, Extent};
use errors::{error_name, gl_error};

/// A handle to a current OpenGL 3.3 core context; cheap to clone, tied to its thread.
#[derive(Clone)]
pub struct Gl {
    inner: Rc<Inner>,
    state_policy: StatePolicy,
}

struct Inner {
    glow: Arc<glow::Context>,
    commands: Commands,
    extent: Extent,
    info: DeviceInfo,
    /// What conditional rendering is asked about with, once it was begun and ended.
    ended_query: Cell<Option<glow::Query>>,
    /// Debug groups that may still be pushed.
    groups_left: Cell<u32>,
    vertex_array: glow::VertexArray,
    nearest: glow::Sampler,
    nearest_mipmap: glow::Sampler,
    /// What all textures of ours hold together.
    texture_bytes: Cell<u64>,
    /// Calls of the library that are in progress, nested.
    state_guards: Cell<u32>,
    /// What all buffers of ours hold together.
    buffer_bytes: Cell<u64>,
    /// Whether the context is lost, so that nothing may be called any more.
    lost: Cell<bool>,
    /// What times the passes, while a frame of it is recorded.
    stage_times: RefCell<Weak<RefCell<stage_times::Recorder>>>,
    /// The context itself, when the library opened it. Last, so that it is dropped last.
    _context: Option<Box<dyn Any>>,
}

impl Gl {
    /// Loads the commands of the current context through `loader`.
    ///
    /// No extension is needed. KHR_debug is used to name passes and objects when it is there.
    ///
    /// # Errors
    /// [`Error::NoContext`] when no context is current, [`Error::Version`] when it is older than 3.3,
    /// [`Error::MissingCommand`] where the loader does not find a command that the library calls.
    ///
    /// # Safety
    /// `loader` returns the address of the named command in the context that is current on this thread, or
    /// null, and that context is current on this thread whenever the handle, its clones, or anything made
    /// from them is used or dropped, until [`Gl::abandon`] was called.
    pub unsafe fn from_loader(loader: impl FnMut(&CStr) -> *const c_void) -> Result<Self> {
        // SAFETY: guaranteed by the caller.
        unsafe { Self::load(loader, None) }
    }

    unsafe fn load(
        mut loader: impl FnMut(&CStr) -> *const c_void,
        context: Option<Box<dyn Any>>,
    ) -> Result<Self> {
        loader::check(&mut loader)?;
        let commands = Commands::load(&mut loader);
        // SAFETY: the caller guarantees for the loader; a current context was just seen.
        let glow = unsafe { glow::Context::from_loader_function_cstr(loader) };
        // SAFETY: guaranteed by the caller.
        unsafe { Self::new(Arc::new(glow), commands, context) }
    }

    /// Uses a context that the host has already wrapped in glow 0.17.
    ///
    /// glow lacks commands that read the colour mask of one draw buffer, and the state of one viewport, so with
    /// this constructor the mask of draw buffer 0 is put back on all of them, as are the first viewport, depth
    /// range and scissor test; conditional rendering and another context are not noticed. [`Gl::from_loader`]
    /// puts back each.
    ///
    /// # Errors
    /// [`Error::Version`] when the context is older than 3.3.
    ///
    /// # Safety
    /// The context behind `glow` is current on this thread whenever the handle, its clones, or anything made
    /// from them is used or dropped, until [`Gl::abandon`] was called.
    pub unsafe fn from_glow(glow: Arc<glow::Context>) -> Result<Self> {
        // SAFETY: guaranteed by the caller.
        unsafe { Self::new(glow, Commands::of_glow(), None) }
    }

    /// As [`Gl::from_loader`], and keeps `context` alive as long as anything made from the handle.
    ///
    /// # Safety
    /// As [`Gl::from_loader`].
    #[cfg(any(feature = "egl", feature = "osmesa", feature = "window"))]
    pub(crate) unsafe fn from_owned_context(
        context: Box<dyn Any>,
        loader: impl FnMut(&CStr) -> *const c_void,
    ) -> Result<Self> {
        // SAFETY: guaranteed by the caller.
        unsafe { Self::load(loader, Some(context)) }
    }

    unsafe fn new(
        glow: Arc<glow::Context>,
        commands: Commands,
        context: Option<Box<dyn Any>>,
    ) -> Result<Self> {
        let info = DeviceInfo::of(&glow);
        let version = glow.version();
        if version.is_embedded || (version.major, version.minor) < (3, 3) {
            return Err(Error::Version { version: info.version, renderer: info.renderer });
        }
        let commands = commands.of_context(&glow);
        let extent = Extent::of(&glow, &commands);
        // SAFETY: the context is current, as the caller guarantees; creating objects changes no binding.
        let (vertex_array, nearest, nearest_mipmap) = unsafe {
            (
                glow.create_vertex_array().map_err(|what| gl_error(&glow, &what))?,
                sampler(&glow, glow::NEAREST)?,
                sampler(&glow, glow::NEAREST_MIPMAP_NEAREST)?,
            )
        };
        tracing::debug!(renderer = info.renderer, version = info.version, "OpenGL context taken");
        let inner = Inner {
            glow,
            commands,
            extent,
            info,
            ended_query: Cell::new(None),
            groups_left: Cell::new(u32::MAX),
            vertex_array,
            nearest,
            nearest_mipmap,
            texture_bytes: Cell::new(0),
            state_guards: Cell::new(0),
            buffer_bytes: Cell::new(0),
            lost: Cell::new(false),
            stage_times: RefCell::default(),
            _context: context,
        };
        let gl = Self { inner: Rc::new(inner), state_policy: StatePolicy::Restore };
        gl.label_own_objects();
        state::prepare(&gl)?;
        Ok(gl)
    }

    /// Another handle to the same context, whose calls, and those of all that is made from it, treat the
    /// host's state by `policy`. A host may use both side by side.
    #[must_use]
    pub fn with_state_policy(&self, policy: StatePolicy) -> Self {
        Self { state_policy: policy, ..self.clone() }
    }

    /// How this handle treats the host's state; [`StatePolicy::Restore`] unless it was made otherwise.
    #[must_use]
    pub fn state_policy(&self) -> StatePolicy {
        self.state_policy
    }

    /// What the context reports about itself.
    #[must_use]
    pub fn info(&self) -> &DeviceInfo {
        &self.inner.info
    }

    /// The glow context, for a host's own calls beside the library's; not to be called once it is
    /// [lost](Self::is_lost).
    #[must_use]
    pub fn glow(&self) -> &glow::Context {
        &self.inner.glow
    }

    /// Bytes of all textures that the library has made in this context and not dropped: every level and
    /// layer, as large as its format says; a driver may add to it.
    #[must_use]
    pub fn texture_bytes(&self) -> u64 {
        self.inner.texture_bytes.get()
    }

    /// Bytes of all buffers that the library has made in this context and not dropped: vertices, and texels
    /// on their way back.
    #[must_use]
    pub fn buffer_bytes(&self) -> u64 {
        self.inner.buffer_bytes.get()
    }

    fn vertex_array(&self) -> glow::VertexArray {
        self.inner.vertex_array
    }

    /// The sampler under which every level of a texture of `levels` levels is complete.
    fn sampler(&self, levels: u32) -> glow::Sampler {
        if levels > 1 { self.inner.nearest_mipmap } else { self.inner.nearest }
    }

    /// Whether a buffer can be bound that takes the results of queries: OpenGL 4.4.
    fn has_query_buffers(&self) -> bool {
        let version = self.glow().version();
        (version.major, version.minor) >= (4, 4)
    }

    /// Waits until the GPU has done what it was asked for.
    ///
    /// # Errors
    /// As [`current`](Self::current).
    pub(crate) fn finish(&self) -> Result<()> {
        // SAFETY: the context is current.
        unsafe { self.current()?.finish() };
        Ok(())
    }

    /// As [`labelled`](Self::labelled), and timed if a [`StageTimes`] is recording.
    fn timed<T>(&self, label: &str, work: impl FnOnce() -> T) -> T {
        let recorder = self.inner.stage_times.borrow().upgrade();
        let Some(recorder) = recorder else { return self.labelled(label, work) };
        recorder.borrow_mut().begin(self, label);
        let result = self.labelled(label, work);
        recorder.borrow_mut().end(self);
        result
    }
}

impl fmt::Debug for Gl {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_tuple("Gl").field(&self.inner.info.renderer).finish()
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        if self.lost.get() || !self.commands.is_at_home() {
            return;
        }
        // SAFETY: the context is current while the handle lives, and the names are ours.
        unsafe {
            if let Some(query) = self.ended_query.get() {
                self.glow.delete_query(query);
            }
            self.glow.delete_vertex_array(self.vertex_array);
            self.glow.delete_sampler(self.nearest);
            self.glow.delete_sampler(self.nearest_mipmap);
        }
    }
}

unsafe fn sampler(glow: &glow::Context, minification: u32) -> Result<glow::Sampler> {
    // SAFETY: the context is current, as the caller guarantees.
    unsafe {
        let sampler = glow.create_sampler().map_err(|what| gl_error(glow, &what))?;
        for (parameter, value) in [
            (glow::TEXTURE_MIN_FILTER, minification),
            (glow::TEXTURE_MAG_FILTER, glow::NEAREST),
            (glow::TEXTURE_WRAP_S, glow::CLAMP_TO_EDGE),
            (glow::TEXTURE_WRAP_T, glow::CLAMP_TO_EDGE),
        ] {
            glow.sampler_parameter_i32(sampler, parameter, value.cast_signed());
        }
        Ok(sampler)
    }
}
