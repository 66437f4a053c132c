//! Errors of pictures: light from tables, variable radii and gathers against the best fixed radius (thesis
//! 2.5, 5.1), for the same photons and for the same time, and their [bias] apart from noise.
//!
//! Each scene has a reference of many photons without kernels, of other seeds. Against it stand pictures of
//! some numbers of photons, with some n and some fixed radii, of some seeds each; all pictures of a seed are
//! drawn from the same photons. The first seed is swept over all widths, the others are drawn with the best ones
//! and those beside them. The fixed radius is chosen knowing the answer, for each scene, number of
//! photons and metric anew, from a sweep that goes on until the best is not at its end. So the comparison
//! favours the fixed radius: in practice the best one is unknown.
//!
//! RMSE and relative MSE are of indirect light, which photons make: inside of faces, and over all pixels. The
//! reference's own noise, known from its seeds, is taken away from both. SSIM and FLIP are of the whole
//! picture; the reference's noise is in them, of all ways alike, and draws their ratios towards 1.

pub mod bias;
mod coverage;
mod equal_photons;
mod equal_time;
mod metric;
mod reference;
mod row;
mod run;
mod studio;
mod targets;

pub use bias::BiasRow;
pub use equal_photons::{Comparison, EqualPhotons, Winner, equal_photons};
pub use equal_time::{Budget, CurvePoint, EqualTime, equal_time};
pub use metric::{Chosen, Metric};
pub use reference::SceneReference;
pub use row::{Family, PictureRow, Way};
pub use run::run;
pub use targets::targets;

use serde::{Deserialize, Serialize};

use varikernel::error::{Error, Result};
use varikernel::scene::Scene;
use varikernel::settings::{Kernel, MAX_PICTURE_RADIUS, PictureSettings};

/// So many photons of all seeds together are enough; two seeds are the least.
const PHOTONS_OF_SEEDS: u32 = 2_000_000;

/// What is drawn and compared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PictureStudy {
    /// Names of shipped scenes.
    pub scenes: Vec<String>,
    /// Columns and rows.
    pub size: [u32; 2],
    /// Photons that leave the lights.
    pub photons: Vec<u32>,
    /// n of variable radii that are tried at least; the sweep goes on, by twos, where the best is at its end.
    /// The default of [`PictureSettings`] is compared on its own if it is among them.
    pub min_photons: Vec<u32>,
    /// MR of variable radii, in pixels.
    pub max_radius: u32,
    /// Fixed radii in pixels, increasing: they are tried one after the other until each metric has its best
    /// and one more; the sweep goes on where the best is at its end.
    pub fixed: Vec<u32>,
    /// Falloffs; variable and fixed radii are compared for each.
    pub kernels: Vec<Kernel>,
    /// Seeds of pictures, from 1 on: independent samples; fewer where there are many photons.
    pub seeds: u32,
    /// Seeds that the reference is the mean of, none of them a picture's; an even number, 4 at least.
    pub reference_seeds: u32,
    /// Photons of each of these.
    pub reference_photons: u32,
    /// Shadow rays for each area light; the reference's direct light is that of the pictures.
    pub light_samples: u32,
    /// The number of photons for which bias is tested; nothing is tested if it is none of `photons`.
    pub bias_photons: u32,
    /// Seeds of that test, at least 2, none of them a picture's.
    pub bias_seeds: u32,
}

impl PictureStudy {
    /// All shipped scenes.
    #[must_use]
    pub fn usual() -> Self {
        Self {
            scenes: Scene::shipped_names().map(str::to_owned).collect(),
            size: [128; 2],
            photons: vec![10_000, 100_000, 1_000_000],
            min_photons: vec![100, 200, 400],
            max_radius: 64,
            fixed: vec![1, 2, 3, 4, 6, 8, 11, 15, 20],
            kernels: vec![Kernel::Silverman],
            seeds: 5,
            reference_seeds: 16,
            reference_photons: 1_000_000,
            light_samples: 4,
            bias_photons: 100_000,
            bias_seeds: 8,
        }
    }

    /// Two small scenes: shows that all works, and little more.
    #[must_use]
    pub fn quick() -> Self {
        Self {
            scenes: ["cornell-glass", "cornell-boxes"].map(str::to_owned).to_vec(),
            size: [48; 2],
            photons: vec![4_000, 16_000],
            min_photons: vec![200, 400],
            seeds: 2,
            reference_seeds: 6,
            reference_photons: 100_000,
            bias_photons: 16_000,
            bias_seeds: 3,
            ..Self::usual()
        }
    }

    /// Seeds of pictures with so many photons: the more there are, the less seeds differ, and the longer each
    /// takes.
    #[must_use]
    pub fn seeds_of(&self, photons: u32) -> u32 {
        self.seeds.min((PHOTONS_OF_SEEDS / photons.max(1)).max(2))
    }

    /// Checks every list and range.
    ///
    /// # Errors
    /// [`Error::Setting`] with the field's name; [`Error::File`] for a scene of no such name.
    pub fn validate(&self) -> Result<()> {
        let refuse = |name, value: String, reason: &str| {
            Err(Error::Setting { name, value, reason: reason.to_owned() })
        };
        for (name, is_empty) in [
            ("scenes", self.scenes.is_empty()),
            ("photons", self.photons.is_empty()),
            ("min_photons", self.min_photons.is_empty()),
            ("fixed", self.fixed.is_empty()),
            ("kernels", self.kernels.is_empty()),
        ] {
            if is_empty {
                return refuse(name, "nothing".to_owned(), "give at least one");
            }
        }
        for scene in &self.scenes {
            Scene::shipped(scene)?;
        }
        for &radius in &self.fixed {
            if !(1..=MAX_PICTURE_RADIUS).contains(&radius) {
                let reason = format!("a kernel's radius goes from 1 to {MAX_PICTURE_RADIUS} pixels");
                return refuse("fixed", radius.to_string(), &reason);
            }
        }
        if self.photons.contains(&0) || self.reference_photons == 0 {
            return refuse("photons", "0".to_owned(), "give at least 1");
        }
        if self.seeds == 0 {
            return refuse("seeds", "0".to_owned(), "give at least 1; an interval takes 2 or more");
        }
        if self.reference_seeds < 4 || self.reference_seeds % 2 == 1 {
            let reason = "the reference's noise is found from its seeds; give an even number, 4 at least";
            return refuse("reference_seeds", self.reference_seeds.to_string(), reason);
        }
        if self.bias_seeds < 2 {
            let reason = "a variance takes at least 2";
            return refuse("bias_seeds", self.bias_seeds.to_string(), reason);
        }
        self.min_photons
            .iter()
            .try_for_each(|&n| self.settings(Way::Variable { min_photons: n }, self.kernels[0]).validate())
    }

    /// What a picture of the study is drawn with.
    fn settings(&self, way: Way, kernel: Kernel) -> PictureSettings {
        let usual = PictureSettings::default();
        PictureSettings {
            size: self.size.into(),
            min_photons: way.min_photons().unwrap_or(usual.min_photons),
            max_radius: self.max_radius,
            radius: way.choice(),
            estimate: way.estimate(),
            kernel,
            light_samples: self.light_samples,
            // References are of what pixels' middles show.
            antialias: 1,
            ..usual
        }
    }
}

/// What a study found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// What the scenes were compared with.
    pub references: Vec<SceneReference>,
    /// A row for each picture, in the order of scenes, photons, seeds, kernels and ways.
    pub rows: Vec<PictureRow>,
    /// How biased the ways are, scene by scene.
    pub biases: Vec<BiasRow>,
}
