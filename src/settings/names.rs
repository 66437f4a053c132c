//! What choices are called in options, tables and files.

use super::{Edges, Method, Order, Storage};

impl Method {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::BruteForce => "brute-force",
            Self::NaiveMipmap => "naive-mipmap",
            Self::AveragedMipmap => "averaged-mipmap",
            Self::Pyramid => "pyramid",
            Self::SummedAreaTable => "sat",
        }
    }
}

impl Order {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Binary => "binary",
            Self::Bracketed => "bracketed",
        }
    }
}

impl Edges {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Zero => "zero",
            Self::Scale => "scale",
        }
    }
}

impl Storage {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::U32 => "u32",
            Self::U16 => "u16",
            Self::F16 => "f16",
            Self::F32MinusMean => "f32-minus-mean",
            Self::F32MinusWholeMean => "f32-minus-whole-mean",
        }
    }
}
