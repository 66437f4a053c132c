//! Pixels that are areas: where something else begins beside a pixel, rays through other places of its square
//! find what part of it each thing fills.
//!
//! - Inside of faces the middle of a pixel stands for all of it. At edges of surfaces, of shadows, of
//!   textures, and of what is seen in mirrors and through glass, some rays are spread evenly over the square.
//! - What they meet has direct light of its own, by a few shadow rays each. Light by photons is that of the
//!   nearest pixel's middle on the same surface, or one that faces the same way; in mirrors and behind glass
//!   that of the nearest place that a pixel shows there. Where there is none, it is gathered anew.
//! - Lamps that are seen get more rays, until their edges are smooth.
//! - Density, radii, irradiance, normals, depth and albedo stay those of pixels' middles.
//! - Cost: at edges, as many rays as samples, and [`RAYS`] shadow rays for each.

mod edges;
mod emitted;
mod reconstruction;

use std::f32::consts::PI;

use glam::{DVec2, DVec3, IVec2, UVec2, Vec3};
use rayon::prelude::*;

use super::Layers;
use super::direct::{DirectRays, Samples};
use super::neighbours::Neighbours;
use super::sight::{Place, Sight};
use crate::image::Image;
use crate::settings::{PictureSettings, PixelFilter};
use crate::view::View;
use edges::{edges, usual};
use emitted::emitted;
use reconstruction::{PixelSamples, reconstruction};

/// Shadow rays of a sample to each light.
const RAYS: u32 = 4;
/// Pixels around in which light by photons is looked for.
const AROUND: i32 = 2;
/// The least cosine between the normals of places with the same light.
const AGREEMENT: f64 = 0.9;
/// A place in a mirror or behind glass has the light of another that is at most so many pixels away, by how
/// far apart those would be if they were seen straight.
const NEAR: f64 = 3.0;

/// Where a sample has its light by photons from.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// The irradiance at a pixel's middle.
    Pixel(u32),
    /// That of a place in a mirror or behind glass that a pixel's middle shows, by its index.
    Bent(usize),
    /// That of a place of [`EdgeSamples`]' own.
    Own(usize),
}

/// A way of light by photons to the camera.
#[derive(Clone, Copy, Debug)]
struct Way {
    share: Vec3,
    source: Source,
}

/// Of a pixel's square.
#[derive(Clone, Debug, Default)]
struct Sample {
    /// From its corner, in pixels.
    at: DVec2,
    /// Radiance of direct light that is reflected.
    reflected: Vec3,
    ways: Vec<Way>,
}

/// Direct light at the middles of pixels, in its parts.
#[derive(Debug)]
pub(super) struct Middles {
    /// What shines by itself.
    pub(super) emitted: Image<[f32; 3]>,
    pub(super) reflected: Image<[f32; 3]>,
}

/// What the pixels at edges show.
#[derive(Debug)]
pub(super) struct EdgeSamples {
    middles: Middles,
    pixels: Vec<u32>,
    /// As many for each pixel.
    samples: Vec<Sample>,
    each: usize,
    emitted: PixelSamples,
    places: Vec<Place>,
}

impl EdgeSamples {
    /// Looks around in the pixels at edges; `direct` is the light at the middles of all.
    pub(super) fn new(
        rays: &DirectRays<'_>,
        view: &View,
        sight: &Sight,
        direct: &Image<[f32; 4]>,
        middles: Middles,
        settings: &PictureSettings,
    ) -> Self {
        let each = settings.antialias;
        let mut all = Self {
            middles,
            pixels: Vec::new(),
            samples: Vec::new(),
            each: each as usize,
            emitted: PixelSamples::default(),
            places: Vec::new(),
        };
        if each == 1 {
            return all;
        }
        let shown = Shown {
            view,
            emitted: &all.middles.emitted,
            straight: Neighbours::new(settings.size, &sight.straight),
            bent: Neighbours::new(settings.size, &sight.bent),
            usual: usual(direct),
        };
        let pixels = edges(&sight.firsts, &shown.bent, direct, shown.usual);
        let of_pixel = |&pixel: &u32| shown.look_around(rays, pixel, each);
        let found: Vec<Around> = pixels.par_iter().map(of_pixel).collect();
        all.pixels = pixels;
        for Around { mut samples, emitted, own } in found {
            for way in samples.iter_mut().flat_map(|sample| &mut sample.ways) {
                if let Source::Own(index) = &mut way.source {
                    *index += all.places.len();
                }
            }
            all.samples.extend(samples);
            all.emitted.push(emitted);
            all.places.extend(own);
        }
        all
    }

