//! A texture of the program's own: pixels that it made, or a copy of another texture.

use glam::UVec2;
use glow::HasContext as _;

use crate::error::{Error, Result};
use crate::gl::{Gl, TextureFormat};
use crate::image::Image;

/// A GL_TEXTURE_2D with one level; row 0 is the first in memory.
#[derive(Debug)]
pub struct Picture {
    gl: Gl,
    texture: glow::Texture,
    size: UVec2,
}

impl Picture {
    /// A GL_RGBA32F texture of `image`.
    ///
    /// # Errors
    /// [`Error::TooLarge`]; [`Error::Gl`] when memory runs out.
    pub fn colours(gl: &Gl, image: &Image<[f32; 4]>) -> Result<Self> {
        let bytes = bytemuck::cast_slice(image.values());
        Self::new(gl, TextureFormat::Rgba32Float, image.size(), Some(bytes))
    }

    /// A GL_R32F texture of `image`.
    ///
    /// # Errors
    /// As [`colours`](Self::colours).
    pub fn values(gl: &Gl, image: &Image<f32>) -> Result<Self> {
        Self::new(gl, TextureFormat::R32Float, image.size(), Some(bytemuck::cast_slice(image.values())))
    }

    /// A copy of another texture of that format and size.
    ///
    /// # Errors
    /// As [`colours`](Self::colours).
    pub fn copy_of(gl: &Gl, texture: glow::Texture, format: TextureFormat, size: UVec2) -> Result<Self> {
        let copy = Self::new(gl, format, size, None)?;
        let glow = gl.glow();
        // SAFETY: the context is current while the handle lives; the texture bound is the copy, and what is
        // read is attached to a framebuffer of ours.
        unsafe {
            let framebuffer = glow.create_framebuffer().map_err(|what| gl.failure(&what))?;
            glow.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(framebuffer));
            let (plane, from) = (glow::TEXTURE_2D, Some(texture));
            glow.framebuffer_texture_2d(glow::READ_FRAMEBUFFER, glow::COLOR_ATTACHMENT0, plane, from, 0);
            let (width, height) = size.as_ivec2().into();
            glow.copy_tex_sub_image_2d(plane, 0, 0, 0, 0, 0, width, height);
            glow.bind_framebuffer(glow::READ_FRAMEBUFFER, None);
            glow.delete_framebuffer(framebuffer);
        }
        gl.check("copying a texture")?;
        Ok(copy)
    }

    /// Allocates, uploads if there is something, and leaves the texture bound to unit 0.
    pub(super) fn new(gl: &Gl, format: TextureFormat, size: UVec2, pixels: Option<&[u8]>) -> Result<Self> {
        let limit = gl.info().max_texture_size;
        if size.max_element() > limit {
            return Err(Error::TooLarge { size, limit });
        }
        let glow = gl.glow();
        // SAFETY: the context is current while the handle lives, and the slice, if any, holds size.x * size.y
        // texels.
        unsafe {
            let texture = glow.create_texture().map_err(|what| gl.failure(&what))?;
            let picture = Self { gl: gl.clone(), texture, size };
            glow.active_texture(glow::TEXTURE0);
            glow.bind_texture(glow::TEXTURE_2D, Some(texture));
            glow.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
            glow.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
            let (width, height) = size.as_ivec2().into();
            let (internal, components, kind) = format.upload();
            let pixels = glow::PixelUnpackData::Slice(pixels);
            let internal = internal.cast_signed();
            glow.tex_image_2d(glow::TEXTURE_2D, 0, internal, width, height, 0, components, kind, pixels);
            for (parameter, value) in [
                (glow::TEXTURE_MIN_FILTER, glow::NEAREST),
                (glow::TEXTURE_MAG_FILTER, glow::NEAREST),
                (glow::TEXTURE_WRAP_S, glow::CLAMP_TO_EDGE),
                (glow::TEXTURE_WRAP_T, glow::CLAMP_TO_EDGE),
            ] {
                glow.tex_parameter_i32(glow::TEXTURE_2D, parameter, value.cast_signed());
            }
            glow.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MAX_LEVEL, 0);
            gl.check(&format!("allocating a {} texture of {} x {}", format.name(), size.x, size.y))?;
            Ok(picture)
        }
    }

    /// The texture.
    #[must_use]
    pub fn texture(&self) -> glow::Texture {
        self.texture
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> UVec2 {
        self.size
    }
}

impl Drop for Picture {
    fn drop(&mut self) {
        // SAFETY: the context is current while the handle lives, and the name is ours.
        unsafe { self.gl.glow().delete_texture(self.texture) };
    }
}
