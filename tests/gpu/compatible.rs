//! A compatibility context, which still has all of OpenGL 1 and 2.

#![expect(unsafe_code, reason = "a host makes contexts and speaks OpenGL itself")]

use std::collections::BTreeMap;
use std::ffi::{CStr, c_void};

use glutin::api::egl::context::PossiblyCurrentContext;
use glutin::api::egl::device::Device;
use glutin::api::egl::display::Display;
use glutin::config::{Api, ConfigSurfaceTypes, ConfigTemplateBuilder};
use glutin::context::{ContextApi, ContextAttributesBuilder, GlProfile, Version};
use glutin::prelude::*;
use varikernel::Gl;

/// A context with the commands that glow lacks. Fields are dropped in this order.
pub(crate) struct Compatible {
    pub(crate) gl: Gl,
    pub(crate) polygon_stipple: unsafe extern "system" fn(*const u8),
    pub(crate) alpha_func: unsafe extern "system" fn(u32, f32),
    pub(crate) new_list: unsafe extern "system" fn(u32, u32),
    pub(crate) end_list: unsafe extern "system" fn(),
    context: PossiblyCurrentContext,
    _display: Display,
}

impl Compatible {
    pub(crate) fn make_current(&self) {
        self.context.make_current_surfaceless().unwrap();
    }
}

/// On the software device, which every test machine has.
pub(crate) fn compatible() -> Compatible {
    let is_software = |device: &Device| device.extensions().contains("EGL_MESA_device_software");
    let device = Device::query_devices().unwrap().find(is_software).unwrap();
    // SAFETY: no raw handle is passed.
    let display = unsafe { Display::with_device(&device, None) }.unwrap();
    let template = ConfigTemplateBuilder::new()
        .with_api(Api::OPENGL)
        .with_surface_type(ConfigSurfaceTypes::empty())
        .build();
    // SAFETY: the template holds no native window.
    let config = unsafe { display.find_configs(template) }.unwrap().next().unwrap();
    let attributes = ContextAttributesBuilder::new()
        .with_context_api(ContextApi::OpenGl(Some(Version::new(3, 3))))
        .with_profile(GlProfile::Compatibility)
        .build(None);
    // SAFETY: the attributes hold no window handle.
    let context = unsafe { display.create_context(&config, &attributes) }.unwrap();
    let context = context.make_current_surfaceless().unwrap();
    let load = |name: &CStr| display.get_proc_address(name).cast::<c_void>();
    let addresses: BTreeMap<&CStr, *const c_void> =
        [c"glPolygonStipple", c"glAlphaFunc", c"glNewList", c"glEndList"]
            .map(|name| (name, load(name)))
            .into();
    // SAFETY: the loader is the context's own, which is current and lives longer; the addresses are those of the
    // commands, which have these types.
    unsafe {
        Compatible {
            gl: Gl::from_loader(load).unwrap(),
            polygon_stipple: std::mem::transmute::<*const c_void, unsafe extern "system" fn(*const u8)>(
                addresses[c"glPolygonStipple"],
            ),
            alpha_func: std::mem::transmute::<*const c_void, unsafe extern "system" fn(u32, f32)>(
                addresses[c"glAlphaFunc"],
            ),
            new_list: std::mem::transmute::<*const c_void, unsafe extern "system" fn(u32, u32)>(
                addresses[c"glNewList"],
            ),
            end_list: std::mem::transmute::<*const c_void, unsafe extern "system" fn()>(
                addresses[c"glEndList"],
            ),
            context,
            _display: display,
        }
    }
}
