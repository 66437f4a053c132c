//! The listings as printed: each fault on the GPU is the fault that the reference predicts.

use varikernel::image::Difference;
use varikernel::settings::{
    Edges, Faults, Laboratory, Method, Order, SatBuild, SatSamples, Search, Settings, Split,
};
use varikernel::{Image, reference};

use crate::support::{assert_same, egl, on_gpu, random_map, search, sparse_map};

/// Square and oblong, below and above 64, so that every fault shows somewhere.
fn maps() -> Vec<(&'static str, Image<u32>)> {
    vec![
        ("64x64", sparse_map(64, 64)),
        ("70x66", sparse_map(70, 66)),
        ("20x37", random_map(20, 37, 3)),
        ("1x1", random_map(1, 1, 9)),
    ]
}

fn each_table_fault() -> Vec<Faults> {
    let none = Faults::NONE;
    vec![
        none,
        Faults { clamp_to_63: true, ..none },
        Faults { border_test: true, ..none },
        Faults { corner_test: true, ..none },
        Faults { border_test: true, corner_test: true, ..none },
        Faults { swapped_axes: true, ..none },
        Faults { sample_stride: true, ..none },
        Faults { float_ratio: true, ..none },
        Faults::AS_PRINTED,
    ]
}

#[test]
fn every_fault_of_the_table_listings_is_the_predicted_one() {
    let gl = egl();
    for (name, density) in maps() {
        for faults in each_table_fault() {
            for (order, edges, sat_samples) in [
                (Order::Forward, Edges::Zero, SatSamples::Two),
                (Order::Binary, Edges::Scale, SatSamples::Four),
            ] {
                let search = Search { order, ..search(25, 16, edges) };
                let settings = Settings {
                    search,
                    limited_mask: true,
                    laboratory: Laboratory {
                        sat_build: SatBuild::Doubling,
                        sat_samples,
                        faults,
                        ..Laboratory::default()
                    },
                    ..Settings::default()
                };
                let expected = reference::as_printed::radius(&density, search, sat_samples, faults);
                assert_same(&on_gpu(&gl, &density, settings), &expected, &format!("{name}, {settings:?}"));
            }
        }
    }
}

#[test]
fn the_forgotten_strip_of_the_pyramid_is_the_predicted_one() {
    let gl = egl();
    let faults = Faults { forgotten_strip: true, ..Faults::NONE };
    for (name, density) in maps() {
        let search = Search { order: Order::Forward, ..search(25, 16, Edges::Scale) };
        let settings = Settings {
            search,
            method: Method::Pyramid,
            limited_mask: true,
            laboratory: Laboratory { faults, split: Split::Odd, ..Laboratory::default() },
            ..Settings::default()
        };
        let expected = reference::pyramid::radius(&density, search, Split::Odd, faults);
        assert_same(&on_gpu(&gl, &density, settings), &expected, &format!("{name}, {settings:?}"));
    }
}

/// A prediction that equals the definition would prove nothing.
#[test]
fn every_fault_spoils_pixels_of_some_map() {
    let spoils = |density: &Image<u32>, samples, faults| {
        let search = search(25, 16, Edges::Zero);
        let printed = reference::as_printed::radius(density, search, samples, faults);
        let definition = reference::radius(density, search);
        Difference::between(&printed.radius, &definition.radius).unwrap().wrong_pixels
    };
    let none = Faults::NONE;
    let large = sparse_map(70, 66);
    assert_eq!(spoils(&large, SatSamples::Four, none), 0);
    assert!(spoils(&large, SatSamples::Two, Faults { clamp_to_63: true, ..none }) > 0);
    assert!(spoils(&large, SatSamples::Two, Faults { border_test: true, ..none }) > 0);
    let both = Faults { border_test: true, corner_test: true, ..none };
    assert!(spoils(&large, SatSamples::Two, both) > 0);
    // More columns than rows would need fewer passes, not more.
    let tall = random_map(20, 37, 2);
    assert!(spoils(&tall, SatSamples::Two, Faults { swapped_axes: true, ..none }) > 0);
    assert!(spoils(&large, SatSamples::Four, Faults { sample_stride: true, ..none }) > 0);
    // Alone, the wrong corner test only adds reads outside of the table, which give 0.
    assert_eq!(spoils(&large, SatSamples::Two, Faults { corner_test: true, ..none }), 0);

    let search = Search { order: Order::Forward, ..search(25, 16, Edges::Zero) };
    let forgotten = Faults { forgotten_strip: true, ..none };
    let printed = reference::pyramid::radius(&large, search, Split::Odd, forgotten);
    let definition = reference::radius(&large, search);
    assert!(!Difference::between(&printed.radius, &definition.radius).unwrap().is_none());
}
