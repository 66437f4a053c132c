//! The first bounce from maps against rays: primitive by primitive, and as a distribution.

use varikernel::photon::{Emission, FirstHit, Landings, TraceSettings, trace, trace_from_hits};
use varikernel::render::{Renderer, first_hits};
use varikernel::scene::{Ray, Scene};
use varikernel::settings::{FirstBounce, Kernel, KernelRadius, PictureSettings};

use crate::stage::settings;
use crate::support::egl;

const PHOTONS: u32 = 60_000;

fn trace_settings(seed: u64) -> TraceSettings {
    TraceSettings { photons: PHOTONS, bounces: Some(3), seed, ..TraceSettings::default() }
}

fn ray_of(hit: &FirstHit) -> Ray {
    let direction = hit.photon.direction.as_dvec3().normalize();
    Ray { origin: hit.photon.origin.as_dvec3(), direction }
}

#[test]
fn maps_tell_the_primitive_that_a_ray_meets() {
    let gl = egl();
    for name in Scene::shipped_names() {
        let scene = Scene::shipped(name).unwrap();
        let emission = Emission::new(&scene, &trace_settings(1)).unwrap();
        let hits = first_hits(&gl, &scene, &emission).unwrap();
        assert_eq!(hits.len(), PHOTONS as usize);
        let wrong = |hits: &[FirstHit]| {
            let is_wrong = |hit: &&FirstHit| {
                let ray = ray_of(hit);
                let met = scene.cast(&ray).map_or(u32::MAX, |hit| hit.primitive);
                // Where the map is wrong and the ray misses its primitive, the ray decides.
                met != hit.primitive && scene.cast_at(&ray, hit.primitive).is_some()
            };
            hits.iter().step_by(4).filter(is_wrong).count()
        };
        let share = |wrong: usize| f64::from(u32::try_from(wrong).unwrap()) / f64::from(PHOTONS / 4);
        let found = share(wrong(&hits));
        // Thin things are edges for the most part.
        let most = if name == "thin-things" { 0.01 } else { 0.005 };
        assert!(found < most, "{name}: {found}");
        let cast: usize = hits.iter().filter(|hit| hit.primitive == u32::MAX).count();
        assert!(cast < hits.len() / 2, "{name}: the maps tell most, {cast} are cast");
    }
}

/// How many standard errors the shares of two runs are apart at most, beside a thousandth for the number of
/// places.
fn worst(found: &Landings, expected: &Landings) -> f64 {
    let mut worst = 0.0_f64;
    for (found, expected) in found.landings.iter().zip(&expected.landings) {
        for (surface, &share) in expected {
            let error = (2.0 * share * (1.0 - share) / f64::from(PHOTONS)).sqrt().max(1e-4);
            worst = worst.max(((found[surface] - share).abs() - 1e-3) / error);
        }
    }
    worst
}

#[test]
fn landings_by_bounce_and_surface_are_those_of_rays_alone() {
    let gl = egl();
    for name in ["cornell-boxes", "cornell-glass"] {
        let scene = Scene::shipped(name).unwrap();
        let other = Emission::new(&scene, &trace_settings(2)).unwrap();
        let expected = trace(&scene, &other).1.landings(&scene, &other);
        let settings = trace_settings(1);
        let emission = Emission::new(&scene, &settings).unwrap();
        let mut hits = first_hits(&gl, &scene, &emission).unwrap();
        let landings =
            |hits: &[FirstHit]| trace_from_hits(&scene, &settings, hits).1.landings(&scene, &emission);
        let found = worst(&landings(&hits), &expected);
        assert!(found < 4.5, "{name}: {found} standard errors");

        // Photons that fall through the tall box are seen.
        let geometry = scene.geometry();
        let of = |wanted: &str| {
            let is = |triangle: &varikernel::scene::Triangle| {
                geometry.surfaces[triangle.surface as usize] == wanted
            };
            let numbered = (0_u32..).zip(&geometry.triangles);
            numbered.filter(|(_, triangle)| is(triangle)).map(|(index, _)| index).collect::<Vec<_>>()
        };
        let (tall, floor) = (of("tall"), of("floor"));
        for hit in hits.iter_mut().filter(|hit| tall.contains(&hit.primitive)) {
            let ray = ray_of(hit);
            let below = floor.iter().find(|&&primitive| scene.cast_at(&ray, primitive).is_some());
            hit.primitive = below.copied().unwrap_or(hit.primitive);
        }
        let planted = worst(&landings(&hits), &expected);
        assert!(planted > 10.0, "{name}: {planted} standard errors");
    }
}

#[test]
fn a_picture_can_be_made_from_maps() {
    let gl = egl();
    let scene = Scene::shipped("cornell-glass").unwrap();
    let settings = PictureSettings {
        first_bounce: FirstBounce::Maps,
        ..settings(32, Kernel::Silverman, KernelRadius::Variable)
    };
    let trace = TraceSettings { photons: 5_000, ..TraceSettings::default() };
    let mut renderer = Renderer::new(&gl, &scene, &settings, &trace, &mut |_| ()).unwrap();
    let (_, account) = renderer.picture(&settings).unwrap();
    assert!(account.contributing > 5_000 && account.energy_error() < 1e-4, "{account:?}");
}
