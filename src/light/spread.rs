//! The ways from radii to light that a pipeline holds: a splat and a gather, for radii from a map and for
//! fixed ones.

use glam::UVec2;

use super::gather::GatherStage;
use super::splat::SplatStage;
use crate::error::Result;
use crate::gl::{Gl, TargetShape, Targets, bytes_of};
use crate::maps::{IrradianceMap, KernelRadii, PhotonPoints, PowerMap, SurfaceMaps};
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
        Self { kernel: settings.kernel, is_fixed: settings.radius.is_fixed(), estimate: settings.estimate }
    }

    /// Whether one takes the other's place: of each kind, a pipeline holds the last alone.
    fn is_of_kind(self, other: Self) -> bool {
        let is_splat = |key: Self| key.estimate == Estimate::Splat;
        (is_splat(self), self.is_fixed) == (is_splat(other), other.is_fixed)
    }
}

impl Stage {
    fn new(gl: &Gl, size: UVec2, settings: &IrradianceSettings) -> Result<Self> {
        Ok(match settings.estimate {
            Estimate::Splat => Self::Splat(Box::new(SplatStage::new(gl, size, settings)?)),
            Estimate::Gather { .. } => Self::Gather(Box::new(GatherStage::new(gl, size, settings)?)),
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
        };
        self.made.iter().flat_map(of).collect()
    }

    pub(super) fn resize(&mut self, targets: &mut Targets) {
        for spread in &mut self.made {
            match &mut spread.stage {
                Stage::Splat(splat) => splat.resize(targets),
                Stage::Gather(gather) => gather.resize(targets),
            }
        }
    }

    /// Forgets the light; a gather holds that of the last photons alone.
    pub(super) fn clear(&mut self) {
        if let Stage::Splat(splat) = &mut self.made[self.current].stage {
            splat.clear();
        }
    }

    /// Adds the light of `photons`, or gathers that of all photons in `power`.
    pub(super) fn add(
        &mut self,
        surfaces: &SurfaceMaps,
        photons: &PhotonPoints,
        power: &PowerMap,
        radius: KernelRadii<'_>,
    ) -> Result<&IrradianceMap> {
        match &mut self.made[self.current].stage {
            Stage::Splat(splat) => splat.add(surfaces, photons, radius),
            Stage::Gather(gather) => gather.gather(surfaces, power, radius),
        }
    }

    pub(super) fn irradiance(&self) -> &IrradianceMap {
        match &self.made[self.current].stage {
            Stage::Splat(splat) => splat.irradiance(),
            Stage::Gather(gather) => gather.irradiance(),
        }
    }
}
