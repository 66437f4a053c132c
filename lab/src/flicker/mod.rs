//! Noise between frames: how much light flickers where nothing, the lamp or the camera moves, for each way to
//! light, and for photons that are kept for some frames.
//!
//! - Each frame has photons of its own seed, and a reference of many. A pixel's flicker is told by the second
//!   difference of its error over three frames in a row, `(a - 2 b + c) / √6`, in which errors that stay or
//!   change evenly are 0: its root mean square over frames and pixels that show the same face in all three is
//!   the standard deviation of a pixel's value.
//! - Kept photons lie in the scene, and are counted anew as each frame's camera sees them. Where the lamp stands
//!   still they are as good as new ones; where it moves, light lags behind, which is told by the same average
//!   of references: the ghost.

mod measure;
mod room;

pub use measure::run;

use std::io::Write as _;
use std::path::Path;

use glam::UVec2;
use serde::{Deserialize, Serialize};
use varikernel::error::{Error, Result};
use varikernel::image::write_atomically;

use crate::study::pictures::Way;

/// What moves from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Moves {
    /// Nothing: frames differ in their photons alone.
    Nothing,
    /// The camera, sideways by a fifth of the room.
    Camera,
    /// The lamp, sideways by two fifths of the room.
    Lamp,
}

impl Moves {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Nothing, Self::Camera, Self::Lamp];

    /// For people.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::Camera => "camera",
            Self::Lamp => "lamp",
        }
    }
}

/// What is measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FlickerStudy {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Photons that leave the lamp in each frame.
    pub photons: u32,
    /// Frames, 3 at least.
    pub frames: u32,
    /// Frames whose photons are kept, beside 1: the frame's own alone.
    pub kept: u32,
    /// Photons of each frame's reference.
    pub reference_photons: u32,
    /// Ways to light.
    pub ways: Vec<Way>,
}

impl FlickerStudy {
    /// 32 frames of 20,000 photons at 128 x 128 pixels, with those of 8 frames kept.
    #[must_use]
    pub fn usual() -> Self {
        Self {
            size: [128; 2],
            photons: 20_000,
            frames: 32,
            kept: 8,
            reference_photons: 1_000_000,
            ways: vec![
                Way::Tables,
                Way::Gather { min_photons: 400 },
                Way::Variable { min_photons: 400 },
                Way::Fixed { radius: 4 },
            ],
        }
    }

    /// Some frames of a small picture.
    #[must_use]
    pub fn quick() -> Self {
        Self { size: [48; 2], photons: 4000, frames: 8, kept: 4, reference_photons: 200_000, ..Self::usual() }
    }

    fn size(&self) -> UVec2 {
        UVec2::from_array(self.size)
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`Error::Setting`] with the field's name.
    pub fn validate(&self) -> Result<()> {
        let refuse = |name, value: u32, reason: &str| {
            Err(Error::Setting { name, value: value.to_string(), reason: reason.to_owned() })
        };
        if self.frames < 3 {
            return refuse("frames", self.frames, "noise is told by three frames in a row");
        }
        if self.kept == 0 || self.kept > self.frames {
            return refuse("kept", self.kept, "photons are kept for one frame at least, and for all at most");
        }
        if self.size().min_element() == 0 {
            return refuse("size", 0, "a picture has at least one pixel");
        }
        Ok(())
    }
}

/// One way's noise between frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FlickerRow {
    /// What moves.
    pub moves: Moves,
    /// How photons become light.
    pub way: Way,
    /// Frames whose photons are counted, the frame's own included.
    pub kept: u32,
    /// Standard deviation of the error of a pixel's indirect irradiance from frame to frame, over the picture's
    /// mean.
    pub flicker: f64,
    /// RMSE of the last frame against a reference, over its mean.
    pub error: f64,
    /// RMSE of what kept photons bring in the mean, over the same: 0 where nothing lags behind.
    pub ghost: f64,
}

/// All that was measured: `flicker.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Flicker {
    /// The version of the program.
    pub program: String,
    /// The commit that it was built from.
    pub commit: String,
    /// Where it ran.
    pub renderer: String,
    /// The settings.
    pub settings: FlickerStudy,
    /// By what moves, then by way.
    pub rows: Vec<FlickerRow>,
}

impl Flicker {
    /// Writes JSON, the old file kept until the new one is whole.
    ///
    /// # Errors
    /// As [`write_atomically`].
    pub fn save(&self, path: &Path) -> Result<()> {
        write_atomically(path, |file| {
            serde_json::to_writer_pretty(&mut *file, self)?;
            file.write_all(b"\n")
        })
    }

    /// A row for each way, in percent: what moves, the way, frames kept, flicker, error and ghost.
    #[must_use]
    pub fn rows(&self) -> Vec<[String; 6]> {
        let percent = |share: f64| format!("{:.2}", 100.0 * share);
        let row = |row: &FlickerRow| {
            let [flicker, error, ghost] = [row.flicker, row.error, row.ghost].map(percent);
            let kept = row.kept.to_string();
            [row.moves.name().to_owned(), row.way.to_string(), kept, flicker, error, ghost]
        };
        self.rows.iter().map(row).collect()
    }
}
