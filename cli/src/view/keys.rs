//! Keys, and a page that lists them.

use egui::{Context, Grid, Key, Modifiers, RichText, Ui};

use super::state::{Beside, State};
use super::views::View;

/// Every key with what it does, for the window and `--help`.
pub(super) const KEYS: [(&str, &str); 12] = [
    ("drag", "turn the camera around the scene"),
    ("right drag", "move the camera sideways"),
    ("wheel", "nearer, farther"),
    ("R", "the camera back to where the scene put it"),
    ("Space", "pause, go on"),
    ("1 to 7", "picture, indirect, direct, density, radius, limited, error"),
    ("B", "snapshot, shown beside the picture"),
    ("S", "radius map beside the picture, or nothing; drag the line"),
    ("P", "save the picture"),
    ("Ctrl+S", "save the settings"),
    ("F1 or H", "this page"),
    ("Q", "quit"),
];

/// Handles the keys of this frame, unless text is being typed.
pub(super) fn handle(context: &Context, state: &mut State) {
    if context.text_edit_focused() {
        return;
    }
    let saves = context.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::S));
    if saves {
        state.save_settings();
    }
    let pressed = |key| context.input(|input| input.key_pressed(key) && input.modifiers.is_none());
    let views = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7];
    for (key, view) in views.into_iter().zip(View::ALL) {
        if pressed(key) && state.has(view) {
            state.view = view;
        }
    }
    if pressed(Key::Space) {
        state.paused = !state.paused;
    }
    if pressed(Key::R) {
        reset_camera(state);
    }
    if pressed(Key::B) {
        state.take_snapshot();
    }
    if pressed(Key::S) {
        let other = if state.view == View::Radius { View::Density } else { View::Radius };
        let other = if state.has(other) { Beside::View(other) } else { Beside::View(View::Density) };
        state.beside = if state.beside == Beside::Nothing { other } else { Beside::Nothing };
    }
    if pressed(Key::P) {
        state.save_picture();
    }
    if pressed(Key::F1) || pressed(Key::H) {
        state.help = !state.help;
    }
    if pressed(Key::Escape) {
        (state.help, state.message) = (false, None);
    }
    if pressed(Key::Q) || context.input(|input| input.modifiers.command && input.key_pressed(Key::Q)) {
        state.quits = true;
    }
}

pub(super) fn reset_camera(state: &mut State) {
    if let (Some(orbit), Some((_, bounds))) = (&mut state.orbit, state.engine.camera()) {
        orbit.reset(bounds);
    }
}

/// The page of keys, over everything else.
pub(super) fn help(ui: &Ui, state: &mut State) {
    let window =
        egui::Window::new("Keys and mouse").open(&mut state.help).collapsible(false).resizable(false);
    window.anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0]).show(ui, |ui| {
        Grid::new("keys").num_columns(2).spacing([16.0, 5.0]).show(ui, |ui| {
            for (key, words) in KEYS {
                ui.label(RichText::new(key).strong());
                ui.label(words);
                ui.end_row();
            }
        });
    });
}
