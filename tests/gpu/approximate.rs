//! The two methods that do not answer the question exactly, and bounds of their error.

use glam::UVec2;
use varikernel::image::Difference;
use varikernel::settings::{Edges, Laboratory, Method, Order, Search, Settings, Split, Storage};
use varikernel::{Image, reference};

use crate::support::{assert_same, each, egl, on_gpu, random_map, search, sparse_map};

/// Figures 3.2 to 3.4: 9 photons within radius 1 and 41 within radius 2 of the star at (3, 3), whose own
/// quadrant is thin; 25 are needed.
fn figure_3_3() -> Image<u32> {
    let rows: [[u32; 8]; 8] = [
        [0, 0, 0, 0, 0, 0, 0, 0],
        [0, 1, 0, 1, 0, 2, 0, 1],
        [0, 0, 1, 0, 1, 4, 1, 0],
        [0, 1, 0, 1, 2, 3, 2, 1],
        [0, 0, 1, 1, 2, 4, 1, 2],
        [0, 2, 3, 4, 3, 4, 2, 1],
        [0, 0, 1, 2, 1, 2, 1, 0],
        [0, 1, 0, 1, 2, 1, 0, 1],
    ];
    Image::from_fn(UVec2::splat(8), |x, y| rows[y as usize][x as usize])
}

#[test]
fn the_naive_mipmap_finds_radius_4_where_2_is_right_as_in_figure_3_3() {
    let density = figure_3_3();
    let table = reference::Table::new(&density);
    let within = |radius| table.count(reference::Inside::of_box(density.size(), 3, 3, radius));
    assert_eq!((within(1), within(2)), (9, 41), "the counts of Figure 3.2");

    let settings = Settings {
        search: search(25, 4, Edges::Zero),
        method: Method::NaiveMipmap,
        limited_mask: true,
        ..Settings::default()
    };
    let naive = on_gpu(&egl(), &density, settings);
    assert_eq!(naive.radius.at(3, 3), 4);
    assert_eq!(reference::radius(&density, settings.search).radius.at(3, 3), 2);
}

#[test]
fn the_naive_mipmap_equals_its_reference_and_keeps_its_one_sided_bound() {
    for gl in each() {
        for density in [
            figure_3_3(),
            random_map(1, 1, 3),
            random_map(1, 6, 9),
            random_map(37, 20, 3),
            sparse_map(64, 64),
            sparse_map(49, 2),
            Image::filled(UVec2::new(5, 5), 0),
        ] {
            for edges in [Edges::Zero, Edges::Scale] {
                for storage in [Storage::U32, Storage::F32] {
                    for max_radius in [1, 4, 7, 100] {
                        let settings = Settings {
                            search: search(25, max_radius, edges),
                            method: Method::NaiveMipmap,
                            storage,
                            limited_mask: true,
                            ..Settings::default()
                        };
                        let found = on_gpu(&gl, &density, settings);
                        let expected = reference::naive_mipmap(&density, settings.search);
                        assert_same(&found, &expected, &format!("{:?}, {settings:?}", density.size()));
                        if edges == Edges::Zero {
                            exact_is_below_twice_naive(&density, &found, settings.search);
                        }
                    }
                }
            }
        }
    }
}

/// A block of side 2 r that holds enough lies within radius 2 r - 1 of each of its pixels.
fn exact_is_below_twice_naive(density: &Image<u32>, naive: &reference::Radii, search: Search) {
    let exact = reference::radius(density, search);
    for (index, &naive_radius) in naive.radius.values().iter().enumerate() {
        // The last block may be larger than MR says.
        if naive.limited.values()[index] == 0 && naive_radius < search.max_radius {
            assert!(exact.radius.values()[index] < 2 * naive_radius, "pixel {index}");
        }
    }
}

fn averaged(search: Search, split: Split) -> Settings {
    Settings {
        search,
        method: Method::AveragedMipmap,
        limited_mask: true,
        laboratory: Laboratory { split, ..Laboratory::default() },
        ..Settings::default()
    }
}

#[test]
fn averaged_mipmaps_are_exact_on_powers_of_two_with_a_box_filter() {
    // Mesa halves with a 2 x 2 box, in f32: averages of whole numbers are then exact.
    for gl in each() {
        for density in [random_map(64, 64, 3), sparse_map(128, 128), random_map(32, 64, 4), figure_3_3()] {
            for split in [Split::Odd, Split::Larger] {
                for order in [Order::Forward, Order::Binary] {
                    let settings = averaged(Search { order, ..search(25, 20, Edges::Scale) }, split);
                    let expected = reference::radius(&density, settings.search);
                    assert_same(&on_gpu(&gl, &density, settings), &expected, &format!("{settings:?}"));
                }
            }
        }
    }
}

#[test]
fn averaged_mipmaps_are_exact_on_constant_maps_of_any_size() {
    // Whatever the filter, its weights sum to one.
    let gl = egl();
    for size in [UVec2::new(37, 20), UVec2::new(49, 2), UVec2::new(1, 6), UVec2::splat(129)] {
        let density = Image::filled(size, 4);
        let settings = averaged(search(100, 20, Edges::Zero), Split::Larger);
        let expected = reference::radius(&density, settings.search);
        assert_same(&on_gpu(&gl, &density, settings), &expected, &format!("{size}"));
    }
}

#[test]
fn averaged_mipmaps_are_wrong_somewhere_on_odd_sizes() {
    // Otherwise the two tests above would test the summed pyramid by mistake.
    let density = random_map(37, 29, 3);
    let settings = averaged(search(60, 12, Edges::Zero), Split::Larger);
    let expected = reference::radius(&density, settings.search);
    let found = on_gpu(&egl(), &density, settings);
    assert!(Difference::between(&found.radius, &expected.radius).unwrap().wrong_pixels > 0);
}
