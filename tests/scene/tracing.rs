//! Photons depend on their seed, and on nothing else.

use bytemuck::cast_slice;
use rayon::ThreadPoolBuilder;
use varikernel::photon::{
    Emission, EmittedPhoton, FirstHit, Photon, TraceSettings, trace, trace_from, trace_from_hits,
};
use varikernel::scene::{Ray, Scene};

use crate::{BARE, load, settings, shipped_text, traced};

fn bytes(photons: &[Photon]) -> &[u8] {
    cast_slice(photons)
}

#[test]
fn threads_change_no_bit() {
    let scene = Scene::shipped("cornell-glass").unwrap();
    let settings = settings(70_001);
    let emission = Emission::new(&scene, &settings).unwrap();
    let on = |threads| {
        ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| trace(&scene, &emission))
    };
    let (photons, tally) = on(1);
    assert!(photons.len() > 200_000);
    for threads in [2, 5] {
        let (others, other_tally) = on(threads);
        assert!(bytes(&others) == bytes(&photons), "{threads} threads");
        assert_eq!(other_tally, tally, "{threads} threads");
        assert_eq!(other_tally.landings(&scene, &emission), tally.landings(&scene, &emission));
    }
}

#[test]
fn the_seed_decides_all() {
    let scene = Scene::shipped("cornell-glass").unwrap();
    let of_seed = |seed| traced(&scene, &TraceSettings { seed, ..settings(2000) }).0;
    assert!(bytes(&of_seed(7)) == bytes(&of_seed(7)));
    let (seven, eight) = (of_seed(7), of_seed(8));
    let same = seven.iter().filter(|photon| eight.contains(photon)).count();
    assert_eq!(same, 0, "of {} landings", seven.len());
}

#[test]
fn starts_and_first_hits_from_elsewhere_give_the_same_photons() {
    let scene = Scene::shipped("cornell-glass").unwrap();
    let settings = settings(20_000);
    let emission = Emission::new(&scene, &settings).unwrap();
    let expected = trace(&scene, &emission);
    let starts: Vec<EmittedPhoton> = (0..settings.photons).map(|id| emission.photon(id)).collect();
    assert_eq!(trace_from(&scene, &settings, &starts), expected);

    let hits: Vec<_> = starts
        .iter()
        .map(|&photon| {
            let ray =
                Ray { origin: photon.origin.as_dvec3(), direction: photon.direction.as_dvec3().normalize() };
            FirstHit { photon, primitive: scene.cast(&ray).map_or(u32::MAX, |hit| hit.primitive) }
        })
        .collect();
    assert_eq!(trace_from_hits(&scene, &settings, &hits), expected);
}

#[test]
fn batches_hold_every_landing_once_and_in_order() {
    let scene = Scene::shipped("cornell-empty").unwrap();
    let (photons, tally) = traced(&scene, &settings(100_000));
    assert_eq!(photons.len() as u64, tally.total());
    let ends = tally.ends;
    assert_eq!(ends.left + ends.absorbed + ends.bounces_used + ends.given_up, 100_000);
    let mut before = None;
    for photon in &photons {
        assert!(photon.bounce == 0 || before == Some(photon.bounce - 1), "a way without gaps");
        before = Some(photon.bounce);
    }
}

#[test]
fn photons_together_carry_the_power_of_all_lights() {
    let text = shipped_text("cornell_empty.toml")
        + "\n[lights.bulb]\npoint = [100, 300, 100]\nintensity = [2e4, 1e4, 3e4]\n\
           [lights.torch]\npoint = [300, 100, 300]\nintensity = [5e4, 5e4, 0]\ndirection = [0, 1, 1]\n\
           angle_degrees = 30\n\
           [materials.glow]\nlambert = [0, 0, 0]\nemission = [1, 2, 3]\n\
           [surfaces.panel]\nmaterial = \"glow\"\n\
           quads = [[[500, 100, 100], [500, 100, 200], [500, 300, 200], [500, 300, 100]]]\n";
    let scene = load(&text).unwrap();
    let settings = settings(10_007);
    let emission = Emission::new(&scene, &settings).unwrap();
    let mut sum = glam::DVec3::ZERO;
    for id in 0..settings.photons {
        sum += emission.photon(id).power.as_dvec3();
    }
    // By hand: π · 130 · 105 · radiance, 4π · intensity, 2π (1 - cos 30°) · intensity, π · 100 · 200 ·
    // emission.
    let pi = std::f64::consts::PI;
    let cone = 2.0 * pi * (1.0 - 0.75_f64.sqrt());
    let red = pi * 13650.0 * 17.0 + 4.0 * pi * 2e4 + cone * 5e4 + pi * 2e4;
    let blue = pi * 13650.0 * 4.0 + 4.0 * pi * 3e4 + pi * 6e4;
    for (found, by_hand) in [(emission.flux().x, red), (emission.flux().z, blue), (sum.x, red), (sum.z, blue)]
    {
        assert!((found / by_hand - 1.0).abs() < 1e-5, "{found}, by hand {by_hand}");
    }
    assert_eq!(scene.lights().len(), 4);
}

