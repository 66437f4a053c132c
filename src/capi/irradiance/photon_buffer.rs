//! Photons of a host and what they carry together, as plain structs of C.

use std::mem::offset_of;

use super::{Failure, Status, answer, check_place};
use crate::error::Error;
use crate::maps::PhotonTotals;
use crate::photon::PhotonPoint;

/// A photon in a vertex buffer of the host.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlainPhoton {
    /// Where it landed, in scene units.
    pub position: [f32; 3],
    /// Of the surface, of length 1, on the side from which the photon came.
    pub normal: [f32; 3],
    /// Linear RGB: its share of the power of all lights.
    pub power: [f32; 3],
    /// The number of the surface, as normal_texture has it; 1 where surfaces have none.
    pub surface: f32,
}

const _: () = assert!(
    size_of::<PlainPhoton>() == size_of::<PhotonPoint>()
        && offset_of!(PlainPhoton, position) == offset_of!(PhotonPoint, position)
        && offset_of!(PlainPhoton, normal) == offset_of!(PhotonPoint, normal)
        && offset_of!(PlainPhoton, power) == offset_of!(PhotonPoint, power)
        && offset_of!(PlainPhoton, surface) == offset_of!(PhotonPoint, surface)
);

/// What photons carry together, or more: an upper bound will do, and costs a bit of exactness for each
/// doubling.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PlainPhotonTotals {
    /// The sum of their power, linear RGB: finite and not negative.
    pub power: [f64; 3],
    /// The sum of (red + green + blue)^2 of each photon's power: finite and not negative.
    pub squares: f64,
}

impl PlainPhotonTotals {
    /// Those of `count` photons.
    pub(super) fn read(&self, count: u32) -> Result<PhotonTotals, Failure> {
        let Self { power: [red, green, blue], squares } = *self;
        for (name, value) in [
            ("photon_totals.power[0]", red),
            ("photon_totals.power[1]", green),
            ("photon_totals.power[2]", blue),
            ("photon_totals.squares", squares),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                let reason = "it is finite and not negative".to_owned();
                return Err(Error::Setting { name, value: value.to_string(), reason }.into());
            }
        }
        Ok(PhotonTotals { count: count.into(), power: self.power, squares })
    }
}

/// Adds up what photons carry together, for hosts that have them in memory as well: no OpenGL is called.
/// `photons` may be null if `count` is 0.
///
/// Fails with INVALID_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn varikernel_photon_totals_of(
    photons: *const PlainPhoton,
    count: u32,
    totals: *mut PlainPhotonTotals,
) -> Status {
    answer(|| {
        check_place(totals, "totals")?;
        let photons = if count == 0 {
            &[]
        } else {
            check_place(photons.cast_mut(), "photons")?;
            // SAFETY: the host gives `count` photons, which have the layout of ours.
            unsafe { std::slice::from_raw_parts(photons.cast::<PhotonPoint>(), count as usize) }
        };
        let PhotonTotals { power, squares, .. } = PhotonTotals::of(photons);
        // SAFETY: the host gives a pointer to write to.
        unsafe { totals.write(PlainPhotonTotals { power, squares }) };
        Ok(())
    })
}
