//! Scene in, picture out: the stages in order (thesis 2.4, 2.6).
//!
//! Surfaces, density, radii, splats and shading are passes on OpenGL; photons, soft shadows and what is seen in mirrors and
//! through glass are rays on the CPU.

mod direct;
mod nearest;
mod reference;
mod sight;

pub use reference::Reference;

use std::f64::consts::PI;

use glam::{DVec3, UVec2, Vec3};
use rayon::prelude::*;

use crate::bounce_map::{self, BounceMaps};
use crate::density::{self, DensityStage};
use crate::error::Result;
use crate::gbuffer::{self, SurfaceStage};
use crate::gl::{Gl, ShaderSource, TextureFormat};
use crate::image::Image;
use crate::maps::{ChosenRadius, DensityMap, PhotonPoints, SurfaceMaps};
use crate::photon::{
    Emission, FirstHit, Photon, PhotonPoint, TraceSettings, trace_from_hits, trace_in_batches,
};
use crate::pipeline::RadiusPipeline;
use crate::scene::Scene;
use crate::settings::{Estimate, FirstBounce, Kernel, PictureSettings, RadiusChoice, Search, Settings};
use crate::shade::{self, ShadeStage, TracedLight};
use crate::splat::{self, GatherStage, SplatStage};
use crate::view::View;
use direct::Dice;
use nearest::{PhotonGrid, Width};
use sight::{Place, Sight};

/// Photons that are uploaded at once.
const UPLOAD: usize = 1 << 20;

/// What is being done, and how far it is from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The stage, for people.
    pub stage: &'static str,
    /// Its done share.
    pub done: f64,
}

/// A picture and what led to it, pixel by pixel. Colours are linear RGB radiance.
#[derive(Clone, Debug)]
pub struct Layers {
    /// Direct plus indirect light.
    pub beauty: Image<[f32; 3]>,
    /// Lights that are seen, and their light on diffuse surfaces; also in mirrors and through glass.
    pub direct: Image<[f32; 3]>,
    /// Everything else: what photons brought.
    pub indirect: Image<[f32; 3]>,
    /// Indirect irradiance on diffuse surfaces, before their albedo: power per area.
    pub irradiance: Image<[f32; 3]>,
    /// Photons that contribute to each pixel.
    pub density: Image<f32>,
    /// R, in pixels.
    pub radius: Image<u32>,
    /// 1 where MR ended the search with too few photons, else 0.
    pub limited: Image<u8>,
    /// Of length 1 towards the camera; 0 where nothing is seen.
    pub normal: Image<[f32; 3]>,
    /// Depth along the view, in scene units; 0 where nothing is seen.
    pub depth: Image<f32>,
    /// Reflectance of diffuse surfaces.
    pub albedo: Image<[f32; 3]>,
}

/// Energy and numbers of one picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Account {
    /// Photons that were emitted.
    pub emitted: u32,
    /// Their diffuse landings.
    pub landings: u64,
    /// Landings inside of the frame that face the camera and are not direct light: these were uploaded.
    pub uploaded: u64,
    /// Those that contribute: visible on the surface that their pixel shows.
    pub contributing: u64,
    /// Power of the contributing photons, linear RGB.
    pub power_in: [f64; 3],
    /// Irradiance times area, summed over the picture.
    pub power_out: [f64; 3],
    /// Fragments that the splat drew; photons that the gather found.
    pub fragments: f64,
    /// Share of pixels on diffuse surfaces whose search MR ended.
    pub limited_share: f64,
}

impl Account {
    /// By how much power out differs from power in, over power in: the worst of the three colours.
    #[must_use]
    pub fn energy_error(&self) -> f64 {
        let pairs = self.power_in.iter().zip(self.power_out);
        pairs
            .map(|(&into, out)| if into > 0.0 { ((out - into) / into).abs() } else { out.abs() })
            .fold(0.0, f64::max)
    }
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
}

/// All that needs no photons.
#[derive(Debug)]
struct Light {
    surfaces: SurfaceMaps,
    traced: TracedLight,
    bent: Vec<Place>,
}

