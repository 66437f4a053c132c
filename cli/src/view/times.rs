//! How long the stages of the last frames took: a bar for each, and a graph that rolls.

use std::collections::VecDeque;
use std::time::Duration;

use egui::{Align2, Color32, FontId, Rect, Sense, Stroke, Ui, pos2, vec2};

/// Frames that the graph shows.
const FRAMES: usize = 120;
const HEIGHT: f32 = 70.0;
/// Of the stages, in their order.
const COLOURS: [Color32; 9] = [
    Color32::from_rgb(0x4e, 0x9a, 0xe8),
    Color32::from_rgb(0xf2, 0xb1, 0x34),
    Color32::from_rgb(0x9b, 0x7e, 0xde),
    Color32::from_rgb(0x5f, 0xbf, 0x77),
    Color32::from_rgb(0xe8, 0x6a, 0x5e),
    Color32::from_rgb(0x4f, 0xc3, 0xc9),
    Color32::from_rgb(0xd8, 0x7a, 0xb8),
    Color32::from_rgb(0xa8, 0x8a, 0x68),
    Color32::from_rgb(0xc0, 0xc4, 0xcc),
];

/// The stages of the last frames that did something, with milliseconds.
#[derive(Default)]
pub(super) struct Times {
    frames: VecDeque<Vec<(&'static str, f32)>>,
}

impl Times {
    /// Adds a frame: its stages, and `rest` for what they do not cover.
    pub(super) fn add(&mut self, stages: &[(&'static str, Duration)], rest: (&'static str, Duration)) {
        let all = stages.iter().chain([&rest]);
        self.frames.push_back(all.map(|&(label, time)| (label, 1000.0 * time.as_secs_f32())).collect());
        if self.frames.len() > FRAMES {
            self.frames.pop_front();
        }
    }

    /// The graph, and below it the stages with the mean of the last frames.
    pub(super) fn show(&self, ui: &mut Ui) {
        let Some(last) = self.frames.back() else {
            ui.weak("no frame yet");
            return;
        };
        let mut totals: Vec<f32> =
            self.frames.iter().map(|frame| frame.iter().map(|(_, time)| time).sum()).collect();
        totals.sort_by(f32::total_cmp);
        // The slowest tenth may stick out, or a first frame would flatten all others.
        let top =
            super::views::round_up(1.2 * totals[totals.len() * 9 / 10].min(totals[totals.len() / 2] * 3.0));
        self.graph(ui, top);
        ui.add_space(4.0);
        let means: Vec<_> = last.iter().map(|&(label, _)| (label, self.mean(label))).collect();
        let longest = means.iter().map(|&(_, mean)| mean).fold(1e-3, f32::max);
        for (index, (label, mean)) in means.into_iter().enumerate() {
            bar(ui, label, mean, mean / longest, COLOURS[index % COLOURS.len()]);
        }
    }

    /// Of the last ten frames, in milliseconds.
    fn mean(&self, label: &str) -> f32 {
        let frames = self.frames.iter().rev().take(10);
        let count = self.frames.len().clamp(1, 10) as f32;
        let times = frames.flatten().filter(|(found, _)| *found == label).map(|(_, time)| time);
        times.sum::<f32>() / count
    }

    fn graph(&self, ui: &mut Ui, top: f32) {
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 3.0, Color32::from_gray(18));
        let wide = rect.width() / FRAMES as f32;
        let first = FRAMES - self.frames.len();
        for (index, frame) in self.frames.iter().enumerate() {
            let left = rect.left() + (first + index) as f32 * wide;
            let mut bottom = rect.bottom();
            for (stage, (_, time)) in frame.iter().enumerate() {
                let tall = HEIGHT * time / top;
                let bar = Rect::from_min_max(pos2(left, bottom - tall), pos2(left + wide, bottom));
                painter.rect_filled(bar, 0.0, COLOURS[stage % COLOURS.len()]);
                bottom -= tall;
            }
        }
        let half = rect.center().y;
        painter.hline(rect.x_range(), half, Stroke::new(1.0, Color32::from_white_alpha(30)));
        for (y, value, align) in
            [(rect.top() + 2.0, top, Align2::LEFT_TOP), (half - 1.0, top / 2.0, Align2::LEFT_BOTTOM)]
        {
            let at = pos2(rect.left() + 4.0, y);
            let text = format!("{value} ms");
            // A shadow, as bars may lie below.
            painter.text(at + vec2(1.0, 1.0), align, &text, FontId::proportional(10.0), Color32::BLACK);
            painter.text(at, align, text, FontId::proportional(10.0), Color32::from_gray(200));
        }
    }
}

/// A stage: its name, a bar and milliseconds.
fn bar(ui: &mut Ui, label: &str, milliseconds: f32, share: f32, colour: Color32) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 17.0), Sense::hover());
    let (middle, painter) = (rect.center().y, ui.painter_at(rect));
    let font = FontId::proportional(12.0);
    let text = ui.visuals().text_color();
    painter.text(pos2(rect.left(), middle), Align2::LEFT_CENTER, label, font.clone(), text);
    let from = rect.left() + 118.0;
    let to = rect.right() - 58.0;
    let filled = Rect::from_min_max(pos2(from, middle - 4.0), pos2(from + (to - from) * share, middle + 4.0));
    painter.rect_filled(filled, 2.0, colour);
    let number = format!("{milliseconds:.1} ms");
    painter.text(pos2(rect.right(), middle), Align2::RIGHT_CENTER, number, font, text);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_the_length_by_hand() {
        let mut times = Times::default();
        for milliseconds in 0..200 {
            times.add(&[("search", Duration::from_millis(milliseconds))], ("rest", Duration::from_millis(5)));
        }
        assert_eq!(times.frames.len(), FRAMES);
        // 190 to 199.
        assert!((times.mean("search") - 194.5).abs() < 1e-3, "{}", times.mean("search"));
        assert!((times.mean("rest") - 5.0).abs() < 1e-4);
        assert!(times.mean("nothing").abs() < 1e-6);
    }
}