    /// Places that no pixel's middle shows, nor one near to it; in the order of their pixels.
    pub(super) fn places(&self) -> &[Place] {
        &self.places
    }

    /// Whether nothing is at an edge, or nobody asked.
    pub(super) fn is_empty(&self) -> bool {
        self.pixels.is_empty()
    }

    /// Makes light at pixels' middles into that of their areas; `bent` and `own` are the irradiance at places
    /// in mirrors and behind glass that middles show, and at [`places`](Self::places).
    pub(super) fn spread_over_areas(
        &self,
        filter: PixelFilter,
        layers: &mut Layers,
        [bent, own]: [&[DVec3]; 2],
    ) {
        let irradiance = &layers.irradiance;
        let light = |way: &Way| {
            let irradiance = match way.source {
                Source::Pixel(pixel) => Vec3::from_array(irradiance.values()[pixel as usize]),
                Source::Bent(index) => bent[index].as_vec3(),
                Source::Own(index) => own[index].as_vec3(),
            };
            way.share * irradiance / PI
        };
        let samples = |of: &(dyn Fn(&Sample) -> Vec3 + Sync)| {
            let values = self.samples.par_iter().map(|sample| (sample.at, of(sample))).collect();
            PixelSamples::of_as_many(self.each, values)
        };
        let reflected = samples(&|sample| sample.reflected);
        let indirect = samples(&|sample| sample.ways.iter().map(light).sum());
        let [emitted, reflected, indirect] = [
            (&self.middles.emitted, &self.emitted),
            (&self.middles.reflected, &reflected),
            (&layers.indirect, &indirect),
        ]
        .map(|(middles, samples)| reconstruction(filter, middles, &self.pixels, samples));
        layers.direct = sum(&reflected, &emitted);
        layers.indirect = indirect;
        layers.beauty = sum(&layers.direct, &layers.indirect);
    }
}

fn sum(image: &Image<[f32; 3]>, other: &Image<[f32; 3]>) -> Image<[f32; 3]> {
    let sum = |x, y| (Vec3::from_array(image.at(x, y)) + Vec3::from_array(other.at(x, y))).to_array();
    Image::from_fn(image.size(), sum)
}

/// What the middles of pixels show.
struct Shown<'a> {
    view: &'a View,
    straight: Neighbours<'a>,
    bent: Neighbours<'a>,
    /// What they emit.
    emitted: &'a Image<[f32; 3]>,
    /// The picture's usual direct light.
    usual: f32,
}

/// What is seen around the middle of a pixel.
struct Around {
    samples: Vec<Sample>,
    emitted: Vec<(DVec2, Vec3)>,
    /// Places of samples' own.
    own: Vec<Place>,
}

