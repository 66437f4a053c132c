//! A host's textures, checked before they are read.

use glam::UVec2;
use glow::HasContext as _;

use super::Texture;
use crate::error::{Error, Result};
use crate::gl::errors::error_name;
use crate::gl::texture_format::{TextureFormat, format_name};
use crate::gl::{Gl, TextureShape};

/// Where each value of a texel belongs.
const SWIZZLES: [(u32, u32, &str); 4] = [
    (glow::TEXTURE_SWIZZLE_R, glow::RED, "GL_TEXTURE_SWIZZLE_R GL_RED"),
    (glow::TEXTURE_SWIZZLE_G, glow::GREEN, "GL_TEXTURE_SWIZZLE_G GL_GREEN"),
    (glow::TEXTURE_SWIZZLE_B, glow::BLUE, "GL_TEXTURE_SWIZZLE_B GL_BLUE"),
    (glow::TEXTURE_SWIZZLE_A, glow::ALPHA, "GL_TEXTURE_SWIZZLE_A GL_ALPHA"),
];

impl Texture {
    /// Wraps a map that stays the host's, after querying what it is; `what` is for errors.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if it is not a two-dimensional texture of a known format with level 0 as its base.
    pub(crate) fn borrow_map(gl: &Gl, name: glow::Texture, what: &'static str) -> Result<Self> {
        Self::borrow_as(gl, name, what, &TextureFormat::OF_MAPS)
    }

    /// Wraps a texture of one of `formats` that stays the host's; `what` it is, for errors.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if it is not a two-dimensional texture of such a format with level 0 as its base,
    /// and each value where it belongs.
    pub(crate) fn borrow_as(
        gl: &Gl,
        name: glow::Texture,
        what: &'static str,
        formats: &[TextureFormat],
    ) -> Result<Self> {
        let mismatch = |expected: String, got: String| Error::Mismatch { what, expected, got };
        let glow = gl.current()?;
        // SAFETY: the context is current while the handle lives; a name of another target is an error, which
        // is checked for at once.
        let (internal, size, base) = unsafe {
            glow.active_texture(glow::TEXTURE0);
            glow.bind_texture(glow::TEXTURE_2D, Some(name));
            let code = glow.get_error();
            if code == glow::CONTEXT_LOST {
                return Err(gl.error(code, "binding a texture of the host", None));
            }
            if code != glow::NO_ERROR {
                let got = format!("a name that answers {} when bound there", error_name(code));
                return Err(mismatch("a GL_TEXTURE_2D".to_owned(), got));
            }
            let level = |parameter| glow.get_tex_level_parameter_i32(glow::TEXTURE_2D, 0, parameter);
            let side = |parameter| u32::try_from(level(parameter)).unwrap_or(0);
            (
                level(glow::TEXTURE_INTERNAL_FORMAT).cast_unsigned(),
                UVec2::new(side(glow::TEXTURE_WIDTH), side(glow::TEXTURE_HEIGHT)),
                glow.get_tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_BASE_LEVEL),
            )
        };
        if size.min_element() == 0 {
            return Err(mismatch("an image at level 0".to_owned(), "none".to_owned()));
        }
        let format = formats.iter().copied().find(|format| format.internal() == internal);
        let Some(format) = format else {
            let known: Vec<_> = formats.iter().copied().map(TextureFormat::name).collect();
            return Err(mismatch(format!("one of {}", known.join(", ")), format_name(internal)));
        };
        if base != 0 {
            return Err(mismatch("GL_TEXTURE_BASE_LEVEL 0".to_owned(), base.to_string()));
        }
        for (swizzle, value, words) in &SWIZZLES[..format.components()] {
            // SAFETY: the context is current, and the texture bound.
            let got = unsafe { glow.get_tex_parameter_i32(glow::TEXTURE_2D, *swizzle) }.cast_unsigned();
            if got != *value {
                return Err(mismatch((*words).to_owned(), format!("{got:#06x}")));
            }
        }
        Ok(Self { gl: gl.clone(), name, shape: TextureShape::new("", format, size), ours: false })
    }

    /// Wraps a texture with depth, of any depth format, that stays the host's.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if it is none.
    pub(crate) fn borrow_depth(gl: &Gl, name: glow::Texture) -> Result<Self> {
        let glow = gl.current()?;
        let mismatch = |got: String| Error::Mismatch {
            what: "host's depth texture",
            expected: "a GL_TEXTURE_2D with depth".to_owned(),
            got,
        };
        // SAFETY: the context is current while the handle lives; a name of another target is an error, which
        // is checked for at once.
        let [width, height, bits] = unsafe {
            glow.active_texture(glow::TEXTURE0);
            glow.bind_texture(glow::TEXTURE_2D, Some(name));
            let code = glow.get_error();
            if code != glow::NO_ERROR {
                return Err(mismatch(format!("a name that answers {} when bound there", error_name(code))));
            }
            [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT, glow::TEXTURE_DEPTH_SIZE].map(|parameter| {
                glow.get_tex_level_parameter_i32(glow::TEXTURE_2D, 0, parameter).cast_unsigned()
            })
        };
        if bits == 0 {
            return Err(mismatch("one without depth, or without an image at level 0".to_owned()));
        }
        // Whatever its bits, shaders read a float.
        let shape = TextureShape::new("", TextureFormat::Depth32Float, UVec2::new(width, height));
        Ok(Self { gl: gl.clone(), name, shape, ours: false })
    }
}
