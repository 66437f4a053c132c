//! What a host has before it uses the library: a context of its own, and a way to make programs.

use std::ffi::{CStr, c_void};
use std::sync::Arc;

use glow::HasContext as _;
use glutin::api::egl::context::PossiblyCurrentContext;
use glutin::api::egl::device::Device;
use glutin::api::egl::display::Display;
use glutin::config::{Api, ConfigSurfaceTypes, ConfigTemplateBuilder};
use glutin::context::{ContextApi, ContextAttributesBuilder, GlProfile, Version};
use glutin::display::GlDisplay as _;
use varikernel::glow;

pub(crate) type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// An OpenGL 3.3 core context on an EGL device, current on this thread, without a window.
pub(crate) struct Headless {
    /// The host's own commands.
    pub(crate) glow: Arc<glow::Context>,
    _context: PossiblyCurrentContext,
    display: Display,
}

impl Headless {
    /// On the first device that has one.
    pub(crate) fn open() -> Result<Self> {
        let mut failures = Vec::new();
        for device in Device::query_devices()? {
            match Self::on(&device) {
                Ok(headless) => return Ok(headless),
                Err(error) => failures.push(error.to_string()),
            }
        }
        Err(format!("no EGL device has OpenGL 3.3 core: {}", failures.join("; ")).into())
    }

    fn on(device: &Device) -> Result<Self> {
        // SAFETY: no raw handle is passed.
        let display = unsafe { Display::with_device(device, None) }?;
        let template = ConfigTemplateBuilder::new()
            .with_api(Api::OPENGL)
            .with_surface_type(ConfigSurfaceTypes::empty())
            .with_alpha_size(0)
            .with_depth_size(0)
            .with_stencil_size(0)
            .build();
        // SAFETY: the template holds no native window.
        let config = unsafe { display.find_configs(template) }?.next().ok_or("no configuration")?;
        let attributes = ContextAttributesBuilder::new()
            .with_context_api(ContextApi::OpenGl(Some(Version::new(3, 3))))
            .with_profile(GlProfile::Core)
            .build(None);
        // SAFETY: the attributes hold no window handle.
        let context = unsafe { display.create_context(&config, &attributes) }?.make_current_surfaceless()?;
        // SAFETY: the context is current, and the loader is that of its display.
        let glow =
            unsafe { glow::Context::from_loader_function_cstr(|name| display.get_proc_address(name).cast()) };
        Ok(Self { glow: Arc::new(glow), _context: context, display })
    }

    /// Where a command of OpenGL is.
    pub(crate) fn loader(&self) -> impl Fn(&CStr) -> *const c_void {
        |name| self.display.get_proc_address(name).cast()
    }
}

/// A program of the host's own.
pub(crate) fn program(glow: &glow::Context, vertex: &str, fragment: &str) -> Result<glow::Program> {
    // SAFETY: the context is current, and each name is of this function.
    unsafe {
        let program = glow.create_program()?;
        for (stage, text) in [(glow::VERTEX_SHADER, vertex), (glow::FRAGMENT_SHADER, fragment)] {
            let shader = glow.create_shader(stage)?;
            glow.shader_source(shader, &format!("#version 330 core\n{text}"));
            glow.compile_shader(shader);
            glow.attach_shader(program, shader);
        }
        glow.link_program(program);
        if glow.get_program_link_status(program) {
            Ok(program)
        } else {
            Err(glow.get_program_info_log(program).into())
        }
    }
}

/// A texture of one level, without filtering.
pub(crate) fn texture(
    glow: &glow::Context,
    internal: u32,
    (components, kind): (u32, u32),
    (width, height): (i32, i32),
) -> Result<glow::Texture> {
    // SAFETY: the context is current; no texels are passed.
    unsafe {
        let texture = glow.create_texture()?;
        glow.bind_texture(glow::TEXTURE_2D, Some(texture));
        let (none, internal) = (glow::PixelUnpackData::Slice(None), internal.cast_signed());
        glow.tex_image_2d(glow::TEXTURE_2D, 0, internal, width, height, 0, components, kind, none);
        glow.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MAX_LEVEL, 0);
        glow.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MIN_FILTER, glow::NEAREST.cast_signed());
        Ok(texture)
    }
}

/// A framebuffer that draws to a texture.
pub(crate) fn framebuffer(glow: &glow::Context, texture: glow::Texture) -> Result<glow::Framebuffer> {
    let (target, attachment) = (glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0);
    // SAFETY: the context is current.
    unsafe {
        let framebuffer = glow.create_framebuffer()?;
        glow.bind_framebuffer(target, Some(framebuffer));
        glow.framebuffer_texture_2d(target, attachment, glow::TEXTURE_2D, Some(texture), 0);
        Ok(framebuffer)
    }
}
