//! Pairs of small pictures by formulas in whole numbers, which another program can make as well.

use glam::UVec2;

use varikernel::image::Image;

pub(super) type Colour = fn(u32, u32) -> [u32; 3];

pub(super) fn busy(x: u32, y: u32) -> [u32; 3] {
    [(6 * x + 2 * y) % 256, 40 + 160 * ((x / 4 + y / 4) % 2), (x * x + 3 * y * y) % 256]
}

pub(super) fn smooth(x: u32, y: u32) -> [u32; 3] {
    [2 * x + y + 20, 200 - 3 * x, 60 + 4 * y]
}

/// The picture of `colour`, and one that differs from it here and there.
pub(super) fn pair(size: UVec2, colour: Colour) -> [Image<[u8; 3]>; 2] {
    let byte = |level: u32| u8::try_from(level.min(255)).expect("at most 255");
    let reference = Image::from_fn(size, |x, y| colour(x, y).map(byte));
    let picture = Image::from_fn(size, |x, y| {
        let [red, green, blue] = colour(x, y);
        let added = 9 * ((7 * x + 13 * y) % 5);
        [red + added, green.saturating_sub(6 * ((x * y) % 7)), blue + 40 * ((x / 3) % 2)].map(byte)
    });
    [reference, picture]
}
