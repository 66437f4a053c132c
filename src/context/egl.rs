//! EGL on a device, without a display server and without a surface.

use std::ffi::{CStr, c_void};
use std::path::PathBuf;

use glutin::api::egl::context::PossiblyCurrentContext;
use glutin::api::egl::device::Device as EglDevice;
use glutin::api::egl::display::Display;
use glutin::config::{Api, ConfigSurfaceTypes, ConfigTemplateBuilder};
use glutin::context::{ContextApi, ContextAttributesBuilder, GlProfile, Version};
use glutin::display::GlDisplay as _;
use glutin::prelude::*;

use super::refusal::{INSTALL, Refusal};
use super::{Opened, device_node, environment, vendor};

/// One EGL device.
#[derive(Clone, Debug)]
pub(super) struct Device {
    /// Its place in eglQueryDevicesEXT.
    pub(super) index: usize,
    pub(super) description: String,
    /// The file in /dev through which the driver reaches the card.
    node: Option<PathBuf>,
    handle: EglDevice,
}

/// All EGL devices, hardware first.
pub(super) fn devices() -> Result<Vec<Device>, Refusal> {
    let devices = EglDevice::query_devices().map_err(|error| match error.error_kind() {
        glutin::error::ErrorKind::NotFound => Refusal::new("libEGL.so.1 can't be loaded", INSTALL),
        _ => without_vendor(&error.to_string()),
    })?;
    let mut devices: Vec<_> =
        devices.enumerate().map(|(index, device)| (is_software(&device), index, device)).collect();
    if devices.is_empty() {
        return Err(without_vendor("EGL lists no device"));
    }
    devices.sort_by_key(|&(software, index, _)| (software, index));
    let device = |(_, index, handle): (bool, usize, EglDevice)| {
        let names: Vec<_> = [handle.vendor(), handle.name()].into_iter().flatten().collect();
        let node = handle.drm_render_device_node_path().or_else(|| handle.drm_device_node_path());
        let description = match (names.is_empty(), node) {
            (false, _) => names.join(" "),
            (true, Some(node)) => format!("EGL device at {}", node.display()),
            (true, None) if is_software(&handle) => "EGL software device".to_owned(),
            (true, None) => "EGL device".to_owned(),
        };
        Device { index, description, node: node.map(PathBuf::from), handle }
    };
    Ok(devices.into_iter().map(device).collect())
}

/// Why EGL is there and lists no device: a vendor file that points nowhere, or no driver.
fn without_vendor(symptom: &str) -> Refusal {
    match vendor::refusals(&environment::get).into_iter().next() {
        Some(broken) => broken.after(symptom),
        None => Refusal::new(format!("{symptom}; is a driver installed?"), INSTALL),
    }
}

fn is_software(device: &EglDevice) -> bool {
    device.extensions().contains("EGL_MESA_device_software")
}

/// Makes a 3.3 core context on the device and makes it current.
pub(super) fn open(device: &Device) -> Result<Opened, Refusal> {
    make_current(device).map_err(|symptom| match cause(device) {
        Some(cause) => cause.after(&symptom),
        None => environment::unexplained(&symptom),
    })
}

/// Why nothing works on the device, as far as can be seen from outside.
fn cause(device: &Device) -> Option<Refusal> {
    // NVIDIA's own driver reads none of Mesa's variables, and may not need the node.
    let is_mesa = !device.description.contains("NVIDIA");
    let of_node = || device.node.as_deref().and_then(device_node::refusal);
    let of_environment = || environment::obstacle(&environment::get).filter(|_| is_mesa);
    of_node().or_else(of_environment)
}

fn make_current(device: &Device) -> Result<Opened, String> {
    let step = |what: &'static str| move |error: glutin::error::Error| format!("{what}: {error}");
    // SAFETY: no raw display handle is passed, so there is none to be invalid.
    let display =
        unsafe { Display::with_device(&device.handle, None) }.map_err(step("making an EGL display"))?;
    let template = ConfigTemplateBuilder::new()
        .with_api(Api::OPENGL)
        .with_surface_type(ConfigSurfaceTypes::empty())
        .with_alpha_size(0)
        .with_depth_size(0)
        .with_stencil_size(0)
        .build();
    // SAFETY: the template holds no native window.
    let config = unsafe { display.find_configs(template) }
        .map_err(step("listing EGL configurations"))?
        .next()
        .ok_or("EGL has no configuration for OpenGL")?;
    let attributes = ContextAttributesBuilder::new()
        .with_context_api(ContextApi::OpenGl(Some(Version::new(3, 3))))
        .with_profile(GlProfile::Core)
        .build(None);
    // SAFETY: the attributes hold no window handle.
    let context = unsafe { display.create_context(&config, &attributes) }
        .map_err(step("making an OpenGL 3.3 core context"))?;
    let current =
        context.make_current_surfaceless().map_err(step("making the context current without a surface"))?;
    let loader_display = display.clone();
    let loader = move |name: &CStr| loader_display.get_proc_address(name).cast::<c_void>();
    Ok(Opened {
        context: Box::new(CurrentContext { context: Some(current), _display: display }),
        loader: Box::new(loader),
    })
}

/// Drops the context before its display.
struct CurrentContext {
    context: Option<PossiblyCurrentContext>,
    _display: Display,
}

impl Drop for CurrentContext {
    fn drop(&mut self) {
        if let Some(context) = self.context.take() {
            // A context that can't be released is dropped all the same.
            if let Err(error) = context.make_not_current() {
                tracing::warn!(%error, "releasing the EGL context");
            }
        }
    }
}
