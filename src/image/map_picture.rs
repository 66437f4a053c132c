//! A map as a picture to look at: colours, and below them a legend with a bar, ticks, title and unit.

use std::ops::RangeInclusive;

use font8x8::{BASIC_FONTS, LATIN_FONTS, UnicodeFonts};
use glam::UVec2;

use super::Image;
use super::colour_map::ColourMap;

/// A picture's legend, and the range of its colours.
///
/// The colours are spread by logarithm, so that small values can be distinguished. The map is enlarged by a
/// whole factor until its longer side has 256 pixels; the picture is at least 256 pixels wide, and the
/// legend's text grows with it.
#[derive(Clone, Debug, Default)]
pub struct Picture<'a> {
    /// One line or more, broken where it does not fit.
    pub title: &'a str,
    /// The unit of the values, for example `pixels`; none if empty.
    pub unit: &'a str,
    /// The values at the ends of the bar, lowest first; values outside get the colour of the nearer end.
    /// `None` takes the lowest and highest value of the map.
    pub range: Option<RangeInclusive<u32>>,
}

/// Light, as the colours of the lowest and highest values are dark.
const BACKGROUND: [u8; 3] = [240, 240, 240];
const INK: [u8; 3] = [24, 24, 24];

/// The least width of a picture, and of the longer side of the enlarged map.
const LEAST_SIDE: u32 = 256;

/// Lengths of the legend, in font pixels: [`Legend::scale`] pixels of the picture each.
const MARGIN: u32 = 8;
const GLYPH: u32 = 8;
const LINE: u32 = 11;
const BAR: u32 = 10;
const TICK: u32 = 3;
const LABEL_GAP: u32 = 2;

/// The colours of a map alone, a pixel for each value, without a legend.
#[cfg(feature = "scene")]
#[must_use]
pub fn picture_of(image: &Image<u32>, picture: &Picture<'_>) -> Image<[u8; 3]> {
    let colours = ColourMap::new(picture.range.as_ref(), image);
    image.map(|value| colours.colour(value))
}

/// Draws the map and its legend.
pub(super) fn draw(image: &Image<u32>, picture: &Picture<'_>) -> Image<[u8; 3]> {
    let colours = ColourMap::new(picture.range.as_ref(), image);
    let factor = LEAST_SIDE.div_ceil(image.size().max_element());
    let map = image.size() * factor;
    let width = map.x.max(LEAST_SIDE);
    let legend = Legend::new(picture, width);

    let mut canvas = Image::filled(UVec2::new(width, map.y + legend.height()), BACKGROUND);
    let left = (width - map.x) / 2;
    for y in 0..map.y {
        for x in 0..map.x {
            canvas.set(left + x, y, colours.colour(image.at(x / factor, y / factor)));
        }
    }
    legend.draw(&mut canvas, map.y, &colours);
    canvas
}

struct Legend {
    /// Pixels of the picture for one of the font.
    scale: u32,
    width: u32,
    lines: Vec<String>,
}

impl Legend {
    fn new(picture: &Picture<'_>, width: u32) -> Self {
        let scale = (width / 384).max(1);
        let unit = if picture.unit.is_empty() { String::new() } else { format!("[{}]", picture.unit) };
        let letters = (width / scale - 2 * MARGIN) / GLYPH;
        Self { scale, width, lines: wrap(&format!("{} {unit}", picture.title), letters as usize) }
    }

    fn text_height(&self) -> u32 {
        u32::try_from(self.lines.len()).expect("few lines") * LINE
    }

    fn height(&self) -> u32 {
        (MARGIN + self.text_height() + BAR + TICK + LABEL_GAP + GLYPH + MARGIN) * self.scale
    }

