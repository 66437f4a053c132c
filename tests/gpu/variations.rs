//! The variations of chapter 6's future work: the same radii as the definition, pixel for pixel.

use glam::UVec2;
use varikernel::gl::TextureFormat;
use varikernel::settings::{
    Edges, Faults, Laboratory, Matching, Method, Order, Search, Settings, Split, Storage, Variation,
};
use varikernel::{CountBounds, DensityMap, Error, Image, RadiusPipeline, reference};

use crate::radius::{agree, cases, longest_search};
use crate::support::{assert_same, egl, exact_variants, on_gpu, osmesa, random_map, search, spike};

/// Every exact method that `variation` fits, with every variant of it.
fn varied(variation: Variation, search: Search) -> Vec<Settings> {
    let all = exact_variants(search).into_iter().map(|settings| Settings {
        laboratory: Laboratory { variation: Some(variation), ..settings.laboratory },
        ..settings
    });
    let fitting: Vec<_> = all.filter(|settings| settings.validate().is_ok()).collect();
    assert!(!fitting.is_empty(), "{variation:?}");
    fitting
}

fn agree_everywhere(gl: &varikernel::Gl, variation: Variation) {
    for (name, density, min_photons, max_radius) in cases() {
        for edges in [Edges::Zero, Edges::Scale] {
            agree(gl, name, &density, &varied(variation, search(min_photons, max_radius, edges)));
        }
    }
}

#[test]
fn brute_force_with_reused_sums_equals_the_definition() {
    agree_everywhere(&egl(), Variation::ReusedSums);
}

#[test]
fn brute_force_with_fetches_at_once_equals_the_definition() {
    agree_everywhere(&egl(), Variation::FetchesAtOnce);
}

#[test]
fn a_pyramid_with_whole_strips_equals_the_definition() {
    agree_everywhere(&egl(), Variation::WholeStrips);
}

#[test]
fn a_table_with_unconditional_fetches_equals_the_definition() {
    agree_everywhere(&egl(), Variation::UnconditionalFetches);
}

#[test]
fn a_table_built_from_unfinished_texels_equals_the_definition() {
    agree_everywhere(&egl(), Variation::UnfinishedTexels);
}

#[test]
fn every_variation_equals_the_definition_on_osmesa() {
    let Some(gl) = osmesa() else { return };
    for variation in Variation::ALL {
        agree(&gl, "37x20", &random_map(37, 20, 3), &varied(variation, search(25, 32, Edges::Scale)));
    }
}

#[test]
fn every_variation_is_exact_beside_a_thousand_million_photons() {
    let gl = egl();
    for variation in Variation::ALL {
        let mut variants = varied(variation, search(25, 32, Edges::Scale));
        variants.retain(|settings| settings.storage == Storage::U32);
        agree(&gl, "spike", &spike(37, 20), &variants);
    }
}

/// Sides around powers of s, where the last pass has little or nothing left to draw, and one pipeline for two
/// maps: the second finds the first one's entries in both textures.
#[test]
fn unfinished_texels_leave_nothing_of_another_frame() {
    let gl = egl();
    let sides = [1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 33, 63, 64, 65];
    for (width, height) in sides.into_iter().flat_map(|side| [(side, side), (side, 6), (5, side)]) {
        let (first, second) = (random_map(width, height, 9), random_map(width, height, 4));
        for settings in varied(Variation::UnfinishedTexels, search(25, 40, Edges::Zero)) {
            let upload = |map| DensityMap::upload(&gl, map, CountBounds::of(map, settings.search)).unwrap();
            let mut pipeline =
                RadiusPipeline::new(&gl, first.size(), TextureFormat::R32Uint, settings).unwrap();
            for map in [&first, &second] {
                let radius = pipeline.render(&upload(map)).unwrap().read().unwrap();
                let expected = reference::radius_by_table(map, settings.search);
                assert_eq!(radius, expected.radius, "{width} x {height}, {settings:?}");
            }
        }
    }
}

