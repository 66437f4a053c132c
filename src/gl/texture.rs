//! Two-dimensional textures of one channel: ours, or borrowed from the host.

use bytemuck::Pod;
use glam::UVec2;
use glow::HasContext as _;

use super::{Gl, gl_error};
use crate::error::{Error, Result};
use crate::image::Image;

/// The formats that maps come in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum TextureFormat {
    /// GL_R32UI: counts, radii.
    R32Uint,
    /// GL_R32F: counts as additive blending writes them, or sums as the thesis keeps them.
    R32Float,
    /// GL_R8UI: masks.
    R8Uint,
}

impl TextureFormat {
    const ALL: [Self; 3] = [Self::R32Uint, Self::R32Float, Self::R8Uint];

    fn internal(self) -> u32 {
        match self {
            Self::R32Uint => glow::R32UI,
            Self::R32Float => glow::R32F,
            Self::R8Uint => glow::R8UI,
        }
    }

    fn transfer(self) -> (u32, u32) {
        match self {
            Self::R32Uint => (glow::RED_INTEGER, glow::UNSIGNED_INT),
            Self::R32Float => (glow::RED, glow::FLOAT),
            Self::R8Uint => (glow::RED_INTEGER, glow::UNSIGNED_BYTE),
        }
    }

    fn sampler_kind(self) -> u32 {
        match self {
            Self::R32Uint | Self::R8Uint => glow::UNSIGNED_INT_SAMPLER_2D,
            Self::R32Float => glow::SAMPLER_2D,
        }
    }

    fn texel_bytes(self) -> usize {
        match self {
            Self::R32Uint | Self::R32Float => 4,
            Self::R8Uint => 1,
        }
    }

    /// The name of the GL enum.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::R32Uint => "GL_R32UI",
            Self::R32Float => "GL_R32F",
            Self::R8Uint => "GL_R8UI",
        }
    }
}

/// A GL_TEXTURE_2D of one channel.
#[derive(Debug)]
pub(crate) struct Texture {
    gl: Gl,
    name: glow::Texture,
    format: TextureFormat,
    size: UVec2,
    levels: u32,
    ours: bool,
}

