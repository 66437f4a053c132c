//! One suite for every exact method: equal to the definition, pixel for pixel.

use proptest::prelude::*;
use varikernel::gl::TextureFormat;
use varikernel::maps::exactness::plan;
use varikernel::settings::{Edges, Laboratory, Matching, Method, Order, Search, Settings, Split, Storage};
use varikernel::{CountBounds, DensityMap, Error, Gl, Image, RadiusPipeline, reference};

use crate::support::{
    Random, assert_same, egl, exact_variants, fits_16_bits, on_gpu, osmesa, random_map, search, sparse_map,
    spike,
};

/// A map, n and MR.
pub(crate) fn cases() -> Vec<(&'static str, Image<u32>, u32, u32)> {
    vec![
        ("1x1", random_map(1, 1, 5), 25, 32),
        ("1x6", random_map(1, 6, 5), 4, 8),
        ("6x1", random_map(6, 1, 5), 4, 8),
        ("12x19", random_map(12, 19, 4), 25, 7),
        ("37x20", random_map(37, 20, 3), 25, 32),
        ("49x2", sparse_map(49, 2), 5, 32),
        ("64x64", sparse_map(64, 64), 25, 32),
        ("128x128", sparse_map(128, 128), 40, 20),
        ("64x64, MR 1", random_map(64, 64, 4), 9, 1),
        ("empty", Image::filled(glam::UVec2::new(13, 9), 0), 1, 5),
        ("n above the total", random_map(12, 19, 3), 1_000_000, 32),
        ("n that needs 64-bit products", random_map(9, 7, 2_000), 4_000_000_000, 32),
    ]
}

/// Compares settings of one question with the definition, which is slow and the same for all orders.
pub(crate) fn agree(gl: &Gl, name: &str, density: &Image<u32>, all: &[Settings]) {
    let Some(first) = all.first() else { return };
    let expected = reference::radius(density, first.search);
    for &settings in all {
        assert_eq!(Search { order: first.search.order, ..settings.search }, first.search, "one question");
        if fits_16_bits(density, &settings) {
            let found = on_gpu(gl, density, settings);
            assert_same(&found, &expected, &format!("{name}, {settings:?}"));
        }
    }
}

fn agree_everywhere(gl: &Gl) {
    for (name, density, min_photons, max_radius) in cases() {
        for edges in [Edges::Zero, Edges::Scale] {
            agree(gl, name, &density, &exact_variants(search(min_photons, max_radius, edges)));
        }
    }
}

/// Dense, thin and empty regions, with borders across tiles, large enough for tiles that no edge reaches.
fn regions(width: u32, height: u32) -> Image<u32> {
    let mut random = Random(31);
    Image::from_fn(glam::UVec2::new(width, height), |x, y| {
        let dice = random.below(64);
        match (x / 90, y / 110) {
            (0, _) => u32::from(dice == 0),
            (1, 0..3) => dice % 8,
            (2, 1) => 0,
            (3, _) if x == 300 => 1_000_000,
            _ => u32::from(dice < 5),
        }
    })
}

#[test]
fn brackets_of_tiles_of_every_class_are_exact() {
    let gl = egl();
    let density = regions(421, 395);
    for (min_photons, max_radius) in [(25, 12), (25, 90), (400, 90), (3, 200), (1, 1)] {
        for edges in [Edges::Zero, Edges::Scale] {
            let question = Search { order: Order::Bracketed, ..search(min_photons, max_radius, edges) };
            let expected = reference::radius_by_table(&density, question);
            let settings = Settings { search: question, limited_mask: true, ..Settings::default() };
            let found = on_gpu(&gl, &density, settings);
            assert_same(&found, &expected, &format!("{settings:?}"));
            // Without the mask, MR itself is never counted.
            let bounds = CountBounds::of(&density, question);
            let map = DensityMap::upload(&gl, &density, bounds).unwrap();
            let settings = Settings { limited_mask: false, ..settings };
            let mut pipeline = RadiusPipeline::new(&gl, density.size(), map.format(), settings).unwrap();
            assert_eq!(pipeline.render(&map).unwrap().read().unwrap(), expected.radius, "{settings:?}");
        }
    }
}

#[test]
fn every_exact_variant_equals_the_definition_on_egl() {
    agree_everywhere(&egl());
}

#[test]
fn every_exact_variant_equals_the_definition_on_osmesa() {
    if let Some(gl) = osmesa() {
        agree_everywhere(&gl);
    }
}

#[test]
fn one_hot_pixel_of_a_thousand_million_is_exact_in_u32() {
    let gl = egl();
    let density = spike(37, 20);
    for edges in [Edges::Zero, Edges::Scale] {
        let mut variants = exact_variants(search(25, 32, edges));
        variants.retain(|settings| settings.storage == Storage::U32);
        agree(&gl, "spike", &density, &variants);
    }
}

/// Only boxes of `radius` hold enough, so every pixel in the middle takes all turns up to it.
pub(crate) fn longest_search(gl: &Gl, settings: Settings, radius: u32) {
    let side = 2 * radius + 1;
    let settings = Settings { search: Search { min_photons: side * side, ..settings.search }, ..settings };
    let density = Image::filled(glam::UVec2::splat(side + 2), 1);
    let expected = reference::radius_by_table(&density, settings.search);
    let in_the_middle = expected.radius.map(|found| u32::from(found == radius));
    assert!(in_the_middle.values().iter().sum::<u32>() >= 9, "{settings:?}");
    assert_same(&on_gpu(gl, &density, settings), &expected, &format!("{settings:?}"));
}

