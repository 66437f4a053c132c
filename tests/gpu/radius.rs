//! One suite for every exact method: equal to the definition, pixel for pixel.

use varikernel::gl::TextureFormat;
use varikernel::settings::{
    Edges, MAX_RADIUS_LIMIT, Matching, Method, Order, Search, Settings, Split, Storage,
};
use varikernel::{Error, Gl, Image, RadiusPipeline, reference};

use crate::support::{
    assert_same, egl, exact_variants, on_gpu, osmesa, random_map, search, sparse_map, spike,
};

/// A map, n and MR.
fn cases() -> Vec<(&'static str, Image<u32>, u32, u32)> {
    vec![
        ("1x1", random_map(1, 1, 5), 25, 32),
        ("1x6", random_map(1, 6, 5), 4, 8),
        ("6x1", random_map(6, 1, 5), 4, 8),
        ("12x19", random_map(12, 19, 4), 25, 7),
        ("37x20", random_map(37, 20, 3), 25, 32),
        ("49x2", sparse_map(49, 2), 5, 32),
        ("64x64", sparse_map(64, 64), 25, 32),
        ("64x64, MR 1", random_map(64, 64, 4), 9, 1),
        ("empty", Image::filled(glam::UVec2::new(13, 9), 0), 1, 5),
        ("n above the total", random_map(12, 19, 3), 1_000_000, 40),
        ("n that needs 64-bit products", random_map(9, 7, 2_000), 4_000_000_000, 40),
    ]
}

fn agree(gl: &Gl, name: &str, density: &Image<u32>, settings: Settings) {
    let expected = reference::radius(density, settings.search);
    let found = on_gpu(gl, density, settings);
    let context = format!("{name}, {settings:?}");
    assert_same(&found, &expected, &context);
}

fn agree_everywhere(gl: &Gl) {
    for (name, density, min_photons, max_radius) in cases() {
        for edges in [Edges::Zero, Edges::Scale] {
            for settings in exact_variants(search(min_photons, max_radius, edges)) {
                agree(gl, name, &density, settings);
            }
        }
    }
}

#[test]
fn every_exact_variant_equals_the_definition_on_egl() {
    agree_everywhere(&egl());
}

#[test]
fn every_exact_variant_equals_the_definition_on_osmesa() {
    agree_everywhere(&osmesa());
}

#[test]
fn one_hot_pixel_of_a_thousand_million_is_exact_in_u32() {
    let gl = egl();
    let density = spike(37, 20);
    for edges in [Edges::Zero, Edges::Scale] {
        for settings in exact_variants(search(25, 32, edges)) {
            if settings.storage == Storage::U32 {
                agree(&gl, "spike", &density, settings);
            }
        }
    }
}

/// The largest MR that a slow search may have, found by asking; the one after it is refused.
fn largest_allowed_radius(gl: &Gl, settings: Settings) -> u32 {
    let is_allowed = |max_radius| {
        let settings = Settings { search: Search { max_radius, ..settings.search }, ..settings };
        match RadiusPipeline::new(gl, glam::UVec2::splat(8), TextureFormat::R32Uint, settings) {
            Ok(_) => true,
            Err(Error::Setting { name: "max_radius", .. }) => false,
            Err(error) => panic!("{error}"),
        }
    };
    let (mut allowed, mut refused) = (1, MAX_RADIUS_LIMIT);
    while refused - allowed > 1 {
        let middle = allowed.midpoint(refused);
        if is_allowed(middle) {
            allowed = middle;
        } else {
            refused = middle;
        }
    }
    allowed
}

#[test]
fn a_search_that_llvmpipe_would_cut_short_is_refused_and_the_longest_allowed_is_exact() {
    let gl = egl();
    if !gl.info().is_llvmpipe() {
        // Elsewhere there is no such limit: the same settings must just work.
        return agree(&gl, "no limit", &random_map(40, 40, 2), brute_force_forward(90));
    }
    let base = brute_force_forward(32);
    let pyramid = Settings { method: Method::Pyramid, ..base };
    for (settings, at_least) in [
        (base, 120),
        (Settings { split: Split::Odd, ..pyramid }, 200),
        (Settings { split: Split::Larger, matching: Matching::Modulo, ..pyramid }, 64),
    ] {
        let max_radius = largest_allowed_radius(&gl, settings);
        assert!(max_radius >= at_least, "MR {max_radius} for {settings:?}");
        // Only the largest box holds enough, so every pixel in the middle takes all turns.
        let side = 2 * max_radius + 1;
        let search = Search { min_photons: side * side, max_radius, ..settings.search };
        let density = Image::filled(glam::UVec2::splat(side + 2), 1);
        let found = on_gpu(&gl, &density, Settings { search, ..settings });
        let expected = reference::radius_by_table(&density, search);
        assert_same(&found, &expected, &format!("MR {max_radius}, {settings:?}"));
        assert_eq!(expected.limited.map(|limited| 1 - u32::from(limited)).values().iter().sum::<u32>(), 9);
    }
}

fn brute_force_forward(max_radius: u32) -> Settings {
    Settings {
        search: Search { order: Order::Forward, ..search(u32::MAX, max_radius, Edges::Zero) },
        method: Method::BruteForce,
        limited_mask: true,
        ..Settings::default()
    }
}