impl Light {
    fn new(
        gl: &Gl,
        scene: &Scene,
        settings: &PictureSettings,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Self> {
        let view = View::new(scene, settings.size);
        let surfaces = SurfaceStage::new(gl)?.draw(scene, view)?;
        progress(Progress { stage: "direct light", done: 0.0 });
        let sight = Sight::new(scene, &view);
        let light = direct_light(scene, &view, &sight, settings, progress);
        Ok(Self { surfaces, traced: light, bent: sight.bent })
    }
}

/// Photons, where they are needed.
#[derive(Debug)]
struct Traced {
    emitted: u32,
    landings: u64,
    /// Those that may be seen, on the GPU.
    points: PhotonPoints,
    /// All of them, if mirrors or glass show places outside of the picture.
    grid: Option<PhotonGrid>,
}

impl Renderer {
    /// Does everything up to the density map.
    ///
    /// # Errors
    /// [`Error::Setting`](crate::Error::Setting) outside of a setting's range, or if no light shines;
    /// [`Error::TooLarge`](crate::Error::TooLarge); [`Error::Shader`](crate::Error::Shader);
    /// [`Error::Gl`](crate::Error::Gl) when memory runs out.
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
        let light = Light::new(gl, scene, settings, progress)?;
        let traced = Traced::new(
            gl,
            scene,
            light.surfaces.view(),
            trace,
            !light.bent.is_empty(),
            settings.first_bounce,
            progress,
        )?;
        Self::assemble(gl, light, traced)
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
        let light = Light::new(gl, scene, settings, &mut |_| ())?;
        let mut points = PhotonPoints::new(gl);
        let view = light.surfaces.view();
        let seen: Vec<_> = photons.iter().copied().filter(|photon| photon.may_be_seen(view)).collect();
        points.upload(&seen)?;
        let grid = (!light.bent.is_empty()).then(|| PhotonGrid::new(photons, scene.bounds()));
        let count = u32::try_from(photons.len()).expect("fewer than 2^32 photons");
        Self::assemble(gl, light, Traced { emitted: count, landings: count.into(), points, grid })
    }

    fn assemble(gl: &Gl, light: Light, traced: Traced) -> Result<Self> {
        let Light { surfaces, traced: light, bent } = light;
        let mut density = DensityStage::new(gl, surfaces.size())?;
        density.add(&surfaces, &traced.points)?;
        Ok(Self { gl: gl.clone(), size: surfaces.size(), surfaces, density, light, bent, traced })
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
        let density = self.density.map()?;
        let mut pipeline = self.radius_pipeline(settings, &density)?;
        let radii = pipeline.render(&density)?;
        let (chosen, fixed) = match settings.radius {
            RadiusChoice::Variable => (ChosenRadius::Map(radii), false),
            RadiusChoice::Fixed(radius) => (ChosenRadius::Fixed(radius), true),
        };
        let width = match settings.radius {
            RadiusChoice::Variable => Wanted::Holding(settings.min_photons, settings.max_radius),
            RadiusChoice::Fixed(radius) => Wanted::Fixed(radius),
        };
        self.light.seen_through =
            seen_through(self.surfaces.view(), &self.bent, self.traced.grid.as_ref(), width, settings.kernel);
        let mut shade = ShadeStage::new(&self.gl, self.size)?;
        let (shaded, irradiance) = match settings.estimate {
            Estimate::Splat => {
                let mut stage = SplatStage::new(&self.gl, self.size, settings.kernel, fixed)?;
                let irradiance = stage.splat(&self.surfaces, &self.traced.points, chosen)?;
                (shade.shade(&self.surfaces, irradiance, &self.light)?, irradiance.read()?)
            }
            Estimate::Gather { count_correction } => {
                let mut stage =
                    GatherStage::new(&self.gl, self.size, settings.kernel, fixed, count_correction)?;
                let irradiance = stage.gather(&self.surfaces, self.density.power(), chosen)?;
                (shade.shade(&self.surfaces, irradiance, &self.light)?, irradiance.read()?)
            }
        };

        let (position, normal) = (self.surfaces.read_position()?, self.surfaces.read_normal()?);
        let radius = match settings.radius {
            RadiusChoice::Variable => radii.read()?,
            RadiusChoice::Fixed(radius) => Image::filled(self.size, radius),
        };
        let limited = radii.read_limited()?.unwrap_or_else(|| unreachable!("the settings ask for the mask"));
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
        Ok((layers, account))
    }

