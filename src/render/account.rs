//! An account of a picture's photons and their energy.

use glam::{DVec3, Vec3};

use super::Renderer;
use crate::error::Result;
use crate::image::Image;
use crate::view::View;

/// Energy and numbers of one picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Account {
    /// Photons that were emitted.
    pub emitted: u32,
    /// Their diffuse landings.
    pub landings: u64,
    /// Landings inside of the frame that face the camera and are not direct light: these were uploaded.
    pub uploaded: u64,
    /// Those that contribute: visible on the surface that their pixel shows.
    pub contributing: u64,
    /// Power of the contributing photons, linear RGB.
    pub power_in: [f64; 3],
    /// Irradiance times area, summed over the picture.
    pub power_out: [f64; 3],
    /// Fragments that the splat drew; photons that the gather found.
    pub fragments: f64,
    /// Share of the photons' power, its three colours added up, that would have gone on where they were
    /// followed no further: light that the picture lacks, and what it would have brought at further landings.
    /// 0 for photons that the caller traced.
    pub cut_off_share: f64,
    /// Share of pixels on diffuse surfaces whose search MR ended; 0 with a fixed radius, which asks for no
    /// search.
    pub limited_share: f64,
}

impl Account {
    /// By how much power out differs from power in, over power in: the worst of the three colours.
    ///
    /// Both are sums of blending in f32. Power in is one sum for each pixel, which of N alike photons on a
    /// pixel is off by up to N 2^-25 of itself; power out is summed more closely. So where a pixel holds 10^5
    /// photons or more, a larger error may be that of power in.
    #[must_use]
    pub fn energy_error(&self) -> f64 {
        let pairs = self.power_in.iter().zip(self.power_out);
        pairs
            .map(|(&into, out)| if into > 0.0 { ((out - into) / into).abs() } else { out.abs() })
            .fold(0.0, f64::max)
    }
}

impl Renderer {
    /// The account of the photons that were counted, and of the light that they gave.
    pub(super) fn account_of(
        &self,
        position: &Image<[f32; 4]>,
        normal: &Image<[f32; 4]>,
        irradiance: &Image<[f32; 4]>,
        limited: &Image<u8>,
    ) -> Result<Account> {
        let counts = self.pipeline.density_stage().read_counts()?;
        let power = self.read_power()?;
        let view = self.surfaces.view();
        let (mut contributing, mut fragments) = (0.0, 0.0);
        let (mut power_in, mut power_out) = (DVec3::ZERO, DVec3::ZERO);
        let (mut diffuse, mut ended) = (0_u32, 0_u32);
        for (index, &power) in power.values().iter().enumerate() {
            contributing += f64::from(counts.values()[index]);
            power_in += DVec3::from_array(power);
            let [red, green, blue, drawn] = irradiance.values()[index].map(f64::from);
            fragments += drawn;
            if normal.values()[index][3] > 0.0 {
                let area = pixel_area(view, position.values()[index], normal.values()[index]);
                power_out += area * DVec3::new(red, green, blue);
                diffuse += 1;
                ended += u32::from(limited.values()[index]);
            }
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a sum of counts")]
        let contributing = contributing as u64;
        Ok(Account {
            emitted: self.traced.emitted,
            landings: self.traced.landings,
            uploaded: self.traced.points.count(),
            contributing,
            power_in: power_in.to_array(),
            power_out: power_out.to_array(),
            fragments,
            cut_off_share: self.traced.cut_off_share,
            limited_share: f64::from(ended) / f64::from(diffuse.max(1)),
        })
    }
}

impl Renderer {
    /// Power of each pixel's photons, linear RGB.
    fn read_power(&self) -> Result<Image<[f64; 3]>> {
        match (self.pipeline.flux(), self.pipeline.power()) {
            (Some(flux), _) => flux.read(),
            (None, Some(power)) => {
                Ok(power.read()?.map(|[red, green, blue, _]| [red, green, blue].map(f64::from)))
            }
            (None, None) => unreachable!("power is added up in one way or the other"),
        }
    }
}

/// Area that a pixel covers on its surface, in square scene units; as `area_on` in `common/surfaces.glsl`.
pub(super) fn pixel_area(view: &View, position: [f32; 4], normal: [f32; 4]) -> f64 {
    let at = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z).as_dvec3();
    let depth = f64::from(position[3]);
    let sight = at(position) - view.position().as_dvec3();
    let slant = at(normal).dot(sight).abs().max(1e-3 * sight.length());
    f64::from(view.pixel_side()).powi(2) * depth.powi(3) / slant
}
