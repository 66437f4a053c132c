//! Pixels that are areas: where something else begins beside a pixel, rays through other places of its square
//! find what part of it each thing fills.
//!
//! - Inside of faces the middle of a pixel stands for all of it. At edges of surfaces, of shadows, of
//!   textures, and of what is seen in mirrors and through glass, some rays are spread evenly over the square.
//! - What they meet has direct light of its own, by a few shadow rays each. Light by photons is that of the
//!   nearest pixel's middle on the same surface, or one that faces the same way; in mirrors and behind glass
//!   that of the nearest place that a pixel shows there. Where there is none, it is gathered anew.
//! - Density, radii, irradiance, normals, depth and albedo stay those of pixels' middles.
//! - Cost: at edges, as many rays as samples, and [`RAYS`] shadow rays for each.

mod edges;
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
use edges::edges;
use reconstruction::reconstruction;

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
    /// Radiance of direct light.
    direct: Vec3,
    ways: Vec<Way>,
}

/// What the pixels at edges show.
#[derive(Debug)]
pub(super) struct EdgeSamples {
    pixels: Vec<u32>,
    /// Those of a pixel are side by side.
    samples: Vec<Sample>,
    each: usize,
    places: Vec<Place>,
}

impl EdgeSamples {
    /// Looks around in the pixels at edges; `direct` is the light at the middles of all.
    pub(super) fn new(
        rays: &DirectRays<'_>,
        view: &View,
        sight: &Sight,
        direct: &Image<[f32; 4]>,
        settings: &PictureSettings,
    ) -> Self {
        let each = settings.antialias;
        if each == 1 {
            return Self { pixels: Vec::new(), samples: Vec::new(), each: 1, places: Vec::new() };
        }
        let shown = Shown {
            view,
            straight: Neighbours::new(settings.size, &sight.straight),
            bent: Neighbours::new(settings.size, &sight.bent),
        };
        let pixels = edges(&sight.firsts, &shown.bent, direct);
        let of_pixel = |&pixel: &u32| shown.look_around(rays, pixel, each);
        let found: Vec<(Vec<Sample>, Vec<Place>)> = pixels.par_iter().map(of_pixel).collect();
        let (mut samples, mut places) = (Vec::new(), Vec::new());
        for (mut of_pixel, own) in found {
            for way in of_pixel.iter_mut().flat_map(|sample| &mut sample.ways) {
                if let Source::Own(index) = &mut way.source {
                    *index += places.len();
                }
            }
            samples.extend(of_pixel);
            places.extend(own);
        }
        Self { pixels, samples, each: each as usize, places }
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
        let samples: Vec<(DVec2, [Vec3; 2])> = self
            .samples
            .par_iter()
            .map(|sample| (sample.at, [sample.direct, sample.ways.iter().map(light).sum()]))
            .collect();
        let middles = [&layers.direct, &layers.indirect];
        [layers.direct, layers.indirect] = reconstruction(filter, middles, &self.pixels, &samples, self.each);
        layers.beauty = Image::from_fn(layers.direct.size(), |x, y| {
            let [direct, indirect] =
                [&layers.direct, &layers.indirect].map(|light| Vec3::from_array(light.at(x, y)));
            (direct + indirect).to_array()
        });
    }
}

/// What the middles of pixels show.
struct Shown<'a> {
    view: &'a View,
    straight: Neighbours<'a>,
    bent: Neighbours<'a>,
}

impl Shown<'_> {
    /// The samples of a pixel, and places of their own.
    fn look_around(&self, rays: &DirectRays<'_>, pixel: u32, count: u32) -> (Vec<Sample>, Vec<Place>) {
        let columns = self.view.size().x;
        let corner = UVec2::new(pixel % columns, pixel / columns).as_dvec2();
        let spread = Samples::new(rays.seed, pixel, u32::MAX);
        let mut own = Vec::new();
        let sample = |number: u32| {
            let at = DVec2::from_array(spread.at(number));
            let mut seen = Sight::default();
            seen.look(rays.scene, pixel, &self.view.ray_at(corner + at));
            let mut direct: Vec3 = seen.lights.iter().map(|&(_, radiance)| radiance).sum();
            for (index, place) in (0..).zip(seen.straight.iter().chain(&seen.bent)) {
                // All samples of a pixel together are spread evenly over lights, too.
                let key = pixel.wrapping_mul(100).wrapping_add(index);
                direct += rays.radiance(key, place, RAYS * number..RAYS * (number + 1)).as_vec3();
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
            Sample { at, direct, ways }
        };
        let samples = (0..count).map(sample).collect();
        (samples, own)
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
