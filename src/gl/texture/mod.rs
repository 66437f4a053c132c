//! Two-dimensional textures, plain or in layers: ours, or borrowed from the host.

mod borrow;

use bytemuck::Pod;
use glam::UVec2;
use glow::HasContext as _;

use super::{Gl, TextureFormat, TextureShape};
use crate::error::{Error, Result};
use crate::image::Image;

/// A GL_TEXTURE_2D, or a GL_TEXTURE_2D_ARRAY.
#[derive(Debug)]
pub(crate) struct Texture {
    gl: Gl,
    name: glow::Texture,
    shape: TextureShape,
    ours: bool,
}

impl Texture {
    /// Allocates `levels` levels, contents undefined.
    ///
    /// # Errors
    /// As [`Texture::of`].
    pub(crate) fn new(gl: &Gl, format: TextureFormat, size: UVec2, levels: u32) -> Result<Self> {
        Self::of(gl, TextureShape::with_levels("", format, size, levels))
    }

    /// Allocates all levels and layers, contents undefined.
    ///
    /// # Errors
    /// [`Error::TooLarge`]; [`Error::OutOfMemory`]; [`Error::ContextLost`]; [`Error::Gl`] if the driver
    /// fails.
    pub(crate) fn of(gl: &Gl, shape: TextureShape) -> Result<Self> {
        let TextureShape { format, size, levels, .. } = shape;
        let limit = gl.info().max_texture_size;
        if size.max_element() > limit {
            return Err(Error::TooLarge { size, limit });
        }
        let glow = gl.current()?;
        // SAFETY: the context is current while the handle lives, and no unpack buffer is bound (StateGuard),
        // so `None` allocates.
        let texture = unsafe {
            let name = glow.create_texture().map_err(|what| gl.failure(&what))?;
            let texture = Self { gl: gl.clone(), name, shape, ours: true };
            let total = &gl.inner.texture_bytes;
            total.set(total.get() + shape.bytes());
            texture.bind(0);
            for level in 0..levels {
                texture.allocate_level(level);
            }
            texture
        };
        // So that a host may read it without a sampler: integers are complete with GL_NEAREST only.
        let minification = if levels > 1 { glow::NEAREST_MIPMAP_NEAREST } else { glow::NEAREST };
        // SAFETY: as above; the texture is bound.
        unsafe {
            let target = texture.target();
            glow.tex_parameter_i32(target, glow::TEXTURE_MIN_FILTER, minification.cast_signed());
            glow.tex_parameter_i32(target, glow::TEXTURE_MAG_FILTER, glow::NEAREST.cast_signed());
        }
        texture.select_levels(0, levels - 1);
        let what = format!("allocating a {} texture of {} x {}", format.name(), size.x, size.y);
        gl.check_allocation(&what, Some(shape.bytes()))?;
        Ok(texture)
    }

    /// Allocates a level of the bound texture.
    unsafe fn allocate_level(&self, level: u32) {
        let glow = self.gl.glow();
        let (width, height) = self.level_size(level).as_ivec2().into();
        let (level, internal) = (level.cast_signed(), self.shape.format.internal().cast_signed());
        let (components, kind) = self.shape.format.transfer();
        let nothing = glow::PixelUnpackData::Slice(None);
        // SAFETY: the caller has bound the texture, and no unpack buffer.
        unsafe {
            match self.shape.layers {
                None => glow.tex_image_2d(
                    self.target(),
                    level,
                    internal,
                    width,
                    height,
                    0,
                    components,
                    kind,
                    nothing,
                ),
                Some(layers) => glow.tex_image_3d(
                    self.target(),
                    level,
                    internal,
                    width,
                    height,
                    layers.cast_signed(),
                    0,
                    components,
                    kind,
                    nothing,
                ),
            }
        }
    }

    /// The same texture for another reader; `self` stays its owner.
    pub(crate) fn alias(&self) -> Self {
        Self { gl: self.gl.clone(), ours: false, ..*self }
    }

    /// Replaces level 0.
    ///
    /// # Panics
    /// If the image's size or type does not fit, which is a bug of the library.
    pub(crate) fn upload<T: Pod>(&self, image: &Image<T>) {
        assert_eq!(image.size(), self.size(), "image and texture");
        assert_eq!(size_of::<T>(), self.shape.format.texel_bytes(), "value and texel");
        let Some(glow) = self.gl.live() else { return };
        self.bind(0);
        let (components, kind) = self.shape.format.transfer();
        let size = self.size().as_ivec2();
        let bytes = bytemuck::cast_slice(image.values());
        // SAFETY: the slice holds size.x * size.y texels of this format, tightly packed as StateGuard sets
        // it.
        unsafe {
            glow.tex_sub_image_2d(
                glow::TEXTURE_2D,
                0,
                0,
                0,
                size.x,
                size.y,
                components,
                kind,
                glow::PixelUnpackData::Slice(Some(bytes)),
            );
        }
    }

