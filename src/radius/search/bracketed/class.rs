//! What is known of a tile, which decides the programs that its pixels take.

use crate::gl::ShaderSource;
use crate::settings::{Edges, Settings};

/// Which programs a tile's pixels take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    Unreached,
    Dense,
    Inner,
    Edge,
    Kept,
}

impl Class {
    /// Those that need brackets of blocks.
    pub(super) const WITH_BLOCKS: [Self; 2] = [Self::Inner, Self::Edge];

    /// Whether tiles of the class occur.
    pub(super) fn occurs(self, settings: &Settings) -> bool {
        self != Self::Edge || settings.search.edges == Edges::Scale
    }

    /// Adds the numbers of all classes, this one's, and its name.
    pub(super) fn define(self, source: ShaderSource) -> ShaderSource {
        define_classes(source).define("CLASS", self as u32).variant(match self {
            // Drawn as tiles, in place of the whole map.
            Self::Unreached => "tiles",
            Self::Dense => "dense",
            Self::Inner => "inner",
            Self::Edge => "edge",
            Self::Kept => "kept",
        })
    }
}

pub(super) fn define_classes(source: ShaderSource) -> ShaderSource {
    source
        .define("CLASS_UNREACHED", Class::Unreached as u32)
        .define("CLASS_DENSE", Class::Dense as u32)
        .define("CLASS_INNER", Class::Inner as u32)
        .define("CLASS_EDGE", Class::Edge as u32)
        .define("CLASS_KEPT", Class::Kept as u32)
}
