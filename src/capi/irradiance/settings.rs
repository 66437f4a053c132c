//! How photons become irradiance, as a plain struct of C.

use super::{Failure, Status, answer, check_place, check_size, flag, out_of_range};
use crate::capi::settings::{read_edges, write_edges};
use crate::settings::{IrradianceSettings, Kernel, KernelRadius, Search, Settings};

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
            kernel: number_of(usual.kernel),
            from_depth: 0,
        };
        // SAFETY: the host gives a pointer to write to.
        unsafe { settings.write(plain) };
        Ok(())
    })
}

fn number_of(kernel: Kernel) -> u32 {
    let of_kernel = KERNELS.into_iter().find(|(_, known)| *known == kernel);
    of_kernel.expect("each kernel has a number").0
}

impl PlainIrradianceSettings {
    /// The settings, and whether depth comes in place of positions. Ranges that the library checks are left
    /// to it.
    pub(super) fn read(&self) -> Result<(IrradianceSettings, bool), Failure> {
        check_size("varikernel_irradiance_settings", self.struct_size, SIZE)?;
        let usual = IrradianceSettings::default();
        let kernel = KERNELS.into_iter().find(|(number, _)| *number == self.kernel).map(|(_, kernel)| kernel);
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
            kernel: kernel
                .ok_or_else(|| out_of_range("kernel", self.kernel, "it is one of VARIKERNEL_KERNEL_..."))?,
            ..usual
        };
        Ok((settings, flag("from_depth", self.from_depth)?))
    }
}
