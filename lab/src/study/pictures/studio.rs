//! Pictures of one seed, drawn and timed.

use std::time::{Duration, Instant};

use super::reference::Target;
use super::{Family, PictureRow, PictureStudy, Way};
use varikernel::error::Result;
use varikernel::gl::Gl;
use varikernel::photon::TraceSettings;
use varikernel::render::{Layers, Renderer};
use varikernel::scene::Scene;
use varikernel::settings::Kernel;

/// A scene, photons in it, and what is to come out.
pub(super) struct Place<'a> {
    pub(super) name: &'a str,
    pub(super) scene: &'a Scene,
    pub(super) photons: u32,
    pub(super) target: &'a Target,
}

/// Photons of one seed.
pub(super) struct Studio<'a> {
    study: &'a PictureStudy,
    renderer: Renderer,
    /// Whether photons are sorted for what is seen in mirrors or glass.
    bends: bool,
    seconds_before: f64,
}

impl<'a> Studio<'a> {
    pub(super) fn new(
        gl: &Gl,
        study: &'a PictureStudy,
        scene: &Scene,
        trace: &TraceSettings,
    ) -> Result<Self> {
        let settings = study.settings(Way::Fixed { radius: 1 }, study.kernels[0]);
        let mut begin = Instant::now();
        let mut traced = Duration::ZERO;
        let renderer = Renderer::new(gl, scene, &settings, trace, &mut |progress| {
            // Direct light comes first, and is the same for all; shaders come last.
            if progress.stage == "direct light" {
                begin = Instant::now();
            } else {
                traced = begin.elapsed();
            }
        })?;
        Ok(Self {
            study,
            renderer,
            bends: scene.has_mirrors_or_glass(),
            seconds_before: traced.as_secs_f64(),
        })
    }

    /// A picture, its share of pixels whose search MR ended, and how long it took.
    pub(super) fn draw(&mut self, way: Way, kernel: Kernel) -> Result<(Layers, f64, Duration)> {
        if self.bends {
            // Photons are sorted in one order for tables and in another for kernels, and stay so. Each picture
            // is to begin as if they were in none.
            let other = if way == Way::Tables { Way::Fixed { radius: 1 } } else { Way::Tables };
            self.renderer.picture(&self.study.settings(other, kernel))?;
        }
        let settings = self.study.settings(way, kernel);
        // In a running program, shaders are there; photons come, and are counted for each picture.
        self.renderer.warm_up(&settings)?;
        // A read waits for what was drawn.
        self.renderer.surfaces().read_normal()?;
        let begin = Instant::now();
        self.renderer.count()?;
        let (layers, account) = self.renderer.picture(&settings)?;
        Ok((layers, account.limited_share, begin.elapsed()))
    }

    pub(super) fn row(
        &mut self,
        place: &Place<'_>,
        seed: u64,
        way: Way,
        kernel: Kernel,
    ) -> Result<PictureRow> {
        let (layers, limited_share, drawn) = self.draw(way, kernel)?;
        let (error, inside) = place.target.error(&layers);
        let is_searched = matches!(way.family(), Family::Variable | Family::Gather);
        Ok(PictureRow {
            scene: place.name.to_owned(),
            photons: place.photons,
            seed,
            kernel,
            way,
            error,
            inside,
            mean_radius: mean_radius(&layers),
            limited_share: if is_searched { limited_share } else { 0.0 },
            seconds_before: self.seconds_before,
            seconds_drawing: drawn.as_secs_f64(),
        })
    }
}

/// Over the pixels where something is seen directly: only there do radii matter.
fn mean_radius(layers: &Layers) -> f64 {
    let normals = layers.normal.values().iter();
    let radii = layers
        .radius
        .values()
        .iter()
        .zip(normals)
        .filter(|(_, normal)| normal.iter().any(|part| part.abs() > 0.0));
    let (sum, count) =
        radii.fold((0.0, 0.0), |(sum, count), (&radius, _)| (sum + f64::from(radius), count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}
