//! A picture that gets better step by step, for a window or a host: photons come a few at a time, and the
//! camera may move.
//!
//! Each step traces some photons, counts them, searches radii for all photons so far, and draws the new ones
//! with these; direct light gets some more shadow rays. So a step costs the same however long the picture has
//! been getting better. With n as it is, kernels shrink as photons come: the picture sharpens, at a noise
//! that n decides (see [`irradiance`](crate::light::irradiance)).
//!
//! Where the camera moves, the photons of the latest steps are counted again, as the new view sees them: the
//! scene has not changed, and they are as good as new ones ([`LiveSettings::landings_kept`]).

mod direct;
mod inspection;
mod kept;
mod settings;
mod through;

pub use inspection::Inspection;
pub use settings::LiveSettings;

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::UVec2;

use super::rgb;
use super::sight::Sight;
use crate::error::Result;
use crate::gl::Gl;
use crate::image::Image;
use crate::light::IrradiancePipeline;
use crate::maps::{PhotonPoints, SurfaceMaps};
use crate::photon::{Emission, PhotonPoint, trace};
use crate::render::shade::ShadeStage;
use crate::render::surfaces::SurfaceStage;
use crate::scene::Scene;
use direct::ProgressiveDirect;
use inspection::Inspector;
use kept::Kept;
use through::ProgressiveThrough;

/// A photon's power is multiplied with the number of photons of its step over this, so that steps of any
/// number add up.
const UNIT: f32 = 65_536.0;

/// A scene, and a picture of it in the making.
#[derive(Debug)]
pub struct Live {
    gl: Gl,
    scene: Arc<Scene>,
    settings: LiveSettings,
    surface_stage: SurfaceStage,
    shown: Shown,
    pipeline: IrradiancePipeline,
    points: PhotonPoints,
    shade: ShadeStage,
    inspector: Inspector,
    kept: Kept,
    /// Whether what is kept is not counted yet.
    recounts: bool,
    /// Photons that left the lights.
    emitted: u64,
    steps: u32,
    /// Steps with this seed: those after a move go on with other photons.
    traced: u32,
    times: Vec<(&'static str, Duration)>,
}

/// What depends on the camera alone.
#[derive(Debug)]
struct Shown {
    surfaces: SurfaceMaps,
    direct: ProgressiveDirect,
    through: ProgressiveThrough,
}

impl Shown {
    fn new(stage: &SurfaceStage, scene: &Scene, settings: &LiveSettings) -> Result<Self> {
        let view = settings.view(scene);
        let mut surfaces = stage.draw(scene, view)?;
        let sight = Sight::new(scene, &view, false);
        sight.paint(&mut surfaces)?;
        let keeps = settings.keeps_landings() && scene.has_mirrors_or_glass();
        let through = ProgressiveThrough::new(view, sight.bent.clone(), keeps);
        Ok(Self { surfaces, direct: ProgressiveDirect::new(settings.size, sight, settings.seed), through })
    }
}

impl Live {
    /// Draws the surfaces; no light yet.
    ///
    /// # Errors
    /// [`Error::Setting`](crate::Error::Setting) outside of a setting's range, or if no light shines;
    /// [`Error::TooLarge`](crate::Error::TooLarge); [`Error::Shader`](crate::Error::Shader);
    /// [`Error::Gl`](crate::Error::Gl) when memory runs out.
    pub fn new(gl: &Gl, scene: Arc<Scene>, settings: LiveSettings) -> Result<Self> {
        settings.validate(&scene)?;
        let surface_stage = SurfaceStage::new(gl)?;
        Ok(Self {
            gl: gl.clone(),
            shown: Shown::new(&surface_stage, &scene, &settings)?,
            surface_stage,
            pipeline: IrradiancePipeline::new(gl, settings.size, settings.irradiance)?,
            points: PhotonPoints::new(gl),
            shade: ShadeStage::new(gl, settings.size)?,
            inspector: Inspector::default(),
            kept: Kept::default(),
            recounts: false,
            emitted: 0,
            steps: 0,
            traced: 0,
            times: Vec::new(),
            scene,
            settings,
        })
    }

    /// Goes on with other settings: keeps what they do not change, and starts the rest anew, but for the
    /// landings that are kept. The number of photons and of shadow rays of a step changes nothing that is
    /// there.
    ///
    /// # Errors
    /// As [`new`](Self::new); everything stays as it was then.
    pub fn change(&mut self, settings: LiveSettings) -> Result<()> {
        settings.validate(&self.scene)?;
        let old = self.settings;
        let moved = (settings.size, settings.camera, settings.seed) != (old.size, old.camera, old.seed);
        let resized = settings.size != old.size;
        let redrawn = resized || settings.irradiance != old.irradiance;
        let gl = &self.gl;
        // Whatever can fail comes first.
        let shown = if moved { Some(Shown::new(&self.surface_stage, &self.scene, &settings)?) } else { None };
        let shade = if resized { Some(ShadeStage::new(gl, settings.size)?) } else { None };
        if resized {
            self.pipeline = IrradiancePipeline::new(gl, settings.size, settings.irradiance)?;
        } else {
            self.pipeline.change(settings.irradiance)?;
        }
        self.settings = settings;
        let retraced = (settings.bounces, settings.seed) != (old.bounces, old.seed);
        let goes_on = settings.keeps_landings() && !retraced;
        if let Some(mut shown) = shown {
            if goes_on {
                shown.through.take_photons(&mut self.shown.through);
            }
            self.shown = shown;
        }
        if moved || redrawn || retraced {
            if !goes_on {
                self.kept.clear();
            }
            if self.kept.emitted() > 0 {
                self.shown.through.gather_again();
            } else {
                // Nothing is there that other photons would have to be beside.
                self.traced = 0;
                self.shown.through.clear();
            }
            self.emitted = self.kept.emitted();
            self.recounts = self.emitted > 0;
            self.steps = 0;
            self.pipeline.clear()?;
            self.inspector.forget();
        }
        if let Some(shade) = shade {
            self.shade = shade;
        }
        Ok(())
    }

