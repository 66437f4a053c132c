//! The ways to light that a pipeline holds: a splat and a gather, for radii from a map and for fixed ones, and
//! tables.

use glam::UVec2;

use super::density::DensityStage;
use super::gather::GatherStage;
use super::splat::SplatStage;
use super::tables::TablesStage;
use crate::error::Result;
use crate::gl::{Gl, TargetShape, Targets, bytes_of};
use crate::maps::{IrradianceMap, KernelRadii, PhotonPoints, RadiusMap, SurfaceMaps};
use crate::settings::{Estimate, IrradianceSettings, Kernel};

/// Stages that were used, of which one is in use.
#[derive(Debug)]
pub(super) struct Spreads {
    made: Vec<Spread>,
    current: usize,
}

/// A stage, and what it was compiled for.
#[derive(Debug)]
struct Spread {
    key: Key,
    stage: Stage,
}

#[derive(Debug)]
enum Stage {
    Splat(Box<SplatStage>),
    Gather(Box<GatherStage>),
    Tables(Box<TablesStage>),
}

/// What decides a stage's shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Key {
    kernel: Kernel,
    is_fixed: bool,
    estimate: Estimate,
}

impl Key {
    fn of(settings: &IrradianceSettings) -> Self {
        if settings.estimate == Estimate::Tables {
            // These ask for neither.
            return Self { kernel: Kernel::Box, is_fixed: false, estimate: settings.estimate };
        }
        Self { kernel: settings.kernel, is_fixed: settings.radius.is_fixed(), estimate: settings.estimate }
    }

    /// Whether one takes the other's place: of each kind, a pipeline holds the last alone.
    fn is_of_kind(self, other: Self) -> bool {
        let kind = |key: Self| (std::mem::discriminant(&key.estimate), key.is_fixed);
        kind(self) == kind(other)
    }
}

impl Stage {
    fn new(gl: &Gl, size: UVec2, settings: &IrradianceSettings) -> Result<Self> {
        Ok(match settings.estimate {
            Estimate::Splat => Self::Splat(Box::new(SplatStage::new(gl, size, settings)?)),
            Estimate::Gather { .. } => Self::Gather(Box::new(GatherStage::new(gl, size, settings)?)),
            Estimate::Tables => Self::Tables(Box::new(TablesStage::new(gl, size)?)),
        })
    }
}

impl Spreads {
    pub(super) fn new(gl: &Gl, size: UVec2, settings: &IrradianceSettings) -> Result<Self> {
        let spread = Spread { key: Key::of(settings), stage: Stage::new(gl, size, settings)? };
        Ok(Self { made: vec![spread], current: 0 })
    }

    /// Bytes of a new one.
    pub(super) fn bytes(size: UVec2, settings: &IrradianceSettings) -> u64 {
        match settings.estimate {
            Estimate::Splat => SplatStage::bytes(size),
            Estimate::Gather { .. } => bytes_of(&[IrradianceMap::shape(size)]),
            Estimate::Tables => TablesStage::bytes(size),
        }
    }

    /// Goes on with the stage of these settings, made now if it is not there; on failure with the one before.
    pub(super) fn change(&mut self, gl: &Gl, size: UVec2, settings: &IrradianceSettings) -> Result<()> {
        let key = Key::of(settings);
        let known = self.made.iter().position(|spread| spread.key.is_of_kind(key));
        self.current = match known {
            Some(index) if self.made[index].key == key => index,
            Some(index) => {
                self.made[index] = Spread { key, stage: Stage::new(gl, size, settings)? };
                index
            }
            None => {
                self.made.push(Spread { key, stage: Stage::new(gl, size, settings)? });
                self.made.len() - 1
            }
        };
        Ok(())
    }

    /// The targets of all of them for another size, in the order in which [`resize`](Self::resize) takes
    /// them.
    pub(super) fn shapes(&self, size: UVec2) -> Vec<TargetShape> {
        let of = |spread: &Spread| match spread.stage {
            Stage::Splat(_) => SplatStage::shapes(size).to_vec(),
            Stage::Gather(_) => vec![IrradianceMap::shape(size)],
            Stage::Tables(_) => TablesStage::shapes(size),
        };
        self.made.iter().flat_map(of).collect()
    }

    pub(super) fn resize(&mut self, size: UVec2, targets: &mut Targets) {
        for spread in &mut self.made {
            match &mut spread.stage {
                Stage::Splat(splat) => splat.resize(targets),
                Stage::Gather(gather) => gather.resize(targets),
                Stage::Tables(tables) => tables.resize(size, targets),
            }
        }
    }

    /// Forgets the light; the others hold that of the last photons alone.
    pub(super) fn clear(&mut self) -> Result<()> {
        match &mut self.made[self.current].stage {
            Stage::Splat(splat) => splat.clear(),
            _ => Ok(()),
        }
    }

    /// The camera or what it sees has moved.
    pub(super) fn forget_camera(&mut self) {
        for spread in &mut self.made {
            if let Stage::Tables(tables) = &mut spread.stage {
                tables.forget_camera();
            }
        }
    }

    /// Adds the light of `photons`, or gathers that of all photons that were counted.
    pub(super) fn add(
        &mut self,
        surfaces: &SurfaceMaps,
        photons: &PhotonPoints,
        counted: &DensityStage,
        radius: KernelRadii<'_>,
    ) -> Result<&IrradianceMap> {
        match (&mut self.made[self.current].stage, counted.power(), counted.flux()) {
            (Stage::Splat(splat), ..) => splat.add(surfaces, photons, radius),
            (Stage::Gather(gather), Some(power), _) => gather.gather(surfaces, power, radius),
            (Stage::Tables(tables), _, Some(flux)) => tables.gather(surfaces, flux),
            (Stage::Gather(_) | Stage::Tables(_), ..) => {
                unreachable!("photons are counted as the light needs")
            }
        }
    }

    /// The widths of light from tables.
    pub(super) fn widths(&self) -> Option<&RadiusMap> {
        match &self.made[self.current].stage {
            Stage::Tables(tables) => Some(tables.radii()),
            Stage::Splat(_) | Stage::Gather(_) => None,
        }
    }

    pub(super) fn irradiance(&self) -> &IrradianceMap {
        match &self.made[self.current].stage {
            Stage::Splat(splat) => splat.irradiance(),
            Stage::Gather(gather) => gather.irradiance(),
            Stage::Tables(tables) => tables.irradiance(),
        }
    }
}
