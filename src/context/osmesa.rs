//! OSMesa: Mesa's software renderer as a plain library, found at run time. Removed from Mesa in 25.1.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::rc::Rc;

use libloading::Library;

use super::refusal::Refusal;
use super::{Opened, environment};

const NAMES: [&str; 3] = ["libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"];

/// OSMESA_FORMAT, RGBA, DEPTH_BITS, ... as GL/osmesa.h numbers them, ended by a zero pair.
const ATTRIBUTES: [c_int; 12] = [0x22, 0x1908, 0x30, 24, 0x33, 0x34, 0x36, 3, 0x37, 3, 0, 0];

const GL_UNSIGNED_BYTE: u32 = 0x1401;

/// How to get the library, and what to use instead.
const REMEDY: &str = "use EGL (--device egl), which has the same renderer; OSMesa was removed from Mesa in \
                      25.1, up to then:\n  Debian, Ubuntu: sudo apt-get install libosmesa6\n  \
                      Fedora:         sudo dnf install mesa-libOSMesa";

type CreateContextAttribs = unsafe extern "C" fn(*const c_int, *mut c_void) -> *mut c_void;
type MakeCurrent = unsafe extern "C" fn(*mut c_void, *mut c_void, u32, c_int, c_int) -> u8;
type GetProcAddress = unsafe extern "C" fn(*const c_char) -> *const c_void;
type DestroyContext = unsafe extern "C" fn(*mut c_void);

struct OsMesa {
    context: *mut c_void,
    destroy: DestroyContext,
    /// OSMesa needs a default framebuffer; nothing draws to it. It outlives the context.
    _framebuffer: Box<[u32; 1]>,
    /// The library outlives all of its functions.
    _library: Rc<Library>,
}

impl Drop for OsMesa {
    fn drop(&mut self) {
        // SAFETY: the context came from this library's create and is destroyed once; OSMesa releases it
        // first.
        unsafe { (self.destroy)(self.context) };
    }
}

/// Makes a 3.3 core context and makes it current.
pub(super) fn open() -> Result<Opened, Refusal> {
    let library = Rc::new(load().map_err(|reason| Refusal::new(reason, REMEDY))?);
    // Where less than 3.3 is to be had, OSMesa reads through a null pointer.
    if let Some(refusal) = environment::obstacle_of_osmesa(&environment::get) {
        return Err(refusal);
    }
    make_current(library).map_err(|symptom| environment::unexplained(&symptom))
}

/// Whether the library can be loaded.
pub(super) fn is_there() -> bool {
    load().is_ok()
}

fn make_current(library: Rc<Library>) -> Result<Opened, String> {
    // SAFETY: the names and types are those of GL/osmesa.h; the library is kept as long as the functions.
    let (create, make_current, get_proc_address, destroy) = unsafe {
        (
            symbol::<CreateContextAttribs>(&library, c"OSMesaCreateContextAttribs")?,
            symbol::<MakeCurrent>(&library, c"OSMesaMakeCurrent")?,
            symbol::<GetProcAddress>(&library, c"OSMesaGetProcAddress")?,
            symbol::<DestroyContext>(&library, c"OSMesaDestroyContext")?,
        )
    };
    // SAFETY: the list ends with a zero, and no context is shared with.
    let context = unsafe { create(ATTRIBUTES.as_ptr(), std::ptr::null_mut()) };
    if context.is_null() {
        return Err("OSMesa makes no OpenGL 3.3 core context".to_owned());
    }
    let mut framebuffer = Box::new([0_u32; 1]);
    let pixels = framebuffer.as_mut_ptr().cast::<c_void>();
    let osmesa = OsMesa { context, destroy, _framebuffer: framebuffer, _library: Rc::clone(&library) };
    // SAFETY: the buffer holds the one RGBA pixel of bytes and lives as long as the context.
    if unsafe { make_current(osmesa.context, pixels, GL_UNSIGNED_BYTE, 1, 1) } == 0 {
        return Err("OSMesaMakeCurrent failed".to_owned());
    }
    let loader = move |name: &CStr| {
        let _library = &library;
        // SAFETY: the name ends with a zero byte, and the library is loaded as long as this closure.
        unsafe { get_proc_address(name.as_ptr()) }
    };
    Ok(Opened { context: Box::new(osmesa), loader: Box::new(loader) })
}

fn load() -> Result<Library, String> {
    let mut last = String::new();
    for name in NAMES {
        // SAFETY: Mesa's library runs no initialiser that could break an invariant of ours.
        match unsafe { Library::new(name) } {
            Ok(library) => return Ok(library),
            Err(error) => last = error.to_string(),
        }
    }
    Err(format!("none of {} can be loaded ({last})", NAMES.join(", ")))
}

unsafe fn symbol<T: Copy>(library: &Library, name: &CStr) -> Result<T, String> {
    // SAFETY: the caller names the symbol's true type.
    unsafe { library.get::<T>(name) }.map(|symbol| *symbol).map_err(|error| error.to_string())
}
