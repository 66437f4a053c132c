//! What choices are called in options, tables and files.

use super::{Edges, Method, Order, Rule, SatBuild, Storage, Variation};

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

impl Rule {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nearest => "nearest",
            Self::Even => "even",
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

impl SatBuild {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Doubling => "doubling",
            Self::Scan => "scan",
        }
    }
}

impl Variation {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ReusedSums => "reused-sums",
            Self::FetchesAtOnce => "fetches-at-once",
            Self::WholeStrips => "whole-strips",
            Self::UnconditionalFetches => "unconditional-fetches",
            Self::UnfinishedTexels => "unfinished-texels",
        }
    }
}

#[cfg(all(test, feature = "serde"))]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_files() {
        fn same<T: serde::Serialize + Copy>(choices: &[T], name: impl Fn(T) -> &'static str) {
            for &choice in choices {
                assert_eq!(serde_json::to_value(choice).expect("a word"), name(choice));
            }
        }
        same(&Method::ALL, Method::name);
        same(&[Rule::Nearest, Rule::Even], Rule::name);
        same(&Order::ALL, Order::name);
        same(&Variation::ALL, Variation::name);
        same(&[SatBuild::Doubling, SatBuild::Scan], SatBuild::name);
        same(&[Edges::Zero, Edges::Scale], Edges::name);
        let integers = [Storage::U32, Storage::U16];
        let floats = [Storage::F32, Storage::F16, Storage::F32MinusMean, Storage::F32MinusWholeMean];
        same(&integers, Storage::name);
        same(&floats, Storage::name);
    }
}