#[test]
fn starts_are_even_on_the_lamp_and_follow_lambert() {
    let scene = Scene::shipped("cornell-empty").unwrap();
    let settings = settings(10_000);
    let emission = Emission::new(&scene, &settings).unwrap();
    let mut cells = [[0_u32; 5]; 5];
    let mut cosines = 0.0;
    for id in 0..settings.photons {
        let EmittedPhoton { origin, direction, .. } = emission.photon(id);
        assert!((origin.y - 548.3).abs() < 1e-3 && direction.y < 0.0 && direction.is_normalized());
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 4")]
        let cell = |at: f32, begin: f32, side: f32| (((at - begin) / side * 5.0) as usize).min(4);
        cells[cell(origin.x, 213.0, 130.0)][cell(origin.z, 227.0, 105.0)] += 1;
        cosines += f64::from(-direction.y);
    }
    // 400 each, with a deviation of 20 if they were not stratified.
    for count in cells.iter().flatten() {
        assert!(count.abs_diff(400) < 25, "{cells:?}");
    }
    // The mean cosine by Lambert's law is 2/3, with a deviation of √(1/18).
    assert!((cosines / 10_000.0 - 2.0 / 3.0).abs() < 4.0 * (1.0 / 18.0_f64).sqrt() / 100.0);
}

#[test]
fn russian_roulette_has_the_same_mean() {
    let scene = Scene::shipped("cornell-boxes").unwrap();
    let plain = TraceSettings { bounces: Some(8), ..settings(100_000) };
    let roulette = TraceSettings { russian_roulette: true, ..plain };
    let flux = |settings: &TraceSettings| {
        let (photons, tally) = traced(&scene, settings);
        (photons.len(), tally.landings(&scene, &Emission::new(&scene, settings).unwrap()).flux)
    };
    let ((many, expected), (fewer, found)) = (flux(&plain), flux(&roulette));
    assert!(fewer < many * 2 / 3, "{fewer} of {many}");
    for (bounce, (expected, found)) in expected.iter().zip(&found).enumerate() {
        for (expected, found) in expected.iter().zip(found) {
            // A share s of 10^5 photons, each with 1 or less: at most √(s / 10^5) on each side.
            let deviation = (2.0 * expected / 1e5).sqrt();
            assert!((expected - found).abs() < 4.0 * deviation, "bounce {bounce}: {found}, not {expected}");
        }
    }
}

#[test]
fn black_surfaces_end_the_way_and_never_divide_by_zero() {
    let floor = "\n[surfaces.floor]\nmaterial = \"black\"\n\
                 quads = [[[-9, 0, -9], [-9, 0, 9], [9, 0, 9], [9, 0, -9]]]";
    let scene = load(&format!("{BARE}black = {{ lambert = [0, 0, 0] }}{floor}")).unwrap();
    for russian_roulette in [false, true] {
        let (photons, tally) = traced(&scene, &TraceSettings { russian_roulette, ..settings(1000) });
        assert!(
            photons.len() > 100
                && photons.iter().all(|photon| photon.bounce == 0 && photon.power.is_finite())
        );
        assert_eq!(tally.ends.absorbed, photons.len() as u64);
    }
}

#[test]
fn settings_and_lights_that_can_not_be_are_refused() {
    let scene = Scene::shipped("cornell-empty").unwrap();
    let message = |scene: &Scene, settings| Emission::new(scene, &settings).unwrap_err().to_string();
    assert!(message(&scene, settings(0)).contains("photons = 0 is not possible"));
    let no_bounces = TraceSettings { bounces: Some(0), ..settings(1) };
    assert!(message(&scene, no_bounces).contains("bounces = 0 is not possible"));
    let dark = load(&shipped_text("cornell_empty.toml").replace("[17.0, 12.0, 4.0]", "[0, 0, 0]")).unwrap();
    assert!(message(&dark, settings(10)).contains("no light of the scene shines"));
    let blinding =
        load(&shipped_text("cornell_empty.toml").replace("[17.0, 12.0, 4.0]", "[3e38, 0, 0]")).unwrap();
    assert!(message(&blinding, settings(10)).contains("brighter than f32"));
}
