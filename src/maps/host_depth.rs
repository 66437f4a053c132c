//! A depth buffer of a host, for positions and masks.

/// A host's depth buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostDepth {
    /// A GL_TEXTURE_2D with depth, with or without stencil, as drawn with the whole depth range from 0 to 1.
    pub texture: glow::Texture,
    /// Whether the far plane is at 0.
    pub reversed: bool,
    /// Whether depth in clip space goes from 0 to 1 instead of from -1 to 1: GL_ZERO_TO_ONE of glClipControl.
    pub zero_to_one: bool,
}
