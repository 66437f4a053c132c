//! Two-dimensional textures, plain or in layers: ours, or borrowed from the host.

use bytemuck::Pod;
use glam::UVec2;
use glow::HasContext as _;

use super::{Gl, TextureShape};
use crate::error::{Error, Result};
use crate::image::Image;

/// The formats of maps and of what lies between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum TextureFormat {
    /// GL_R32UI: counts, radii.
    R32Uint,
    /// GL_R32F: counts as additive blending writes them, or sums as the thesis keeps them.
    R32Float,
    /// GL_R16F: sums of up to 2^11.
    R16Float,
    /// GL_R16UI: sums of boxes that hold less than 2^16.
    R16Uint,
    /// GL_R8UI: masks.
    R8Uint,
    /// GL_RGBA32UI: four neighbours in one texel, between passes only.
    Rgba32Uint,
    /// GL_RGBA32F: places, normals, colours.
    Rgba32Float,
    /// GL_RGBA16F: a host's normals or colours.
    Rgba16Float,
    /// GL_RGB32F: a host's places, normals or colours; its fourth value reads 1.
    Rgb32Float,
    /// GL_RGB16F: a host's normals or colours; its fourth value reads 1.
    Rgb16Float,
    /// GL_DEPTH_COMPONENT32F: what hides what.
    Depth32Float,
}

impl TextureFormat {
    /// What a host's map may be.
    const OF_MAPS: [Self; 4] = [Self::R32Uint, Self::R32Float, Self::R16Uint, Self::R8Uint];

    fn internal(self) -> u32 {
        match self {
            Self::R32Uint => glow::R32UI,
            Self::R32Float => glow::R32F,
            Self::R16Float => glow::R16F,
            Self::R16Uint => glow::R16UI,
            Self::R8Uint => glow::R8UI,
            Self::Rgba32Uint => glow::RGBA32UI,
            Self::Rgba32Float => glow::RGBA32F,
            Self::Rgba16Float => glow::RGBA16F,
            Self::Rgb32Float => glow::RGB32F,
            Self::Rgb16Float => glow::RGB16F,
            Self::Depth32Float => glow::DEPTH_COMPONENT32F,
        }
    }

    pub(super) fn transfer(self) -> (u32, u32) {
        match self {
            Self::R32Uint => (glow::RED_INTEGER, glow::UNSIGNED_INT),
            Self::R32Float => (glow::RED, glow::FLOAT),
            Self::R16Float => (glow::RED, glow::HALF_FLOAT),
            Self::R16Uint => (glow::RED_INTEGER, glow::UNSIGNED_SHORT),
            Self::R8Uint => (glow::RED_INTEGER, glow::UNSIGNED_BYTE),
            Self::Rgba32Uint => (glow::RGBA_INTEGER, glow::UNSIGNED_INT),
            Self::Rgba32Float => (glow::RGBA, glow::FLOAT),
            Self::Rgba16Float => (glow::RGBA, glow::HALF_FLOAT),
            Self::Rgb32Float => (glow::RGB, glow::FLOAT),
            Self::Rgb16Float => (glow::RGB, glow::HALF_FLOAT),
            Self::Depth32Float => (glow::DEPTH_COMPONENT, glow::FLOAT),
        }
    }

    /// What glTexImage2D takes: the internal format, components and type.
    #[cfg(feature = "window")]
    pub(crate) fn upload(self) -> (u32, u32, u32) {
        let (components, kind) = self.transfer();
        (self.internal(), components, kind)
    }

    pub(crate) fn is_float(self) -> bool {
        !matches!(self, Self::R32Uint | Self::R16Uint | Self::R8Uint | Self::Rgba32Uint)
    }

    pub(super) fn texel_bytes(self) -> usize {
        match self {
            Self::R32Uint | Self::R32Float | Self::Depth32Float => 4,
            Self::R16Uint | Self::R16Float => 2,
            Self::R8Uint => 1,
            Self::Rgba32Uint | Self::Rgba32Float => 16,
            Self::Rgb32Float => 12,
            Self::Rgba16Float => 8,
            Self::Rgb16Float => 6,
        }
    }

    /// Values of a texel.
    fn components(self) -> usize {
        match self {
            Self::Rgba32Uint | Self::Rgba32Float | Self::Rgba16Float => 4,
            Self::Rgb32Float | Self::Rgb16Float => 3,
            _ => 1,
        }
    }

    /// The name of the GL enum.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::R32Uint => "GL_R32UI",
            Self::R32Float => "GL_R32F",
            Self::R16Float => "GL_R16F",
            Self::R16Uint => "GL_R16UI",
            Self::R8Uint => "GL_R8UI",
            Self::Rgba32Uint => "GL_RGBA32UI",
            Self::Rgba32Float => "GL_RGBA32F",
            Self::Rgba16Float => "GL_RGBA16F",
            Self::Rgb32Float => "GL_RGB32F",
            Self::Rgb16Float => "GL_RGB16F",
            Self::Depth32Float => "GL_DEPTH_COMPONENT32F",
        }
    }
}