/// llvmpipe cuts a fragment short after 65,535 turns of its loops; these searches take more.
#[test]
fn searches_longer_than_llvmpipe_allows_in_a_pass_are_exact() {
    let gl = egl();
    let pyramid = Settings { method: Method::Pyramid, ..brute_force_forward(60) };
    let odd = Settings { laboratory: Laboratory { split: Split::Odd, ..pyramid.laboratory }, ..pyramid };
    let modulo =
        Settings { laboratory: Laboratory { matching: Matching::Modulo, ..pyramid.laboratory }, ..pyramid };
    let modulo = Settings { search: Search { max_radius: 30, ..modulo.search }, ..modulo };
    let binary = Search { order: Order::Binary, max_radius: 32, ..pyramid.search };
    // The end of the first of several passes, one before and one after it, and the end.
    for (settings, radii) in [
        (brute_force_forward(40), vec![35, 36, 40]),
        (odd, vec![52, 60]),
        (modulo, vec![25, 30]),
        (Settings { search: binary, ..modulo }, vec![20, 32]),
    ] {
        for radius in radii {
            longest_search(&gl, settings, radius);
        }
    }
}

/// A map on which neighbours take different ways through a binary search: llvmpipe counts the turns of all of
/// them.
#[test]
fn a_binary_search_whose_neighbours_part_is_refused_or_exact() {
    let gl = egl();
    let mut density = Image::filled(glam::UVec2::splat(132), 0);
    density.set(123, 64, 10);
    let brute_force = Settings { method: Method::BruteForce, limited_mask: true, ..Settings::default() };
    for max_radius in [45, 52, 55, 59] {
        let search = search(10, max_radius, Edges::Zero);
        let settings = Settings { search, ..brute_force };
        match RadiusPipeline::new(&gl, density.size(), TextureFormat::R32Uint, settings) {
            Err(Error::Setting { name: "max_radius", .. }) => {
                assert!(gl.info().is_llvmpipe() && max_radius > 50, "MR {max_radius} is refused");
            }
            other => {
                other.unwrap();
                let expected = reference::radius_by_table(&density, search);
                assert_same(&on_gpu(&gl, &density, settings), &expected, &format!("MR {max_radius}"));
            }
        }
    }
}

#[test]
fn what_llvmpipe_would_cut_short_even_so_is_refused() {
    let gl = egl();
    let try_radius = |settings: Settings, max_radius| {
        let settings = Settings { search: Search { max_radius, ..settings.search }, ..settings };
        RadiusPipeline::new(&gl, glam::UVec2::splat(8), TextureFormat::R32Uint, settings).map(drop)
    };
    let forward = brute_force_forward(32);
    let binary = Settings { search: Search { order: Order::Binary, ..forward.search }, ..forward };
    // One box of radius 126 takes 254 * 254 turns of two loops; halving tries several large boxes in one
    // pass.
    for (settings, allowed, refused) in [(forward, 126, 127), (binary, 45, 70)] {
        try_radius(settings, allowed).unwrap();
        let result = try_radius(settings, refused);
        if gl.info().is_llvmpipe() {
            assert!(matches!(result, Err(Error::Setting { name: "max_radius", .. })), "{result:?}");
        } else {
            result.unwrap();
        }
    }
}

/// A comparison that could not fail would prove nothing.
#[test]
#[should_panic(
    expected = "1 of 228 pixels differ, by 0.0044 on average over all and 1 at most; first at (5, 7)"
)]
fn a_planted_difference_of_one_pixel_is_seen() {
    let density = random_map(12, 19, 4);
    let settings = Settings { limited_mask: true, ..Settings::default() };
    let mut expected = reference::radius(&density, settings.search);
    expected.radius.set(5, 7, expected.radius.at(5, 7) + 1);
    assert_same(&on_gpu(&egl(), &density, settings), &expected, "planted");
}

fn brute_force_forward(max_radius: u32) -> Settings {
    Settings {
        search: Search { order: Order::Forward, ..search(u32::MAX, max_radius, Edges::Zero) },
        method: Method::BruteForce,
        limited_mask: true,
        ..Settings::default()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    /// Any small map, any question, any exact variant.
    #[test]
    fn any_map_and_any_question_agree(
        (width, height) in (1..24_u32, 1..24_u32),
        largest in prop_oneof![Just(1_u32), Just(4), Just(60), Just(u32::MAX)],
        seed: u64,
        min_photons in prop_oneof![1..200_u32, Just(100_000), Just(2_000_000_000)],
        max_radius in 1..=32_u32,
        scale: bool,
        variant in 0..52_usize,
    ) {
        let mut random = Random(seed);
        // Mostly empty, so that radii differ.
        let density = Image::from_fn(glam::UVec2::new(width, height), |_, _| {
            if random.below(4) == 0 { random.below(largest).saturating_add(1) } else { 0 }
        });
        let edges = if scale { Edges::Scale } else { Edges::Zero };
        let variants = exact_variants(search(min_photons, max_radius, edges));
        let settings = variants[variant % variants.len()];
        let bounds = CountBounds::of_boxes(&density, settings.search);
        // What is refused is tested elsewhere; here the answer must be right.
        if plan(&settings, density.size(), bounds).is_ok() {
            agree(&egl(), "random", &density, &[settings]);
        }
    }
}