    fn radius_pipeline(&self, settings: &PictureSettings, density: &DensityMap) -> Result<RadiusPipeline> {
        let usual = Settings::default();
        let search =
            Search { min_photons: settings.min_photons, max_radius: settings.max_radius, ..usual.search };
        let settings = Settings { search, limited_mask: true, ..usual };
        RadiusPipeline::new(&self.gl, density.size(), TextureFormat::R32Float, settings)
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
            limited_share: f64::from(ended) / f64::from(diffuse.max(1)),
        })
    }
}

impl Traced {
    /// Traces photons; those of direct light are left out.
    fn new(
        gl: &Gl,
        scene: &Scene,
        view: &View,
        trace: &TraceSettings,
        needs_grid: bool,
        first_bounce: FirstBounce,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Self> {
        let emission = Emission::new(scene, trace)?;
        let (mut seen, mut all) = (Vec::new(), Vec::new());
        let mut points = PhotonPoints::new(gl);
        let mut keep = |photons: &[Photon], points: &mut PhotonPoints| {
            for photon in photons.iter().filter(|photon| !photon.is_direct()) {
                let point = PhotonPoint::new(photon);
                if needs_grid {
                    all.push(point);
                }
                if point.may_be_seen(view) {
                    seen.push(point);
                }
            }
            if seen.len() >= UPLOAD {
                points.upload(&seen[..UPLOAD])?;
                seen.drain(..UPLOAD);
            }
            Ok(())
        };
        let mut show = |followed: u32| {
            progress(Progress { stage: "photons", done: f64::from(followed) / f64::from(trace.photons) });
        };
        let landings = match first_bounce {
            FirstBounce::Rays => {
                let tally = trace_in_batches(scene, &emission, |photons, followed| {
                    keep(photons, &mut points)?;
                    show(followed);
                    Ok(())
                })?;
                tally.total()
            }
            FirstBounce::Maps => {
                let mut maps = BounceMaps::new(gl, scene)?;
                let (mut landings, mut followed) = (0, 0);
                while let Some(hits) = maps.next_hits(&emission, followed)? {
                    let (photons, tally) = trace_from_hits(scene, trace, &hits);
                    keep(&photons, &mut points)?;
                    landings += tally.total();
                    followed +=
                        u32::try_from(hits.len()).unwrap_or_else(|_| unreachable!("a part of the photons"));
                    show(followed);
                }
                landings
            }
        };
        points.upload(&seen)?;
        let grid = needs_grid.then(|| PhotonGrid::new(&all, scene.bounds()));
        Ok(Self { emitted: trace.photons, landings, points, grid })
    }
}

/// Area that a pixel covers on its surface, in square scene units; as `area_on` in `common/surfaces.glsl`.
fn pixel_area(view: &View, position: [f32; 4], normal: [f32; 4]) -> f64 {
    let at = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z).as_dvec3();
    let depth = f64::from(position[3]);
    let sight = at(position) - view.position().as_dvec3();
    let slant = at(normal).dot(sight).abs().max(1e-3 * sight.length());
    f64::from(view.pixel_side()).powi(2) * depth.powi(3) / slant
}

/// How wide the disc of a place in a mirror or behind glass is, in pixels.
#[derive(Clone, Copy, Debug)]
enum Wanted {
    /// Up to the n-th photon, and at most as for this radius.
    Holding(u32, u32),
    /// As for this radius.
    Fixed(u32),
}

/// Indirect light in mirrors and through glass: the photons around each place that is seen there.
fn seen_through(
    view: &View,
    bent: &[Place],
    grid: Option<&PhotonGrid>,
    wanted: Wanted,
    kernel: Kernel,
) -> Image<[f32; 4]> {
    let mut light = Image::filled(view.size(), [0.0; 4]);
    let Some(grid) = grid else { return light };
    let found: Vec<DVec3> = bent
        .par_iter()
        .map(|place| {
            // The disc of the same area as a box of that radius, if the place were seen straight.
            let disc = |radius: u32| {
                f64::from(2 * radius + 1) * f64::from(view.pixel_side()) * place.distance / PI.sqrt()
            };
            let width = match wanted {
                Wanted::Holding(photons, most) => {
                    Width::Holding { photons: photons as usize, at_most: disc(most) }
                }
                Wanted::Fixed(radius) => Width::Fixed(disc(radius)),
            };
            place.share.as_dvec3() * grid.irradiance(place, width, kernel) / PI
        })
        .collect();
    for (place, radiance) in bent.iter().zip(found) {
        add(&mut light, place.pixel, radiance);
    }
    light
}