impl Texture {
    /// Allocates `levels` levels, contents undefined; each level has half the side of the one before, rounded
    /// down, at least 1.
    ///
    /// # Errors
    /// [`Error::TooLarge`]; [`Error::Gl`] when memory runs out.
    pub(crate) fn new(gl: &Gl, format: TextureFormat, size: UVec2, levels: u32) -> Result<Self> {
        let limit = gl.info().max_texture_size;
        if size.max_element() > limit {
            return Err(Error::TooLarge { size, limit });
        }
        let glow = gl.glow();
        // SAFETY: the context is current while the handle lives, and no unpack buffer is bound (StateGuard), so
        // `None` allocates.
        let texture = unsafe {
            let name = glow.create_texture().map_err(|what| gl_error(glow, &what))?;
            let texture = Self { gl: gl.clone(), name, format, size, levels, ours: true };
            texture.bind(0);
            for level in 0..levels {
                let extent = texture.level_size(level).as_ivec2();
                let (components, kind) = format.transfer();
                glow.tex_image_2d(
                    glow::TEXTURE_2D,
                    level.cast_signed(),
                    format.internal().cast_signed(),
                    extent.x,
                    extent.y,
                    0,
                    components,
                    kind,
                    glow::PixelUnpackData::Slice(None),
                );
            }
            texture
        };
        // So that a host may read it without a sampler: integers are complete with GL_NEAREST only.
        let minification = if levels > 1 { glow::NEAREST_MIPMAP_NEAREST } else { glow::NEAREST };
        // SAFETY: as above; the texture is bound.
        unsafe {
            glow.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MIN_FILTER, minification.cast_signed());
            glow.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MAG_FILTER, glow::NEAREST.cast_signed());
        }
        texture.select_levels(0, levels - 1);
        gl.check(&format!("allocating a {} texture of {} x {}", format.name(), size.x, size.y))?;
        Ok(texture)
    }

    /// Wraps a texture that stays the host's, after asking the driver what it is.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if it is not a two-dimensional texture of a known format with level 0 as its base.
    pub(crate) fn borrow(gl: &Gl, name: glow::Texture) -> Result<Self> {
        let mismatch =
            |expected: String, got: String| Error::Mismatch { what: "host texture", expected, got };
        let glow = gl.glow();
        // SAFETY: the context is current while the handle lives; a name of another target is an error that is
        // asked for at once.
        let (internal, size, base, red) = unsafe {
            glow.active_texture(glow::TEXTURE0);
            glow.bind_texture(glow::TEXTURE_2D, Some(name));
            let code = glow.get_error();
            if code != glow::NO_ERROR {
                let got = format!("a name that answers {} when bound there", super::error_name(code));
                return Err(mismatch("a GL_TEXTURE_2D".to_owned(), got));
            }
            let level = |parameter| glow.get_tex_level_parameter_i32(glow::TEXTURE_2D, 0, parameter);
            let side = |parameter| u32::try_from(level(parameter)).unwrap_or(0);
            (
                level(glow::TEXTURE_INTERNAL_FORMAT).cast_unsigned(),
                UVec2::new(side(glow::TEXTURE_WIDTH), side(glow::TEXTURE_HEIGHT)),
                glow.get_tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_BASE_LEVEL),
                glow.get_tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_SWIZZLE_R),
            )
        };
        if size.min_element() == 0 {
            return Err(mismatch("an image at level 0".to_owned(), "none".to_owned()));
        }
        let format = TextureFormat::ALL.into_iter().find(|format| format.internal() == internal);
        let Some(format) = format else {
            let known = TextureFormat::ALL.map(TextureFormat::name).join(", ");
            return Err(mismatch(format!("one of {known}"), format_name(internal)));
        };
        if base != 0 {
            return Err(mismatch("GL_TEXTURE_BASE_LEVEL 0".to_owned(), base.to_string()));
        }
        if red.cast_unsigned() != glow::RED {
            return Err(mismatch("GL_TEXTURE_SWIZZLE_R GL_RED".to_owned(), format!("{red:#06x}")));
        }
        Ok(Self { gl: gl.clone(), name, format, size, levels: 1, ours: false })
    }

    /// Replaces level 0.
    ///
    /// # Panics
    /// If the image's size or type does not fit: our own mistake.
    pub(crate) fn upload<T: Pod>(&self, image: &Image<T>) {
        assert_eq!(image.size(), self.size, "image and texture");
        assert_eq!(size_of::<T>(), self.format.texel_bytes(), "value and texel");
        self.bind(0);
        let (components, kind) = self.format.transfer();
        let size = self.size.as_ivec2();
        let bytes = bytemuck::cast_slice(image.values());
        // SAFETY: the slice holds size.x * size.y texels of this format, tightly packed as StateGuard sets it.
        unsafe {
            self.gl.glow().tex_sub_image_2d(
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

    /// Reads a level back; waits for the GPU.
    ///
    /// # Panics
    /// If the type does not fit the format: our own mistake.
    pub(crate) fn read<T: Pod>(&self, level: u32) -> Image<T> {
        assert_eq!(size_of::<T>(), self.format.texel_bytes(), "value and texel");
        self.bind(0);
        let size = self.level_size(level);
        let mut values = vec![T::zeroed(); size.x as usize * size.y as usize];
        let (components, kind) = self.format.transfer();
        // SAFETY: the buffer holds the level's texels, tightly packed as StateGuard sets it.
        unsafe {
            self.gl.glow().get_tex_image(
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
        self.bind(0);
        // SAFETY: the context is current, and the texture has a filterable format and all its levels.
        unsafe { self.gl.glow().generate_mipmap(glow::TEXTURE_2D) };
    }

    /// Restricts reading to the levels from `base` to `last`; `base` is then lod 0 of texelFetch.
    ///
    /// Also how a level may be drawn to while the one before it is read, without a feedback loop
    /// (OpenGL 3.3 core, 4.4.3).
    pub(super) fn select_levels(&self, base: u32, last: u32) {
        self.bind(0);
        // SAFETY: the context is current, and both levels exist.
        unsafe {
            let glow = self.gl.glow();
            glow.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_BASE_LEVEL, base.cast_signed());
            glow.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MAX_LEVEL, last.cast_signed());
        }
    }

    /// Binds the texture to a unit.
    pub(super) fn bind(&self, unit: u32) {
        // SAFETY: the context is current while the handle lives.
        unsafe {
            self.gl.glow().active_texture(glow::TEXTURE0 + unit);
            self.gl.glow().bind_texture(glow::TEXTURE_2D, Some(self.name));
        }
    }

    pub(super) fn sampler_kind(&self) -> u32 {
        self.format.sampler_kind()
    }

    pub(crate) fn format(&self) -> TextureFormat {
        self.format
    }

    /// The size of level 0.
    pub(crate) fn size(&self) -> UVec2 {
        self.size
    }

    pub(crate) fn levels(&self) -> u32 {
        self.levels
    }

    pub(crate) fn level_size(&self, level: u32) -> UVec2 {
        (self.size >> level).max(UVec2::ONE)
    }

    pub(crate) fn name(&self) -> glow::Texture {
        self.name
    }

    pub(crate) fn gl(&self) -> &Gl {
        &self.gl
    }
}

impl Drop for Texture {
    fn drop(&mut self) {
        if self.ours {
            // SAFETY: the context is current while the handle lives, and the name is ours.
            unsafe { self.gl.glow().delete_texture(self.name) };
        }
    }
}

/// The names of formats that hosts are likely to hold by mistake.
fn format_name(internal: u32) -> String {
    let name = match internal {
        glow::R8 => "GL_R8",
        glow::R16 => "GL_R16",
        glow::R16F => "GL_R16F",
        glow::R16UI => "GL_R16UI",
        glow::R32I => "GL_R32I",
        glow::RGBA8 => "GL_RGBA8",
        glow::RGBA16F => "GL_RGBA16F",
        glow::RGBA32F => "GL_RGBA32F",
        glow::RGBA32UI => "GL_RGBA32UI",
        _ => return format!("format {internal:#06x}"),
    };
    name.to_owned()
}
