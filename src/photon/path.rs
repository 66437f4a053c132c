//! The way of one photon through the scene.

use glam::{DVec3, Vec3};

use super::direction::cosine_around;
use super::random::{Purpose, Stream};
use super::roulette::{MAX_BOUNCES, survives};
use super::scatter::{mirrored, reflected_by_pane, refract};
use super::{EmittedPhoton, Photon, Tally, TraceSettings};
use crate::scene::{Hit, Ray, Scattering, Scene};

/// How often in a row a photon may meet mirrors and glass before it is given up.
pub const MAX_SPECULAR: u32 = 256;

/// Follows one photon to its end.
///
/// It lands on diffuse surfaces alone, and every landing is kept; it goes on by Lambert's law with its power
/// times the reflectance. Mirrors and glass pass it on without a landing.
pub(super) fn follow(
    scene: &Scene,
    settings: &TraceSettings,
    emitted: &EmittedPhoton,
    first_primitive: Option<u32>,
    landings: &mut Vec<Photon>,
    tally: &mut Tally,
) {
    tally.leaves(emitted.power);
    let mut random = Stream::new(settings.seed, emitted.id, Purpose::Bounces);
    let origin = emitted.origin.as_dvec3();
    let mut ray = Ray { origin, direction: emitted.direction.as_dvec3().normalize() };
    let mut power = emitted.power;
    let most = settings.bounces.unwrap_or(MAX_BOUNCES);
    let (mut bounce, mut specular, mut through_glass) = (0, 0, false);
    let mut known = first_primitive;
    loop {
        let known_hit = known.take().and_then(|primitive| scene.cast_at(&ray, primitive));
        let Some(hit) = known_hit.or_else(|| scene.cast(&ray)) else {
            tally.ends.left += 1;
            return;
        };
        // The side from which the photon comes.
        let side = if hit.normal.dot(ray.direction) <= 0.0 { 1.0 } else { -1.0 };
        let facing = side * hit.normal;
        let (direction, onward) = match scene.scattering(&hit) {
            Scattering::Lambert(reflectance) => {
                let photon = Photon {
                    position: hit.position.as_vec3(),
                    incoming: ray.direction.as_vec3(),
                    power,
                    normal: facing.as_vec3(),
                    bounce,
                    surface: hit.surface,
                    through_glass: u32::from(through_glass),
                    from_specular: u32::from(specular > 0),
                };
                landings.push(photon);
                tally.add(&photon);
                (bounce, specular) = (bounce + 1, 0);
                if bounce == most {
                    tally.cut_off(power * reflectance);
                    return;
                }
                if !survives(settings, bounce, reflectance, emitted.power, &mut power, &mut random) {
                    tally.ends.absorbed += 1;
                    return;
                }
                (cosine_around(facing, &mut random), facing)
            }
            Scattering::Mirror(reflectance) => {
                power *= reflectance;
                if power == Vec3::ZERO {
                    tally.ends.absorbed += 1;
                    return;
                }
                specular += 1;
                (mirrored(&ray, &hit, side), facing)
            }
            Scattering::Dielectric { index } => {
                specular += 1;
                let ratio = if side > 0.0 { 1.0 / f64::from(index) } else { f64::from(index) };
                match refracted(&ray, &hit, side, ratio, &mut random) {
                    Some(direction) => {
                        through_glass = true;
                        (direction, -facing)
                    }
                    None => (mirrored(&ray, &hit, side), facing),
                }
            }
            Scattering::ThinDielectric { index, transmittance } => {
                specular += 1;
                let reflected = reflected_by_pane(ray.direction.dot(hit.normal).abs(), index);
                if random.number() < reflected {
                    (mirrored(&ray, &hit, side), facing)
                } else {
                    power *= transmittance;
                    if power == Vec3::ZERO {
                        tally.ends.absorbed += 1;
                        return;
                    }
                    through_glass = true;
                    (ray.direction, -facing)
                }
            }
        };
        if specular == MAX_SPECULAR {
            tally.give_up(power);
            return;
        }
        ray = Ray { origin: scene.start(hit.position, onward), direction };
    }
}

/// The direction behind glass, or nothing by chance for Fresnel's share, and where all light is reflected.
fn refracted(ray: &Ray, hit: &Hit, side: f64, ratio: f64, random: &mut Stream) -> Option<DVec3> {
    let smooth = side * hit.smooth_normal;
    // Seen from behind at grazing angles, where the smooth surface would not be met from this side.
    let normal = if smooth.dot(ray.direction) < 0.0 { smooth } else { side * hit.normal };
    let (direction, reflected) = refract(ray.direction, normal, ratio)?;
    let passes = random.number() >= reflected && side * direction.dot(hit.normal) < 0.0;
    passes.then_some(direction)
}