/// Where each value of a texel belongs.
const SWIZZLES: [(u32, u32, &str); 4] = [
    (glow::TEXTURE_SWIZZLE_R, glow::RED, "GL_TEXTURE_SWIZZLE_R GL_RED"),
    (glow::TEXTURE_SWIZZLE_G, glow::GREEN, "GL_TEXTURE_SWIZZLE_G GL_GREEN"),
    (glow::TEXTURE_SWIZZLE_B, glow::BLUE, "GL_TEXTURE_SWIZZLE_B GL_BLUE"),
    (glow::TEXTURE_SWIZZLE_A, glow::ALPHA, "GL_TEXTURE_SWIZZLE_A GL_ALPHA"),
];

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
    /// [`Error::TooLarge`]; [`Error::OutOfMemory`]; [`Error::ContextLost`]; [`Error::Gl`] if the driver fails.
    pub(crate) fn of(gl: &Gl, shape: TextureShape) -> Result<Self> {
        let TextureShape { format, size, levels, .. } = shape;
        let limit = gl.info().max_texture_size;
        if size.max_element() > limit {
            return Err(Error::TooLarge { size, limit });
        }
        let glow = gl.current()?;
        // SAFETY: the context is current while the handle lives, and no unpack buffer is bound (StateGuard), so
        // `None` allocates.
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

    /// Wraps a map that stays the host's, after asking the driver what it is.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if it is not a two-dimensional texture of a known format with level 0 as its base.
    pub(crate) fn borrow(gl: &Gl, name: glow::Texture) -> Result<Self> {
        Self::borrow_as(gl, name, "host texture", &TextureFormat::OF_MAPS)
    }

    /// Wraps a texture of one of `formats` that stays the host's; `what` it is, for errors.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if it is not a two-dimensional texture of such a format with level 0 as its base, and each value
    /// where it belongs.
    pub(crate) fn borrow_as(
        gl: &Gl,
        name: glow::Texture,
        what: &'static str,
        formats: &[TextureFormat],
    ) -> Result<Self> {
        let mismatch = |expected: String, got: String| Error::Mismatch { what, expected, got };
        let glow = gl.current()?;
        // SAFETY: the context is current while the handle lives; a name of another target is an error that is
        // asked for at once.
        let (internal, size, base) = unsafe {
            glow.active_texture(glow::TEXTURE0);
            glow.bind_texture(glow::TEXTURE_2D, Some(name));
            let code = glow.get_error();
            if code == glow::CONTEXT_LOST {
                return Err(gl.error(code, "binding a texture of the host", None));
            }
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
        // SAFETY: the context is current while the handle lives; a name of another target is an error that is asked for at
        // once.
        let [width, height, bits] = unsafe {
            glow.active_texture(glow::TEXTURE0);
            glow.bind_texture(glow::TEXTURE_2D, Some(name));
            let code = glow.get_error();
            if code != glow::NO_ERROR {
                return Err(mismatch(format!(
                    "a name that answers {} when bound there",
                    super::error_name(code)
                )));
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

    /// The same texture for another reader; `self` stays its owner.
    pub(crate) fn alias(&self) -> Self {
        Self { gl: self.gl.clone(), ours: false, ..*self }
    }

    /// Replaces level 0.
    ///
    /// # Panics
    /// If the image's size or type does not fit: our own mistake.
    pub(crate) fn upload<T: Pod>(&self, image: &Image<T>) {
        assert_eq!(image.size(), self.size(), "image and texture");
        assert_eq!(size_of::<T>(), self.shape.format.texel_bytes(), "value and texel");
        let Some(glow) = self.gl.live() else { return };
        self.bind(0);
        let (components, kind) = self.shape.format.transfer();
        let size = self.size().as_ivec2();
        let bytes = bytemuck::cast_slice(image.values());
        // SAFETY: the slice holds size.x * size.y texels of this format, tightly packed as StateGuard sets it.
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

    /// Reads a level back; waits for the GPU. Zeros if the context is lost, which [`Gl::check`] tells.
    ///
    /// # Panics
    /// If the type does not fit the format: our own mistake.
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
            // SAFETY: as the caller vouches; level and layer exist.
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

/// The names of formats that hosts are likely to hold by mistake.
fn format_name(internal: u32) -> String {
    let name = match internal {
        glow::R8 => "GL_R8",
        glow::R16 => "GL_R16",
        glow::R16F => "GL_R16F",
        glow::R32I => "GL_R32I",
        glow::R32UI => "GL_R32UI",
        glow::R32F => "GL_R32F",
        glow::R16UI => "GL_R16UI",
        glow::R8UI => "GL_R8UI",
        glow::RGB16F => "GL_RGB16F",
        glow::RGB32F => "GL_RGB32F",
        glow::DEPTH_COMPONENT32F => "GL_DEPTH_COMPONENT32F",
        glow::RGBA8 => "GL_RGBA8",
        glow::RGBA16F => "GL_RGBA16F",
        glow::RGBA32F => "GL_RGBA32F",
        glow::RGBA32UI => "GL_RGBA32UI",
        glow::RGB8 => "GL_RGB8",
        glow::RGB10_A2 => "GL_RGB10_A2",
        glow::R11F_G11F_B10F => "GL_R11F_G11F_B10F",
        glow::RG16F => "GL_RG16F",
        glow::RG32F => "GL_RG32F",
        glow::RGBA8_SNORM => "GL_RGBA8_SNORM",
        glow::RGBA16_SNORM => "GL_RGBA16_SNORM",
        glow::SRGB8_ALPHA8 => "GL_SRGB8_ALPHA8",
        glow::DEPTH_COMPONENT16 => "GL_DEPTH_COMPONENT16",
        glow::DEPTH_COMPONENT24 => "GL_DEPTH_COMPONENT24",
        glow::DEPTH24_STENCIL8 => "GL_DEPTH24_STENCIL8",
        glow::DEPTH32F_STENCIL8 => "GL_DEPTH32F_STENCIL8",
        _ => return format!("format {internal:#06x}"),
    };
    name.to_owned()
}
