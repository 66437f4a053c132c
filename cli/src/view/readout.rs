//! The values of the pixel under the mouse, as text.

use egui::{Grid, RichText, Ui};

use super::state::{State, grouped};

pub(super) fn show(ui: &mut Ui, state: &State) {
    let readout = state.readout.as_ref();
    let text =
        |value: Option<String>| RichText::new(value.unwrap_or_else(|| "\u{2013}".to_owned())).monospace();
    Grid::new("readout").num_columns(2).min_col_width(74.0).spacing([8.0, 3.0]).show(ui, |ui| {
        let mut row = |name: &str, hint: &str, value: Option<String>| {
            ui.label(name).on_hover_text(hint);
            ui.label(text(value));
            ui.end_row();
        };
        row("pixel", "Column, row", readout.map(|of| format!("{}, {}", of.pixel.x, of.pixel.y)));
        if !state.engine.is_map() {
            let name = readout.map(|of| of.surface.clone().unwrap_or_else(|| "nothing".to_owned()));
            row("surface", "What the pixel shows", name);
        }
        row("photons", "Of the pixel itself", readout.map(|of| grouped(of.photons)));
        let (radius, within) =
            (readout.map(|of| of.radius.to_string()), readout.map(|of| grouped(of.within)));
        if state.has_widths() {
            row("width", "Radius of the box that its light is gathered from, in pixels", radius);
            row("within", "Photons in that box, also on faces that it does not gather from", within);
            return;
        }
        row("R", "Radius of its box, in pixels", radius);
        row("N(R)", "Photons in the box, inside of the map", within);
        let smaller = readout.map(|of| of.within_smaller.map_or_else(|| "none".to_owned(), grouped));
        row("N(R - 1)", "Photons in the next smaller box", smaller);
        let wanted =
            if state.has_radii() { grouped(state.choices.min_photons.into()) } else { "any".to_owned() };
        row("n", "Photons that a box has to hold", Some(wanted));
    });
}