/// One row with a photon at its start: pixel x finds it at radius x, after every ring before.
#[test]
fn reused_sums_are_exact_up_to_the_last_radius_that_llvmpipe_allows() {
    let gl = egl();
    let mut density = Image::filled(UVec2::new(300, 1), 0);
    density.set(0, 0, 1);
    let settings = |max_radius| Settings {
        search: Search { order: Order::Forward, ..search(1, max_radius, Edges::Zero) },
        method: Method::BruteForce,
        limited_mask: true,
        laboratory: Laboratory { variation: Some(Variation::ReusedSums), ..Laboratory::default() },
        ..Settings::default()
    };
    let largest = 254;
    let expected = reference::Radii {
        radius: Image::from_fn(density.size(), |x, _| x.clamp(1, largest)),
        limited: Image::from_fn(density.size(), |x, _| u8::from(x > largest)),
    };
    assert_same(&on_gpu(&gl, &density, settings(largest)), &expected, "a photon at the start of a row");
    let refused = RadiusPipeline::new(&gl, density.size(), TextureFormat::R32Uint, settings(largest + 1));
    assert_eq!(refused.is_err(), gl.info().is_llvmpipe());
}

/// As in `radius.rs`: llvmpipe takes these in several passes.
#[test]
fn varied_searches_longer_than_llvmpipe_allows_in_a_pass_are_exact() {
    let gl = egl();
    let forward = |max_radius| Search { order: Order::Forward, ..search(1, max_radius, Edges::Zero) };
    let base = Settings { limited_mask: true, ..Settings::default() };
    longest_search(
        &gl,
        Settings {
            search: forward(60),
            method: Method::BruteForce,
            laboratory: Laboratory { variation: Some(Variation::FetchesAtOnce), ..base.laboratory },
            ..base
        },
        60,
    );
    for (split, matching, max_radius) in [
        (Split::Odd, Matching::Bits, 60),
        (Split::Larger, Matching::Bits, 60),
        (Split::Odd, Matching::Modulo, 40),
    ] {
        longest_search(
            &gl,
            Settings {
                search: forward(max_radius),
                method: Method::Pyramid,
                laboratory: Laboratory {
                    split,
                    matching,
                    variation: Some(Variation::WholeStrips),
                    ..base.laboratory
                },
                ..base
            },
            max_radius,
        );
    }
}

#[test]
fn a_variation_that_does_not_fit_is_refused_by_name() {
    let refused = |settings: Settings| match settings.validate() {
        Err(Error::Setting { name: "variation", reason, .. }) => reason,
        other => panic!("{settings:?}: {other:?}"),
    };
    for variation in Variation::ALL {
        for method in Method::ALL {
            let settings = Settings {
                search: Search { order: Order::Forward, ..search(25, 8, Edges::Zero) },
                method,
                laboratory: Laboratory { variation: Some(variation), ..Laboratory::default() },
                ..Settings::default()
            };
            if method == variation.method() {
                settings.validate().unwrap();
                let faults = Faults { float_ratio: true, ..Faults::NONE };
                assert!(
                    refused(Settings {
                        laboratory: Laboratory { faults, ..settings.laboratory },
                        ..settings
                    })
                    .contains("faults")
                );
            } else {
                assert!(refused(settings).contains("varies"));
            }
            if method == variation.method() && variation == Variation::ReusedSums {
                let binary = Search { order: Order::Binary, ..settings.search };
                assert!(refused(Settings { search: binary, ..settings }).contains("forward"));
            }
        }
    }
}

/// A comparison that could not fail would prove nothing: the variations do change the shaders or the build.
#[test]
fn every_counting_variation_has_a_shader_of_its_own() {
    for variation in Variation::ALL {
        for settings in varied(variation, search(25, 8, Edges::Zero)) {
            let text = |settings: &Settings| {
                varikernel::radius::shader_sources(TextureFormat::R32Uint, settings)
                    .iter()
                    .map(varikernel::gl::ShaderSource::fragment)
                    .collect::<Vec<_>>()
            };
            let plain =
                Settings { laboratory: Laboratory { variation: None, ..settings.laboratory }, ..settings };
            assert_eq!(text(&settings) == text(&plain), variation == Variation::UnfinishedTexels);
        }
    }
}
