//! How photons become irradiance, as a plain struct of C.

use super::{Failure, Status, answer, check_place, check_size, flag, out_of_range};
use crate::capi::settings::{read_edges, write_edges};
use crate::settings::{Estimate, IrradianceSettings, Kernel, KernelRadius, Search, Settings};

/// kernel: the same everywhere on the disc.
pub const VARIKERNEL_KERNEL_BOX: u32 = 0;

/// kernel: 1 - d, with d the distance from the middle in radii.
pub const VARIKERNEL_KERNEL_CONE: u32 = 1;

/// kernel: 1 - d^2.
pub const VARIKERNEL_KERNEL_EPANECHNIKOV: u32 = 2;

/// kernel: (1 - d^2)^2.
pub const VARIKERNEL_KERNEL_SILVERMAN: u32 = 3;

/// kernel: exp(-4.5 d^2), cut off at three standard deviations.
pub const VARIKERNEL_KERNEL_GAUSSIAN: u32 = 4;

/// All of them by their numbers.
const KERNELS: [(u32, Kernel); 5] = [
    (VARIKERNEL_KERNEL_BOX, Kernel::Box),
    (VARIKERNEL_KERNEL_CONE, Kernel::Cone),
    (VARIKERNEL_KERNEL_EPANECHNIKOV, Kernel::Epanechnikov),
    (VARIKERNEL_KERNEL_SILVERMAN, Kernel::Silverman),
    (VARIKERNEL_KERNEL_GAUSSIAN, Kernel::Gaussian),
];

/// estimate: each photon spreads its power over the pixels around it, with the radius of its own pixel.
pub const VARIKERNEL_ESTIMATE_SPLAT: u32 = 0;

/// estimate: each pixel gathers the power around it, with its own radius.
pub const VARIKERNEL_ESTIMATE_GATHER: u32 = 1;

/// estimate: the same, and of what c photons give (c - 1) / c is taken, as a radius that ends at a photon
/// asks for.
pub const VARIKERNEL_ESTIMATE_GATHER_CORRECTED: u32 = 2;

/// estimate: each pixel gathers from summed-area tables, as wide as a test of noise allows. No kernel, no
/// min_photons and no radius is asked for; frames have to bring photon_totals.
pub const VARIKERNEL_ESTIMATE_TABLES: u32 = 3;

/// All of them by their numbers.
const ESTIMATES: [(u32, Estimate); 4] = [
    (VARIKERNEL_ESTIMATE_SPLAT, Estimate::Splat),
    (VARIKERNEL_ESTIMATE_GATHER, Estimate::Gather { count_correction: false }),
    (VARIKERNEL_ESTIMATE_GATHER_CORRECTED, Estimate::Gather { count_correction: true }),
    (VARIKERNEL_ESTIMATE_TABLES, Estimate::Tables),
];

/// How photons become irradiance. Fill it with varikernel_irradiance_settings_default, then change what you
/// like.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlainIrradianceSettings {
    /// sizeof(varikernel_irradiance_settings), by which another version's struct is told.
    pub struct_size: u32,
    /// 0 for kernels that fit the photons' density, else the radius of all kernels, 1 to 96 pixels. Default
    /// 0.
    pub fixed_radius: u32,
    /// n: photons that a kernel has to hold, at least 1. Default 400.
    pub min_photons: u32,
    /// MR: the largest radius of a kernel, 1 to 96 pixels. Default 64.
    pub max_radius: u32,
    /// What a box holds outside the map: VARIKERNEL_EDGES_... Default VARIKERNEL_EDGES_SCALE.
    pub edges: u32,
    /// How a photon's power falls off to the edge: VARIKERNEL_KERNEL_... Default VARIKERNEL_KERNEL_SILVERMAN.
    pub kernel: u32,
    /// 1 if the host brings a depth buffer in place of positions, else 0. Default 0.
    pub from_depth: u32,
    /// How photons become light: VARIKERNEL_ESTIMATE_... Default VARIKERNEL_ESTIMATE_SPLAT.
    pub estimate: u32,
}

const SIZE: usize = size_of::<PlainIrradianceSettings>();

/// Fills `settings` with the defaults. `size` is sizeof(varikernel_irradiance_settings).
///
/// Fails with INVALID_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_irradiance_settings_default(
    settings: *mut PlainIrradianceSettings,
    size: u32,
) -> Status {
    answer(|| {
        check_place(settings, "settings")?;
        check_size("varikernel_irradiance_settings", size, SIZE)?;
        let usual = IrradianceSettings::default();
        let Search { min_photons, max_radius, edges, .. } = usual.radii.search;
        let plain = PlainIrradianceSettings {
            struct_size: size,
            fixed_radius: match usual.radius {
                KernelRadius::Variable => 0,
                KernelRadius::Fixed(radius) => radius,
            },
            min_photons,
            max_radius,
            edges: write_edges(edges),
            kernel: number_of(&KERNELS, usual.kernel),
            from_depth: 0,
            estimate: number_of(&ESTIMATES, usual.estimate),
        };
        // SAFETY: the host gives a pointer to write to.
        unsafe { settings.write(plain) };
        Ok(())
    })
}

fn number_of<T: Copy + PartialEq>(all: &[(u32, T)], choice: T) -> u32 {
    all.iter().find(|(_, known)| *known == choice).expect("each choice has a number").0
}

fn choice_of<T: Copy>(all: &[(u32, T)], name: &'static str, number: u32) -> Result<T, Failure> {
    let known = all.iter().find(|(known, _)| *known == number);
    let reason = || format!("it is one of VARIKERNEL_{}_...", name.to_uppercase());
    known.map(|(_, choice)| *choice).ok_or_else(|| out_of_range(name, number, &reason()))
}

impl PlainIrradianceSettings {
    /// The settings, and whether depth comes in place of positions. Ranges that the library checks are left
    /// to it.
    pub(super) fn read(&self) -> Result<(IrradianceSettings, bool), Failure> {
        check_size("varikernel_irradiance_settings", self.struct_size, SIZE)?;
        let usual = IrradianceSettings::default();
        let search = Search {
            min_photons: self.min_photons,
            max_radius: self.max_radius,
            edges: read_edges(self.edges)?,
            ..usual.radii.search
        };
        let settings = IrradianceSettings {
            radius: match self.fixed_radius {
                0 => KernelRadius::Variable,
                radius => KernelRadius::Fixed(radius),
            },
            radii: Settings { search, ..usual.radii },
            kernel: choice_of(&KERNELS, "kernel", self.kernel)?,
            estimate: choice_of(&ESTIMATES, "estimate", self.estimate)?,
        };
        Ok((settings, flag("from_depth", self.from_depth)?))
    }
}
