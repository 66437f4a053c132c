//! What is opened in the window: scenes, maps, references and saved settings. On an error, all stays as it
//! was.

use std::path::Path;

use anyhow::{Result, bail};
use varikernel::image::{Format, ReadOptions, read_colours, read_counts};

use super::{Beside, RECENT, State};
use crate::view::camera::Orbit;
use crate::view::choices::Choices;
use crate::view::engine::Engine;
use crate::view::times::Times;
use crate::view::views::View;

impl State {
    /// Opens a scene or map by its name; on an error the old one stays.
    pub(in crate::view) fn open_source(&mut self, source: &str) {
        let choices = Choices { source: source.to_owned(), camera: None, ..self.choices.clone() };
        self.open_choices(choices);
    }

    fn open_choices(&mut self, choices: Choices) {
        match Engine::open(&self.gl, &choices) {
            Ok(engine) => {
                self.engine = engine;
                self.accepted = choices.clone();
                self.choices = choices;
                self.source_changed();
                self.tell(format!("opened {}", self.choices.source));
            }
            Err(error) => self.tell_error(&error),
        }
    }

    pub(super) fn source_changed(&mut self) {
        self.orbit = self.engine.camera().map(|(home, bounds)| {
            let mut orbit = Orbit::new(home, bounds);
            if let Some(camera) = self.choices.camera {
                orbit.place(camera.into(), bounds);
            }
            orbit
        });
        if self.engine.is_map() {
            self.view = if self.view.is_of_maps() { self.view } else { View::Radius };
            if matches!(self.beside, Beside::View(view) if !view.is_of_maps()) {
                self.beside = Beside::Nothing;
            }
            "radius.png".clone_into(&mut self.paths.picture);
        } else {
            "picture.png".clone_into(&mut self.paths.picture);
        }
        self.paths.open.clone_from(&self.choices.source);
        self.fitted = 0;
        self.snapshot = None;
        if self.beside == Beside::Snapshot {
            self.beside = Beside::Nothing;
        }
        (self.readout, self.hovered, self.paused) = (None, None, false);
        self.times = Times::default();
        self.recent = [f64::from(self.choices.frame_milliseconds) / 1000.0; RECENT];
    }

    /// Opens any file that the window supports: saved settings (.json), a map, a reference (a picture), else
    /// a scene.
    pub(in crate::view) fn open_file(&mut self, path: &Path) {
        let name = path.to_string_lossy().into_owned();
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json")) {
            match Choices::load(path) {
                Ok(choices) => self.open_choices(choices),
                Err(error) => self.tell_error(&error),
            }
        } else if Format::of(path).is_err() || read_counts(path, &ReadOptions::default()).is_ok() {
            self.open_source(&name);
        } else if let Err(picture) = self.open_reference(path) {
            // It is neither: the error is that of a map, and for colours that of a reference.
            match read_colours(path) {
                Ok(_) => self.tell_error(&picture),
                Err(_) => self.open_source(&name),
            }
        }
    }

    /// Takes a picture that errors are taken against from now on.
    ///
    /// # Errors
    /// If it can't be read, or has another size than the picture.
    pub(in crate::view) fn open_reference(&mut self, path: &Path) -> Result<()> {
        let reference = read_colours(path)?;
        let (size, wanted) = (reference.size(), self.engine.maps().size);
        if self.engine.is_map() {
            bail!(
                "{}: a picture is a reference for scenes, and a map is open\nhelp: open a scene first",
                path.display()
            );
        }
        if size != wanted {
            bail!(
                "{}: the reference has {} x {} pixels, and the picture {} x {}\n\
                 help: choose the size of the picture to fit",
                path.display(),
                size.x,
                size.y,
                wanted.x,
                wanted.y
            );
        }
        self.screen.set_reference(&reference)?;
        self.view = View::Error;
        self.tell(format!("errors are against {}", path.display()));
        Ok(())
    }
}
