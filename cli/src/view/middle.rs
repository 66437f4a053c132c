//! The middle of the window: the picture, what the mouse does to it, the line between its sides, and legends.

use egui::{
    Align2, Color32, CursorIcon, FontId, Mesh, PointerButton, Pos2, Rect, Response, Sense, Shape, Stroke,
    StrokeKind, TextureId, Ui, Vec2, pos2, vec2,
};
use varikernel::glam::{self, UVec2};
use varikernel::image::colour_of_bar;

use super::screen::{Placement, Side};
use super::state::{Beside, State};
use super::views::{Maps, View, place, ticks};

/// Height of the strip of legends below the picture, in points.
const LEGENDS: f32 = 52.0;
/// How near the line a drag has to begin to move it, in points.
const NEAR: f32 = 9.0;

/// Where the picture goes, to be drawn before egui is painted.
pub(super) struct Spot {
    pub(super) place: Placement,
    /// Column of the line on the canvas, or beyond.
    pub(super) split: f32,
}

/// Lays the middle out, and takes what the mouse does there.
pub(super) fn show(ui: &mut Ui, state: &mut State, texture: Option<TextureId>) -> Spot {
    let whole = ui.available_rect_before_wrap();
    let below = Rect::from_min_max(pos2(whole.left(), whole.bottom() - LEGENDS), whole.max);
    let scale = ui.ctx().pixels_per_point();
    // On whole pixels, so that the canvas is shown as it is drawn.
    let snap = |at: Pos2| (at * scale).round() / scale;
    let rect = Rect::from_min_max(snap(whole.min), snap(pos2(whole.right(), below.top())));
    let maps = state.engine.maps();
    let canvas = (rect.size() * scale).round();
    let place = Placement::fitting(maps.size, UVec2::new(canvas.x as u32, canvas.y as u32).max(UVec2::ONE));
    let to_screen = |at: glam::Vec2| rect.min + vec2(at.x, at.y) / scale;
    let picture = Rect::from_min_max(
        to_screen(place.origin),
        to_screen(place.origin + place.scale * maps.size.as_vec2()),
    );

    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    let line = picture.left() + state.split * picture.width();
    let has_line = state.beside != Beside::Nothing;
    mouse(ui, state, &response, picture, has_line.then_some(line));
    state.hovered = response.hover_pos().and_then(|at| {
        let at = (at - rect.min) * scale;
        place.pixel(glam::Vec2::new(at.x, at.y), maps.size)
    });

    let painter = ui.painter_at(rect);
    if let Some(texture) = texture {
        let all = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        painter.image(texture, rect, all, Color32::WHITE);
    } else {
        let text = "compiling shaders for the first step \u{2026}";
        painter.text(rect.center(), Align2::CENTER_CENTER, text, FontId::proportional(15.0), Color32::GRAY);
    }
    if let Some(readout) = &state.readout {
        let (pixel, radius) = (readout.pixel.as_vec2(), readout.radius as f32);
        let first = to_screen(place.origin + place.scale * (pixel - radius));
        let end = to_screen(place.origin + place.scale * (pixel + radius + 1.0));
        let stroke = Stroke::new(1.5, Color32::from_rgb(0xff, 0xe0, 0x66));
        let painter = painter.with_clip_rect(picture.expand(1.0));
        painter.rect_stroke(Rect::from_min_max(first, end), 0.0, stroke, StrokeKind::Outside);
    }
    let line = picture.left() + state.split * picture.width();
    if has_line {
        draw_line(ui, state, &maps, picture, line);
    }
    let absent = match state.view {
        View::Radius if maps.radii.is_none() => Some("the radius is fixed"),
        View::Limited if maps.limited.is_none() => Some("no radii are searched"),
        _ => None,
    };
    if let Some(text) = absent.filter(|_| !has_line && state.engine.steps() > 0) {
        let font = FontId::proportional(15.0);
        painter.text(picture.center(), Align2::CENTER_CENTER, text, font, Color32::GRAY);
    }
    legends(ui, state, below);
    let split = if has_line { (line - rect.left()) * scale } else { canvas.x + 1.0 };
    Spot { place, split }
}

