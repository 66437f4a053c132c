//! What a surface does with light.

use std::sync::Arc;

use glam::Vec3;

use super::Texture;

/// A named material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name in the scene file, or in the mesh file behind the surface's name.
    pub name: String,
    /// What happens to light that arrives.
    pub scattering: Scattering,
    /// Radiance that leaves the front side, linear RGB; zero for what does not shine.
    pub emission: Vec3,
    /// An image that the reflectance is multiplied with.
    pub reflectance_texture: Option<Arc<Texture>>,
    /// An image that the emission is multiplied with.
    pub emission_texture: Option<Arc<Texture>>,
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
    /// A pane that is thinner than anything else: light goes straight on, less what its two faces reflect, or
    /// is reflected.
    ThinDielectric {
        /// Index of refraction of the pane over that around it.
        index: f32,
        /// What light that goes through is multiplied with, linear RGB from 0 to 1.
        transmittance: Vec3,
    },
}

impl Scattering {
    /// The same with its colour multiplied, as textures and vertex colours do; clear glass stays clear.
    #[must_use]
    pub(crate) fn times(self, colour: Vec3) -> Self {
        match self {
            Self::Lambert(reflectance) => Self::Lambert(reflectance * colour),
            Self::Mirror(reflectance) => Self::Mirror(reflectance * colour),
            Self::ThinDielectric { index, transmittance } => {
                Self::ThinDielectric { index, transmittance: transmittance * colour }
            }
            Self::Dielectric { .. } => self,
        }
    }
}

impl Material {
    /// A material of one colour everywhere.
    #[must_use]
    pub fn plain(name: String, scattering: Scattering, emission: Vec3) -> Self {
        Self { name, scattering, emission, reflectance_texture: None, emission_texture: None }
    }

    /// Reflectance of a diffuse surface; zero for others.
    #[must_use]
    pub fn albedo(&self) -> Vec3 {
        match self.scattering {
            Scattering::Lambert(reflectance) => reflectance,
            Scattering::Mirror(_) | Scattering::Dielectric { .. } | Scattering::ThinDielectric { .. } => {
                Vec3::ZERO
            }
        }
    }
}
