//! Photons for a picture: traced in parts, those that may be seen uploaded, all kept where mirrors or glass
//! need them.

use super::Progress;
use super::landed::{Landed, Wanted};
use crate::error::Result;
use crate::gl::Gl;
use crate::maps::PhotonPoints;
use crate::photon::{Emission, FirstHit, Photon, PhotonPoint, Tally, trace_from_hits, trace_in_batches};
use crate::render::bounce_map::BounceMaps;
use crate::scene::Scene;
use crate::settings::FirstBounce;
use crate::view::View;

/// Photons that are uploaded at once.
const UPLOAD: usize = 1 << 20;

/// Photons, where they are needed.
#[derive(Debug)]
pub(super) struct Traced {
    pub(super) emitted: u32,
    pub(super) landings: u64,
    /// Share of the photons' power that would have gone on where they were followed no further.
    pub(super) cut_off_share: f64,
    /// Those that may be seen, on the GPU.
    pub(super) points: PhotonPoints,
    /// All of them, if mirrors or glass show places outside of the picture.
    pub(super) landed: Option<Landed>,
}

impl Traced {
    /// Traces photons; those of direct light are left out. All are kept only for what is seen `through`
    /// mirrors and glass.
    pub(super) fn new(
        gl: &Gl,
        scene: &Scene,
        view: &View,
        emission: &Emission<'_>,
        through: Option<Wanted>,
        first_bounce: FirstBounce,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Self> {
        let trace = emission.settings();
        let (mut seen, mut all) = (Vec::new(), Vec::new());
        let mut points = PhotonPoints::new(gl);
        let mut keep = |photons: &[Photon], points: &mut PhotonPoints| {
            for photon in photons.iter().filter(|photon| !photon.is_direct()) {
                let point = PhotonPoint::new(photon);
                if through.is_some() {
                    all.push(point);
                }
                if point.may_be_seen(view) {
                    seen.push(point);
                }
            }
            if seen.len() >= UPLOAD {
                points.upload(&seen[..UPLOAD])?;
                seen.drain(..UPLOAD);
            }
            Ok(())
        };
        let mut show = |followed: u32| {
            progress(Progress { stage: "photons", done: f64::from(followed) / f64::from(trace.photons) });
        };
        let tally = match first_bounce {
            FirstBounce::Rays => trace_in_batches(scene, emission, |photons, followed| {
                keep(photons, &mut points)?;
                show(followed);
                Ok::<_, crate::error::Error>(())
            })?,
            FirstBounce::Maps => {
                let mut maps = BounceMaps::new(gl, scene)?;
                let (mut all, mut followed) = (Tally::default(), 0);
                while let Some(hits) = maps.next_hits(emission, followed)? {
                    let (photons, tally) = trace_from_hits(scene, trace, &hits);
                    keep(&photons, &mut points)?;
                    all.merge(&tally);
                    followed +=
                        u32::try_from(hits.len()).unwrap_or_else(|_| unreachable!("a part of the photons"));
                    show(followed);
                }
                all
            }
        };
        points.upload(&seen)?;
        let landed = through.map(|wanted| Landed::new(&all, wanted));
        let cut_off_share =
            tally.power_cut_off().element_sum() / tally.power_emitted().element_sum().max(f64::MIN_POSITIVE);
        Ok(Self { emitted: trace.photons, landings: tally.total(), cut_off_share, points, landed })
    }
}

/// All photons of an emission, leaving from some places on the lights, with what they meet first as bounce
/// maps tell it (thesis 2.6.1); for [`trace_from_hits`].
///
/// # Errors
/// [`Error::Shader`](crate::Error::Shader); [`Error::Gl`](crate::Error::Gl) if the driver fails.
pub fn first_hits(gl: &Gl, scene: &Scene, emission: &Emission<'_>) -> Result<Vec<FirstHit>> {
    let mut maps = BounceMaps::new(gl, scene)?;
    let (mut all, mut followed) = (Vec::new(), 0);
    while let Some(hits) = maps.next_hits(emission, followed)? {
        followed += u32::try_from(hits.len()).unwrap_or_else(|_| unreachable!("a part of the photons"));
        all.extend(hits);
    }
    Ok(all)
}
