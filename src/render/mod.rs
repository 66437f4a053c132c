//! Scene in, picture out: the stages in order (thesis 2.4, 2.6).
//!
//! Surfaces, density, radii, splats and shading are passes on OpenGL; photons and what is seen in mirrors and
//! through glass are rays on the CPU. Direct light and what photons meet first are either: shadow rays or
//! shadow maps, rays or bounce maps.

mod account;
mod antialias;
mod bounce_map;
mod cube_map;
mod direct;
mod landed;
mod layers;
mod live;
mod nearest;
mod neighbours;
mod photon_sums;
mod prepared;
mod reference;
mod rings;
mod seen_through;
mod shade;
mod shadow_map;
mod sight;
mod stages;
mod surfaces;
mod traced;
mod widened;

pub use account::Account;
pub use layers::Layers;
pub use live::{Inspection, Live, LiveSettings};
pub use reference::Reference;
pub use surfaces::draw_surfaces;
pub use traced::first_hits;

use bytemuck::Zeroable as _;
use glam::{DVec3, Vec3};

use crate::error::Result;
use crate::gl::{Gl, ShaderSource};
use crate::image::Image;
use crate::light::{self, IrradiancePipeline};
use crate::maps::{PhotonPoints, SurfaceMaps};
use crate::photon::{Emission, PhotonPoint, TraceSettings};
use crate::scene::Scene;
use crate::settings::{KernelRadius, PictureSettings, PixelFilter};
use antialias::EdgeSamples;
use landed::{Landed, Wanted};
use prepared::Prepared;
use seen_through::seen_through;
use shade::{ShadeStage, TracedLight};
use sight::Place;
use traced::Traced;

/// What is being done, and how far it is from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The stage, for people.
    pub stage: &'static str,
    /// Its done share.
    pub done: f64,
}

/// A scene with its photons traced, direct light found and density counted: all that does not depend on the
/// radius.
#[derive(Debug)]
pub struct Renderer {
    gl: Gl,
    surfaces: SurfaceMaps,
    light: TracedLight,
    bent: Vec<Place>,
    edges: EdgeSamples,
    traced: Traced,
    pipeline: IrradiancePipeline,
    shade: ShadeStage,
}

