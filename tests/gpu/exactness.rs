//! What is exact past 2^24 and 2^32, what is refused, and that the limits are real.

use glam::UVec2;
use varikernel::image::Difference;
use varikernel::settings::{
    Edges, Exactness, Faults, Laboratory, Method, Order, SatBuild, SatSamples, Search, Settings, Storage,
};
use varikernel::{Changed, CountBounds, DensityMap, Error, Frame, Gl, Image, RadiusPipeline, reference};

use crate::support::{Random, assert_same, egl, exact_variants, on_gpu, random_map, search};

/// Random counts below 2^24: the total of 40 x 40 pixels is past 2^33.
fn heavy() -> Image<u32> {
    random_map(40, 40, 1 << 24)
}

#[test]
fn totals_past_32_bits_are_exact_in_u32() {
    let gl = egl();
    let density = heavy();
    let total: u64 = density.values().iter().map(|&count| u64::from(count)).sum();
    assert!(total > 2 * u64::from(u32::MAX), "{total}");
    for edges in [Edges::Zero, Edges::Scale] {
        // Boxes of radius 5 stay below 2^32, so nothing is clamped and the table wraps.
        for settings in exact_variants(search(900_000_000, 5, edges)) {
            if settings.storage != Storage::U32 {
                continue;
            }
            if settings.search.order == Order::Bracketed {
                // Its larger boxes may not.
                assert!(refused(&gl, &density, settings), "{settings:?}");
                continue;
            }
            let expected = reference::radius(&density, settings.search);
            assert_same(&on_gpu(&gl, &density, settings), &expected, &format!("{settings:?}"));
        }
    }
    // Twenty thousand million in all, less than 2^32 in any box around a tile.
    let wide = random_map(700, 300, 200_000);
    for edges in [Edges::Zero, Edges::Scale] {
        let search = Search { order: Order::Bracketed, ..search(40_000_000, 30, edges) };
        let settings = Settings { search, limited_mask: true, ..Settings::default() };
        let expected = reference::radius_by_table(&wide, search);
        assert_same(&on_gpu(&gl, &wide, settings), &expected, &format!("{settings:?}"));
    }
}

#[test]
fn counts_are_clamped_to_n_where_boxes_could_wrap() {
    let gl = egl();
    // Many pixels of nearly 2^32 in one box: only clamping makes their sum fit.
    let mut random = Random(3);
    let density = Image::from_fn(UVec2::new(23, 31), |_, _| match random.below(40) {
        0 => u32::MAX,
        1..8 => random.below(9),
        _ => 0,
    });
    for edges in [Edges::Zero, Edges::Scale] {
        for settings in exact_variants(search(25, 20, edges)) {
            if settings.storage == Storage::U32 {
                let expected = reference::radius(&density, settings.search);
                assert_same(&on_gpu(&gl, &density, settings), &expected, &format!("{settings:?}"));
            }
        }
    }
}

