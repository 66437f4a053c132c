//! What a surface does with light.

use glam::Vec3;

/// A named material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name in the scene file, or in the mesh file behind the surface's name.
    pub name: String,
    /// What happens to light that arrives.
    pub scattering: Scattering,
    /// Radiance that leaves the front side, linear RGB; zero for what does not shine.
    pub emission: Vec3,
}

/// What happens to light that arrives at a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scattering {
    /// Evenly in all directions, on both sides of the surface. Reflectance, linear RGB from 0 to 1.
    ///
    /// The only kind that photons land on.
    Lambert(Vec3),
    /// As in a mirror, on both sides. Reflectance, linear RGB from 0 to 1.
    Mirror(Vec3),
    /// Reflected and refracted by Fresnel's equations for unpolarised light, without absorption.
    Dielectric {
        /// Index of refraction behind the surface over the one in front of it, where its normal points.
        index: f32,
    },
}

impl Material {
    /// Reflectance of a diffuse surface; zero for others.
    #[must_use]
    pub fn albedo(&self) -> Vec3 {
        match self.scattering {
            Scattering::Lambert(reflectance) => reflectance,
            Scattering::Mirror(_) | Scattering::Dielectric { .. } => Vec3::ZERO,
        }
    }
}
