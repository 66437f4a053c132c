//! The only code that talks to OpenGL: programs, textures, passes, timers, saved state.
//!
//! Nothing here knows about photons. Every object deletes its GL name when dropped, and every object
//! holds a [`Gl`], so a context that the library opened itself outlives all that was made in it.

#![expect(unsafe_code, reason = "OpenGL is a C interface; design rule 8 confines it to this module")]

mod device_info;
mod fragment_test;
mod geometry;
mod pass;
mod program;
mod query;
mod readback;
mod source;
mod state;
mod texture;
mod timer;

pub use device_info::DeviceInfo;
pub(crate) use fragment_test::{FragmentTest, fill_where};
pub(crate) use geometry::Vertices;
pub(crate) use pass::{Pass, Target};
pub(crate) use program::Program;
pub(crate) use query::Query;
pub(crate) use readback::Readback;
pub use source::ShaderSource;
pub(crate) use source::glsl;
pub(crate) use state::StateGuard;
pub(crate) use texture::Texture;
pub use texture::TextureFormat;
pub use timer::{Sample, Timer, time};

use std::any::Any;
use std::cell::Cell;
use std::ffi::{CStr, c_void};
use std::fmt;
use std::rc::Rc;
use std::sync::Arc;

use glow::HasContext as _;

use crate::error::{Error, Result};

/// A handle to a current OpenGL 3.3 core context; cheap to clone, tied to its thread.
#[derive(Clone)]
pub struct Gl {
    inner: Rc<Inner>,
}

struct Inner {
    glow: Arc<glow::Context>,
    get_booleani_v: Option<GetBooleaniV>,
    info: DeviceInfo,
    debug_groups: bool,
    vertex_array: glow::VertexArray,
    nearest: glow::Sampler,
    nearest_mipmap: glow::Sampler,
    /// What all textures of ours hold together.
    texture_bytes: Cell<u64>,
    /// The context itself, when the library opened it. Last, so that it is dropped last.
    _context: Option<Box<dyn Any>>,
}

type GetBooleaniV = unsafe extern "system" fn(target: u32, index: u32, data: *mut u8);

impl Gl {
    /// Loads the commands of the current context through `loader`.
    ///
    /// No extension is needed. KHR_debug is used for pass labels when it is there.
    ///
    /// # Errors
    /// [`Error::NoContext`] when no context is current, [`Error::Version`] when it is older than 3.3.
    ///
    /// # Safety
    /// `loader` returns the address of the named command in the context that is current on this thread, or
    /// null, and that context is current on this thread whenever the handle, its clones, or anything made
    /// from them is used or dropped.
    pub unsafe fn from_loader(loader: impl FnMut(&CStr) -> *const c_void) -> Result<Self> {
        // SAFETY: as the caller vouches.
        unsafe { Self::load(loader, None) }
    }

    unsafe fn load(
        mut loader: impl FnMut(&CStr) -> *const c_void,
        context: Option<Box<dyn Any>>,
    ) -> Result<Self> {
        check_current(&mut loader)?;
        let has_debug_groups = !loader(c"glPushDebugGroup").is_null();
        let get_booleani_v = loader(c"glGetBooleani_v");
        // SAFETY: the caller vouches for the loader; a current context was just seen.
        let glow = unsafe { glow::Context::from_loader_function_cstr(loader) };
        let get_booleani_v = (!get_booleani_v.is_null()).then(|| {
            // SAFETY: the caller vouches that this is the address of glGetBooleani_v, which has this type.
            unsafe { std::mem::transmute::<*const c_void, GetBooleaniV>(get_booleani_v) }
        });
        // SAFETY: as the caller vouches.
        unsafe { Self::new(Arc::new(glow), get_booleani_v, has_debug_groups, context) }
    }

    /// Uses a context that the host has already wrapped in glow 0.17.
    ///
    /// glow cannot read the colour mask of one draw buffer (`glColorMaski`), so through this door the mask of
    /// draw buffer 0 is put back on all; [`Gl::from_loader`] puts back each.
    ///
    /// # Errors
    /// [`Error::Version`] when the context is older than 3.3.
    ///
    /// # Safety
    /// The context behind `glow` is current on this thread whenever the handle, its clones, or anything made
    /// from them is used or dropped.
    pub unsafe fn from_glow(glow: Arc<glow::Context>) -> Result<Self> {
        // SAFETY: as the caller vouches.
        unsafe { Self::new(glow, None, true, None) }
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
        // SAFETY: as the caller vouches.
        unsafe { Self::load(loader, Some(context)) }
    }