    /// Reads a level back; waits for the GPU. Zeros if the context is lost, which [`Gl::check`] reports.
    ///
    /// # Panics
    /// If the type does not fit the format, which is a bug of the library.
    pub(crate) fn read<T: Pod>(&self, level: u32) -> Image<T> {
        assert_eq!(size_of::<T>(), self.shape.format.texel_bytes(), "value and texel");
        let size = self.level_size(level);
        let mut values = vec![T::zeroed(); size.x as usize * size.y as usize];
        let Some(glow) = self.gl.live() else { return Image::from_values(size, values) };
        self.bind(0);
        let (components, kind) = self.shape.format.transfer();
        // SAFETY: the buffer holds the level's texels, tightly packed as StateGuard sets it.
        unsafe {
            glow.get_tex_image(
                glow::TEXTURE_2D,
                level.cast_signed(),
                components,
                kind,
                glow::PixelPackData::Slice(Some(bytemuck::cast_slice_mut(&mut values))),
            );
        }
        Image::from_values(size, values)
    }

    /// Fills the levels above 0 with glGenerateMipmap, whatever filter the driver uses.
    pub(crate) fn generate_mipmaps(&mut self) {
        let Some(glow) = self.gl.live() else { return };
        self.bind(0);
        // SAFETY: the context is current, and the texture has a filterable format and all its levels.
        unsafe { glow.generate_mipmap(glow::TEXTURE_2D) };
    }

    /// Restricts reading to the levels from `base` to `last`; `base` is then lod 0 of texelFetch.
    ///
    /// Also how a level may be drawn to while the one before it is read, without a feedback loop
    /// (OpenGL 3.3 core, 4.4.3).
    pub(super) fn select_levels(&self, base: u32, last: u32) {
        let Some(glow) = self.gl.live() else { return };
        self.bind(0);
        // SAFETY: the context is current, and both levels exist.
        unsafe {
            glow.tex_parameter_i32(self.target(), glow::TEXTURE_BASE_LEVEL, base.cast_signed());
            glow.tex_parameter_i32(self.target(), glow::TEXTURE_MAX_LEVEL, last.cast_signed());
        }
    }

    /// Binds the texture to a unit.
    pub(super) fn bind(&self, unit: u32) {
        let Some(glow) = self.gl.live() else { return };
        // SAFETY: the context is current while the handle lives.
        unsafe {
            glow.active_texture(glow::TEXTURE0 + unit);
            glow.bind_texture(self.target(), Some(self.name));
        }
    }

    /// Attaches `level`, each layer apart, to the bound framebuffer.
    ///
    /// # Safety
    /// A framebuffer of ours is bound.
    pub(super) unsafe fn attach(&self, attachments: &mut impl Iterator<Item = u32>, level: u32) {
        let (glow, name, level) = (self.gl.glow(), Some(self.name), level.cast_signed());
        let layers =
            self.shape.layers.map_or(vec![None], |layers| (0..layers.cast_signed()).map(Some).collect());
        for (layer, attachment) in layers.into_iter().zip(attachments) {
            // SAFETY: guaranteed by the caller; level and layer exist.
            unsafe {
                match layer {
                    None => glow.framebuffer_texture_2d(
                        glow::FRAMEBUFFER,
                        attachment,
                        glow::TEXTURE_2D,
                        name,
                        level,
                    ),
                    Some(layer) => {
                        glow.framebuffer_texture_layer(glow::FRAMEBUFFER, attachment, name, level, layer);
                    }
                }
            }
        }
    }

    /// GL_TEXTURE_2D or GL_TEXTURE_2D_ARRAY.
    pub(super) fn target(&self) -> u32 {
        if self.shape.layers.is_some() { glow::TEXTURE_2D_ARRAY } else { glow::TEXTURE_2D }
    }

    /// Layers of an array.
    pub(super) fn layers(&self) -> Option<u32> {
        self.shape.layers
    }

    /// The type of the sampler that reads it.
    pub(super) fn sampler_kind(&self) -> u32 {
        match (self.shape.format.is_float(), self.shape.layers) {
            (true, None) => glow::SAMPLER_2D,
            (true, Some(_)) => glow::SAMPLER_2D_ARRAY,
            (false, None) => glow::UNSIGNED_INT_SAMPLER_2D,
            (false, Some(_)) => glow::UNSIGNED_INT_SAMPLER_2D_ARRAY,
        }
    }

    pub(crate) fn format(&self) -> TextureFormat {
        self.shape.format
    }

    /// The size of level 0.
    pub(crate) fn size(&self) -> UVec2 {
        self.shape.size
    }

    pub(crate) fn levels(&self) -> u32 {
        self.shape.levels
    }

    pub(crate) fn level_size(&self, level: u32) -> UVec2 {
        self.shape.level_size(level)
    }

    pub(crate) fn name(&self) -> glow::Texture {
        self.name
    }

    pub(crate) fn gl(&self) -> &Gl {
        &self.gl
    }

    /// Whether the library made it.
    pub(super) fn is_ours(&self) -> bool {
        self.ours
    }
}

impl Drop for Texture {
    fn drop(&mut self) {
        if self.ours {
            if let Some(glow) = self.gl.live() {
                // SAFETY: the context is current while the handle lives, and the name is ours.
                unsafe { glow.delete_texture(self.name) };
            }
            let total = &self.gl.inner.texture_bytes;
            total.set(total.get() - self.shape.bytes());
        }
    }
}