impl Renderer {
    /// Does everything up to the density map.
    ///
    /// # Errors
    /// [`Error::Setting`](crate::Error::Setting) outside of a setting's range, or if no light shines;
    /// [`Error::TooLarge`](crate::Error::TooLarge); [`Error::Shader`](crate::Error::Shader);
    /// [`Error::OutOfMemory`](crate::Error::OutOfMemory).
    pub fn new(
        gl: &Gl,
        scene: &Scene,
        settings: &PictureSettings,
        trace: &TraceSettings,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Self> {
        settings.validate()?;
        // What can be refused is refused before anything is traced.
        let emission = Emission::new(scene, trace)?;
        let prepared = Prepared::new(gl, scene, settings, progress)?;
        let wanted = prepared.gathers().then(|| Wanted::of(&settings.irradiance()));
        let view = prepared.surfaces.view();
        let traced = Traced::new(gl, scene, view, &emission, wanted, settings.first_bounce, progress)?;
        Self::assemble(gl, prepared, traced, settings)
    }

    /// The same with photons that the caller traced, without those of direct light.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    ///
    /// # Panics
    /// If there are 2^32 photons or more.
    pub fn with_photons(
        gl: &Gl,
        scene: &Scene,
        settings: &PictureSettings,
        photons: &[PhotonPoint],
    ) -> Result<Self> {
        settings.validate()?;
        let prepared = Prepared::new(gl, scene, settings, &mut |_| ())?;
        let mut points = PhotonPoints::new(gl);
        let view = prepared.surfaces.view();
        let seen: Vec<_> = photons.iter().copied().filter(|photon| photon.may_be_seen(view)).collect();
        points.upload(&seen)?;
        let wanted = Wanted::of(&settings.irradiance());
        let landed = prepared.gathers().then(|| Landed::new(photons, wanted));
        let count = u32::try_from(photons.len()).expect("fewer than 2^32 photons");
        let traced = Traced { emitted: count, landings: count.into(), cut_off_share: 0.0, points, landed };
        Self::assemble(gl, prepared, traced, settings)
    }

    fn assemble(gl: &Gl, prepared: Prepared, traced: Traced, settings: &PictureSettings) -> Result<Self> {
        let Prepared { surfaces, traced: light, bent, edges } = prepared;
        let mut pipeline = IrradiancePipeline::new(gl, surfaces.size(), settings.irradiance())?;
        pipeline.count(&surfaces, &traced.points)?;
        Ok(Self {
            gl: gl.clone(),
            shade: ShadeStage::new(gl, surfaces.size())?,
            surfaces,
            light,
            bent,
            edges,
            traced,
            pipeline,
        })
    }

    /// What each pixel shows.
    #[must_use]
    pub fn surfaces(&self) -> &SurfaceMaps {
        &self.surfaces
    }

    /// The picture with the radius, kernel, estimate and filter of `settings`; its size, shadow rays and
    /// samples at edges are those of before.
    ///
    /// # Errors
    /// As [`Renderer::new`], and [`Error::Inexact`](crate::Error::Inexact) where a pixel has more photons
    /// than can be counted.
    pub fn picture(&mut self, settings: &PictureSettings) -> Result<(Layers, Account)> {
        settings.validate()?;
        let asked = settings.irradiance();
        self.pipeline.change(asked)?;
        self.count_unless_known()?;
        let (view, landed, wanted) = (self.surfaces.view(), &mut self.traced.landed, Wanted::of(&asked));
        let mut through = |places| seen_through(view, places, landed.as_mut(), wanted, settings.kernel);
        let (of_bent, seen_through) = through(&self.bent);
        let (of_edges, _) = through(self.edges.places());
        self.light.seen_through = seen_through;
        self.pipeline.clear_light()?;
        let irradiance = self.pipeline.spread(&self.surfaces, &self.traced.points)?;
        let shaded = self.shade.shade(&self.surfaces, irradiance, &self.light)?;
        let irradiance = irradiance.read()?;

        let (position, normal) = (self.surfaces.read_position()?, self.surfaces.read_normal()?);
        let size = self.surfaces.size();
        let (radius, limited) = match (settings.radius, self.pipeline.radii()) {
            (_, Some(radii)) => {
                let limited = radii.read_limited()?;
                (radii.read()?, limited.unwrap_or_else(|| Image::filled(size, 0)))
            }
            (KernelRadius::Fixed(radius), None) => (Image::filled(size, radius), Image::filled(size, 0)),
            (KernelRadius::Variable, None) => unreachable!("variable radii were searched"),
        };
        let mut layers = Layers {
            beauty: shaded.beauty.map(rgb),
            direct: self.light.direct.map(rgb),
            indirect: shaded.indirect.map(rgb),
            irradiance: irradiance.map(rgb),
            density: self.pipeline.density_stage().read_counts()?,
            radius,
            limited,
            normal: normal.map(rgb),
            depth: position.map(|[.., depth]| depth),
            albedo: self.surfaces.read_albedo()?.map(rgb),
        };
        if !self.edges.is_empty() || settings.filter != PixelFilter::Box {
            self.edges.spread_over_areas(settings.filter, &mut layers, [&of_bent, &of_edges]);
        }
        let account = self.account_of(&position, &normal, &irradiance, &layers.limited)?;
        Ok((layers, account))
    }

    /// Counts all photons, if the pipeline has none of them.
    fn count_unless_known(&mut self) -> Result<()> {
        if self.pipeline.density_stage().drawn() == 0 {
            self.pipeline.count(&self.surfaces, &self.traced.points)?;
        }
        Ok(())
    }

    /// Compiles and allocates what a picture with these settings needs, so that the next one takes as long as
    /// those after it: radii are searched, and again for the next picture, and a photon that is nowhere is
    /// drawn.
    ///
    /// # Errors
    /// As [`picture`](Self::picture).
    pub fn warm_up(&mut self, settings: &PictureSettings) -> Result<()> {
        settings.validate()?;
        let mut nowhere = PhotonPoints::new(&self.gl);
        nowhere.upload(&[PhotonPoint::zeroed()])?;
        self.pipeline.change(settings.irradiance())?;
        self.count_unless_known()?;
        let irradiance = self.pipeline.spread(&self.surfaces, &nowhere)?;
        self.shade.shade(&self.surfaces, irradiance, &self.light)?;
        self.pipeline.clear_radii();
        Ok(())
    }
}

/// Adds light to a pixel, counted row by row.
fn add(image: &mut Image<[f32; 4]>, pixel: u32, light: DVec3) {
    let (x, y) = (pixel % image.size().x, pixel / image.size().x);
    let [red, green, blue, alpha] = image.at(x, y);
    let sum = Vec3::new(red, green, blue) + light.as_vec3();
    image.set(x, y, [sum.x, sum.y, sum.z, alpha]);
}

fn rgb([red, green, blue, _]: [f32; 4]) -> [f32; 3] {
    [red, green, blue]
}

/// The shaders of a picture beside those of its light by photons: what photons meet first, and what pixels
/// show.
#[must_use]
pub fn surface_sources() -> Vec<ShaderSource> {
    cube_map::sources().into_iter().chain(surfaces::sources()).collect()
}

/// The shaders of a picture after its light by photons: direct light by shadow maps, and all of it together.
#[must_use]
pub fn shading_sources() -> Vec<ShaderSource> {
    vec![shadow_map::source(), shade::source()]
}

/// Every shader that a picture may compile beside those of the radius map.
#[must_use]
pub fn shader_sources() -> Vec<ShaderSource> {
    let light = light::shader_sources();
    surface_sources().into_iter().chain(light).chain(shading_sources()).collect()
}
