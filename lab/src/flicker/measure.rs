//! Frames drawn and compared.

use std::collections::VecDeque;

use varikernel::error::Result;
use varikernel::gl::Gl;
use varikernel::image::Image;
use varikernel::light::IrradiancePipeline;
use varikernel::maps::{PhotonPoints, SurfaceMaps};
use varikernel::photon::{Emission, PhotonPoint, TraceSettings, trace};
use varikernel::render::draw_surfaces;
use varikernel::scene::Scene;
use varikernel::settings::PictureSettings;

use super::room::{along, room};
use super::{Flicker, FlickerRow, FlickerStudy, Moves};
use crate::BOUNCES;
use crate::study::pictures::Way;

/// The parts of the room's width that the camera and the lamp move by.
const CAMERA: f32 = 0.2;
const LAMP: f32 = 0.4;
/// References have seeds of their own.
const REFERENCE_SEED: u64 = 1 << 40;

/// Measures everything; `show` is told the done share.
///
/// # Errors
/// [`Error::Setting`](varikernel::Error::Setting) outside of a setting's range;
/// [`Error::Gl`](varikernel::Error::Gl) if the driver fails.
pub fn run(gl: &Gl, study: &FlickerStudy, show: &mut dyn FnMut(f64)) -> Result<Flicker> {
    study.validate()?;
    let mut rows = Vec::new();
    for (index, moves) in (0_u32..).zip(Moves::ALL) {
        let mut show = |done: f64| show((f64::from(index) + done) / 3.0);
        rows.extend(Situation { gl, study, moves }.rows(&mut show)?);
    }
    Ok(Flicker {
        program: env!("CARGO_PKG_VERSION").to_owned(),
        commit: crate::COMMIT.to_owned(),
        renderer: gl.info().renderer.clone(),
        settings: study.clone(),
        rows,
    })
}

struct Situation<'a> {
    gl: &'a Gl,
    study: &'a FlickerStudy,
    moves: Moves,
}

/// What a frame shows, without light.
struct Frame {
    scene: Scene,
    surfaces: SurfaceMaps,
    /// Normals, and the surface's number; at most 0 where no photon lands.
    faces: Image<[f32; 4]>,
}

impl Situation<'_> {
    fn frame(&self, frame: u32) -> Result<Frame> {
        let at = |part| along(part, frame, self.study.frames);
        let scene = match self.moves {
            Moves::Nothing => room(0.0, 0.0)?,
            Moves::Camera => room(0.0, at(CAMERA))?,
            Moves::Lamp => room(at(LAMP), 0.0)?,
        };
        let surfaces = draw_surfaces(self.gl, &scene, scene.view(self.study.size()))?;
        let faces = surfaces.read_normal()?;
        Ok(Frame { scene, surfaces, faces })
    }

    fn rows(&self, show: &mut dyn FnMut(f64)) -> Result<Vec<FlickerRow>> {
        let &FlickerStudy { frames, photons, kept, reference_photons, ref ways, .. } = self.study;
        let mut tried = Vec::new();
        for &way in ways {
            tried.push(Tried::new(self.gl, self.study, way, 1)?);
        }
        tried.push(Tried::new(self.gl, self.study, ways[0], kept)?);
        let mut right = Tried::new(self.gl, self.study, Way::Tables, 1)?;
        let mut many: VecDeque<Vec<PhotonPoint>> = VecDeque::new();
        let mut latest: VecDeque<Vec<PhotonPoint>> = VecDeque::new();
        let mut references: VecDeque<Vec<f64>> = VecDeque::new();
        for number in 0..frames {
            let frame = self.frame(number)?;
            if many.is_empty() || self.moves == Moves::Lamp {
                many = VecDeque::from([traced(
                    &frame.scene,
                    reference_photons,
                    REFERENCE_SEED + u64::from(number),
                )?]);
            }
            references.push_back(right.light(self.gl, &frame, &many)?);
            latest.push_back(traced(&frame.scene, photons, 1 + u64::from(number))?);
            if latest.len() > kept as usize {
                latest.pop_front();
                references.pop_front();
            }
            for one in &mut tried {
                let light = one.light(self.gl, &frame, &latest)?;
                let reference = &references[references.len() - 1];
                let errors =
                    light.iter().zip(reference).map(|(light, reference)| light - reference).collect();
                one.take(Drawn { errors, faces: frame.faces.clone() });
            }
            show(f64::from(number + 1) / f64::from(frames));
        }
        let references: Vec<Vec<f64>> = references.into();
        let [.., last] = references.as_slice() else { unreachable!("three frames at least") };
        let row = |one: &Tried| {
            let recent = &references[references.len() - one.kept as usize..];
            // Where the camera moves, kept photons are counted as the last frame sees them.
            let ghost = if self.moves == Moves::Lamp { difference(&mean_of(recent), last) } else { 0.0 };
            let error = one.history.back().map_or(0.0, |drawn| rms(&drawn.errors) / mean(last));
            let flicker = one.flicker() / mean(last);
            FlickerRow { moves: self.moves, way: one.way, kept: one.kept, flicker, error, ghost }
        };
        Ok(tried.iter().map(row).collect())
    }
}