impl Shown<'_> {
    fn look_around(&self, rays: &DirectRays<'_>, pixel: u32, count: u32) -> Around {
        let columns = self.view.size().x;
        let corner = UVec2::new(pixel % columns, pixel / columns).as_dvec2();
        let spread = Samples::new(rays.seed, pixel, u32::MAX);
        let look = |number: u32| {
            let at = DVec2::from_array(spread.at(number));
            let mut seen = Sight::default();
            seen.look(rays.scene, pixel, &self.view.ray_at(corner + at));
            (at, seen)
        };
        let shines = |seen: &Sight| seen.lights.iter().map(|&(_, radiance)| radiance).sum::<Vec3>();
        let (mut samples, mut lights, mut own) = (Vec::new(), Vec::new(), Vec::new());
        for number in 0..count {
            let (at, seen) = look(number);
            lights.push((at, shines(&seen)));
            let mut reflected = Vec3::ZERO;
            for (index, place) in (0..).zip(seen.straight.iter().chain(&seen.bent)) {
                // All samples of a pixel together are spread evenly over lights, too.
                let key = pixel.wrapping_mul(100).wrapping_add(index);
                reflected += rays.radiance(key, place, RAYS * number..RAYS * (number + 1)).as_vec3();
            }
            let mut ways = Vec::new();
            let straight = seen.straight.iter().map(|place| (place, self.of_straight(place)));
            let bent = seen.bent.iter().map(|place| (place, self.of_bent(place).map(Source::Bent)));
            for (place, source) in straight.chain(bent) {
                let source = source.unwrap_or_else(|| {
                    own.push(*place);
                    Source::Own(own.len() - 1)
                });
                ways.push(Way { share: place.share, source });
            }
            samples.push(Sample { at, reflected, ways });
        }
        let more = |number: u32| {
            let (at, seen) = look(number);
            (at, shines(&seen))
        };
        let emitted = emitted(lights, more, self.beside(pixel), self.usual);
        Around { samples, emitted, own }
    }

    /// The least and the most that the middles of a pixel and of those around it emit, in each colour.
    fn beside(&self, pixel: u32) -> [Vec3; 2] {
        let size = self.emitted.size().as_ivec2();
        let home = UVec2::new(pixel % self.emitted.size().x, pixel / self.emitted.size().x).as_ivec2();
        let inside = |at: &IVec2| at.cmpge(IVec2::ZERO).all() && at.cmplt(size).all();
        let around = square(1).map(|away| home + away).filter(inside).map(IVec2::as_uvec2);
        let mine = Vec3::from_array(self.emitted.values()[pixel as usize]);
        // By colour: of lamps that are as bright in other colours, none is the darkest.
        let lights = around.map(|at| Vec3::from_array(self.emitted.at(at.x, at.y)));
        lights.fold([mine; 2], |[darkest, brightest], light| [darkest.min(light), brightest.max(light)])
    }

    /// The pixel whose middle is nearest on the same surface; or else on one that faces about the same way.
    fn of_straight(&self, place: &Place) -> Option<Source> {
        let places = self.straight.places;
        let near = |radius: i32| {
            let others = square(radius).flat_map(|away| self.straight.of(place, away));
            nearest(places, place, others)
        };
        let on_any = || {
            let others = square(AROUND).flat_map(|away| self.straight.at(place.pixel, away));
            nearest(places, place, others)
        };
        let found = (1..=AROUND).find_map(near).or_else(on_any);
        found.map(|index| Source::Pixel(places[index].pixel))
    }

    /// A place near to this one that is seen in a mirror or through glass around.
    fn of_bent(&self, place: &Place) -> Option<usize> {
        let others = square(AROUND).flat_map(|away| self.bent.of(place, away));
        let near = NEAR * f64::from(self.view.pixel_side()) * place.distance;
        nearest(self.bent.places, place, others)
            .filter(|&index| self.bent.places[index].position.distance_squared(place.position) <= near * near)
    }
}

/// Of some places, the nearest that faces as one does.
fn nearest(places: &[Place], place: &Place, others: impl Iterator<Item = usize>) -> Option<usize> {
    let squared = |index: usize| places[index].position.distance_squared(place.position);
    others
        .filter(|&index| places[index].normal.dot(place.normal) >= AGREEMENT)
        .min_by(|&a, &b| squared(a).total_cmp(&squared(b)))
}

/// All pixels up to a radius around.
fn square(radius: i32) -> impl Iterator<Item = IVec2> {
    (-radius..=radius).flat_map(move |y| (-radius..=radius).map(move |x| IVec2::new(x, y)))
}
