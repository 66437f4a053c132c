//! The state of the window, and how it changes from frame to frame.

mod opening;

use std::path::Path;
use std::time::Duration;

use anyhow::Result;
use varikernel::Gl;
use varikernel::glam::UVec2;
use varikernel::image::ToneMap;

use super::camera::Orbit;
use super::choices::{CameraChoice, Choices, MOST_A_FRAME};
use super::engine::{Engine, Readout};
use super::screen::{Screen, Snapshot};
use super::times::Times;
use super::views::View;
use crate::light::Light;

/// Frames whose median says how long a frame takes.
const RECENT: usize = 5;
/// Below this, the photons of a frame take hardly any time beside everything else that it does.
const LEAST_ADAPTED: u32 = 2000;

/// What is shown on the right side of the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Beside {
    Nothing,
    View(View),
    /// The same view of the snapshot.
    Snapshot,
}

/// A message that stays until the next event.
pub(super) struct Message {
    pub(super) text: String,
    pub(super) is_error: bool,
}

/// File names in the fields of the panels.
pub(super) struct Paths {
    pub(super) open: String,
    pub(super) picture: String,
    pub(super) settings: String,
}

#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub(super) struct State {
    pub(super) gl: Gl,
    pub(super) engine: Engine,
    pub(super) choices: Choices,
    /// The choices that the engine has taken last.
    accepted: Choices,
    /// Of a scene.
    pub(super) orbit: Option<Orbit>,
    pub(super) screen: Screen,
    pub(super) tone: ToneMap,
    /// Steps at which the exposure was fitted last; 0 before that.
    fitted: u32,
    pub(super) view: View,
    pub(super) beside: Beside,
    /// Where the line is, as a share of the picture's width.
    pub(super) split: f32,
    /// Whether the drag that goes on moves the line.
    pub(super) drags_line: bool,
    pub(super) snapshot: Option<Snapshot>,
    pub(super) paused: bool,
    /// Steps after which the picture is left as it is.
    pub(super) most_steps: Option<u32>,
    pub(super) help: bool,
    pub(super) message: Option<Message>,
    pub(super) paths: Paths,
    /// The pixel under the mouse, and what it holds.
    pub(super) hovered: Option<UVec2>,
    pub(super) readout: Option<Readout>,
    pub(super) times: Times,
    /// Seconds of the last frames.
    recent: [f64; RECENT],
    pub(super) quits: bool,
}

impl State {
    pub(super) fn new(gl: &Gl, choices: Choices) -> Result<Self> {
        let engine = Engine::open(gl, &choices)?;
        let mut state = Self {
            gl: gl.clone(),
            orbit: None,
            screen: Screen::new(gl)?,
            tone: ToneMap::default(),
            fitted: 0,
            view: View::Picture,
            beside: Beside::Nothing,
            split: 0.5,
            drags_line: false,
            snapshot: None,
            paused: false,
            most_steps: None,
            help: false,
            message: None,
            paths: Paths {
                open: String::new(),
                picture: "picture.png".to_owned(),
                settings: "view.json".to_owned(),
            },
            hovered: None,
            readout: None,
            times: Times::default(),
            recent: [0.1; RECENT],
            quits: false,
            accepted: choices.clone(),
            choices,
            engine,
        };
        state.source_changed();
        Ok(state)
    }

    /// Takes a step if one is due. Errors are shown, and nothing more is done until choices change.
    ///
    /// Returns whether a step was taken.
    pub(super) fn advance(&mut self) -> bool {
        self.take_choices();
        if self.paused || self.is_done() {
            return false;
        }
        if let Err(error) = self.engine.step().and_then(|()| self.fit_exposure()) {
            self.paused = true;
            self.tell_error(&error);
            return false;
        }
        self.readout = None;
        true
    }

    /// More photons a frame where frames are faster than was chosen, fewer where they are slower.
    pub(super) fn adapt(&mut self, frame: Duration) {
        if !self.choices.adapt || self.engine.is_map() {
            return;
        }
        // One slow frame, as of a first step or when mirrors are gathered, does not depend on the photons.
        self.recent.rotate_left(1);
        self.recent[RECENT - 1] = frame.as_secs_f64();
        let mut sorted = self.recent;
        sorted.sort_by(f64::total_cmp);
        let usual = sorted[RECENT / 2].max(1e-4);
        let wanted = Duration::from_millis(self.choices.frame_milliseconds.into()).as_secs_f64();
        // By less than what is measured, as other things take their time as well.
        let factor = (wanted / usual).powf(0.7).clamp(0.7, 1.4);
        let photons = f64::from(self.choices.photons_per_frame) * factor;
        // A step of few percent is not worth a change.
        if (factor - 1.0).abs() > 0.05 {
            self.choices.photons_per_frame = (photons as u32).clamp(LEAST_ADAPTED, MOST_A_FRAME);
        }
    }

    /// Whether nothing more is to do.
    pub(super) fn is_done(&self) -> bool {
        let steps = self.most_steps.is_some_and(|most| self.engine.steps() >= most);
        steps || self.engine.is_done(&self.choices)
    }

