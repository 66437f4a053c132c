//! A window with an OpenGL 3.3 core context, for a program that shows what the library makes.
//!
//! winit opens the window and glutin the context: EGL, GLX or WGL, whichever the display has. Nothing here
//! depends on the stages: [`Canvas`] draws the program's own shader, [`Picture`] holds its own pixels.

mod canvas;
mod libraries;
mod own_texture;

pub use canvas::{Canvas, Input, Uniform};
pub use own_texture::Picture;

use std::ffi::{CStr, c_void};
use std::num::NonZeroU32;
use std::rc::Rc;
use std::sync::Arc;

use glam::UVec2;
use glutin::config::{Config, ConfigTemplateBuilder};
use glutin::context::{ContextApi, ContextAttributesBuilder, GlProfile, PossiblyCurrentContext, Version};
use glutin::display::{Display, GetGlDisplay as _};
use glutin::prelude::*;
use glutin::surface::{Surface, SwapInterval, WindowSurface};
use glutin_winit::{DisplayBuilder, GlWindow as _};
use raw_window_handle::{HasWindowHandle as _, RawWindowHandle};
use winit::error::EventLoopError;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::{Window, WindowAttributes};

use super::{Refusal, ThreadGuard, environment};
use crate::error::{Error, Result};
use crate::gl::Gl;

/// The loop that brings a window's events: one for each process, on its main thread.
///
/// # Errors
/// [`Error::NoContext`] without a display, or without a library that windows need, by the name of its
/// package.
///
/// # Panics
/// On a thread that is not the main one, as winit does.
pub fn event_loop() -> Result<EventLoop<()>> {
    libraries::check()?;
    EventLoop::new().map_err(|error| {
        let reason = match error {
            EventLoopError::Os(error) => error.to_string(),
            other => other.to_string(),
        };
        // winit puts the line of its own source before the reason.
        let after = reason.split_once(".rs:").and_then(|(_, after)| after.split_once(": "));
        let reason = after.map_or(reason.as_str(), |(_, reason)| reason);
        Error::NoContext {
            reason: format!("no display to open a window on: {reason}"),
            remedy: "set DISPLAY or WAYLAND_DISPLAY to a display that runs (`xvfb-run` makes one \
                     without a screen)"
                .to_owned(),
        }
    })
}

/// A window, its surface, and its context, which is current on this thread as long as this or anything made
/// from its [`Gl`] lives.
#[derive(Debug)]
pub struct GlWindow {
    gl: Gl,
    glow: Arc<glow::Context>,
    held: Rc<Held>,
}

/// What has to live as long as the context is used; fields are dropped in this order.
#[derive(Debug)]
struct Held {
    context: PossiblyCurrentContext,
    surface: Surface<WindowSurface>,
    window: Window,
    _guard: ThreadGuard,
}

impl Drop for Held {
    fn drop(&mut self) {
        // A context that can't be released is dropped all the same.
        if let Err(error) = self.context.make_not_current_in_place() {
            tracing::warn!(%error, "releasing the window's context");
        }
    }
}

impl GlWindow {
    /// Opens a window, with 8 bits a colour, no depth and no samples, and makes its context current; frames
    /// wait for the display's refresh where the driver supports it.
    ///
    /// # Errors
    /// [`Error::NoContext`] with the platform's answer; [`Error::Version`] with what was found if it is older
    /// than 3.3.
    pub fn open(event_loop: &ActiveEventLoop, attributes: WindowAttributes) -> Result<Self> {
        let guard = ThreadGuard::take()?;
        let template =
            ConfigTemplateBuilder::new().with_alpha_size(0).with_depth_size(0).with_stencil_size(0);
        let (window, config) = DisplayBuilder::new()
            .with_window_attributes(Some(attributes))
            .build(event_loop, template, |configs| {
                configs.min_by_key(Config::num_samples).unwrap_or_else(|| unreachable!("glutin found some"))
            })
            .map_err(|error| no_window("choosing a configuration", &error))?;
        let window = window.ok_or_else(|| no_window("opening a window", &"the platform made none"))?;
        let display = config.display();
        let handle =
            window.window_handle().map_err(|error| no_window("asking for the window's handle", &error))?;
        let attributes = window
            .build_surface_attributes(<_>::default())
            .map_err(|error| no_window("describing the window's surface", &error))?;
        // SAFETY: the window behind the handle lives in `Held`, behind its surface.
        let surface = unsafe { display.create_window_surface(&config, &attributes) }
            .map_err(|error| no_window("making the window's surface", &error))?;
        let context = context(&display, &config, handle.as_raw(), &surface)?;
        // Some drivers do not support this; frames then come as fast as they are drawn.
        if let Err(error) = surface.set_swap_interval(&context, SwapInterval::Wait(NonZeroU32::MIN)) {
            tracing::info!(%error, "frames do not wait for the display");
        }
        let held = Rc::new(Held { context, surface, window, _guard: guard });
        let loader = |name: &CStr| display.get_proc_address(name).cast::<c_void>();
        // SAFETY: the context was just made current on this thread, the loader is its own, and `Gl` keeps it
        // alive and can't leave the thread; the guard keeps a second context of ours from taking its place.
        let (gl, glow) = unsafe {
            let gl = Gl::from_owned_context(Box::new(Rc::clone(&held)), loader)?;
            (gl, glow::Context::from_loader_function_cstr(loader))
        };
        Ok(Self { gl, glow: Arc::new(glow), held })
    }