    unsafe fn new(
        glow: Arc<glow::Context>,
        get_booleani_v: Option<GetBooleaniV>,
        has_debug_groups: bool,
        context: Option<Box<dyn Any>>,
    ) -> Result<Self> {
        let info = DeviceInfo::of(&glow);
        let version = glow.version();
        if version.is_embedded || (version.major, version.minor) < (3, 3) {
            return Err(Error::Version { version: info.version, renderer: info.renderer });
        }
        let debug_groups = has_debug_groups && glow.supports_debug();
        // SAFETY: the context is current, as the caller vouches; creating objects changes no binding.
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
            get_booleani_v,
            info,
            debug_groups,
            vertex_array,
            nearest,
            nearest_mipmap,
            texture_bytes: Cell::new(0),
            _context: context,
        };
        Ok(Self { inner: Rc::new(inner) })
    }

    /// What the context says of itself.
    #[must_use]
    pub fn info(&self) -> &DeviceInfo {
        &self.inner.info
    }

    /// The glow context, for a host's own calls beside the library's.
    #[must_use]
    pub fn glow(&self) -> &glow::Context {
        &self.inner.glow
    }

    /// Bytes of all textures that the library has made in this context and not dropped: every level and layer, as large as
    /// its format says; a driver may add to it.
    #[must_use]
    pub fn texture_bytes(&self) -> u64 {
        self.inner.texture_bytes.get()
    }

    fn vertex_array(&self) -> glow::VertexArray {
        self.inner.vertex_array
    }

    /// The sampler under which every level of a texture of `levels` levels is complete.
    fn sampler(&self, levels: u32) -> glow::Sampler {
        if levels > 1 { self.inner.nearest_mipmap } else { self.inner.nearest }
    }

    /// The colour mask of draw buffer `index`.
    fn color_mask(&self, index: u32) -> [bool; 4] {
        let mut mask = [0_u8; 4];
        match self.inner.get_booleani_v {
            // SAFETY: GL_COLOR_WRITEMASK has four values, and the mask has room for them.
            Some(get) => unsafe { get(glow::COLOR_WRITEMASK, index, mask.as_mut_ptr()) },
            // SAFETY: the context is current; the mask of buffer 0 has four values.
            None => return unsafe { self.glow().get_parameter_bool_array::<4>(glow::COLOR_WRITEMASK) },
        }
        mask.map(|value| value != 0)
    }

    /// Whether draw buffer `index` blends.
    fn is_blending(&self, index: u32) -> bool {
        let mut blends = 0_u8;
        match self.inner.get_booleani_v {
            // SAFETY: GL_BLEND has one value for each draw buffer.
            Some(get) => unsafe { get(glow::BLEND, index, &raw mut blends) },
            // SAFETY: the context is current; OpenGL converts the value.
            None => return unsafe { self.glow().get_parameter_indexed_i32(glow::BLEND, index) } != 0,
        }
        blends != 0
    }

    /// Whether a buffer can be bound that takes the results of queries: OpenGL 4.4.
    fn has_query_buffers(&self) -> bool {
        let version = self.glow().version();
        (version.major, version.minor) >= (4, 4)
    }

    /// The oldest pending GL error as our error, if there is one.
    ///
    /// # Errors
    /// [`Error::Gl`] with the enum's name.
    pub(crate) fn check(&self, what: &str) -> Result<()> {
        // SAFETY: the context is current while the handle lives.
        match unsafe { self.glow().get_error() } {
            glow::NO_ERROR => Ok(()),
            code => {
                self.forget_errors();
                Err(Error::Gl { code: error_name(code), what: what.to_owned() })
            }
        }
    }

    /// Takes errors that somebody else left behind, so that they are not blamed on the call that follows.
    pub(crate) fn forget_errors(&self) {
        // A lost context answers with an error for ever.
        for _ in 0..16 {
            // SAFETY: the context is current while the handle lives.
            match unsafe { self.glow().get_error() } {
                glow::NO_ERROR => return,
                code => tracing::warn!(code = error_name(code), "an OpenGL error was already pending"),
            }
        }
    }

    /// Runs `work` inside a debug group that RenderDoc and apitrace show as `label`.
    fn labelled<T>(&self, label: &str, work: impl FnOnce() -> T) -> T {
        if !self.inner.debug_groups {
            return work();
        }
        // SAFETY: the context is current and has KHR_debug.
        unsafe { self.glow().push_debug_group(glow::DEBUG_SOURCE_APPLICATION, 0, label) };
        let result = work();
        // SAFETY: as above; the group was pushed a line ago.
        unsafe { self.glow().pop_debug_group() };
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
        // SAFETY: the context is current while the handle lives, and the names are ours.
        unsafe {
            self.glow.delete_vertex_array(self.vertex_array);
            self.glow.delete_sampler(self.nearest);
            self.glow.delete_sampler(self.nearest_mipmap);
        }
    }
}

/// The name of a glGetError code.
pub(crate) fn error_name(code: u32) -> String {
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

/// glow panics where no context is current; a host deserves an error.
fn check_current(loader: &mut impl FnMut(&CStr) -> *const c_void) -> Result<()> {
    type GetString = unsafe extern "system" fn(name: u32) -> *const u8;
    let get_string = loader(c"glGetString");
    if get_string.is_null() {
        return Err(Error::NoContext("the loader does not know glGetString".to_owned()));
    }
    // SAFETY: the caller of `from_loader` vouches that this is the address of glGetString.
    let get_string = unsafe { std::mem::transmute::<*const c_void, GetString>(get_string) };
    // SAFETY: glGetString takes any value; without a context it returns null.
    if unsafe { get_string(glow::VERSION) }.is_null() {
        return Err(Error::NoContext("no OpenGL context is current on this thread".to_owned()));
    }
    Ok(())
}

unsafe fn sampler(glow: &glow::Context, minification: u32) -> Result<glow::Sampler> {
    // SAFETY: the context is current, as the caller vouches.
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

/// glow returned no name: the GL error tells why.
fn gl_error(glow: &glow::Context, what: &str) -> Error {
    // SAFETY: the context is current where an object was just asked for.
    let code = unsafe { glow.get_error() };
    Error::Gl { code: error_name(code), what: what.to_owned() }
}
