//! The formats of textures, ours and those of a host.

/// The formats of maps and of what lies between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
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
    /// GL_RGBA8UI: lengths of up to 255 in four directions.
    Rgba8Uint,
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
    /// GL_DEPTH_COMPONENT32F: depth buffers.
    Depth32Float,
}

impl TextureFormat {
    /// What a host's map may be.
    pub(super) const OF_MAPS: [Self; 4] = [Self::R32Uint, Self::R32Float, Self::R16Uint, Self::R8Uint];

    pub(super) fn internal(self) -> u32 {
        match self {
            Self::R32Uint => glow::R32UI,
            Self::R32Float => glow::R32F,
            Self::R16Float => glow::R16F,
            Self::R16Uint => glow::R16UI,
            Self::R8Uint => glow::R8UI,
            Self::Rgba8Uint => glow::RGBA8UI,
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
            Self::Rgba8Uint => (glow::RGBA_INTEGER, glow::UNSIGNED_BYTE),
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
        !matches!(self, Self::R32Uint | Self::R16Uint | Self::R8Uint | Self::Rgba8Uint | Self::Rgba32Uint)
    }

    pub(super) fn texel_bytes(self) -> usize {
        match self {
            Self::R32Uint | Self::R32Float | Self::Rgba8Uint | Self::Depth32Float => 4,
            Self::R16Uint | Self::R16Float => 2,
            Self::R8Uint => 1,
            Self::Rgba32Uint | Self::Rgba32Float => 16,
            Self::Rgb32Float => 12,
            Self::Rgba16Float => 8,
            Self::Rgb16Float => 6,
        }
    }

    /// Values of a texel.
    pub(super) fn components(self) -> usize {
        match self {
            Self::Rgba8Uint | Self::Rgba32Uint | Self::Rgba32Float | Self::Rgba16Float => 4,
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
            Self::Rgba8Uint => "GL_RGBA8UI",
            Self::Rgba32Uint => "GL_RGBA32UI",
            Self::Rgba32Float => "GL_RGBA32F",
            Self::Rgba16Float => "GL_RGBA16F",
            Self::Rgb32Float => "GL_RGB32F",
            Self::Rgb16Float => "GL_RGB16F",
            Self::Depth32Float => "GL_DEPTH_COMPONENT32F",
        }
    }
}

/// The names of formats that hosts are likely to hold by mistake.
pub(super) fn format_name(internal: u32) -> String {
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