/// Direct light at every place that is seen, in rows so that the progress can be told.
fn direct_light(
    scene: &Scene,
    view: &View,
    sight: &Sight,
    settings: &PictureSettings,
    progress: &mut dyn FnMut(Progress),
) -> TracedLight {
    let mut direct = Image::filled(view.size(), [0.0; 4]);
    for &(pixel, radiance) in &sight.lights {
        add(&mut direct, pixel, radiance.as_dvec3());
    }
    let places = sight.straight.len() + sight.bent.len();
    let mut done = 0;
    for (list, seed) in [(&sight.straight, settings.seed), (&sight.bent, settings.seed.wrapping_add(1 << 32))]
    {
        for (number, part) in (0..).zip(list.chunks(1 << 14)) {
            let found: Vec<DVec3> = part
                .par_iter()
                .enumerate()
                .map(|(index, place)| {
                    let index = u32::try_from(index).expect("a part is small");
                    let mut dice = Dice::new(seed, (number << 14) + index);
                    let samples = settings.light_samples;
                    let arrives = direct::irradiance(scene, place.position, place.normal, samples, &mut dice);
                    place.share.as_dvec3() * arrives / PI
                })
                .collect();
            for (place, radiance) in part.iter().zip(found) {
                add(&mut direct, place.pixel, radiance);
            }
            done += part.len();
            #[expect(clippy::cast_precision_loss, reason = "a share")]
            progress(Progress { stage: "direct light", done: done as f64 / places as f64 });
        }
    }
    for place in &sight.straight {
        let (x, y) = (place.pixel % view.size().x, place.pixel / view.size().x);
        let [red, green, blue, _] = direct.at(x, y);
        direct.set(x, y, [red, green, blue, 1.0]);
    }
    TracedLight { direct, seen_through: Image::filled(view.size(), [0.0; 4]) }
}

fn add(image: &mut Image<[f32; 4]>, pixel: u32, light: DVec3) {
    let (x, y) = (pixel % image.size().x, pixel / image.size().x);
    let [red, green, blue, alpha] = image.at(x, y);
    let sum = Vec3::new(red, green, blue) + light.as_vec3();
    image.set(x, y, [sum.x, sum.y, sum.z, alpha]);
}

fn rgb([red, green, blue, _]: [f32; 4]) -> [f32; 3] {
    [red, green, blue]
}

/// All photons of an emission, leaving from some places on the lights, with what they meet first as bounce maps tell it
/// (thesis 2.6.1); for [`trace_from_hits`].
///
/// # Errors
/// [`Error::Shader`](crate::Error::Shader); [`Error::Gl`](crate::Error::Gl) if the driver fails.
pub fn first_hits(gl: &Gl, scene: &Scene, emission: &Emission<'_>) -> Result<Vec<FirstHit>> {
    let mut maps = BounceMaps::new(gl, scene)?;
    let (mut all, mut followed) = (Vec::new(), 0);
    while let Some(hits) = maps.next_hits(emission, followed)? {
        followed += u32::try_from(hits.len()).unwrap_or_else(|_| unreachable!("a part of the photons"));
        all.extend(hits);
    }
    Ok(all)
}

/// Every shader that a picture may compile beside those of the radius map.
#[must_use]
pub fn shader_sources() -> Vec<ShaderSource> {
    let mut sources = vec![density::source(), shade::source()];
    sources.extend(bounce_map::sources());
    sources.extend(gbuffer::sources());
    for kernel in Kernel::ALL {
        for fixed in [false, true] {
            sources.extend(splat::sources(kernel, fixed));
            sources.extend([false, true].map(|correct| splat::gather_source(kernel, fixed, correct)));
        }
    }
    sources
}
