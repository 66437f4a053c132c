//! Pictures of maps: their size, their colours, and that text is there and not cut.

use glam::UVec2;
use image::RgbImage;
use tempfile::TempDir;
use varikernel::image::{Image, Picture, write_picture};

fn drawn(map: &Image<u32>, picture: &Picture<'_>) -> RgbImage {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("map.png");
    write_picture(&path, map, picture).unwrap();
    image::open(path).unwrap().into_rgb8()
}

/// The colour at a place on the bar, from 0 to 1: TURBO from 0.07 on.
fn turbo(place: f64) -> [u8; 3] {
    colorous::TURBO.eval_continuous(0.07 + 0.93 * place).as_array()
}

const BACKGROUND: [u8; 3] = [240, 240, 240];
const INK: [u8; 3] = [24, 24, 24];

/// Whether a pixel of ink lies in the rows, in any column of the picture.
fn has_ink(picture: &RgbImage, rows: std::ops::Range<u32>) -> bool {
    rows.into_iter().any(|y| (0..picture.width()).any(|x| picture.get_pixel(x, y).0 == INK))
}

#[test]
fn colours_are_spread_by_logarithm() {
    // 2 x 2 pixels are enlarged to 256 x 256. (1 + 1)^2 = 3 + 1: 1 lies halfway from 0 to 3.
    let map = Image::from_values(UVec2::new(2, 2), vec![0, 1, 3, 3]);
    let picture = drawn(&map, &Picture::default());
    for (x, y, place) in
        [(0, 0, 0.0), (127, 127, 0.0), (128, 0, 0.5), (255, 127, 0.5), (0, 128, 1.0), (255, 255, 1.0)]
    {
        assert_eq!(picture.get_pixel(x, y).0, turbo(place), "at ({x}, {y})");
    }
}

#[test]
fn a_range_is_kept_and_values_outside_get_the_colour_of_its_ends() {
    let map = Image::from_values(UVec2::new(4, 1), vec![0, 3, 7, 15]);
    let picture = drawn(&map, &Picture { range: Some(1..=7), ..Picture::default() });
    for (column, place) in [(0, 0.0), (1, 0.5), (2, 1.0), (3, 1.0)] {
        assert_eq!(picture.get_pixel(64 * column, 0).0, turbo(place), "column {column}");
    }
}

#[test]
fn the_legend_has_the_size_of_its_parts() {
    // Margin 8, bar 10, tick 3, gap 2, label 8, margin 8; 11 more for each line of text.
    let one = Image::filled(UVec2::ONE, 7);
    assert_eq!(drawn(&one, &Picture::default()).dimensions(), (256, 256 + 39));
    let titled = Picture { title: "radius", unit: "pixels", range: None };
    assert_eq!(drawn(&one, &titled).dimensions(), (256, 256 + 50));
    // 30 letters fit beside the margins of 256 pixels: "aaaaaaaaaaaaaa aaaaaaaaaaaaaaa" and the unit below.
    let long = Picture { title: "aaaaaaaaaaaaaa aaaaaaaaaaaaaaa", unit: "pixels", range: None };
    assert_eq!(drawn(&one, &long).dimensions(), (256, 256 + 61));
    let endless = "a".repeat(61);
    let endless = Picture { title: &endless, unit: "", range: None };
    assert_eq!(drawn(&one, &endless).dimensions(), (256, 256 + 39 + 33));

    // A large map is not enlarged, its text is: 800 / 384 = 2.
    let large = Image::filled(UVec2::new(800, 20), 7);
    assert_eq!(drawn(&large, &titled).dimensions(), (800, 20 + 2 * 50));
}

#[test]
fn a_narrow_map_stands_in_the_middle() {
    let picture = drawn(&Image::filled(UVec2::new(20, 300), 5), &Picture::default());
    assert_eq!(picture.dimensions(), (256, 300 + 39));
    for (x, colour) in [(117, BACKGROUND), (118, turbo(0.0)), (137, turbo(0.0)), (138, BACKGROUND)] {
        assert_eq!(picture.get_pixel(x, 150).0, colour, "column {x}");
    }
}

#[test]
fn the_bar_runs_from_the_first_colour_to_the_last() {
    let map = Image::from_values(UVec2::new(2, 1), vec![0, 100]);
    let picture = drawn(&map, &Picture::default());
    // The map is 128 high, the margin 8; the bar is 240 wide, so that no pixel is its exact middle.
    let y = 128 + 8;
    assert_eq!(picture.get_pixel(7, y).0, BACKGROUND);
    assert_eq!(picture.get_pixel(8, y).0, turbo(0.0));
    assert_eq!(picture.get_pixel(127, y).0, turbo(119.0 / 239.0));
    assert_eq!(picture.get_pixel(247, y).0, turbo(1.0));
    assert_eq!(picture.get_pixel(248, y).0, BACKGROUND);
    // Ticks at both ends, one pixel below the bar.
    for x in [8, 247] {
        assert_eq!(picture.get_pixel(x, y + 10).0, INK);
    }
}

#[test]
fn labels_do_not_touch() {
    for (lowest, highest) in
        [(0, 1), (1, 32), (0, u32::MAX), (u32::MAX - 1, u32::MAX), (1000, 1010), (95, 105), (7, 7)]
    {
        let map = Image::from_values(UVec2::new(2, 1), vec![lowest, highest]);
        let picture = drawn(&map, &Picture::default());
        // The rows of the labels: below map, margin, bar, tick and gap.
        let top = 128 + 8 + 10 + 3 + 2;
        assert!(has_ink(&picture, top..top + 8));
        assert!(!has_ink(&picture, top + 8..picture.height()), "nothing in the lower margin");
        let ticks = (0..256).filter(|&x| picture.get_pixel(x, 128 + 18).0 == INK).count();
        // Each label is a run of columns; letters have gaps of at most 4 columns, labels of at least 10.
        let inked: Vec<u32> =
            (0..256).filter(|&x| (top..top + 8).any(|y| picture.get_pixel(x, y).0 == INK)).collect();
        let labels = 1 + inked.windows(2).filter(|pair| pair[1] - pair[0] > 10).count();
        assert_eq!(ticks, labels, "{lowest} to {highest}");
        assert!(inked[0] >= 8 && inked[inked.len() - 1] < 248, "{lowest} to {highest} is cut");
    }
}

#[test]
fn letters_outside_the_font_are_shown_as_boxes() {
    let picture = Picture { title: "\u{1f4a1}", unit: "", range: None };
    let picture = drawn(&Image::filled(UVec2::ONE, 7), &picture);
    // The box's upper edge: columns 1 to 6 of the first letter.
    let row: Vec<bool> = (8..16).map(|x| picture.get_pixel(x, 264).0 == INK).collect();
    assert_eq!(row, [false, true, true, true, true, true, true, false]);
}
