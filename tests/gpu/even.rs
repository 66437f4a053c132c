//! Radii by the rule of even density: equal to the definition, pixel for pixel.

use glam::UVec2;
use varikernel::gl::TextureFormat;
use varikernel::settings::{Edges, IrradianceSettings, MAX_EVEN_RADIUS, Method, Order, Rule, Settings};
use varikernel::{
    Changed, CountBounds, Error, Frame, Gl, Image, IrradiancePipeline, Mask, RadiusPipeline, reference,
};

use crate::frames::{read, upload};
use crate::support::{
    Random, assert_same, each, egl, on_gpu, planned, random_map, search, sparse_map, spike,
};

/// The rule with the limited pixels.
pub(crate) fn even(max_radius: u32, edges: Edges) -> Settings {
    Settings {
        rule: Rule::Even,
        search: search(1, max_radius, edges),
        limited_mask: true,
        ..Settings::default()
    }
}

/// What the rule can get wrong: even ground, an edge, a slope, a line, a spike, and noise of all densities.
fn cases() -> Vec<(&'static str, Image<u32>)> {
    let size = UVec2::new(90, 53);
    let mut random = Random(5);
    let noisy = |random: &mut Random, mean: u32| (0..mean).map(|_| random.below(3)).sum::<u32>();
    vec![
        ("1x1", random_map(1, 1, 5)),
        ("1x6", random_map(1, 6, 5)),
        ("300x1", sparse_map(300, 1)),
        ("49x2", sparse_map(49, 2)),
        ("12x19", random_map(12, 19, 4)),
        ("empty", Image::filled(UVec2::new(13, 9), 0)),
        ("even", Image::filled(size, 3)),
        ("sparse", sparse_map(131, 67)),
        ("spike", spike(66, 71)),
        ("step", Image::from_fn(size, |x, _| noisy(&mut random, if x < 40 { 2 } else { 16 }))),
        ("ramp", Image::from_fn(size, |x, _| noisy(&mut random, x / 4))),
        ("line", Image::from_fn(size, |x, y| if x == y { 40 } else { random.below(4) })),
        ("bright", Image::from_fn(size, |_, _| 800_000 + noisy(&mut random, 1000))),
    ]
}

fn agree(gl: &Gl, name: &str, density: &Image<u32>, settings: Settings) {
    let expected = reference::even(density, settings.search);
    assert_same(&on_gpu(gl, density, settings), &expected, &format!("{name}, {settings:?}"));
}

#[test]
fn radii_are_those_of_the_definition() {
    for gl in each() {
        for max_radius in [1, 2, 8, 16, 64] {
            for edges in [Edges::Zero, Edges::Scale] {
                let settings = even(max_radius, edges);
                let mut pipeline =
                    RadiusPipeline::new(&gl, UVec2::ONE, TextureFormat::R32Uint, settings).unwrap();
                for (name, density) in cases() {
                    pipeline.resize(density.size()).unwrap();
                    let map = upload(&gl, &density, settings.search);
                    let found = read(pipeline.render(&map).unwrap());
                    let expected = reference::even(&density, settings.search);
                    assert_same(&found, &expected, &format!("{name}, {settings:?}"));
                }
            }
        }
    }
}

/// Seen in none of the smaller maps: sums of two radii in one number that ran into each other.
#[test]
fn large_maps_have_radii_of_all_kinds() {
    let gl = egl();
    let mut random = Random(17);
    // Noise: a ramp with a disc, a grid and an empty part to the left, and nothing else to the right.
    let density = Image::from_fn(UVec2::new(520, 400), |x, y| {
        let away = UVec2::new(x, y).as_ivec2() - 90;
        let mean = match (x, y) {
            _ if away.length_squared() < 1600 => 24,
            (0..60, 300..) => 0,
            (100..180, 300..) if x % 8 == 0 => 30,
            _ => 1 + x.min(180) / 60,
        };
        (0..mean).map(|_| random.below(3)).sum()
    });
    let expected = reference::even(&density, even(64, Edges::Scale).search);
    for radius in [0, 1, 2, 4, 8, 16, 32, 64] {
        assert!(expected.radius.values().contains(&radius), "{radius}");
    }
    for max_radius in [32, 64] {
        agree(&gl, "large", &density, even(max_radius, Edges::Scale));
    }
}

#[test]
fn neither_n_nor_order_nor_build_changes_a_radius() {
    let gl = egl();
    let density = sparse_map(131, 67);
    let usual = even(16, Edges::Scale);
    let expected = reference::even(&density, usual.search);
    for order in Order::ALL {
        let settings = Settings {
            search: varikernel::settings::Search { order, min_photons: 9, ..usual.search },
            ..usual
        };
        for settings in [settings, Settings { laboratory: Settings::thesis().laboratory, ..settings }] {
            assert_same(&on_gpu(&gl, &density, settings), &expected, &format!("{settings:?}"));
        }
    }
    let map = upload(&gl, &density, usual.search);
    let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), usual).unwrap();
    pipeline.set_order(Order::Forward).unwrap();
    assert_same(&read(pipeline.render(&map).unwrap()), &expected, "another order");
    assert_eq!(RadiusPipeline::memory_required(map.size(), &usual).unwrap().other_orders, 0);
}

