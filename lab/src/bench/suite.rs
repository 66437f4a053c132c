//! The suite of the fast path, as settings hold it; `fast` says what it runs.

use serde::{Deserialize, Serialize};

/// The suite for some sizes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FastSuite {
    /// Columns and rows of the maps with which everything is timed.
    pub sizes: Vec<[u32; 2]>,
    /// Columns and rows of the maps with which only builds are.
    pub build_sizes: Vec<[u32; 2]>,
}

impl Default for FastSuite {
    /// Everything at 1024², builds from 64² to 2048².
    fn default() -> Self {
        let build_sizes = [64, 128, 256, 512, 1024, 2048].map(|side| [side, side]).into();
        Self { sizes: vec![[1024, 1024]], build_sizes }
    }
}
