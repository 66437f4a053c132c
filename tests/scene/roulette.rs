//! How the ways of photons end where no number of landings is asked for.

use varikernel::glam::{DVec3, Vec3};
use varikernel::photon::{MAX_BOUNCES, MAX_SPECULAR, ROULETTE_AFTER, TraceSettings};
use varikernel::scene::Scene;

use crate::{load, settings, traced};

/// A closed cube around a lamp, where light is 1 / (1 - reflectance) of what is emitted.
fn room(material: &str) -> Scene {
    let text = format!(
        "
[camera]
position = [0, 0, 0]
direction = [0, 0, -1]
up = [0, 1, 0]
vertical_fov_degrees = 60
[lights.lamp]
point = [0.1, 0.2, 0.3]
intensity = [1, 2, 3]
[materials]
inside = {{ {material} }}
[surfaces.room]
material = \"inside\"
quads = [
  [[-1, -1, -1], [-1, -1, 1], [-1, 1, 1], [-1, 1, -1]],
  [[1, -1, -1], [1, -1, 1], [1, 1, 1], [1, 1, -1]],
  [[-1, -1, -1], [-1, -1, 1], [1, -1, 1], [1, -1, -1]],
  [[-1, 1, -1], [-1, 1, 1], [1, 1, 1], [1, 1, -1]],
  [[-1, -1, -1], [-1, 1, -1], [1, 1, -1], [1, -1, -1]],
  [[-1, -1, 1], [-1, 1, 1], [1, 1, 1], [1, -1, 1]],
]
"
    );
    load(&text).unwrap()
}

#[test]
fn all_light_of_a_closed_room_is_there() {
    for reflectance in [0.5_f64, 0.9, 0.97, 0.99] {
        let photons = 10_000;
        let scene = room(&format!("lambert = [{reflectance}, {reflectance}, {reflectance}]"));
        let (landings, tally) = traced(&scene, &settings(photons));
        let light: DVec3 = landings.iter().map(|photon| photon.power.as_dvec3()).sum();
        let found = light / tally.power_emitted();
        let expected = 1.0 / (1.0 - reflectance);
        // The number of landings by roulette has about its mean as its deviation.
        let deviation = expected / f64::from(photons).sqrt();
        assert!((found - expected).abs().max_element() < 4.0 * deviation, "{reflectance}: {found}");
        let cut_off = (tally.power_cut_off() / tally.power_emitted()).max_element();
        assert!(cut_off < 1e-3, "{reflectance}: {cut_off}");
        // Eight landings of every photon, and then what roulette leaves.
        let most = f64::from(photons) * (f64::from(ROULETTE_AFTER) + expected);
        assert!((landings.len() as f64) < 1.05 * most, "{reflectance}: {} landings", landings.len());
    }
}

#[test]
fn light_that_nothing_absorbs_is_cut_off_and_told() {
    let (landings, tally) = traced(&room("lambert = [1, 1, 1]"), &settings(50));
    assert_eq!((landings.len(), tally.ends.bounces_used), (50 * MAX_BOUNCES as usize, 50));
    assert!((tally.power_cut_off() / tally.power_emitted() - 1.0).abs().max_element() < 1e-4);

    let (landings, tally) = traced(&room("mirror = [1, 1, 0.99]"), &settings(50));
    assert_eq!((landings.len(), tally.ends.given_up), (0, 50));
    let share = tally.power_cut_off() / tally.power_emitted();
    let blue = 0.99_f64.powf(f64::from(MAX_SPECULAR));
    assert!((share - DVec3::new(1.0, 1.0, blue)).abs().max_element() < 1e-4, "{share}");
}

#[test]
fn before_roulette_begins_photons_are_those_that_are_then_cut_off() {
    for name in ["cornell-boxes", "cornell-glass"] {
        let scene = Scene::shipped(name).unwrap();
        let (all, _) = traced(&scene, &settings(20_000));
        let cut_off = TraceSettings { bounces: Some(ROULETTE_AFTER), ..settings(20_000) };
        let (first, _) = traced(&scene, &cut_off);
        let of_all: Vec<_> = all.iter().copied().filter(|photon| photon.bounce < ROULETTE_AFTER).collect();
        assert!(of_all == first, "{name}");
        let more = all.len() as f64 / first.len() as f64;
        assert!((1.005..1.02).contains(&more), "{name}: {more} times the landings");
    }
}

#[test]
fn roulette_keeps_the_light_of_each_colour_and_evens_out_powers() {
    let scene = Scene::shipped("cornell-boxes").unwrap();
    let (by_roulette, tally) = traced(&scene, &settings(200_000));
    let (followed, other) = traced(&scene, &TraceSettings { bounces: Some(100), ..settings(200_000) });
    assert!(other.power_cut_off().max_element() < 1e-9 * other.power_emitted().max_element());
    assert_eq!((tally.power_cut_off(), tally.ends.bounces_used), (DVec3::ZERO, 0));

    let late = |photons: &[varikernel::photon::Photon]| -> DVec3 {
        let late = photons.iter().filter(|photon| photon.bounce >= ROULETTE_AFTER);
        late.map(|photon| photon.power.as_dvec3()).sum()
    };
    let (found, expected) = (late(&by_roulette), late(&followed));
    // A few thousand photons of about the same power go on, for some landings each.
    assert!((found / expected - 1.0).abs().max_element() < 0.1, "{found}, not {expected}");
    assert!((late(&by_roulette[..by_roulette.len() / 2]) / expected).max_element() < 0.6, "is seen");

    let most = by_roulette[0].power.max_element();
    let of_late = by_roulette.iter().filter(|photon| photon.bounce >= ROULETTE_AFTER);
    let largest: Vec<f32> = of_late.map(|photon| photon.power.max_element() / most).collect();
    assert!(largest.iter().all(|share| (0.2499..=1.0001).contains(share)));
    assert!(by_roulette.iter().all(|photon| photon.power.cmple(Vec3::splat(1.0001 * most)).all()));
}