#[test]
fn counts_are_right_up_to_the_last_that_fits() {
    let gl = egl();
    // A table that wraps a hundred times, and boxes that do not.
    let mut density =
        Image::from_fn(UVec2::new(40, 30), |x, y| 400_000_000 + (x * 7919 + y * 104_729) % 60_000_000);
    agree(&gl, "wraps", &density, even(1, Edges::Scale));
    // The largest count of all, alone and at the end of a map.
    for place in [UVec2::new(20, 15), UVec2::new(39, 0)] {
        let mut one = Image::filled(density.size(), 0);
        one.set(place.x, place.y, u32::MAX);
        agree(&gl, "one", &one, even(64, Edges::Scale));
        agree(&gl, "one", &one, even(64, Edges::Zero));
    }
    // One more in a box of 3 x 3 is refused.
    density = Image::filled(UVec2::new(40, 30), 0);
    density.set(3, 3, u32::MAX);
    density.set(9, 9, 1);
    agree(&gl, "just so", &density, even(1, Edges::Scale));
    density.set(4, 4, 1);
    let settings = even(1, Edges::Scale);
    let map = upload(&gl, &density, settings.search);
    let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), settings).unwrap();
    match pipeline.render(&map) {
        Err(Error::Inexact { reason, remedy }) => {
            assert!(reason.contains("4294967296") && remedy.contains("scale the counts down"), "{reason}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_photon_in_another_place_is_seen() {
    let gl = egl();
    let density = sparse_map(131, 67);
    let found = on_gpu(&gl, &density, even(16, Edges::Scale));
    let mut planted = density.clone();
    planted.set(70, 30, density.at(70, 30) + 40);
    let other = reference::even(&planted, even(16, Edges::Scale).search);
    assert!(found.radius != other.radius, "40 photons more in a pixel change radii");
    assert!(reference::even(&density, even(16, Edges::Zero).search).radius != found.radius, "as edges do");
}

#[test]
fn frames_follow_each_other() {
    for gl in each() {
        let size = UVec2::new(131, 67);
        let settings = Settings { masked: true, ..even(32, Edges::Scale) };
        let (mut counts, question) = (sparse_map(size.x, size.y), settings.search);
        let mut map = upload(&gl, &counts, question);
        let mut pipeline = RadiusPipeline::new(&gl, size, map.format(), settings).unwrap();
        let expect = |found: &reference::Radii, counts: &Image<u32>, context: &str| {
            assert_same(found, &reference::even(counts, question), context);
        };
        expect(&read(pipeline.render(&map).unwrap()), &counts, "first");
        // Counts in a rectangle.
        for x in 60..70 {
            counts.set(x, 20, 50);
        }
        map.replace(&counts, CountBounds::of(&counts, question)).unwrap();
        let changed = Changed::Rectangle { first: UVec2::new(60, 20), size: UVec2::new(10, 1) };
        expect(&read(pipeline.update(&Frame { changed, ..Frame::new(&map) }).unwrap()), &counts, "rectangle");
        // A mask, and none.
        let mask = Image::from_fn(size, |x, y| u8::from(x > 30 && (x + y) % 3 != 0));
        let on_gpu = Mask::upload(&gl, &mask).unwrap();
        let found = read(pipeline.update(&Frame { mask: Some(&on_gpu), ..Frame::new(&map) }).unwrap());
        assert_same(&found, &reference::even(&counts, question).where_needed(&mask), "mask");
        let frame = Frame { changed: Changed::Nothing, ..Frame::new(&map) };
        expect(&read(pipeline.update(&frame).unwrap()), &counts, "no mask");
        // Photons in addition.
        let more = random_map(size.x, size.y, 3);
        let added = upload(&gl, &more, question);
        let frame = Frame { changed: Changed::Added, ..Frame::new(&added) };
        let all = Image::from_fn(size, |x, y| counts.at(x, y) + more.at(x, y));
        expect(&read(pipeline.update(&frame).unwrap()), &all, "added");
        // Another size, and a map without photons.
        let size = UVec2::new(20, 75);
        pipeline.resize(size).unwrap();
        for counts in [random_map(size.x, size.y, 9), Image::filled(size, 0), random_map(size.x, size.y, 2)] {
            let map = upload(&gl, &counts, question);
            expect(&read(pipeline.render(&map).unwrap()), &counts, "resized");
        }
    }
}

#[test]
fn what_has_no_meaning_for_the_rule_is_refused_by_name() {
    let gl = egl();
    let usual = even(32, Edges::Scale);
    let refused = |settings: Settings| match settings.validate() {
        Err(Error::Setting { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    for max_radius in [3, 2 * MAX_EVEN_RADIUS] {
        assert_eq!(refused(even(max_radius, Edges::Scale)), "max_radius");
    }
    assert_eq!(
        refused(Settings { rule: Rule::Even, search: usual.search, ..Settings::of(Method::Pyramid) }),
        "method"
    );
    assert_eq!(refused(Settings { storage: varikernel::settings::Storage::U16, ..usual }), "storage");
    assert_eq!(refused(planned(usual)), "planning");
    let mut varied = usual;
    varied.laboratory.variation = Some(varikernel::settings::Variation::UnconditionalFetches);
    assert_eq!(refused(varied), "variation");
    let mut faulty = usual;
    faulty.search.order = Order::Binary;
    faulty.laboratory.faults = varikernel::settings::Faults::AS_PRINTED;
    assert_eq!(refused(faulty), "faults");

    let density = random_map(8, 8, 4);
    let map = upload(&gl, &density, usual.search);
    let mut pipeline = RadiusPipeline::new(&gl, map.size(), map.format(), usual).unwrap();
    pipeline.render(&map).unwrap();
    assert!(matches!(pipeline.certify(&map), Err(Error::Setting { name: "rule", .. })));
    let light = IrradianceSettings { radii: usual, ..IrradianceSettings::default() };
    let result = IrradiancePipeline::new(&gl, map.size(), light).map(drop);
    assert!(matches!(result, Err(Error::Setting { name: "rule", .. })), "{result:?}");
    assert!(matches!(
        RadiusPipeline::new(&gl, map.size(), TextureFormat::R32Uint, planned(usual)).map(drop),
        Err(Error::Setting { name: "planning", .. })
    ));
}
