//! What a context reports about itself: names, versions, limits.

use glow::HasContext as _;

/// What a context reports about itself.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    expect(
        clippy::unsafe_derive_deserialize,
        reason = "plain data: the unsafe code reads from a context, and keeps no invariant"
    )
)]
pub struct DeviceInfo {
    /// GL_RENDERER.
    pub renderer: String,
    /// GL_VENDOR.
    pub vendor: String,
    /// GL_VERSION: the context's version and the driver's.
    pub version: String,
    /// GL_SHADING_LANGUAGE_VERSION.
    pub glsl_version: String,
    /// Whether the renderer's name is that of a software renderer (llvmpipe, softpipe, swrast, SwiftShader).
    pub software: bool,
    /// The longest side of a map, in pixels: GL_MAX_TEXTURE_SIZE, or GL_MAX_VIEWPORT_DIMS where that is less.
    pub max_texture_size: u32,
    /// GL_MAX_DRAW_BUFFERS: render targets of one pass.
    pub max_draw_buffers: u32,
    /// GL_MAX_TEXTURE_IMAGE_UNITS: textures that one pass may read.
    pub max_texture_units: u32,
}

impl DeviceInfo {
    /// Reads them from the current context.
    pub(super) fn of(glow: &glow::Context) -> Self {
        // SAFETY: the context is current; these are states of every 3.x context.
        unsafe {
            let text = |name| glow.get_parameter_string(name);
            let limit = |name| u32::try_from(glow.get_parameter_i32(name)).unwrap_or(0);
            let mut viewport = [0; 2];
            glow.get_parameter_i32_slice(glow::MAX_VIEWPORT_DIMS, &mut viewport);
            let largest_viewport = u32::try_from(viewport[0].min(viewport[1])).unwrap_or(0);
            let renderer = text(glow::RENDERER);
            let software =
                ["llvmpipe", "softpipe", "swrast", "SwiftShader"].iter().any(|name| renderer.contains(name));
            Self {
                renderer,
                vendor: text(glow::VENDOR),
                version: text(glow::VERSION),
                glsl_version: text(glow::SHADING_LANGUAGE_VERSION),
                software,
                max_texture_size: limit(glow::MAX_TEXTURE_SIZE).min(largest_viewport),
                max_draw_buffers: limit(glow::MAX_DRAW_BUFFERS),
                max_texture_units: limit(glow::MAX_TEXTURE_IMAGE_UNITS),
            }
        }
    }

    /// Whether this is llvmpipe, whose GL_TIME_ELAPSED needs a glFinish to be true.
    #[must_use]
    pub fn is_llvmpipe(&self) -> bool {
        self.renderer.to_lowercase().contains("llvmpipe")
    }

    /// Whether this is softpipe, Mesa's interpreter.
    #[must_use]
    pub fn is_softpipe(&self) -> bool {
        self.renderer.to_lowercase().contains("softpipe")
    }
}
