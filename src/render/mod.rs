//! Scene in, picture out: the stages in order (thesis 2.4, 2.6).
//!
//! Surfaces, density, radii, splats and shading are passes on OpenGL; photons and what is seen in mirrors and through glass are
//! rays on the CPU. Direct light and what photons meet first are either: shadow rays or shadow maps, rays or bounce maps.

mod bounce_map;
mod cube_map;
mod direct;
mod layers;
mod live;
mod nearest;
mod prepared;
mod reference;
mod seen_through;
mod shade;
mod shadow_map;
mod sight;
mod stages;
mod surfaces;
mod traced;

pub use layers::{Account, Layers};
pub use live::{Inspection, Live, LiveSettings};
pub use reference::Reference;
pub use stages::Stages;
pub use surfaces::draw_surfaces;
pub use traced::first_hits;

use bytemuck::Zeroable as _;
use glam::{DVec3, UVec2, Vec3};

use crate::error::Result;
use crate::gl::{Gl, ShaderSource, TextureFormat};
use crate::image::Image;
use crate::light::DensityStage;
use crate::light::{self, GatherStage, SplatStage};
use crate::maps::{Changed, Frame};
use crate::maps::{ChosenRadius, PhotonPoints, SurfaceMaps};
use crate::photon::{Emission, PhotonPoint, TraceSettings};
use crate::radius::RadiusPipeline;
use crate::scene::Scene;
use crate::settings::{Estimate, Kernel, PictureSettings, RadiusChoice, Search, Settings};
use crate::view::View;
use nearest::PhotonGrid;
use prepared::Prepared;
use seen_through::{Wanted, seen_through};
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

