//! The panels: settings on the left, results on the right.

use clap::ValueEnum;
use egui::{Button, Color32, ComboBox, DragValue, RichText, ScrollArea, Slider, TextEdit, Ui};
use varikernel::scene::Scene;
use varikernel::settings::{Edges, Kernel, MAX_PICTURE_RADIUS, Method, Order};

use super::choices::{LEAST_A_FRAME, MOST_A_FRAME, word};
use super::state::{Beside, State, grouped};
use super::views::View;
use crate::light::Light;

/// Width of the names of rows, in points.
const NAMES: f32 = 62.0;
const SIDES: [u32; 6] = [128, 256, 384, 512, 768, 1024];

/// What is made, shown, lit and traced.
pub(super) fn choices(ui: &mut Ui, state: &mut State) {
    ScrollArea::vertical().show(ui, |ui| {
        ui.spacing_mut().slider_width = 104.0;
        source(ui, state);
        shown(ui, state);
        light(ui, state);
        photons(ui, state);
    });
}

/// What the mouse points at, how long frames take, and files.
pub(super) fn results(ui: &mut Ui, state: &mut State) {
    ScrollArea::vertical().show(ui, |ui| {
        heading(ui, "Pixel under the mouse");
        super::readout::show(ui, state);
        heading(ui, "Stages of a frame");
        state.times.show(ui);
        files(ui, state);
    });
}

fn heading(ui: &mut Ui, text: &str) {
    ui.add_space(7.0);
    ui.label(RichText::new(text).strong().size(13.5).color(Color32::from_rgb(0x8f, 0xc7, 0xff)));
    ui.separator();
}

/// A row with its name on the left.
fn row<R>(ui: &mut Ui, name: &str, contents: impl FnOnce(&mut Ui) -> R) -> R {
    ui.horizontal(|ui| {
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        ui.allocate_ui_with_layout(egui::vec2(NAMES, 18.0), layout, |ui| {
            ui.set_min_width(NAMES);
            ui.label(name);
        });
        contents(ui)
    })
    .inner
}

fn source(ui: &mut Ui, state: &mut State) {
    heading(ui, "Scene or map");
    row(ui, "scene", |ui| {
        let current = state.choices.source.clone();
        ComboBox::from_id_salt("scene").width(170.0).selected_text(short(&current)).show_ui(ui, |ui| {
            for name in Scene::shipped_names() {
                if ui.selectable_label(name == current, name).clicked() && name != current {
                    state.open_source(name);
                }
            }
        });
    });
    row(ui, "file", |ui| {
        let field = ui.add(TextEdit::singleline(&mut state.paths.open).desired_width(120.0));
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if ui.button("Open").clicked() || entered {
            let path = state.paths.open.clone();
            if Scene::shipped_names().any(|name| name == path) {
                state.open_source(&path);
            } else {
                state.open_file(path.as_ref());
            }
        }
    });
    ui.weak("or drop a scene, map or reference here");
    if state.engine.is_map() {
        return;
    }
    row(ui, "size", |ui| {
        let [width, height] = state.choices.size;
        ComboBox::from_id_salt("size").width(100.0).selected_text(format!("{width} x {height}")).show_ui(
            ui,
            |ui| {
                for side in SIDES {
                    ui.selectable_value(&mut state.choices.size, [side; 2], format!("{side} x {side}"));
                }
            },
        );
        let moved = state.orbit.is_some_and(|orbit| !orbit.is_home());
        if ui.add_enabled(moved, Button::new("Reset camera")).clicked() {
            super::keys::reset_camera(state);
        }
    });
}

fn shown(ui: &mut Ui, state: &mut State) {
    heading(ui, "Show");
    let maps = state.engine.maps();
    ui.horizontal_wrapped(|ui| {
        for view in View::ALL {
            let button = Button::selectable(state.view == view, maps.name(view));
            let hint = if state.has(view) {
                maps.words(view)
            } else if view == View::Error {
                "Drop an EXR or PNG of the picture's size here first"
            } else {
                "Not with these settings"
            };
            if ui
                .add_enabled(state.has(view), button)
                .on_hover_text(hint)
                .on_disabled_hover_text(hint)
                .clicked()
            {
                state.view = view;
            }
        }
    });
    row(ui, "beside it", |ui| {
        let text = match state.beside {
            Beside::Nothing => "nothing",
            Beside::View(view) => maps.name(view),
            Beside::Snapshot => "the snapshot",
        };
        ComboBox::from_id_salt("beside").width(100.0).selected_text(text).show_ui(ui, |ui| {
            ui.selectable_value(&mut state.beside, Beside::Nothing, "nothing");
            let shown: Vec<_> = View::ALL.into_iter().filter(|&view| state.has(view)).collect();
            for view in shown {
                ui.selectable_value(&mut state.beside, Beside::View(view), maps.name(view));
            }
            if state.snapshot.is_some() {
                ui.selectable_value(&mut state.beside, Beside::Snapshot, "the snapshot");
            }
        });
        if ui.button("Snapshot").on_hover_text("Keep this, to compare other settings with it").clicked() {
            state.take_snapshot();
        }
    });
    if state.engine.is_map() {
        return;
    }
    row(ui, "exposure", |ui| {
        let mut exposure = state.tone.exposure;
        if ui.add(Slider::new(&mut exposure, -8.0..=12.0).suffix(" stops").fixed_decimals(1)).changed() {
            (state.choices.exposure, state.tone.exposure) = (Some(exposure), exposure);
        }
        if ui.small_button("fit").on_hover_text("What suits the picture").clicked() {
            state.fit_again();
        }
    });
}

