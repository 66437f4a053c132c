//! The same photons in another order.

use glam::UVec2;
use rand::SeedableRng as _;
use rand::seq::SliceRandom as _;
use rand_pcg::Pcg64;

use super::row::{Row, Verdict};
use varikernel::error::Result;
use varikernel::gl::Gl;
use varikernel::photon::{Emission, PhotonPoint, TraceSettings, trace};
use varikernel::render::{Layers, Renderer};
use varikernel::scene::Scene;
use varikernel::settings::PictureSettings;

/// Density, radii and splats of photons, as traced and shuffled.
pub(super) fn rows(gl: &Gl) -> Result<Vec<Row>> {
    let scene = Scene::shipped("cornell-glass")?;
    let emission = Emission::new(&scene, &TraceSettings { photons: 5_000, ..TraceSettings::default() })?;
    let (photons, _) = trace(&scene, &emission);
    let photons: Vec<_> = photons.iter().filter(|photon| !photon.is_direct()).map(PhotonPoint::new).collect();
    let mut shuffled = photons.clone();
    shuffled.shuffle(&mut Pcg64::seed_from_u64(1));
    let settings = PictureSettings { size: UVec2::splat(64), light_samples: 1, ..PictureSettings::default() };
    let picture = |photons: &[PhotonPoint]| -> Result<Layers> {
        Ok(Renderer::with_photons(gl, &scene, &settings, photons)?.picture(&settings)?.0)
    };
    let (first, second) = (picture(&photons)?, picture(&shuffled)?);
    let of = first.density.values().len() as u64;
    let unlike = |differ: &dyn Fn(usize) -> bool| {
        (0..first.density.values().len()).filter(|&pixel| differ(pixel)).count() as u64
    };
    let counts =
        unlike(&|pixel| first.density.values()[pixel].to_bits() != second.density.values()[pixel].to_bits());
    let radii = unlike(&|pixel| first.radius.values()[pixel] != second.radius.values()[pixel]);
    let mut largest = 0.0_f64;
    for (first, second) in
        first.irradiance.values().iter().flatten().zip(second.irradiance.values().iter().flatten())
    {
        let (first, second) = (f64::from(*first), f64::from(*second));
        largest = largest.max((first - second).abs() / first.abs().max(f64::from(f32::MIN_POSITIVE)));
    }
    let bits = |layers: &Layers, pixel: usize| layers.irradiance.values()[pixel].map(f32::to_bits);
    let sums = unlike(&|pixel| bits(&first, pixel) != bits(&second, pixel));
    let row = |id: &str, wrong: u64, promise: Option<&str>| {
        let verdict = promise.map_or(Verdict::Information, |_| Verdict::kept_if(wrong == 0));
        let promises: Vec<&str> = promise.into_iter().collect();
        Row {
            total: Some(photons.len() as u64),
            wrong: Some(wrong),
            of: Some(of),
            ..Row::new(id, &promises, verdict)
        }
    };
    Ok(vec![
        row("order/density", counts, Some("order-of-photons")),
        row("order/radius", radii, Some("order-of-photons")),
        Row {
            largest_error: Some(largest),
            note: "sums of kernels are rounded, so their last bits depend on the order".to_owned(),
            ..row("order/splat", sums, None)
        },
    ])
}
