//! Pictures side by side with a caption below each.

use glam::UVec2;

use super::Image;
use super::map_picture::draw_text;

const BACKGROUND: [u8; 3] = [250, 250, 250];
const INK: [u8; 3] = [24, 24, 24];
/// Lengths in pixels.
const MARGIN: u32 = 12;
const GLYPH: u32 = 8;
const LINE: u32 = 12;

/// A picture and its caption, a line each.
#[derive(Clone, Debug)]
pub struct Tile {
    /// Colours for a screen.
    pub picture: Image<[u8; 3]>,
    /// Lines below it; cut off where they are wider than the picture.
    pub caption: Vec<String>,
}

/// All tiles, of one size, in rows of `columns`.
///
/// # Panics
/// If there is no tile or no column, or the sizes differ.
#[must_use]
pub fn contact_sheet(tiles: &[Tile], columns: u32) -> Image<[u8; 3]> {
    let size = tiles[0].picture.size();
    assert!(tiles.iter().all(|tile| tile.picture.size() == size), "pictures of one size");
    let count = u32::try_from(tiles.len()).expect("few tiles");
    let lines = tiles.iter().map(|tile| tile.caption.len()).max().unwrap_or(0);
    let cell = size + UVec2::new(MARGIN, MARGIN + u32::try_from(lines).expect("few lines") * LINE + LINE / 2);
    let columns = columns.min(count);
    let all = cell * UVec2::new(columns, count.div_ceil(columns)) + MARGIN;
    let mut sheet = Image::filled(all, BACKGROUND);
    for (index, tile) in (0..).zip(tiles) {
        let corner = cell * UVec2::new(index % columns, index / columns) + MARGIN;
        for y in 0..size.y {
            for x in 0..size.x {
                sheet.set(corner.x + x, corner.y + y, tile.picture.at(x, y));
            }
        }
        for (number, line) in (0..).zip(&tile.caption) {
            let fits: String = line.chars().take((size.x / GLYPH) as usize).collect();
            let at = corner + UVec2::new(0, size.y + LINE / 2 + number * LINE);
            draw_text(&mut sheet, at, &fits, 1, INK);
        }
    }
    sheet
}