/// Landings of indirect light.
fn traced(scene: &Scene, photons: u32, seed: u64) -> Result<Vec<PhotonPoint>> {
    let settings = TraceSettings { photons, bounces: Some(BOUNCES), seed, russian_roulette: false };
    let emission = Emission::new(scene, &settings)?;
    let (photons, _) = trace(scene, &emission);
    Ok(photons.iter().filter(|photon| !photon.is_direct()).map(PhotonPoint::new).collect())
}

/// How far a frame's irradiance (green) is off where a face is seen, and the faces.
struct Drawn {
    errors: Vec<f64>,
    faces: Image<[f32; 4]>,
}

/// A way, and its frames so far.
struct Tried {
    way: Way,
    kept: u32,
    pipeline: IrradiancePipeline,
    /// The last three.
    history: VecDeque<Drawn>,
    /// Of second differences.
    squares: f64,
    count: f64,
}

impl Tried {
    fn new(gl: &Gl, study: &FlickerStudy, way: Way, kept: u32) -> Result<Self> {
        let usual = PictureSettings::default();
        let settings = PictureSettings {
            min_photons: way.min_photons().unwrap_or(usual.min_photons),
            radius: way.choice(),
            estimate: way.estimate(),
            ..usual
        };
        let pipeline = IrradiancePipeline::new(gl, study.size(), settings.irradiance())?;
        Ok(Self { way, kept, pipeline, history: VecDeque::new(), squares: 0.0, count: 0.0 })
    }

    /// Irradiance (green) of a frame where a face is seen.
    fn light(&mut self, gl: &Gl, frame: &Frame, latest: &VecDeque<Vec<PhotonPoint>>) -> Result<Vec<f64>> {
        let steps = latest.len().min(self.kept as usize);
        #[expect(clippy::cast_precision_loss, reason = "a few frames")]
        let share = 1.0 / steps as f32;
        let view = frame.surfaces.view();
        let landings = latest.iter().rev().take(steps).flatten().filter(|landing| landing.may_be_seen(view));
        let landings: Vec<PhotonPoint> =
            landings.map(|landing| PhotonPoint { power: share * landing.power, ..*landing }).collect();
        let mut points = PhotonPoints::new(gl);
        points.upload(&landings)?;
        let light = self.pipeline.render(&frame.surfaces, &points)?.read()?;
        let lit =
            |(light, face): (&[f32; 4], &[f32; 4])| if face[3] > 0.0 { f64::from(light[1]) } else { 0.0 };
        Ok(light.values().iter().zip(frame.faces.values()).map(lit).collect())
    }

    fn take(&mut self, drawn: Drawn) {
        self.history.push_back(drawn);
        if let [first, middle, last] = self.history.make_contiguous() {
            for pixel in 0..middle.errors.len() {
                let face = |drawn: &Drawn| drawn.faces.values()[pixel].map(f32::to_bits);
                let is_seen = middle.faces.values()[pixel][3] > 0.0;
                if is_seen && face(first) == face(middle) && face(last) == face(middle) {
                    let second = first.errors[pixel] - 2.0 * middle.errors[pixel] + last.errors[pixel];
                    self.squares += second * second / 6.0;
                    self.count += 1.0;
                }
            }
            self.history.pop_front();
        }
    }

    fn flicker(&self) -> f64 {
        (self.squares / self.count.max(1.0)).sqrt()
    }
}

fn mean(light: &[f64]) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "fewer than 2^52 pixels")]
    let count = light.len() as f64;
    light.iter().sum::<f64>() / count
}

/// The mean of some pictures of one size.
fn mean_of(pictures: &[Vec<f64>]) -> Vec<f64> {
    let of = |pixel: usize| mean(&pictures.iter().map(|picture| picture[pixel]).collect::<Vec<_>>());
    (0..pictures[0].len()).map(of).collect()
}

/// RMSE over the mean of the reference.
fn difference(picture: &[f64], reference: &[f64]) -> f64 {
    let errors: Vec<f64> = picture.iter().zip(reference).map(|(a, b)| a - b).collect();
    rms(&errors) / mean(reference)
}

fn rms(errors: &[f64]) -> f64 {
    mean(&errors.iter().map(|error| error * error).collect::<Vec<_>>()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_by_hand() {
        assert!((difference(&[1.0, 3.0], &[2.0, 2.0]) - 0.5).abs() < 1e-12);
        assert_eq!(mean_of(&[vec![1.0, 2.0], vec![3.0, 6.0]]), [2.0, 4.0]);
    }
}