    /// The context, for the library.
    #[must_use]
    pub fn gl(&self) -> &Gl {
        &self.gl
    }

    /// The same context for egui; to be dropped before this.
    #[must_use]
    pub fn glow(&self) -> &Arc<glow::Context> {
        &self.glow
    }

    /// The window.
    #[must_use]
    pub fn window(&self) -> &Window {
        &self.held.window
    }

    /// Columns and rows of the window's content; 0 while it is minimised on some systems.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        let size = self.held.window.inner_size();
        UVec2::new(size.width, size.height)
    }

    /// Fits the surface to a new size of the window; nothing if a side is 0.
    pub fn resize(&self, size: UVec2) {
        if let (Some(width), Some(height)) = (NonZeroU32::new(size.x), NonZeroU32::new(size.y)) {
            self.held.surface.resize(&self.held.context, width, height);
        }
    }

    /// Shows what was drawn to framebuffer 0.
    ///
    /// # Errors
    /// [`Error::NoContext`] if the display is gone.
    pub fn show(&self) -> Result<()> {
        self.held.window.pre_present_notify();
        let swapped = self.held.surface.swap_buffers(&self.held.context);
        swapped.map_err(|error| no_window("showing a frame", &error))
    }
}

/// An OpenGL 3.3 core context, current on the surface of the window behind `handle`.
fn context(
    display: &Display,
    config: &Config,
    handle: RawWindowHandle,
    surface: &Surface<WindowSurface>,
) -> Result<PossiblyCurrentContext> {
    let make = |attributes: ContextAttributesBuilder| {
        // SAFETY: the window behind the handle lives in the caller.
        let context = unsafe { display.create_context(config, &attributes.build(Some(handle))) };
        context.and_then(|context| context.make_current(surface))
    };
    let wanted = ContextAttributesBuilder::new()
        .with_context_api(ContextApi::OpenGl(Some(Version::new(3, 3))))
        .with_profile(GlProfile::Core);
    make(wanted).map_err(|error| {
        // A context without requirements shows which version there is.
        let little = ContextAttributesBuilder::new()
            .with_context_api(ContextApi::OpenGl(Some(Version::new(2, 1))))
            .with_profile(GlProfile::Compatibility);
        let Ok(_old) = make(little) else {
            return no_window("making an OpenGL 3.3 core context", &error);
        };
        // SAFETY: `_old` was just made current on this thread, and outlives the handle, which is dropped
        // here.
        let found = unsafe { Gl::from_loader(|name| display.get_proc_address(name).cast()) };
        match found {
            Err(found) => match environment::obstacle(&environment::get) {
                Some(refusal) => refusal.after(&Refusal::from(found).reason).into_error(),
                None => found,
            },
            Ok(_) => no_window("making an OpenGL 3.3 core context", &error),
        }
    })
}

fn no_window(step: &str, error: &dyn std::fmt::Display) -> Error {
    let symptom = format!("{step}: {error}");
    let refusal = match environment::obstacle(&environment::get) {
        Some(cause) => cause.after(&symptom),
        None => environment::unexplained(&symptom),
    };
    refusal.into_error()
}