    fn draw(&self, canvas: &mut Image<[u8; 3]>, top: u32, colours: &ColourMap) {
        let scale = self.scale;
        let (left, bar_width) = (MARGIN * scale, self.width - 2 * MARGIN * scale);
        let mut y = top + MARGIN * scale;
        for line in &self.lines {
            draw_text(canvas, UVec2::new(left, y), line, scale, INK);
            y += LINE * scale;
        }

        for x in 0..bar_width {
            let place = f64::from(x) / f64::from(bar_width - 1);
            fill(canvas, UVec2::new(left + x, y), UVec2::new(1, BAR * scale), colours.bar_colour(place));
        }
        y += BAR * scale;

        // The ends first: they stay, and a tick between them is dropped where its label would touch another.
        let mut taken: Vec<(u32, u32)> = Vec::new();
        let ends = [colours.lowest(), colours.highest()];
        for value in ends.into_iter().chain(ticks(colours.lowest(), colours.highest())) {
            let label = value.to_string();
            let label_width = u32::try_from(label.len()).expect("ten digits") * GLYPH * scale;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "from 0 to the width of the bar"
            )]
            let x = (colours.place(value) * f64::from(bar_width - scale)).round() as u32;
            let start = (x + scale / 2).saturating_sub(label_width / 2).min(bar_width - label_width);
            let gap = 2 * GLYPH * scale;
            if taken.iter().any(|&(from, to)| start < to + gap && from < start + label_width + gap) {
                continue;
            }
            taken.push((start, start + label_width));
            fill(canvas, UVec2::new(left + x, y), UVec2::new(scale, TICK * scale), INK);
            let at = UVec2::new(left + start, y + (TICK + LABEL_GAP) * scale);
            draw_text(canvas, at, &label, scale, INK);
        }
    }
}

/// Draws one line of text, `scale` pixels for one of the font.
pub(super) fn draw_text(canvas: &mut Image<[u8; 3]>, at: UVec2, text: &str, scale: u32, ink: [u8; 3]) {
    for (column, letter) in (0..).zip(text.chars()) {
        let glyph = BASIC_FONTS.get(letter).or_else(|| LATIN_FONTS.get(letter)).unwrap_or(UNKNOWN);
        for (y, row) in (0..).zip(glyph) {
            for x in (0..GLYPH).filter(|x| row >> x & 1 == 1) {
                let corner = at + UVec2::new(column * GLYPH + x, y) * scale;
                fill(canvas, corner, UVec2::splat(scale), ink);
            }
        }
    }
}

/// A box, for letters that the font lacks.
const UNKNOWN: [u8; 8] = [0x7e, 0x42, 0x42, 0x42, 0x42, 0x42, 0x7e, 0];

fn fill(canvas: &mut Image<[u8; 3]>, corner: UVec2, size: UVec2, colour: [u8; 3]) {
    for y in corner.y..corner.y + size.y {
        for x in corner.x..corner.x + size.x {
            canvas.set(x, y, colour);
        }
    }
}

/// Round values strictly between the ends, the best first: 1, 2 and 5 times each power of ten suit a bar
/// spread by logarithm, even steps fill it where the range begins far from zero.
fn ticks(lowest: u32, highest: u32) -> impl Iterator<Item = u32> {
    let round: Vec<u64> =
        (0..10).flat_map(|power| [1, 2, 5].map(|digit| digit * 10_u64.pow(power))).collect();
    let range = u64::from(highest - lowest);
    let step =
        *round.iter().find(|&step| range / step <= 10).expect("the last step is longer than any range");
    let multiples = (u64::from(lowest) / step + 1..=u64::from(highest) / step).map(move |k| k * step);
    round
        .into_iter()
        .chain(multiples)
        .filter_map(|value| u32::try_from(value).ok())
        .filter(move |&value| lowest < value && value < highest)
}

/// The text in lines of at most `letters` letters, broken between words where that is possible.
fn wrap(text: &str, letters: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let word: Vec<char> = word.chars().collect();
        for part in word.chunks(letters) {
            match lines.last_mut() {
                Some(line) if line.chars().count() + 1 + part.len() <= letters => {
                    line.push(' ');
                    line.extend(part);
                }
                _ => lines.push(part.iter().collect()),
            }
        }
    }
    lines
}