    /// Hands what was chosen to the engine; what it refuses is taken back.
    fn take_choices(&mut self) {
        let camera = self.orbit.map(|orbit| orbit.camera());
        self.choices.camera =
            self.orbit.filter(|orbit| !orbit.is_home()).map(|orbit| CameraChoice::from(orbit.camera()));
        if self.choices == self.accepted {
            return;
        }
        match self.engine.change(&self.choices, camera) {
            Ok(()) => self.accepted = self.choices.clone(),
            Err(error) => {
                self.choices = self.accepted.clone();
                self.tell_error(&error);
            }
        }
        self.readout = None;
    }

    /// Until an exposure is chosen: the one that suits the picture, found less and less often.
    fn fit_exposure(&mut self) -> Result<()> {
        if let Some(exposure) = self.choices.exposure {
            self.tone.exposure = exposure;
            return Ok(());
        }
        let steps = self.engine.steps();
        if steps >= 2 * self.fitted.max(1) || self.fitted == 0 {
            if let Some(picture) = self.engine.read()? {
                self.tone = ToneMap::fitting(&picture);
            }
            self.fitted = steps;
        }
        Ok(())
    }

    /// Lets the exposure suit the picture again.
    pub(super) fn fit_again(&mut self) {
        (self.choices.exposure, self.fitted) = (None, 0);
        if let Err(error) = self.fit_exposure() {
            self.tell_error(&error);
        }
    }

    /// Whether a view has something to show.
    pub(super) fn has(&self, view: View) -> bool {
        match view {
            View::Error => self.screen.reference_size() == Some(self.engine.maps().size),
            View::Density => true,
            View::Radius => self.has_radii() || self.has_widths(),
            View::Limited => self.has_radii(),
            _ => !self.engine.is_map(),
        }
    }

    /// Whether radii are searched.
    pub(super) fn has_radii(&self) -> bool {
        self.engine.is_map() || self.choices.irradiance().searches_radii()
    }

    /// Whether light is from tables, each pixel with a width of its own.
    pub(super) fn has_widths(&self) -> bool {
        !self.engine.is_map() && self.choices.light == Light::Tables
    }

    /// Keeps the maps as they are, to be compared with those of other choices.
    pub(super) fn take_snapshot(&mut self) {
        let words = if self.has_radii() {
            format!("n = {}, MR = {}", self.choices.min_photons, self.choices.max_radius)
        } else if self.has_widths() {
            "light from tables".to_owned()
        } else {
            format!("radius {}", self.choices.fixed_radius)
        };
        match Snapshot::of(&self.gl, &self.engine.maps(), words) {
            Ok(snapshot) => {
                self.snapshot = Some(snapshot);
                self.beside = Beside::Snapshot;
                self.tell("kept: A goes on, B is the snapshot".to_owned());
            }
            Err(error) => self.tell_error(&error),
        }
    }

    pub(super) fn save_picture(&mut self) {
        let path = self.paths.picture.clone();
        match self.engine.save(Path::new(&path), self.tone) {
            Ok(()) => self.tell(format!("written: {path}")),
            Err(error) => self.tell_error(&error),
        }
    }

    pub(super) fn save_settings(&mut self) {
        let path = self.paths.settings.clone();
        match self.choices.save(Path::new(&path), self.command()) {
            Ok(()) => self.tell(format!("written: {path}")),
            Err(error) => self.tell_error(&error),
        }
    }

    /// The same without a window.
    pub(super) fn command(&self) -> String {
        self.choices.command(self.engine.photons(), self.engine.is_map())
    }

    /// What the pixel under the mouse holds, once a step.
    pub(super) fn inspect(&mut self) {
        let Some(pixel) = self.hovered else {
            self.readout = None;
            return;
        };
        if self.engine.steps() == 0 || self.readout.as_ref().is_some_and(|readout| readout.pixel == pixel) {
            return;
        }
        match self.engine.inspect(pixel) {
            Ok(readout) => self.readout = Some(readout),
            Err(error) => self.tell_error(&error),
        }
    }

    pub(super) fn tell(&mut self, text: String) {
        self.message = Some(Message { text, is_error: false });
    }

    pub(super) fn tell_error(&mut self, error: &anyhow::Error) {
        let causes: Vec<_> = error.chain().map(ToString::to_string).collect();
        self.message = Some(Message { text: causes.join(": "), is_error: true });
    }

    /// For the window's title.
    pub(super) fn title(&self) -> String {
        let what = if self.is_done() {
            "done"
        } else if self.paused {
            "paused"
        } else {
            "working"
        };
        format!("{} \u{b7} step {}, {what} \u{b7} varikernel", self.engine.title(), self.engine.steps())
    }
}

/// 1234567 as 1,234,567.
pub(super) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let parts: Vec<_> = digits.as_bytes().rchunks(3).rev().map(String::from_utf8_lossy).collect();
    parts.join(",")
}

#[cfg(test)]
mod tests {
    #[test]
    fn thousands_are_apart() {
        assert_eq!([0, 999, 1000, 1_234_567].map(super::grouped), ["0", "999", "1,000", "1,234,567"]);
    }
}
