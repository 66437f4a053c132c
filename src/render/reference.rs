//! A picture without kernels: each pixel keeps its own photons only, averaged over many seeds. It is noisy
//! for long, and right in the end: what other pictures are compared with.

use glam::DVec3;

use super::account::pixel_area;
use super::landed::Wanted;
use super::prepared::Prepared;
use super::seen_through::seen_through;
use super::sight::Place;
use super::traced::Traced;
use super::{Layers, Progress, add, rgb};
use crate::error::Result;
use crate::gl::Gl;
use crate::image::Image;
use crate::light::DensityStage;
use crate::maps::SurfaceMaps;
use crate::photon::{Emission, TraceSettings};
use crate::render::shade::TracedLight;
use crate::scene::Scene;
use crate::settings::{FirstBounce, Kernel, PictureSettings};

/// The sums over the seeds so far.
#[derive(Debug)]
pub struct Reference {
    gl: Gl,
    surfaces: SurfaceMaps,
    density: DensityStage,
    light: TracedLight,
    bent: Vec<Place>,
    seeds: u32,
    /// Of all seeds.
    cut_off_shares: f64,
    /// Power of all photons of each pixel, and their count.
    power: Image<[f64; 4]>,
    seen_through: Image<[f64; 4]>,
}

impl Reference {
    /// No photons yet; shadow rays as `settings` ask.
    ///
    /// # Errors
    /// As [`Renderer::new`](super::Renderer::new).
    pub fn new(
        gl: &Gl,
        scene: &Scene,
        settings: &PictureSettings,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Self> {
        settings.validate()?;
        // Power is of pixels' own photons, on what their middles show.
        let settings = &PictureSettings { antialias: 1, ..*settings };
        let Prepared { surfaces, traced: light, bent, .. } = Prepared::new(gl, scene, settings, progress)?;
        Ok(Self {
            gl: gl.clone(),
            surfaces,
            density: DensityStage::new(gl, settings.size)?,
            light,
            bent,
            seeds: 0,
            cut_off_shares: 0.0,
            power: Image::filled(settings.size, [0.0; 4]),
            seen_through: Image::filled(settings.size, [0.0; 4]),
        })
    }

    /// Adds the photons of one seed.
    ///
    /// # Errors
    /// As [`Renderer::new`](super::Renderer::new).
    pub fn add_seed(
        &mut self,
        scene: &Scene,
        trace: &TraceSettings,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<()> {
        let view = *self.surfaces.view();
        let emission = Emission::new(scene, trace)?;
        // A pixel's own photons.
        let wanted = Wanted::Fixed(0);
        let mut traced = Traced::new(
            &self.gl,
            scene,
            &view,
            &emission,
            (!self.bent.is_empty()).then_some(wanted),
            FirstBounce::Rays,
            progress,
        )?;
        self.density.clear()?;
        self.density.add(&self.surfaces, &traced.points)?;
        // The counts are checked before they are believed.
        let power = self.density.power().unwrap_or_else(|| unreachable!("made without units"));
        add_up(&mut self.power, &power.read()?);
        let (_, through) = seen_through(&view, &self.bent, traced.landed.as_mut(), wanted, Kernel::Box);
        add_up(&mut self.seen_through, &through);
        self.seeds += 1;
        self.cut_off_shares += traced.cut_off_share;
        Ok(())
    }

    /// As [`Account::cut_off_share`](super::Account::cut_off_share), the mean of the seeds; 0 before the first.
    #[must_use]
    pub fn cut_off_share(&self) -> f64 {
        self.cut_off_shares / f64::from(self.seeds.max(1))
    }

    /// The mean of the seeds; radii are 0, as there are no kernels.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) if the driver fails.
    ///
    /// # Panics
    /// Before the first seed.
    pub fn picture(&self) -> Result<Layers> {
        assert!(self.seeds > 0, "a mean of some seeds");
        let share = 1.0 / f64::from(self.seeds);
        let (position, normal) = (self.surfaces.read_position()?, self.surfaces.read_normal()?);
        let albedo = self.surfaces.read_albedo()?.map(rgb);
        let size = albedo.size();
        let view = self.surfaces.view();
        let (mut indirect, mut irradiance) = (Image::filled(size, [0.0; 4]), Image::filled(size, [0.0; 4]));
        for pixel in 0..size.element_product() {
            let (x, y) = (pixel % size.x, pixel / size.x);
            let [red, green, blue, _] = self.seen_through.at(x, y);
            add(&mut indirect, pixel, share * DVec3::new(red, green, blue));
            if normal.at(x, y)[3] > 0.0 && self.light.direct.at(x, y)[3] > 0.0 {
                let [red, green, blue, _] = self.power.at(x, y);
                let area = pixel_area(view, position.at(x, y), normal.at(x, y));
                let reflectance = glam::Vec3::from(albedo.at(x, y)).as_dvec3();
                let arrives = DVec3::new(red, green, blue) * (share / area);
                add(&mut irradiance, pixel, arrives);
                add(&mut indirect, pixel, reflectance * arrives / std::f64::consts::PI);
            }
        }
        let mut beauty = indirect.clone();
        for pixel in 0..size.element_product() {
            let [red, green, blue, _] = self.light.direct.at(pixel % size.x, pixel / size.x).map(f64::from);
            add(&mut beauty, pixel, DVec3::new(red, green, blue));
        }
        #[expect(clippy::cast_possible_truncation, reason = "a mean count")]
        let density = self.power.map(|[.., count]| (share * count) as f32);
        Ok(Layers {
            beauty: beauty.map(rgb),
            direct: self.light.direct.map(rgb),
            indirect: indirect.map(rgb),
            irradiance: irradiance.map(rgb),
            density,
            radius: Image::filled(size, 0),
            limited: Image::filled(size, 0),
            normal: normal.map(rgb),
            depth: position.map(|[.., depth]| depth),
            albedo,
        })
    }
}

fn add_up(sum: &mut Image<[f64; 4]>, image: &Image<[f32; 4]>) {
    let size = sum.size();
    for y in 0..size.y {
        for x in 0..size.x {
            let (before, more) = (sum.at(x, y), image.at(x, y));
            sum.set(x, y, std::array::from_fn(|channel| before[channel] + f64::from(more[channel])));
        }
    }
}
