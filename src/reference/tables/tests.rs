//! Light whose truth is known: even, steps, ramps and lines, with photons enough that noise decides nothing,
//! or with the noise of Poisson.

use glam::UVec2;

use super::{Gathered, Tables};
use crate::image::Image;

const SIZE: UVec2 = UVec2::new(40, 24);

/// One face over the whole map, where pixel (x, y) has `photons(x, y)` photons of 100 units each.
fn tables(photons: impl Fn(u32, u32) -> u32) -> Tables {
    let extent = |length: u32| u8::try_from(length.min(128)).unwrap();
    Tables {
        areas: Image::filled(SIZE, 1000),
        lit: Image::filled(SIZE, true),
        flux: Image::from_fn(SIZE, |x, y| [100 * photons(x, y), 200 * photons(x, y), 0, photons(x, y)]),
        extents: Image::from_fn(SIZE, |x, y| {
            [extent(x), extent(SIZE.x - 1 - x), extent(y), extent(SIZE.y - 1 - y)]
        }),
        square_unit: 90_000.0,
        usual_square: 1.0,
    }
}

/// Whole numbers that scatter as photons do, by a generator of 64 bits (PCG-like), with a mean of 8.
fn scattered(seed: u64) -> impl Fn(u32, u32) -> u32 {
    move |x, y| {
        let mut state = seed ^ (u64::from(x) << 32 | u64::from(y));
        (0..16)
            .map(|_| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                u32::from((state >> 40) & 1 == 1)
            })
            .sum::<u32>()
    }
}

/// Whole numbers that scatter as photons do: one of eight at 64 tries, with a mean of 8.
fn by_chance(x: u32, y: u32) -> u32 {
    let tries = (0..192).step_by(3).map(|try_of| {
        let coins = (0..3).map(|coin| coin_at(x, y, try_of + coin));
        u32::from(coins.into_iter().all(|heads| heads))
    });
    tries.sum()
}

fn at(found: &Image<Gathered>, x: u32, y: u32) -> Gathered {
    found.at(x, y)
}

#[test]
fn even_light_is_gathered_from_the_widest_boxes() {
    let found = tables(|_, _| 7).gather();
    // Boxes that the map ends grow no further, which decides nothing.
    assert!(found.values().iter().all(|pixel| pixel.radius > 32.0), "{:?}", at(&found, 0, 0));
    // 700 units over 1000, and twice that.
    let is_even = |light: [f64; 3]| (light[0] - 0.7).abs() < 1e-12 && (light[1] - 1.4).abs() < 1e-12;
    assert!(found.values().iter().all(|pixel| is_even(pixel.light)));
}

#[test]
fn noise_is_averaged_away() {
    let found = tables(scattered(1)).gather();
    let errors = found.values().iter().map(|pixel| (pixel.light[0] - 0.8).powi(2));
    let rmse = (errors.sum::<f64>() / f64::from(SIZE.element_product())).sqrt();
    // A pixel alone is off by a quarter of 0.8.
    assert!(rmse < 0.02, "{rmse}");
}

#[test]
fn a_step_keeps_its_edge() {
    let found = tables(|x, _| if x < 20 { 1000 } else { 10_000 }).gather();
    for (x, light) in [(0, 100.0), (10, 100.0), (18, 100.0), (21, 1000.0), (39, 1000.0)] {
        let pixel = at(&found, x, 12);
        assert!((pixel.light[0] / light - 1.0).abs() < 1e-2, "{x}: {pixel:?}");
    }
    assert!(at(&found, 19, 12).radius < 0.1);
    assert!(at(&found, 2, 12).radius >= 4.0, "{:?}", at(&found, 2, 12));
}

#[test]
fn a_ramp_keeps_its_slope() {
    let found = tables(|x, _| 1000 + 500 * x).gather();
    for x in 8..32 {
        let (light, truth) = (at(&found, x, 12).light[0], 100.0 + 50.0 * f64::from(x));
        assert!((light / truth - 1.0).abs() < 0.02, "{x}: {light} for {truth}");
    }
}

