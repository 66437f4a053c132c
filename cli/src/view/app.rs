//! The window's life: opened once, drawn when something changes or the picture gets better, closed by a key
//! or its button.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result};
use egui::{CentralPanel, Frame, Panel, TextureId, ViewportId};
use varikernel::Image;
use varikernel::context::window::GlWindow;
use varikernel::gl::StageTimes;
use varikernel::glam::UVec2;
use varikernel::image::write_colours;
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::window::{Window, WindowId};

use super::choices::Choices;
use super::input::Waiting;
use super::state::{Beside, State};
use super::views::View;
use super::{keys, middle, panels, passes};

/// Frames that egui takes to lay everything out after a change.
const SETTLED: u32 = 3;

/// The settings by the arguments.
pub(super) struct Wishes {
    pub(super) choices: Choices,
    pub(super) window: [u32; 2],
    pub(super) view: Option<View>,
    pub(super) beside: Beside,
    pub(super) split: f32,
    pub(super) reference: Option<PathBuf>,
    pub(super) frames: Option<u32>,
    pub(super) screenshot: Option<PathBuf>,
}

/// The program as winit runs it.
pub(super) struct App {
    wishes: Wishes,
    running: Option<Running>,
    failure: Option<anyhow::Error>,
}

/// Everything that lives as long as the window; fields are dropped in this order, so that the context goes
/// last.
struct Running {
    state: State,
    /// What times the passes of a step.
    passes: StageTimes,
    egui: egui_winit::State,
    waiting: Waiting,
    painter: egui_glow::Painter,
    /// The canvas as a texture of egui; nothing before the first frame.
    canvas: Option<TextureId>,
    /// When egui is due to be drawn again, if nothing happens before.
    wake: Option<Instant>,
    /// Frames since the picture was done.
    settled: u32,
    title: String,
    window: GlWindow,
}

impl App {
    pub(super) fn new(wishes: Wishes) -> Self {
        Self { wishes, running: None, failure: None }
    }

    /// How it ended.
    pub(super) fn result(self) -> Result<()> {
        self.failure.map_or(Ok(()), Err)
    }

