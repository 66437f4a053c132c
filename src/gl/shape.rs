//! What a texture is before it exists: the one description for both its allocation and sums of memory.

use glam::UVec2;

use super::TextureFormat;

/// Format, size, levels and layers of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TextureShape {
    /// Its label in debuggers; empty where the caller labels the texture.
    pub(super) label: &'static str,
    pub(super) format: TextureFormat,
    /// Of level 0.
    pub(crate) size: UVec2,
    pub(super) levels: u32,
    /// Layers of an array.
    pub(super) layers: Option<u32>,
}

/// The textures of one target, in the order of its draw buffers.
pub(crate) type TargetShape = Vec<TextureShape>;

impl TextureShape {
    /// One level, no array.
    pub(crate) fn new(label: &'static str, format: TextureFormat, size: UVec2) -> Self {
        Self { label, format, size, levels: 1, layers: None }
    }

    /// Each level has half the side of the one before, rounded down, at least 1.
    pub(crate) fn with_levels(label: &'static str, format: TextureFormat, size: UVec2, levels: u32) -> Self {
        Self { levels, ..Self::new(label, format, size) }
    }

    /// An array of layers with one level.
    pub(crate) fn layered(label: &'static str, format: TextureFormat, size: UVec2, layers: u32) -> Self {
        Self { layers: Some(layers), ..Self::new(label, format, size) }
    }

    pub(super) fn level_size(self, level: u32) -> UVec2 {
        (self.size >> level).max(UVec2::ONE)
    }

    /// What its levels and layers hold.
    pub(crate) fn bytes(self) -> u64 {
        let texels = |level| {
            let size = self.level_size(level);
            u64::from(size.x) * u64::from(size.y)
        };
        let layers = u64::from(self.layers.unwrap_or(1));
        (0..self.levels).map(texels).sum::<u64>() * layers * self.format.texel_bytes() as u64
    }
}

/// What the textures of several targets hold together.
pub(crate) fn bytes_of(targets: &[TargetShape]) -> u64 {
    targets.iter().flatten().map(|texture| texture.bytes()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_by_hand() {
        let size = UVec2::new(5, 3);
        assert_eq!(TextureShape::new("", TextureFormat::R32Uint, size).bytes(), 60);
        // 5 x 3, 2 x 1, 1 x 1: 18 texels of 2 bytes.
        assert_eq!(TextureShape::with_levels("", TextureFormat::R16Uint, size, 3).bytes(), 36);
        assert_eq!(TextureShape::layered("", TextureFormat::Rgba32Uint, size, 8).bytes(), 1920);
        let single = TextureShape::new("", TextureFormat::R8Uint, UVec2::ONE);
        assert_eq!(bytes_of(&[vec![single, single], vec![single]]), 3);
    }
}
