//! A scene whose picture gets better: `render::Live` with the window's choices.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Result, bail};
use varikernel::glam::{UVec2, Vec3};
use varikernel::image::{Attribute, Format, LayerFile, ToneMap, write_colours};
use varikernel::light::TablesStage;
use varikernel::render::{Inspection, Live, LiveSettings};
use varikernel::settings::Estimate;
use varikernel::view::Camera;
use varikernel::{Gl, Image};

use super::Readout;
use crate::photons::load;
use crate::view::choices::Choices;
use crate::view::views::{Maps, round_up};
use crate::words::in_words_of_options;

pub(in crate::view) struct SceneEngine {
    live: Live,
}

impl SceneEngine {
    pub(super) fn open(gl: &Gl, path: &Path, choices: &Choices) -> Result<Self> {
        let scene = Arc::new(load(path)?);
        let camera = choices.camera.map_or(scene.camera, Camera::from);
        let settings = settings(&LiveSettings::new(&scene), choices, camera);
        Ok(Self { live: Live::new(gl, scene, settings).map_err(in_words_of_options)? })
    }

    pub(super) fn change(&mut self, choices: &Choices, camera: Option<Camera>) -> Result<()> {
        let camera = camera.unwrap_or(self.live.scene().camera);
        let wanted = settings(self.live.settings(), choices, camera);
        if wanted == *self.live.settings() {
            return Ok(());
        }
        self.live.change(wanted).map_err(in_words_of_options)
    }

    pub(super) fn step(&mut self) -> Result<()> {
        Ok(self.live.step()?)
    }

    pub(super) fn title(&self) -> &str {
        &self.live.scene().title
    }

    pub(super) fn photons(&self) -> u64 {
        self.live.photons()
    }

    pub(super) fn steps(&self) -> u32 {
        self.live.steps()
    }

    pub(super) fn maps(&self) -> Maps {
        let live = &self.live;
        let (size, irradiance) = (live.settings().size, live.settings().irradiance);
        // A photon lands several times; a lit pixel has about as many landings as there are photons for each
        // pixel, a caustic some dozens of times that.
        let mean = live.photons() as f32 / (size.x * size.y) as f32;
        let widths = irradiance.estimate == Estimate::Tables;
        // What a first step has not yet filled is undefined.
        let drawn = live.steps() > 0;
        Maps {
            size,
            beauty: drawn.then(|| live.beauty()),
            indirect: drawn.then(|| live.indirect()),
            direct: drawn.then(|| live.direct()),
            density: drawn.then(|| live.density()),
            radii: live.radii().filter(|_| drawn),
            limited: live.limited().filter(|_| drawn),
            widths,
            most_photons: round_up(40.0 * mean),
            max_radius: if widths { TablesStage::WIDEST } else { irradiance.radii.search.max_radius },
        }
    }

    pub(super) fn times(&self) -> Vec<(&'static str, Duration)> {
        self.live.times().to_vec()
    }

    pub(super) fn inspect(&mut self, pixel: UVec2) -> Result<Readout> {
        let Inspection { photons, radius, within, within_smaller, surface, .. } = self.live.inspect(pixel)?;
        Ok(Readout { pixel, photons, radius, within, within_smaller, surface })
    }

    pub(super) fn camera(&self) -> (Camera, (Vec3, Vec3)) {
        let scene = self.live.scene();
        (scene.camera, scene.bounds())
    }

    pub(super) fn read(&self) -> Result<Image<[f32; 3]>> {
        Ok(self.live.read()?)
    }

    pub(super) fn save(&self, path: &Path, tone: ToneMap) -> Result<()> {
        let picture = self.live.read()?;
        match Format::of(path)? {
            Format::Png => Ok(write_colours(path, &tone.apply(&picture))?),
            Format::Npy => {
                bail!("{}: a picture is written as EXR or PNG", path.display())
            }
            Format::Exr => {
                let indirect = self.live.read_indirect()?;
                let direct = difference(&picture, &indirect);
                let letters = ['R', 'G', 'B'];
                let file = LayerFile::new(picture.size())
                    .colours("", letters, &picture)
                    .colours("direct", letters, &direct)
                    .colours("indirect", letters, &indirect);
                let attributes = [
                    Attribute::text("varikernel.scene", self.title()),
                    Attribute::text("varikernel.photons", self.live.photons().to_string()),
                    Attribute::text("varikernel.settings", format!("{:?}", self.live.settings())),
                    Attribute::text("varikernel.version", env!("CARGO_PKG_VERSION")),
                ];
                Ok(file.write(path, &attributes)?)
            }
        }
    }
}

/// `settings` with everything that is chosen in the window.
fn settings(settings: &LiveSettings, choices: &Choices, camera: Camera) -> LiveSettings {
    LiveSettings {
        size: choices.size.into(),
        camera,
        irradiance: choices.irradiance(),
        bounces: choices.bounces,
        photons_per_step: choices.photons_per_frame,
        seed: choices.seed,
        ..*settings
    }
}

fn difference(from: &Image<[f32; 3]>, less: &Image<[f32; 3]>) -> Image<[f32; 3]> {
    Image::from_fn(from.size(), |x, y| {
        let (from, less) = (Vec3::from(from.at(x, y)), Vec3::from(less.at(x, y)));
        (from - less).to_array()
    })
}