#[test]
fn a_line_keeps_its_width() {
    let found = tables(|x, _| if x == 20 { 100_000 } else { 1000 }).gather();
    let row: Vec<f64> = (17..24).map(|x| at(&found, x, 12).light[0].round()).collect();
    assert_eq!(row, [100.0, 100.0, 100.0, 10_000.0, 100.0, 100.0, 100.0]);
}

#[test]
fn boxes_end_where_the_face_ends() {
    let mut given = tables(|x, _| if x < 20 { 5 } else { 6 });
    // Two faces that differ by less than noise.
    given.extents = Image::from_fn(SIZE, |x, y| {
        let [left, right, down, up] = given.extents.at(x, y);
        let [near, far] = if x < 20 { [left, right - 20] } else { [left - 20, right] };
        [near, far, down, up]
    });
    let found = given.gather();
    let [near, far] = [19, 20].map(|x| at(&found, x, 3).light[0]);
    assert!((near - 0.5).abs() < 1e-12 && (far - 0.6).abs() < 1e-12, "{near} {far}");
}

/// Where a face is so small that its tests are few, they are not believed alone.
#[test]
fn small_faces_are_not_speckled() {
    const FACE: UVec2 = UVec2::new(5, 3);
    let mut given = tables(by_chance);
    let extent = |length: u32| u8::try_from(length).unwrap();
    given.extents = Image::from_fn(SIZE, |x, y| {
        let (column, row) = (x % FACE.x, y % FACE.y);
        let (right, up) = ((FACE.x - 1 - column).min(SIZE.x - 1 - x), (FACE.y - 1 - row).min(SIZE.y - 1 - y));
        [extent(column), extent(right), extent(row), extent(up)]
    });
    let found = given.gather();
    // A pixel alone is off by a third of 0.8, and the mean of a face by less than a tenth of that.
    let off = found.values().iter().filter(|pixel| (pixel.light[0] / 0.8 - 1.0).abs() > 0.4).count();
    assert!(off <= 2, "{off}");
}

#[test]
fn what_is_not_lit_is_dark_and_nothing_is_no_number() {
    let mut given = tables(|_, _| 0);
    given.areas = Image::from_fn(SIZE, |x, y| if x == y { 0 } else { 1000 });
    given.lit = given.areas.map(|area| area > 0);
    given.extents = Image::filled(SIZE, [0; 4]);
    assert!(given.gather().values().iter().all(|pixel| pixel.light.iter().all(|&light| light == 0.0)));
    let empty = Tables { extents: tables(|_, _| 0).extents, ..given };
    assert!(empty.gather().values().iter().all(|pixel| pixel.light.iter().all(|&light| light == 0.0)));
}

#[test]
fn noise_that_is_less_than_by_chance_is_known_from_narrow_boxes() {
    let share = |photons: &dyn Fn(u32, u32) -> u32| {
        let tables = tables(photons);
        tables.share_of_noise(&super::Sums::of(&tables))
    };
    // The variance of one of eight tries is 7/8 of its mean, and sixteen halves have a half, which is less
    // than the least.
    assert!((share(&by_chance) - 0.875).abs() < 0.08, "{}", share(&by_chance));
    assert!((share(&scattered(1)) - 0.75).abs() < 1e-12);
    assert!((share(&|_, _| 7) - 0.75).abs() < 1e-12);
    // Light that changes at each pixel is not taken for noise.
    assert!((share(&|x, y| 200 * ((x + y) % 2) + 1) - 1.0).abs() < 1e-12);
    // Nothing is known where there is nothing.
    assert!((share(&|_, _| 0) - 1.0).abs() < 1e-12);
}

/// Whether the `number`-th coin of a place shows heads.
fn coin_at(x: u32, y: u32, number: u64) -> bool {
    let mut state = number << 40 ^ u64::from(x) << 20 ^ u64::from(y);
    for _ in 0..3 {
        state = (state ^ state >> 31).wrapping_mul(0xBF58_476D_1CE4_E5B9).wrapping_add(0x9E37_79B9_7F4A_7C15);
    }
    state >> 63 == 1
}