/// A scene with its photons traced, direct light found and density counted: all that does not depend on the radius.
#[derive(Debug)]
pub struct Renderer {
    gl: Gl,
    size: UVec2,
    surfaces: SurfaceMaps,
    density: DensityStage,
    light: TracedLight,
    bent: Vec<Place>,
    traced: Traced,
    /// Made for the first picture, and anew for one with another n or MR.
    radii: Option<RadiusPipeline>,
    /// Whether its radii are to be searched again although they are there.
    searches_again: bool,
    /// Of the kernel that was drawn last, for radii from a map and for fixed ones.
    splats: [Option<(Kernel, SplatStage)>; 2],
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
        Emission::new(scene, trace)?;
        let prepared = Prepared::new(gl, scene, settings, progress)?;
        let traced = Traced::new(
            gl,
            scene,
            prepared.surfaces.view(),
            trace,
            !prepared.bent.is_empty(),
            settings.first_bounce,
            progress,
        )?;
        Self::assemble(gl, prepared, traced)
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
        let grid = (!prepared.bent.is_empty()).then(|| PhotonGrid::new(photons));
        let count = u32::try_from(photons.len()).expect("fewer than 2^32 photons");
        Self::assemble(
            gl,
            prepared,
            Traced { emitted: count, landings: count.into(), cut_off_share: 0.0, points, grid },
        )
    }

    fn assemble(gl: &Gl, prepared: Prepared, traced: Traced) -> Result<Self> {
        let Prepared { surfaces, traced: light, bent } = prepared;
        let mut density = DensityStage::new(gl, surfaces.size())?;
        density.add(&surfaces, &traced.points)?;
        Ok(Self {
            gl: gl.clone(),
            shade: ShadeStage::new(gl, surfaces.size())?,
            size: surfaces.size(),
            surfaces,
            density,
            light,
            bent,
            traced,
            radii: None,
            searches_again: false,
            splats: [None, None],
        })
    }

    /// What each pixel shows.
    #[must_use]
    pub fn surfaces(&self) -> &SurfaceMaps {
        &self.surfaces
    }

    /// The picture with the radius, kernel and estimate of `settings`; its size and shadow rays are those of before.
    ///
    /// # Errors
    /// As [`Renderer::new`], and [`Error::Inexact`](crate::Error::Inexact) where a pixel has more photons than can be
    /// counted.
    pub fn picture(&mut self, settings: &PictureSettings) -> Result<(Layers, Account)> {
        settings.validate()?;
        let mut searched = None;
        let (chosen, width) = match settings.radius {
            RadiusChoice::Fixed(radius) => (ChosenRadius::Fixed(radius), Wanted::Fixed(radius)),
            RadiusChoice::Variable => {
                let pipeline = searched.insert(self.radius_pipeline(settings)?);
                // The photons are those of the picture before, if there was one.
                let searches_again = std::mem::take(&mut self.searches_again);
                let changed = if searches_again { Changed::Everything } else { Changed::Nothing };
                let radii = pipeline.update(&Frame { changed, ..Frame::new(self.density.map()) })?;
                (ChosenRadius::Map(radii), Wanted::Holding(settings.min_photons, settings.max_radius))
            }
        };
        let fixed = matches!(chosen, ChosenRadius::Fixed(_));
        self.light.seen_through =
            seen_through(self.surfaces.view(), &self.bent, self.traced.grid.as_ref(), width, settings.kernel);
        let shade = &mut self.shade;
        let (shaded, irradiance) = match settings.estimate {
            Estimate::Splat => {
                let stage = splat_stage(&self.gl, self.size, &mut self.splats, settings.kernel, fixed)?;
                let irradiance = stage.splat(&self.surfaces, &self.traced.points, chosen)?;
                (shade.shade(&self.surfaces, irradiance, &self.light)?, irradiance.read()?)
            }
            Estimate::Gather { count_correction } => {
                let mut stage =
                    GatherStage::new(&self.gl, self.size, settings.kernel, fixed, count_correction)?;
                let irradiance = stage.gather(&self.surfaces, &self.density, chosen)?;
                (shade.shade(&self.surfaces, irradiance, &self.light)?, irradiance.read()?)
            }
        };

        let (position, normal) = (self.surfaces.read_position()?, self.surfaces.read_normal()?);
        let (radius, limited) = match chosen {
            ChosenRadius::Fixed(radius) => (Image::filled(self.size, radius), Image::filled(self.size, 0)),
            ChosenRadius::Map(radii) => {
                let limited = radii.read_limited()?;
                (radii.read()?, limited.unwrap_or_else(|| unreachable!("the settings ask for the mask")))
            }
        };
        let layers = Layers {
            beauty: shaded.beauty.map(rgb),
            direct: self.light.direct.map(rgb),
            indirect: shaded.indirect.map(rgb),
            irradiance: irradiance.map(rgb),
            density: self.density.read_counts()?,
            radius,
            limited,
            normal: normal.map(rgb),
            depth: position.map(|[.., depth]| depth),
            albedo: self.surfaces.read_albedo()?.map(rgb),
        };
        let account = self.account(&position, &normal, &irradiance, &layers.limited)?;
        self.radii = searched.or(self.radii.take());
        Ok((layers, account))
    }

    /// Compiles and allocates what a splat with these settings needs, so that the next picture takes as long as those after
    /// it: radii are searched, but not kept, and a photon that is nowhere is drawn.
    ///
    /// # Errors
    /// As [`picture`](Self::picture).
    pub fn warm_up(&mut self, settings: &PictureSettings) -> Result<()> {
        settings.validate()?;
        let mut nowhere = PhotonPoints::new(&self.gl);
        nowhere.upload(&[PhotonPoint::zeroed()])?;
        let fixed = matches!(settings.radius, RadiusChoice::Fixed(_));
        let mut searched = None;
        let chosen = match settings.radius {
            RadiusChoice::Fixed(radius) => ChosenRadius::Fixed(radius),
            RadiusChoice::Variable => {
                let pipeline = searched.insert(self.radius_pipeline(settings)?);
                self.searches_again = true;
                ChosenRadius::Map(pipeline.render(self.density.map())?)
            }
        };
        let stage = splat_stage(&self.gl, self.size, &mut self.splats, settings.kernel, fixed)?;
        let irradiance = stage.splat(&self.surfaces, &nowhere, chosen)?;
        self.shade.shade(&self.surfaces, irradiance, &self.light)?;
        self.radii = searched.or(self.radii.take());
        Ok(())
    }

    /// The pipeline of the picture before, with its radii, if it answers the same question; else a new one.
    fn radius_pipeline(&mut self, settings: &PictureSettings) -> Result<RadiusPipeline> {
        let usual = Settings::default();
        let search =
            Search { min_photons: settings.min_photons, max_radius: settings.max_radius, ..usual.search };
        let settings = Settings { search, limited_mask: true, ..usual };
        match self.radii.take().filter(|pipeline| *pipeline.settings() == settings) {
            Some(pipeline) => Ok(pipeline),
            None => RadiusPipeline::new(&self.gl, self.size, TextureFormat::R32Float, settings),
        }
    }

    fn account(
        &self,
        position: &Image<[f32; 4]>,
        normal: &Image<[f32; 4]>,
        irradiance: &Image<[f32; 4]>,
        limited: &Image<u8>,
    ) -> Result<Account> {
        let power = self.density.read_power()?;
        let view = self.surfaces.view();
        let (mut contributing, mut fragments) = (0.0, 0.0);
        let (mut power_in, mut power_out) = (DVec3::ZERO, DVec3::ZERO);
        let (mut diffuse, mut ended) = (0_u32, 0_u32);
        for (index, photons) in power.values().iter().enumerate() {
            let [red, green, blue, count] = photons.map(f64::from);
            contributing += count;
            power_in += DVec3::new(red, green, blue);
            let [red, green, blue, drawn] = irradiance.values()[index].map(f64::from);
            fragments += drawn;
            if normal.values()[index][3] > 0.0 {
                let area = pixel_area(view, position.values()[index], normal.values()[index]);
                power_out += area * DVec3::new(red, green, blue);
                diffuse += 1;
                ended += u32::from(limited.values()[index]);
            }
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a sum of counts")]
        let contributing = contributing as u64;
        Ok(Account {
            emitted: self.traced.emitted,
            landings: self.traced.landings,
            uploaded: self.traced.points.count(),
            contributing,
            power_in: power_in.to_array(),
            power_out: power_out.to_array(),
            fragments,
            cut_off_share: self.traced.cut_off_share,
            limited_share: f64::from(ended) / f64::from(diffuse.max(1)),
        })
    }
}

/// The stage that was used last with such radii, if its kernel is the same; else a new one.
fn splat_stage<'a>(
    gl: &Gl,
    size: UVec2,
    stages: &'a mut [Option<(Kernel, SplatStage)>; 2],
    kernel: Kernel,
    fixed: bool,
) -> Result<&'a mut SplatStage> {
    let slot = &mut stages[usize::from(fixed)];
    let stage = match slot.take().filter(|(of, _)| *of == kernel) {
        Some(stage) => stage,
        None => (kernel, SplatStage::new(gl, size, kernel, fixed)?),
    };
    Ok(&mut slot.insert(stage).1)
}

/// Area that a pixel covers on its surface, in square scene units; as `area_on` in `common/surfaces.glsl`.
fn pixel_area(view: &View, position: [f32; 4], normal: [f32; 4]) -> f64 {
    let at = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z).as_dvec3();
    let depth = f64::from(position[3]);
    let sight = at(position) - view.position().as_dvec3();
    let slant = at(normal).dot(sight).abs().max(1e-3 * sight.length());
    f64::from(view.pixel_side()).powi(2) * depth.powi(3) / slant
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

/// The shaders of a picture beside those of its light by photons: what photons meet first, and what pixels show.
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