/// Drags and the wheel: the line, or the camera.
fn mouse(ui: &Ui, state: &mut State, response: &Response, picture: Rect, line: Option<f32>) {
    let is_near = |at: Pos2| line.is_some_and(|line| (at.x - line).abs() < NEAR);
    if response.drag_started() {
        // Where the button went down, not where the drag was noticed.
        let origin = ui.input(|input| input.pointer.press_origin());
        state.drags_line = origin.is_some_and(is_near);
    }
    let drag = response.drag_delta();
    if response.dragged() && state.drags_line {
        if let Some(at) = response.interact_pointer_pos() {
            state.split = ((at.x - picture.left()) / picture.width()).clamp(0.0, 1.0);
        }
    } else if let Some(orbit) = &mut state.orbit {
        if response.dragged_by(PointerButton::Primary) && drag != Vec2::ZERO {
            orbit.turn(drag.x, drag.y);
        } else if response.dragged_by(PointerButton::Secondary) && drag != Vec2::ZERO {
            orbit.pan(drag.x / picture.height(), drag.y / picture.height());
        }
        let wheel = ui.input(|input| input.smooth_scroll_delta().y);
        if response.hovered() && wheel != 0.0 {
            orbit.zoom(wheel / 50.0);
        }
    }
    if response.dragged() && state.drags_line || response.hover_pos().is_some_and(is_near) {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
    } else if response.dragged() {
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
    }
}

/// The line, with the names of its sides.
fn draw_line(ui: &Ui, state: &State, maps: &Maps, picture: Rect, line: f32) {
    let painter = ui.painter_at(picture);
    painter.vline(line, picture.y_range(), Stroke::new(3.0, Color32::from_black_alpha(120)));
    painter.vline(line, picture.y_range(), Stroke::new(1.0, Color32::WHITE));
    painter.circle(
        pos2(line, picture.center().y),
        6.0,
        Color32::from_black_alpha(160),
        Stroke::new(1.0, Color32::WHITE),
    );
    let [a, b] = sides(state, maps).map(|side| side.maps.name(side.view));
    let other = match (state.beside, &state.snapshot) {
        (Beside::Snapshot, Some(snapshot)) => format!("B  {b} of the snapshot, {}", snapshot.words),
        _ => format!("B  {b}"),
    };
    let font = FontId::proportional(13.0);
    let top = picture.top() + 7.0;
    for (at, align, text) in [
        (pos2(line - 10.0, top), Align2::RIGHT_TOP, format!("A  {a}")),
        (pos2(line + 10.0, top), Align2::LEFT_TOP, other),
    ] {
        let galley = painter.layout_no_wrap(text, font.clone(), Color32::WHITE);
        let rect = align.anchor_size(at, galley.size());
        painter.rect_filled(rect.expand2(vec2(5.0, 2.0)), 4.0, Color32::from_black_alpha(170));
        painter.galley(rect.min, galley, Color32::WHITE);
    }
}

/// What the two sides show: the picture itself may be one of them.
pub(super) fn sides<'a>(state: &'a State, maps: &'a Maps) -> [Side<'a>; 2] {
    let a = Side { maps, view: state.view };
    let b = match (state.beside, &state.snapshot) {
        (Beside::View(view), _) => Side { maps, view },
        (Beside::Snapshot, Some(snapshot)) => Side { maps: snapshot.maps(), view: state.view },
        _ => a,
    };
    [a, b]
}

