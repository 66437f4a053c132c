//! Pictures of one seed, drawn and timed.

use std::time::Instant;

use super::{PictureRow, PictureStudy, Width};
use crate::picture::PictureError;
use varikernel::error::Result;
use varikernel::gl::Gl;
use varikernel::image::Image;
use varikernel::photon::TraceSettings;
use varikernel::render::{Layers, Renderer};
use varikernel::scene::Scene;
use varikernel::settings::Kernel;

/// The pictures that others are compared with.
pub(super) struct Compared {
    pub(super) indirect: Image<[f32; 3]>,
    pub(super) beauty: Image<[f32; 3]>,
}

/// A scene, photons in it, and what is to come out.
pub(super) struct Place<'a> {
    pub(super) name: &'a str,
    pub(super) scene: &'a Scene,
    pub(super) photons: u32,
    pub(super) target: &'a Compared,
}

/// Photons of one seed.
pub(super) struct Studio<'a> {
    study: &'a PictureStudy,
    renderer: Renderer,
    seconds_before: f64,
}

impl<'a> Studio<'a> {
    pub(super) fn new(
        gl: &Gl,
        study: &'a PictureStudy,
        place: &Place<'_>,
        trace: &TraceSettings,
    ) -> Result<Self> {
        let settings = study.settings(Width::Fixed { radius: 1 }, study.kernels[0]);
        let mut begin = Instant::now();
        let renderer = Renderer::new(gl, place.scene, &settings, trace, &mut |progress| {
            // Direct light comes first, and is the same for all.
            if progress.stage == "direct light" {
                begin = Instant::now();
            }
        })?;
        // A read waits for what was drawn.
        renderer.surfaces().read_normal()?;
        Ok(Self { study, renderer, seconds_before: begin.elapsed().as_secs_f64() })
    }

    pub(super) fn row(
        &mut self,
        place: &Place<'_>,
        seed: u64,
        width: Width,
        kernel: Kernel,
    ) -> Result<PictureRow> {
        let settings = self.study.settings(width, kernel);
        // In a running program, shaders are there; variable radii are searched for each picture.
        self.renderer.warm_up(&settings)?;
        let begin = Instant::now();
        let (layers, account) = self.renderer.picture(&settings)?;
        let seconds_drawing = begin.elapsed().as_secs_f64();
        let error = PictureError::of_light_and_sight(
            [&layers.indirect, &place.target.indirect],
            [&layers.beauty, &place.target.beauty],
        );
        Ok(PictureRow {
            scene: place.name.to_owned(),
            photons: place.photons,
            seed,
            kernel,
            width,
            error,
            mean_radius: mean_radius(&layers),
            limited_share: account.limited_share,
            seconds_before: self.seconds_before,
            seconds_drawing,
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
