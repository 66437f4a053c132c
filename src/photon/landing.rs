//! Where a photon landed.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// A diffuse landing of a photon, also called a hit or a deposit (thesis, Table 2.1, the photon map's
/// columns).
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Photon {
    /// In scene units.
    pub position: Vec3,
    /// The way that the photon went, of length 1: towards the surface.
    pub incoming: Vec3,
    /// Before absorption, linear RGB.
    pub power: Vec3,
    /// Of the surface, of length 1, on the side from which the photon came.
    pub normal: Vec3,
    /// k: how many times the photon had landed before, from 0.
    pub bounce: u32,
    /// Index into the scene's surfaces.
    pub surface: u32,
    /// 1 if glass has refracted the photon anywhere on its way from the light, else 0.
    pub through_glass: u32,
    /// 1 if a mirror or glass has passed the photon on since it last landed or left its light, else 0.
    pub from_specular: u32,
}

impl Photon {
    /// Whether the photon came straight from its light: what direct light counts already.
    #[must_use]
    pub fn is_direct(&self) -> bool {
        self.bounce == 0 && self.from_specular == 0
    }

    /// Whether glass has refracted the photon anywhere on its way from the light.
    #[must_use]
    pub fn passed_glass(&self) -> bool {
        self.through_glass != 0
    }
}
