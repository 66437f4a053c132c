//! What each pixel sees, by rays on the CPU: the way through mirrors and glass to the diffuse surfaces behind
//! them.
//!
//! A g-buffer holds one surface a pixel, which is not enough where glass reflects one place and shows
//! another. Such pixels get a short list of places instead, each with the share of its light that reaches the
//! camera.

use glam::{DVec3, UVec2, Vec3};
use rayon::prelude::*;

use crate::error::Result;
use crate::maps::SurfaceMaps;
use crate::photon::{mirrored, reflected_by_pane, refract};
use crate::scene::{Ray, Scattering, Scene};
use crate::view::View;

/// Mirrors and glass in a row.
const DEEPEST: u32 = 12;
/// Ways that carry less of a place's light are not followed.
const LEAST_SHARE: f32 = 1e-3;

/// A diffuse place that a pixel sees.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) pixel: u32,
    pub(super) position: DVec3,
    /// On the side that is seen.
    pub(super) normal: DVec3,
    /// Of the light that arrives there, what reaches the camera: albedo times that of the mirrors and glass
    /// on the way.
    pub(super) share: Vec3,
    /// From the camera, along the way.
    pub(super) distance: f64,
    /// Number of the surface: its index plus 1.
    pub(super) surface: f32,
}

/// What a ray from the camera meets first, whatever it is made of.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct First {
    /// Number of the surface: its index plus 1; 0 for nothing.
    pub(super) surface: u32,
    pub(super) position: DVec3,
    /// On the side that is seen.
    pub(super) normal: DVec3,
    /// Of a diffuse surface.
    pub(super) reflectance: Vec3,
}

/// What all pixels see.
#[derive(Clone, Debug, Default)]
pub(super) struct Sight {
    /// Diffuse surfaces that are seen straight.
    pub(super) straight: Vec<Place>,
    /// Those that are seen in mirrors and through glass.
    pub(super) bent: Vec<Place>,
    /// Of each pixel, or nothing.
    pub(super) firsts: Vec<First>,
    /// Pixels, and the radiance of what shines by itself in them.
    pub(super) lights: Vec<(u32, Vec3)>,
    /// Pixels that show a diffuse surface straight, and its reflectance; only where it differs within a
    /// material.
    pub(super) albedos: Vec<(u32, Vec3)>,
}

impl Sight {
    /// Casts a ray through the middle of each pixel; with what each meets `first`, if that is asked for.
    pub(super) fn new(scene: &Scene, view: &View, first: bool) -> Self {
        let UVec2 { x: width, y: height } = view.size();
        let rows: Vec<Self> = (0..height)
            .into_par_iter()
            .map(|y| {
                let mut sight = Self::default();
                for x in 0..width {
                    if first {
                        sight.firsts.push(First::default());
                    }
                    sight.look(scene, y * width + x, &view.ray(x, y));
                }
                sight
            })
            .collect();
        let mut all = Self::default();
        for row in rows {
            all.straight.extend(row.straight);
            all.bent.extend(row.bent);
            all.firsts.extend(row.firsts);
            all.lights.extend(row.lights);
            all.albedos.extend(row.albedos);
        }
        all
    }

    /// Sets the albedo of pixels where it is that of a texture or of colours of vertices.
    pub(super) fn paint(&self, surfaces: &mut SurfaceMaps) -> Result<()> {
        if self.albedos.is_empty() {
            return Ok(());
        }
        let mut albedo = surfaces.read_albedo()?;
        for &(pixel, reflectance) in &self.albedos {
            let (x, y) = (pixel % albedo.size().x, pixel / albedo.size().x);
            albedo.set(x, y, reflectance.extend(1.0).to_array());
        }
        surfaces.set_albedo(&albedo)
    }

    /// Adds what a ray from the camera sees.
    pub(super) fn look(&mut self, scene: &Scene, pixel: u32, ray: &Ray) {
        self.follow(scene, pixel, ray, Vec3::ONE, 0.0, 0);
    }

    fn follow(&mut self, scene: &Scene, pixel: u32, ray: &Ray, share: Vec3, way: f64, depth: u32) {
        let Some(hit) = scene.cast(ray) else { return };
        let light = scene.emission(&hit, ray.direction);
        if light != Vec3::ZERO {
            self.lights.push((pixel, share * light));
        }
        let distance = way + hit.distance;
        let side = if hit.normal.dot(ray.direction) <= 0.0 { 1.0 } else { -1.0 };
        let facing = side * hit.normal;
        let scattering = scene.scattering(&hit);
        if depth == 0
            && let Some(first) = self.firsts.last_mut()
        {
            *first = First {
                surface: hit.surface + 1,
                position: hit.position,
                normal: facing,
                reflectance: if let Scattering::Lambert(reflectance) = scattering {
                    reflectance
                } else {
                    Vec3::ZERO
                },
            };
        }
        let mut go = |direction: DVec3, side: DVec3, share: Vec3| {
            if depth < DEEPEST && share.max_element() >= LEAST_SHARE {
                let ray = Ray { origin: scene.start(hit.position, side), direction };
                self.follow(scene, pixel, &ray, share, distance, depth + 1);
            }
        };
        match scattering {
            Scattering::Lambert(reflectance) => {
                if depth == 0 && scene.has_patterns() {
                    self.albedos.push((pixel, reflectance));
                }
                #[expect(clippy::cast_precision_loss, reason = "fewer than 2^24 surfaces")]
                let surface = (hit.surface + 1) as f32;
                let place = Place {
                    pixel,
                    position: hit.position,
                    normal: facing,
                    share: share * reflectance,
                    distance,
                    surface,
                };
                if depth == 0 { self.straight.push(place) } else { self.bent.push(place) }
            }
            Scattering::Mirror(reflectance) => go(mirrored(ray, &hit, side), facing, share * reflectance),
            Scattering::Dielectric { index } => {
                let ratio = if side > 0.0 { 1.0 / f64::from(index) } else { f64::from(index) };
                let smooth = side * hit.smooth_normal;
                let normal = if smooth.dot(ray.direction) < 0.0 { smooth } else { facing };
                let refracted = refract(ray.direction, normal, ratio)
                    .filter(|(direction, _)| direction.dot(facing) < 0.0);
                #[expect(clippy::cast_possible_truncation, reason = "a share from 0 to 1")]
                let reflected = refracted.map_or(1.0, |(_, reflected)| reflected as f32);
                if let Some((direction, _)) = refracted {
                    go(direction, -facing, share * (1.0 - reflected));
                }
                go(mirrored(ray, &hit, side), facing, share * reflected);
            }
            Scattering::ThinDielectric { index, transmittance } => {
                #[expect(clippy::cast_possible_truncation, reason = "a share from 0 to 1")]
                let reflected = reflected_by_pane(ray.direction.dot(hit.normal).abs(), index) as f32;
                go(ray.direction, -facing, share * transmittance * (1.0 - reflected));
                go(mirrored(ray, &hit, side), facing, share * reflected);
            }
        }
    }
}