fn refused(gl: &Gl, density: &Image<u32>, settings: Settings) -> bool {
    let map = DensityMap::upload(gl, density, CountBounds::of(density, settings.search)).unwrap();
    let mut pipeline = RadiusPipeline::new(gl, density.size(), map.format(), settings).unwrap();
    match pipeline.render(&map) {
        Ok(_) => false,
        Err(Error::Inexact { .. }) => true,
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn boxes_that_exceed_32_bits_even_clamped_are_refused() {
    let gl = egl();
    let density = Image::filled(UVec2::splat(4), 4_000_000_000);
    let u32_sums = Settings { search: search(3_000_000_000, 3, Edges::Zero), ..Settings::default() };
    assert!(refused(&gl, &density, u32_sums));
    // One photon less to ask for than what two pixels hold is fine: n clamps them.
    let one_pixel = Settings { search: search(1_000, 3, Edges::Zero), ..Settings::default() };
    assert!(!refused(&gl, &density, one_pixel));
}

#[test]
fn f32_is_refused_past_2_to_24_and_rightly_so() {
    let gl = egl();
    // 262 million photons, in boxes of a million at most.
    let density = random_map(512, 512, 2_001);
    let total: u64 = density.values().iter().map(|&count| u64::from(count)).sum();
    assert!(total > 1 << 24, "{total}");
    let settings = Settings {
        search: search(49_000, 16, Edges::Zero),
        storage: Storage::F32,
        laboratory: Laboratory { sat_build: SatBuild::Doubling, ..Laboratory::default() },
        ..Settings::default()
    };
    assert!(refused(&gl, &density, settings));
    assert!(!refused(&gl, &density, Settings { method: Method::Pyramid, ..settings }), "its boxes are small");

    let waived = Settings {
        limited_mask: true,
        laboratory: Laboratory { exactness: Exactness::Waived, ..settings.laboratory },
        ..settings
    };
    let expected = reference::radius_by_table(&density, settings.search);
    let found = on_gpu(&gl, &density, waived);
    let difference = Difference::between(&found.radius, &expected.radius).unwrap();
    assert!(difference.wrong_pixels > 0, "the refusal would be needless");
    let in_u32 = on_gpu(&gl, &density, Settings { storage: Storage::U32, ..waived });
    assert_same(&in_u32, &expected, "u32");
}

#[test]
fn tables_in_16_bits_are_exact_while_each_box_fits() {
    let gl = egl();
    let in_16_bits = |search| {
        let all = exact_variants(search).into_iter();
        let tables: Vec<_> = all.filter(|settings| settings.storage == Storage::U16).collect();
        assert!(tables.len() >= 8);
        tables
    };
    // The table wraps, or holds counts of 2^32 that are clamped to n, whatever is known of them.
    let wrapping = random_map(120, 100, 20);
    assert!(wrapping.values().iter().sum::<u32>() > 1 << 16);
    let clamped = random_map(30, 40, u32::MAX).map(|count| if count % 8 == 0 { count } else { count % 2 });
    for (density, min_photons) in [(&wrapping, 300), (&clamped, 4)] {
        for edges in [Edges::Zero, Edges::Scale] {
            for settings in in_16_bits(search(min_photons, 5, edges)) {
                let expected = reference::radius_by_table(density, settings.search);
                assert_same(&on_gpu(&gl, density, settings), &expected, &format!("{settings:?}"));
            }
        }
    }
}

#[test]
fn u16_is_refused_past_2_to_16_and_rightly_so() {
    let gl = egl();
    let map = |first| {
        let mut density = Image::filled(UVec2::new(9, 7), 0);
        density.set(4, 3, first);
        density.set(5, 3, 1);
        density
    };
    let settings = Settings {
        search: search(65_535, 3, Edges::Zero),
        storage: Storage::U16,
        limited_mask: true,
        ..Settings::default()
    };
    assert!(!refused(&gl, &map(65_534), settings));
    assert!(refused(&gl, &map(65_535), settings));
    assert!(!refused(&gl, &map(65_535), Settings { storage: Storage::U32, ..settings }));

    let waived = Settings {
        laboratory: Laboratory { exactness: Exactness::Waived, ..settings.laboratory },
        ..settings
    };
    for (density, is_wrong) in [(map(65_534), false), (map(65_535), true)] {
        let expected = reference::radius(&density, settings.search);
        let found = on_gpu(&gl, &density, waived);
        let difference = Difference::between(&found.radius, &expected.radius).unwrap();
        assert_eq!(difference.wrong_pixels > 0, is_wrong, "the refusal would be needless");
    }
    for settings in [
        Settings { method: Method::BruteForce, ..settings },
        Settings { method: Method::Pyramid, ..settings },
        Settings {
            laboratory: Laboratory {
                faults: Faults { border_test: true, ..Faults::NONE },
                ..settings.laboratory
            },
            ..settings
        },
    ] {
        assert!(matches!(settings.validate(), Err(Error::Setting { name: "storage", .. })), "{settings:?}");
    }
}

#[test]
fn bounds_hold_for_the_question_that_they_were_found_for_and_no_larger_one() {
    let gl = egl();
    // Boxes of radius 1 hold less than 2^32, those of radius 12 do not; n = 4 * 10^9 clamps nothing.
    let density = random_map(25, 25, 400_000_000);
    let small = search(4_000_000_000, 1, Edges::Zero);
    let bounds = CountBounds::of(&density, small);
    assert!(bounds.densest_box < 1 << 32 && bounds.total > 1 << 32, "{bounds:?}");
    let map = DensityMap::upload(&gl, &density, bounds).unwrap();
    let render = |search| {
        let settings = Settings { search, ..Settings::default() };
        let mut pipeline = RadiusPipeline::new(&gl, density.size(), map.format(), settings).unwrap();
        pipeline.render(&map).map(|radii| radii.read().unwrap())
    };
    assert_eq!(render(small).unwrap(), reference::radius(&density, small).radius);
    let large = Search { max_radius: 12, ..small };
    assert!(matches!(render(large), Err(Error::Inexact { .. })));

    // The naive mipmap's last block is larger than a box of MR.
    let even = Image::filled(UVec2::splat(8), 87_652_393);
    let naive = Settings {
        search: search(u32::MAX, 3, Edges::Zero),
        method: Method::NaiveMipmap,
        ..Settings::default()
    };
    assert!(refused(&gl, &even, naive));
}

#[test]
fn without_bounds_only_n_and_the_radius_can_prove_exactness() {
    let gl = egl();
    let density = random_map(16, 16, 3);
    let render = |settings: Settings| {
        let map = DensityMap::upload(&gl, &density, CountBounds::UNKNOWN).unwrap();
        let mut pipeline = RadiusPipeline::new(&gl, density.size(), map.format(), settings).unwrap();
        pipeline.render(&map).map(|radii| radii.read().unwrap())
    };
    let usual = Settings { search: search(25, 32, Edges::Scale), ..Settings::default() };
    assert_eq!(render(usual).unwrap(), reference::radius(&density, usual.search).radius);
    let large = Settings { search: search(1 << 30, 32, Edges::Scale), ..usual };
    assert!(matches!(render(large), Err(Error::Inexact { .. })));
    assert!(matches!(
        render(Settings {
            storage: Storage::F32,
            laboratory: Laboratory { sat_build: SatBuild::Doubling, ..usual.laboratory },
            ..usual
        }),
        Err(Error::Inexact { .. })
    ));
}

#[test]
fn settings_outside_their_range_are_refused_by_name() {
    let gl = egl();
    let new = |method, min_photons, max_radius| {
        let search = Search { min_photons, max_radius, ..search(1, 1, Edges::Zero) };
        let settings = Settings { search, method, ..Settings::default() };
        RadiusPipeline::new(&gl, UVec2::splat(4), varikernel::gl::TextureFormat::R32Uint, settings)
    };
    for (method, min_photons, max_radius, expected) in [
        (Method::SummedAreaTable, 0, 8, "min_photons"),
        (Method::SummedAreaTable, 5, 0, "max_radius"),
        (Method::SummedAreaTable, 5, 32_768, "max_radius"),
        (Method::NaiveMipmap, 5, 16_385, "max_radius"),
    ] {
        match new(method, min_photons, max_radius) {
            Err(Error::Setting { name, .. }) => assert_eq!(name, expected),
            other => panic!("{other:?}"),
        }
    }
    assert!(new(Method::SummedAreaTable, 1, 32_767).is_ok());
    let too_large = UVec2::new(gl.info().max_texture_size + 1, 1);
    let format = varikernel::gl::TextureFormat::R32Uint;
    let result = RadiusPipeline::new(&gl, too_large, format, Settings::default());
    assert!(matches!(result, Err(Error::TooLarge { .. })));
}

#[test]
fn f16_is_exact_up_to_2_to_11_and_refused_past_it() {
    let gl = egl();
    for edges in [Edges::Zero, Edges::Scale] {
        for sat_samples in SatSamples::ALL {
            let search = search(20, 6, edges);
            let settings = Settings {
                search,
                laboratory: Laboratory { sat_samples, ..table(Storage::F16).laboratory },
                ..table(Storage::F16)
            };
            let map = random_map(37, 29, 3);
            let total: u32 = map.values().iter().sum();
            assert!(total > 900 && total < 1 << 11, "{total}");
            let expected = reference::radius(&map, search);
            assert_same(&on_gpu(&gl, &map, settings), &expected, &format!("{settings:?}"));
            let dense = random_map(37, 29, 9);
            assert!(refused(&gl, &dense, settings));
            let waived = Settings {
                laboratory: Laboratory { exactness: Exactness::Waived, ..settings.laboratory },
                ..settings
            };
            let expected = reference::radius(&dense, search);
            let found = on_gpu(&gl, &dense, waived);
            let difference = Difference::between(&found.radius, &expected.radius).unwrap();
            assert!(difference.wrong_pixels > 0, "the refusal would be needless");
        }
    }
}

#[test]
fn sums_without_the_mean_are_never_taken_for_exact_though_small_ones_are() {
    let gl = egl();
    for storage in [Storage::F32MinusMean, Storage::F32MinusWholeMean] {
        for edges in [Edges::Zero, Edges::Scale] {
            let search = search(40, 6, edges);
            let settings = Settings { search, ..table(storage) };
            let (map, more) = (random_map(37, 29, 9), random_map(37, 29, 4));
            assert!(refused(&gl, &map, settings));
            let waived = Settings {
                laboratory: Laboratory { exactness: Exactness::Waived, ..settings.laboratory },
                ..settings
            };
            let expected = reference::radius(&map, search);
            assert_same(&on_gpu(&gl, &map, waived), &expected, &format!("{waived:?}"));
            let bracketed = Settings { search: Search { order: Order::Bracketed, ..search }, ..waived };
            assert_same(&on_gpu(&gl, &map, bracketed), &expected, &format!("{bracketed:?}"));

            // Photons that are added have a mean of their own.
            let upload = |map| DensityMap::upload(&gl, map, CountBounds::of(map, search)).unwrap();
            let (first, added) = (upload(&map), upload(&more));
            let mut pipeline = RadiusPipeline::new(&gl, map.size(), first.format(), waived).unwrap();
            pipeline.render(&first).unwrap();
            let radii = pipeline.update(&Frame { changed: Changed::Added, ..Frame::new(&added) }).unwrap();
            let both = Image::from_fn(map.size(), |x, y| map.at(x, y) + more.at(x, y));
            assert_eq!(radii.read().unwrap(), reference::radius(&both, search).radius, "{waived:?}");
            assert_ne!(expected.radius, reference::radius(&both, search).radius);
        }
        for settings in [
            Settings { method: Method::Pyramid, ..table(storage) },
            Settings {
                laboratory: Laboratory { sat_build: SatBuild::Scan, ..table(storage).laboratory },
                ..table(storage)
            },
        ] {
            assert!(matches!(settings.validate(), Err(Error::Setting { .. })), "{settings:?}");
        }
    }
}

/// A table by doubling.
fn table(storage: Storage) -> Settings {
    let order = Search { order: Order::Binary, ..Settings::default().search };
    Settings {
        search: order,
        storage,
        limited_mask: true,
        laboratory: Laboratory { sat_build: SatBuild::Doubling, ..Laboratory::default() },
        ..Settings::default()
    }
}
