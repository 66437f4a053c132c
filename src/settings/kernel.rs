//! How photons are spread: the kernel, and where its radius comes from.

/// The largest radius of a kernel, in pixels: its disc then still fits the loops that every renderer
/// finishes.
pub const MAX_PICTURE_RADIUS: u32 = 96;

/// How a photon's power falls off from the middle of its disc to the edge (thesis 2.6.2); unit energy always.
///
/// With d the distance from the middle, in radii:
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum Kernel {
    /// 1: the same everywhere on the disc.
    Box,
    /// 1 - d.
    Cone,
    /// 1 - d²: the least mean squared error for smooth densities.
    Epanechnikov,
    /// (1 - d²)²: smooth at the edge (B. W. Silverman, "Density Estimation", 1986, 4.2).
    Silverman,
    /// exp(-4.5 d²): a bell, cut off at three standard deviations.
    Gaussian,
}

impl Kernel {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Box, Self::Cone, Self::Epanechnikov, Self::Silverman, Self::Gaussian];

    /// The weight for the square of the distance from the middle, in radii; 1 in the middle, 0 from the edge
    /// on.
    #[must_use]
    pub fn profile(self, squared: f64) -> f64 {
        if squared >= 1.0 {
            return 0.0;
        }
        match self {
            Self::Box => 1.0,
            Self::Cone => 1.0 - squared.sqrt(),
            Self::Epanechnikov => 1.0 - squared,
            Self::Silverman => (1.0 - squared) * (1.0 - squared),
            Self::Gaussian => (-4.5 * squared).exp(),
        }
    }

    /// The mean weight on the disc.
    #[must_use]
    pub fn mean(self) -> f64 {
        match self {
            Self::Box => 1.0,
            Self::Cone | Self::Silverman => 1.0 / 3.0,
            Self::Epanechnikov => 0.5,
            Self::Gaussian => (1.0 - (-4.5_f64).exp()) / 4.5,
        }
    }

    /// The define that chooses it in `common/kernel.glsl`.
    pub(crate) fn define(self) -> &'static str {
        match self {
            Self::Box => "KERNEL_BOX",
            Self::Cone => "KERNEL_CONE",
            Self::Epanechnikov => "KERNEL_EPANECHNIKOV",
            Self::Silverman => "KERNEL_SILVERMAN",
            Self::Gaussian => "KERNEL_GAUSSIAN",
        }
    }
}

/// The radius of each pixel's kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum KernelRadius {
    /// From the radius map: the smallest box that holds n photons.
    Variable,
    /// The same for all, in pixels.
    Fixed(u32),
}

impl KernelRadius {
    /// Whether it is the same for all.
    #[must_use]
    pub fn is_fixed(self) -> bool {
        matches!(self, Self::Fixed(_))
    }
}