    fn fail(&mut self, event_loop: &ActiveEventLoop, error: anyhow::Error) {
        self.failure = Some(error);
        event_loop.exit();
    }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.running.is_some() {
            return;
        }
        match Running::open(event_loop, &self.wishes) {
            Ok(running) => self.running = Some(running),
            Err(error) => self.fail(event_loop, error),
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(running) = &mut self.running else { return };
        match &event {
            WindowEvent::CloseRequested => return event_loop.exit(),
            WindowEvent::RedrawRequested => {
                let drawn = running.frame().and_then(|()| running.finish(&self.wishes));
                return match drawn {
                    Ok(false) => (),
                    Ok(true) => event_loop.exit(),
                    Err(error) => self.fail(event_loop, error),
                };
            }
            WindowEvent::Resized(size) => {
                running.window.resize(UVec2::new(size.width, size.height));
                running.window.window().request_redraw();
            }
            WindowEvent::DroppedFile(path) => running.state.open_file(path),
            _ => (),
        }
        if running.egui.on_window_event(running.window.window(), &event).repaint {
            running.window.window().request_redraw();
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let Some(running) = &mut self.running else { return };
        if running.wake.is_some_and(|wake| wake <= Instant::now()) {
            running.wake = None;
            running.window.window().request_redraw();
        }
        event_loop.set_control_flow(running.wake.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        if let Some(running) = &mut self.running {
            running.painter.destroy();
        }
        self.running = None;
    }
}

impl Running {
    fn open(event_loop: &ActiveEventLoop, wishes: &Wishes) -> Result<Self> {
        let [width, height] = wishes.window;
        let attributes = Window::default_attributes()
            .with_title("varikernel")
            .with_inner_size(LogicalSize::new(width, height))
            .with_min_inner_size(LogicalSize::new(760, 420));
        let window = GlWindow::open(event_loop, attributes)
            .context("no window could be opened; `varikernel render` and `varikernel radius` need none")?;
        let context = egui::Context::default();
        context.set_theme(egui::Theme::Dark);
        let mut egui = egui_winit::State::new(
            context,
            ViewportId::ROOT,
            window.window(),
            None,
            None,
            usize::try_from(window.gl().info().max_texture_size).ok(),
        );
        let mut painter = egui_glow::Painter::new(Arc::clone(window.glow()), "", None, false)
            .context("egui's shaders were refused")?;
        // What follows takes a software renderer seconds.
        greet(&window, &mut egui, &mut painter, &wishes.choices.source)?;

        let mut state = State::new(window.gl(), wishes.choices.clone())?;
        state.most_steps = wishes.frames;
        if let Some(reference) = &wishes.reference {
            state.open_reference(reference)?;
            state.message = None;
        }
        state.view = wishes.view.filter(|&view| state.has(view)).unwrap_or(state.view);
        (state.beside, state.split) = (wishes.beside, wishes.split);
        window.window().request_redraw();
        let title = String::new();
        let passes = StageTimes::new(window.gl())?;
        let waiting = Waiting::default();
        Ok(Self {
            state,
            passes,
            egui,
            waiting,
            painter,
            canvas: None,
            wake: None,
            settled: 0,
            title,
            window,
        })
    }

    /// One step of the picture, and the window drawn; the first time without a step, which takes long where
    /// shaders are compiled, so that something is seen before it.
    ///
    /// Three take turns with OpenGL's state: the library puts back what it touches, the canvas and egui set
    /// all that they need and put nothing back. So none of them may rely on the state that it left.
    fn frame(&mut self) -> Result<()> {
        let begun = Instant::now();
        let size = self.window.size();
        if size.min_element() == 0 {
            return Ok(());
        }
        let mut input = self.egui.take_egui_input(self.window.window());
        self.waiting.divide(&mut input);
        let context = self.egui.egui_ctx().clone();
        let canvas = self.canvas;
        let state = &mut self.state;
        let mut spot = None;
        let output = context.run_ui(input, |ui| spot = Some(lay_out(ui, state, canvas)));
        self.egui.handle_platform_output(self.window.window(), output.platform_output);

        self.passes.begin_frame();
        let stepped = canvas.is_some() && state.advance();
        self.passes.end_frame();
        if let Some(spot) = spot {
            let maps = state.engine.maps();
            let sides = middle::sides(state, &maps).map(|side| (*side.maps, side.view));
            let sides =
                [0, 1].map(|index| super::screen::Side { maps: &sides[index].0, view: sides[index].1 });
            let texture = state.screen.draw(&spot.place, sides, spot.split, state.tone)?;
            if self.canvas.is_none() {
                self.canvas = Some(self.painter.register_native_texture(texture));
            }
        }
        let shapes = context.tessellate(output.shapes, output.pixels_per_point);
        self.painter.clear(size.to_array(), [0.0, 0.0, 0.0, 1.0]);
        let points = output.pixels_per_point;
        self.painter.paint_and_update_textures(size.to_array(), points, &shapes, &output.textures_delta);

        let wait = output.viewport_output.get(&ViewportId::ROOT).map(|output| output.repaint_delay);
        self.schedule(wait.unwrap_or(Duration::MAX), stepped, begun);
        if canvas.is_none() {
            self.window.window().request_redraw();
        }
        Ok(())
    }

    /// Shows the frame, saves it if that was asked for, and says whether the window is to be closed.
    fn finish(&mut self, wishes: &Wishes) -> Result<bool> {
        self.settled = if self.state.is_done() { self.settled + 1 } else { 0 };
        if self.settled > 0 && self.settled <= SETTLED {
            self.window.window().request_redraw();
        }
        if let Some(path) = wishes.screenshot.as_ref().filter(|_| self.settled >= SETTLED) {
            let size = self.window.size();
            let shot = self.painter.read_screen_rgba(size.to_array());
            let colours = shot.pixels.iter().map(|pixel| [pixel.r(), pixel.g(), pixel.b()]).collect();
            write_colours(path, &Image::from_values(size, colours))?;
            self.state.quits = true;
        }
        self.window.show()?;
        // Set after the frame is shown, so that the title describes what is seen, the panels among it.
        let title = self.state.title();
        let is_seen = self.settled == 0 || self.settled >= SETTLED;
        if is_seen && title != self.title {
            self.window.window().set_title(&title);
            self.title = title;
        }
        Ok(self.state.quits)
    }

    /// When the next frame is due, and with how many photons.
    fn schedule(&mut self, wait: Duration, stepped: bool, begun: Instant) {
        let state = &mut self.state;
        if stepped {
            // What OpenGL still has to do is done when the frame is shown: with a software renderer, by this
            // thread.
            let whole = begun.elapsed();
            let mut stages = state.engine.times();
            // Of a GPU, those of a frame or a few before.
            if let Some(frame) = self.passes.poll() {
                stages.extend(passes::grouped(frame));
            }
            let known = stages.iter().map(|&(_, time)| time).sum();
            state.times.add(&stages, ("drawing", whole.saturating_sub(known)));
            state.adapt(whole);
        }
        let goes_on = !(state.paused || state.is_done());
        if goes_on || wait.is_zero() || !self.waiting.is_empty() {
            self.window.window().request_redraw();
        } else {
            self.wake = Instant::now().checked_add(wait).filter(|_| wait < Duration::from_hours(1));
        }
    }
}

/// Says what is being opened.
fn greet(
    window: &GlWindow,
    egui: &mut egui_winit::State,
    painter: &mut egui_glow::Painter,
    source: &str,
) -> Result<()> {
    let size = window.size().to_array();
    let input = egui.take_egui_input(window.window());
    let output = egui.egui_ctx().run_ui(input, |ui| {
        CentralPanel::default().show(ui, |ui| {
            ui.centered_and_justified(|ui| ui.label(format!("opening {source} \u{2026}")));
        });
    });
    let points = output.pixels_per_point;
    let shapes = egui.egui_ctx().tessellate(output.shapes, points);
    painter.clear(size, [0.0, 0.0, 0.0, 1.0]);
    painter.paint_and_update_textures(size, points, &shapes, &output.textures_delta);
    window.show()?;
    Ok(())
}

/// The whole window; without a canvas, none of the picture was drawn yet.
fn lay_out(ui: &mut egui::Ui, state: &mut State, canvas: Option<TextureId>) -> middle::Spot {
    keys::handle(ui.ctx(), state);
    Panel::left("choices").exact_size(292.0).resizable(false).show(ui, |ui| panels::choices(ui, state));
    Panel::right("results").exact_size(262.0).resizable(false).show(ui, |ui| panels::results(ui, state));
    let spot = CentralPanel::default()
        .frame(Frame::NONE.fill(egui::Color32::from_gray(20)))
        .show(ui, |ui| middle::show(ui, state, canvas))
        .inner;
    state.inspect();
    middle::message(ui, state);
    keys::help(ui, state);
    spot
}
