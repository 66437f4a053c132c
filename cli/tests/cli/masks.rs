//! `--mask` with the files that paint programs make.

use glam::UVec2;
use image::{GrayImage, LumaA, Rgb, RgbImage, Rgba, RgbaImage};
use varikernel::Image;

use crate::Workplace;

const SIZE: UVec2 = UVec2::new(9, 5);

fn is_needed(x: u32, y: u32) -> bool {
    x > 2 && !(x + y).is_multiple_of(3)
}

/// A map, and the radii that it has where they are needed.
fn workplace() -> (Workplace, Image<u32>) {
    let place = Workplace::new();
    place.put_map("map.npy", &Image::from_fn(SIZE, |x, y| x + 2 * y));
    place.answer("radius map.npy -o all.npy -n 9 -r 4");
    let all = place.map("all.npy");
    let expected = Image::from_fn(SIZE, |x, y| if is_needed(x, y) { all.at(x, y) } else { 0 });
    (place, expected)
}

#[test]
fn masks_of_every_kind_say_the_same() {
    let (place, expected) = workplace();
    let level = |x, y, set: u8| if is_needed(x, y) { set } else { 0 };
    GrayImage::from_fn(SIZE.x, SIZE.y, |x, y| [level(x, y, 1)].into()).save(place.path("grey.png")).unwrap();
    RgbImage::from_fn(SIZE.x, SIZE.y, |x, y| Rgb([0, level(x, y, 7), 0]))
        .save(place.path("rgb.png"))
        .unwrap();
    RgbaImage::from_fn(SIZE.x, SIZE.y, |x, y| Rgba([255, 255, 255, level(x, y, 9)]))
        .save(place.path("rgba.png"))
        .unwrap();
    image::GrayAlphaImage::from_fn(SIZE.x, SIZE.y, |x, y| LumaA([level(x, y, 200), 255]))
        .save(place.path("grey-alpha.png"))
        .unwrap();
    for mask in ["grey.png", "rgb.png", "rgba.png", "grey-alpha.png"] {
        place.answer(&format!("radius map.npy -o out.npy -n 9 -r 4 --mask {mask} --verify"));
        assert_eq!(place.map("out.npy"), expected, "{mask}");
    }
}

#[test]
fn a_mask_is_refused_in_words_about_masks() {
    let (place, _) = workplace();
    RgbImage::new(3, 3).save(place.path("small.png")).unwrap();
    place.refuses(
        "radius map.npy -o out.npy --mask small.png",
        &["small.png: the mask is 3 x 3 pixels, and the map 9 x 5", "help: give one of the map's size"],
    );
    place.refuses(
        "radius map.npy -o small.png --mask small.png",
        &["small.png: --output is the same file as the mask", "help: choose another name"],
    );
    place.put("broken.png", &place.bytes("small.png")[..60]);
    place.refuses("radius map.npy -o out.npy --mask broken.png", &["broken.png", "truncated"]);
}