/// A legend for each side that has colours, or how the light is shown.
fn legends(ui: &Ui, state: &State, strip: Rect) {
    let maps = state.engine.maps();
    let [a, b] = sides(state, &maps);
    if state.beside == Beside::Nothing {
        let wide = strip.width().min(560.0);
        let rect = Rect::from_center_size(strip.center(), vec2(wide, strip.height()));
        legend(ui, state, &a, rect, "");
    } else {
        let (left, right) = strip.split_left_right_at_fraction(0.5);
        legend(ui, state, &a, left.shrink2(vec2(16.0, 0.0)), "A  ");
        legend(ui, state, &b, right.shrink2(vec2(16.0, 0.0)), "B  ");
    }
}

fn legend(ui: &Ui, state: &State, side: &Side<'_>, rect: Rect, letter: &str) {
    let painter = ui.painter();
    let (font, ink) = (FontId::proportional(12.0), Color32::from_gray(205));
    let Some(unit) = side.maps.unit(side.view) else {
        let text = format!(
            "{letter}{}, tone-mapped at {:+.1} stops",
            side.maps.name(side.view),
            state.tone.exposure
        );
        painter.text(rect.center(), Align2::CENTER_CENTER, text, font, ink);
        return;
    };
    if side.view == View::Limited {
        let text = format!("{letter}{unit}");
        painter.text(rect.center(), Align2::CENTER_CENTER, text, font, ink);
        return;
    }
    painter.text(pos2(rect.left(), rect.top() + 4.0), Align2::LEFT_TOP, format!("{letter}{unit}"), font, ink);
    let (top, bottom) = (rect.top() + 21.0, rect.top() + 31.0);
    let bar = Rect::from_min_max(pos2(rect.left(), top), pos2(rect.right(), bottom));
    painter.add(Shape::mesh(colour_bar(bar)));
    let range = side.maps.range(side.view);
    for value in ticks(range, 26.0 / bar.width()) {
        let x = bar.left() + bar.width() * place(value, range);
        painter.vline(x, bar.bottom()..=bar.bottom() + 4.0, Stroke::new(1.0, ink));
        let at = pos2(x, bar.bottom() + 5.0);
        painter.text(at, Align2::CENTER_TOP, number(value), FontId::proportional(11.0), ink);
    }
}

/// 20000 as 20k.
fn number(value: f32) -> String {
    match value {
        1e6.. => format!("{}M", value / 1e6),
        1e4.. => format!("{}k", value / 1e3),
        _ => value.to_string(),
    }
}

fn colour_bar(bar: Rect) -> Mesh {
    const PARTS: u16 = 64;
    let mut mesh = Mesh::default();
    for part in 0..=PARTS {
        let share = f32::from(part) / f32::from(PARTS);
        let [red, green, blue] = colour_of_bar(share.into());
        let x = bar.left() + share * bar.width();
        for y in [bar.top(), bar.bottom()] {
            mesh.colored_vertex(pos2(x, y), Color32::from_rgb(red, green, blue));
        }
    }
    for part in 0..u32::from(PARTS) {
        let first = 2 * part;
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first + 1, first + 2, first + 3);
    }
    mesh
}

/// The last message, over the picture.
pub(super) fn message(ui: &Ui, state: &mut State) {
    let Some(message) = &state.message else { return };
    let (text, is_error) = (message.text.clone(), message.is_error);
    let mut closes = false;
    let fill =
        if is_error { Color32::from_rgb(0x5c, 0x1f, 0x24) } else { Color32::from_rgb(0x24, 0x3a, 0x2e) };
    let area = egui::Area::new("message".into()).anchor(Align2::CENTER_BOTTOM, [0.0, -60.0]);
    area.show(ui, |ui| {
        egui::Frame::popup(ui.style()).fill(fill).show(ui, |ui| {
            ui.set_max_width(520.0);
            ui.horizontal(|ui| {
                closes = ui.button("\u{d7}").clicked();
                ui.add(egui::Label::new(egui::RichText::new(text).color(Color32::WHITE)).wrap());
            });
        });
    });
    if closes {
        state.message = None;
    }
}