    /// Makes the picture better by [`LiveSettings::photons_per_step`] photons and
    /// [`LiveSettings::shadow_rays_per_step`] shadow rays; the first step takes a shadow ray of every pixel.
    ///
    /// # Errors
    /// [`Error::Inexact`](crate::Error::Inexact) where a pixel has more photons than can be counted;
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn step(&mut self) -> Result<()> {
        let Self { scene, settings, shown, pipeline, points, kept, .. } = self;
        self.times.clear();
        self.inspector.forget();
        let mut since = Instant::now();
        let mut lap = |label| {
            let now = Instant::now();
            self.times.push((label, now - since));
            since = now;
        };
        let emission = Emission::new(scene, &settings.trace(self.traced))?;
        let (photons, _) = trace(scene, &emission);
        #[expect(clippy::cast_precision_loss, reason = "a factor for f32 powers")]
        let factor = settings.photons_per_step as f32 / UNIT;
        let indirect: Vec<_> = photons
            .iter()
            .filter(|photon| !photon.is_direct())
            .map(PhotonPoint::new)
            .map(|point| PhotonPoint { power: factor * point.power, ..point })
            .collect();
        self.emitted += u64::from(settings.photons_per_step);
        #[expect(clippy::cast_precision_loss, reason = "a factor for f32 light")]
        let scale = UNIT / self.emitted as f32;
        let view = *shown.surfaces.view();
        let seen: Vec<_> = indirect.iter().copied().filter(|point| point.may_be_seen(&view)).collect();
        if self.recounts {
            points.replace(&kept.seen(&view))?;
            pipeline.clear_photons()?;
            pipeline.count(&shown.surfaces, points)?;
            self.recounts = false;
        }
        if settings.keeps_landings() {
            kept.push(settings.photons_per_step, indirect.clone(), settings.landings_kept as usize);
        }
        lap("photons");
        shown.direct.step(scene, settings.shadow_rays_per_step);
        lap("direct light");
        shown.through.step(indirect, settings.photons_per_step, &settings.irradiance);
        lap("mirrors and glass");
        points.replace(&seen)?;
        let irradiance = pipeline.add(&shown.surfaces, points)?;
        self.shade.set_light(&shown.direct.image(), shown.through.image())?;
        self.shade.draw(&shown.surfaces, irradiance, scale)?;
        self.steps += 1;
        self.traced += 1;
        Ok(())
    }

    /// The settings of the next step.
    #[must_use]
    pub fn settings(&self) -> &LiveSettings {
        &self.settings
    }

    /// What the picture is of.
    #[must_use]
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Photons that left the lights since the picture was started anew, and those whose landings were kept then.
    #[must_use]
    pub fn photons(&self) -> u64 {
        self.emitted
    }

    /// Steps since the picture was started anew.
    #[must_use]
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// How long the parts of the last step took the processor, in their order;
    /// [`StageTimes`](crate::gl::StageTimes) tells of the passes on OpenGL.
    #[must_use]
    pub fn times(&self) -> &[(&'static str, Duration)] {
        &self.times
    }

    /// The picture: radiance towards the camera, linear RGB, GL_RGBA32F; undefined before the first step, as
    /// the next ones.
    ///
    /// All textures have row 0 of the picture, its top, as their first row. Ask again after
    /// [`change`](Self::change).
    #[must_use]
    pub fn beauty(&self) -> glow::Texture {
        self.shade.beauty().name()
    }

    /// Radiance of light that was reflected more than once, GL_RGBA32F.
    #[must_use]
    pub fn indirect(&self) -> glow::Texture {
        self.shade.indirect().name()
    }

    /// Radiance of lights and of what they light, GL_RGBA32F.
    #[must_use]
    pub fn direct(&self) -> glow::Texture {
        self.shade.direct().name()
    }

    /// Photons of each pixel, GL_R32F.
    #[must_use]
    pub fn density(&self) -> glow::Texture {
        self.pipeline.density().texture()
    }

    /// The radii of the last step's kernels in pixels, GL_R32UI, if they are variable.
    #[must_use]
    pub fn radii(&self) -> Option<glow::Texture> {
        self.pipeline.radii().map(crate::maps::RadiusMap::texture)
    }

    /// 1 where MR ended the search with too few photons, GL_R8UI, if radii are variable and the settings ask
    /// for it.
    #[must_use]
    pub fn limited(&self) -> Option<glow::Texture> {
        self.pipeline.radii().and_then(crate::maps::RadiusMap::limited_texture)
    }

    /// The picture, read back: radiance, linear RGB; waits for the GPU.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    pub fn read(&self) -> Result<Image<[f32; 3]>> {
        Ok(self.shade.read()?.beauty.map(rgb))
    }

    /// Light that was reflected more than once, read back as the picture is.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_indirect(&self) -> Result<Image<[f32; 3]>> {
        Ok(self.shade.read()?.indirect.map(rgb))
    }

    /// What a pixel holds. The first time after a step, the maps are read back, which waits for the GPU.
    ///
    /// # Errors
    /// [`Error::Setting`](crate::Error::Setting) outside of the picture; [`Error::Gl`](crate::Error::Gl) if
    /// the driver fails.
    pub fn inspect(&mut self, pixel: UVec2) -> Result<Inspection> {
        self.inspector.inspect(&self.scene, self.shown.surfaces.view(), &self.pipeline, pixel)
    }
}
