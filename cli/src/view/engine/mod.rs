//! What makes the pictures: a scene that gets better frame by frame, or a map whose radii are searched once.

mod map;
mod scene;

use std::path::Path;
use std::time::Duration;

use anyhow::Result;
use varikernel::glam::{UVec2, Vec3};
use varikernel::image::{Format, ToneMap};
use varikernel::view::Camera;
use varikernel::{Gl, Image};

use super::choices::Choices;
use super::views::Maps;
use map::MapEngine;
use scene::SceneEngine;

/// A scene or a map, and what was made of it.
pub(super) enum Engine {
    Scene(Box<SceneEngine>),
    Map(Box<MapEngine>),
}

/// What a pixel holds.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Readout {
    pub(super) pixel: UVec2,
    /// Photons of the pixel.
    pub(super) photons: u64,
    /// R.
    pub(super) radius: u32,
    /// N(R), and N(R - 1) if R is more than 1.
    pub(super) within: u64,
    pub(super) within_smaller: Option<u64>,
    /// Of the scene, by name.
    pub(super) surface: Option<String>,
}

impl Engine {
    /// Reads what `choices` name: a scene's name, a scene file, or a map by its extension.
    ///
    /// # Errors
    /// If it can't be read, or a choice is out of range.
    pub(super) fn open(gl: &Gl, choices: &Choices) -> Result<Self> {
        let path = Path::new(&choices.source);
        if Format::of(path).is_ok() {
            return Ok(Self::Map(Box::new(MapEngine::open(gl, path, choices)?)));
        }
        Ok(Self::Scene(Box::new(SceneEngine::open(gl, path, choices)?)))
    }

    /// Goes on with other choices, seen from `camera` or as the scene has it; the source is as it was.
    ///
    /// # Errors
    /// If a choice is refused; all is as it was then.
    pub(super) fn change(&mut self, choices: &Choices, camera: Option<Camera>) -> Result<()> {
        match self {
            Self::Scene(engine) => engine.change(choices, camera),
            Self::Map(engine) => engine.change(choices),
        }
    }

    /// A frame's worth of work.
    ///
    /// # Errors
    /// If sums would not be exact, or the driver fails.
    pub(super) fn step(&mut self) -> Result<()> {
        match self {
            Self::Scene(engine) => engine.step(),
            Self::Map(engine) => engine.step(),
        }
    }

    /// Whether nothing more is to do until choices change.
    pub(super) fn is_done(&self, choices: &Choices) -> bool {
        match self {
            Self::Scene(engine) => engine.photons() >= choices.photons,
            Self::Map(engine) => engine.steps() > 0,
        }
    }

    pub(super) fn is_map(&self) -> bool {
        matches!(self, Self::Map(_))
    }

    /// The scene's title, or the map's name.
    pub(super) fn title(&self) -> &str {
        match self {
            Self::Scene(engine) => engine.title(),
            Self::Map(engine) => engine.title(),
        }
    }

    /// Photons that left the lights, or that a map holds.
    pub(super) fn photons(&self) -> u64 {
        match self {
            Self::Scene(engine) => engine.photons(),
            Self::Map(engine) => engine.photons(),
        }
    }

    /// Steps since the picture was started anew.
    pub(super) fn steps(&self) -> u32 {
        match self {
            Self::Scene(engine) => engine.steps(),
            Self::Map(engine) => engine.steps(),
        }
    }

    /// What there is to show.
    pub(super) fn maps(&self) -> Maps {
        match self {
            Self::Scene(engine) => engine.maps(),
            Self::Map(engine) => engine.maps(),
        }
    }

    /// How long the stages of the last step took.
    pub(super) fn times(&self) -> Vec<(&'static str, Duration)> {
        match self {
            Self::Scene(engine) => engine.times(),
            Self::Map(_) => Vec::new(),
        }
    }

    /// What a pixel holds, read back once after each step.
    ///
    /// # Errors
    /// If the driver fails.
    pub(super) fn inspect(&mut self, pixel: UVec2) -> Result<Readout> {
        match self {
            Self::Scene(engine) => engine.inspect(pixel),
            Self::Map(engine) => engine.inspect(pixel),
        }
    }

    /// The scene's own camera and the corners of its box; nothing for a map.
    pub(super) fn camera(&self) -> Option<(Camera, (Vec3, Vec3))> {
        match self {
            Self::Scene(engine) => Some(engine.camera()),
            Self::Map(_) => None,
        }
    }

    /// The picture's radiance; nothing for a map.
    ///
    /// # Errors
    /// If the driver fails.
    pub(super) fn read(&self) -> Result<Option<Image<[f32; 3]>>> {
        match self {
            Self::Scene(engine) => engine.read().map(Some),
            Self::Map(_) => Ok(None),
        }
    }

    /// Writes the picture and its light (EXR), the picture as it is seen (PNG), or a map's radii (EXR, NPY,
    /// PNG).
    ///
    /// # Errors
    /// If the file can't be written, or the driver fails.
    pub(super) fn save(&self, path: &Path, tone: ToneMap) -> Result<()> {
        match self {
            Self::Scene(engine) => engine.save(path, tone),
            Self::Map(engine) => engine.save(path),
        }
    }
}