fn light(ui: &mut Ui, state: &mut State) {
    let is_map = state.engine.is_map();
    heading(ui, if is_map { "Radius" } else { "Light" });
    let choices = &mut state.choices;
    if !is_map {
        row(ui, "light", |ui| {
            for &light in Light::value_variants() {
                ui.radio_value(&mut choices.light, light, word(light));
            }
        });
        if choices.light == Light::Tables {
            ui.weak("as wide as a test of noise allows, pixel by pixel");
            return;
        }
        row(ui, "radius", |ui| {
            ui.radio_value(&mut choices.variable, true, "variable");
            ui.radio_value(&mut choices.variable, false, "fixed");
        });
    }
    if is_map || choices.variable {
        let most = if is_map { 1024 } else { MAX_PICTURE_RADIUS };
        row(ui, "n", |ui| {
            ui.add(Slider::new(&mut choices.min_photons, 1..=20_000).logarithmic(true).suffix(" photons"))
                .on_hover_text("Photons that a box has to hold");
        });
        row(ui, "MR", |ui| {
            ui.add(Slider::new(&mut choices.max_radius, 1..=most).logarithmic(true).suffix(" pixels"))
                .on_hover_text("The radius at which a search ends");
        });
        row(ui, "method", |ui| {
            let mut method = choices.method;
            choose(ui, "method", &mut method);
            if method != choices.method {
                choices.set_method(method);
            }
        });
        row(ui, "search", |ui| {
            let brackets = choices.method == Method::SummedAreaTable;
            ComboBox::from_id_salt("search").width(150.0).selected_text(word(choices.order)).show_ui(
                ui,
                |ui| {
                    for order in [Order::Forward, Order::Binary] {
                        ui.selectable_value(&mut choices.order, order, word(order));
                    }
                    if brackets {
                        ui.selectable_value(&mut choices.order, Order::Bracketed, word(Order::Bracketed));
                    }
                },
            );
        });
        row(ui, "edges", |ui| choose::<Edges>(ui, "edges", &mut choices.edges));
    } else {
        row(ui, "pixels", |ui| {
            ui.add(Slider::new(&mut choices.fixed_radius, 1..=MAX_PICTURE_RADIUS).suffix(" pixels"));
        });
    }
    if !is_map {
        row(ui, "kernel", |ui| choose::<Kernel>(ui, "kernel", &mut choices.kernel));
    }
}

fn photons(ui: &mut Ui, state: &mut State) {
    heading(ui, "Photons");
    if state.engine.is_map() {
        row(ui, "in all", |ui| ui.label(grouped(state.engine.photons())));
        return;
    }
    row(ui, "so far", |ui| {
        ui.label(RichText::new(grouped(state.engine.photons())).monospace());
        let text = if state.paused { "Go on" } else { "Pause" };
        if ui.button(text).clicked() {
            state.paused = !state.paused;
        }
    });
    let choices = &mut state.choices;
    row(ui, "up to", |ui| {
        let field = DragValue::new(&mut choices.photons).speed(1e5).range(1_u64..=1_000_000_000);
        ui.add(field.custom_formatter(|number, _| grouped(number as u64)));
    });
    row(ui, "a frame", |ui| {
        let slider =
            Slider::new(&mut choices.photons_per_frame, LEAST_A_FRAME..=MOST_A_FRAME).logarithmic(true);
        ui.add_enabled(!choices.adapt, slider);
    });
    row(ui, "adapt", |ui| {
        ui.checkbox(&mut choices.adapt, "to frames of");
        ui.add(DragValue::new(&mut choices.frame_milliseconds).range(16..=2000).suffix(" ms"));
    });
}

fn files(ui: &mut Ui, state: &mut State) {
    heading(ui, "Save");
    row(ui, "picture", |ui| {
        ui.add(TextEdit::singleline(&mut state.paths.picture).desired_width(104.0));
        if ui.button("Save").clicked() {
            state.save_picture();
        }
    });
    row(ui, "settings", |ui| {
        ui.add(TextEdit::singleline(&mut state.paths.settings).desired_width(104.0));
        if ui.button("Save ").clicked() {
            state.save_settings();
        }
    });
    ui.add_space(4.0);
    ui.weak("The same without a window:");
    let mut command = state.command();
    let size = egui::FontId::monospace(10.5);
    ui.add(TextEdit::multiline(&mut command).font(size).desired_width(f32::INFINITY).desired_rows(5));
    if state.choices.camera.is_some() {
        ui.weak("from the scene file's own camera; settings hold yours");
    }
}

fn choose<T: ValueEnum + PartialEq + Copy>(ui: &mut Ui, name: &str, value: &mut T) {
    ComboBox::from_id_salt(name).width(150.0).selected_text(word(*value)).show_ui(ui, |ui| {
        for &variant in T::value_variants() {
            ui.selectable_value(value, variant, word(variant));
        }
    });
}

/// The end of a long path.
fn short(text: &str) -> String {
    let letters: Vec<_> = text.chars().collect();
    if letters.len() <= 24 {
        text.to_owned()
    } else {
        format!("\u{2026}{}", letters[letters.len() - 23..].iter().collect::<String>())
    }
}
