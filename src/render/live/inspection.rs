//! What a pixel of a picture in the making holds, for people to look at.

use glam::UVec2;

use crate::error::{Error, Result};
use crate::image::Image;
use crate::light::IrradiancePipeline;
use crate::reference::{Inside, Table};
use crate::scene::Scene;
use crate::settings::{Estimate, KernelRadius};
use crate::view::View;

/// What a pixel holds, and why its radius is what it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inspection {
    /// Photons of the pixel itself.
    pub photons: u64,
    /// R: the radius of its photons' kernels, or of the box that light from tables is gathered from, in pixels;
    /// only there it may be 0.
    pub radius: u32,
    /// N(R): photons in the box of radius R, as far as it is inside of the picture.
    pub within: u64,
    /// N(R - 1): photons in the next smaller box; nothing for R up to 1.
    pub within_smaller: Option<u64>,
    /// Name of the surface that the pixel shows first, mirrors and glass too.
    pub surface: Option<String>,
}

/// Maps as they were after a step.
#[derive(Debug, Default)]
pub(super) struct Inspector {
    maps: Option<(Table, Option<Image<u32>>)>,
}

impl Inspector {
    /// The maps have changed.
    pub(super) fn forget(&mut self) {
        self.maps = None;
    }

    pub(super) fn inspect(
        &mut self,
        scene: &Scene,
        view: &View,
        pipeline: &IrradiancePipeline,
        pixel: UVec2,
    ) -> Result<Inspection> {
        let size = view.size();
        if pixel.cmpge(size).any() {
            return Err(Error::Setting {
                name: "pixel",
                value: pixel.to_string(),
                reason: format!("the picture has {} x {} pixels", size.x, size.y),
            });
        }
        let maps = if let Some(maps) = self.maps.take() {
            maps
        } else {
            let radii = pipeline.radii().filter(|_| pipeline.density_stage().drawn() > 0);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts up to 2^24")]
            let counts = pipeline.density_stage().read_counts()?.map(|count| count as u32);
            (Table::new(&counts), radii.map(crate::maps::RadiusMap::read).transpose()?)
        };
        let (table, radii) = self.maps.insert(maps);
        let radius = match (pipeline.settings().radius, radii) {
            (_, Some(radii)) => radii.at(pixel.x, pixel.y),
            _ if pipeline.settings().estimate == Estimate::Tables => 0,
            (KernelRadius::Fixed(radius), None) => radius,
            (KernelRadius::Variable, None) => pipeline.settings().radii.search.max_radius,
        };
        let within = |radius| table.count(Inside::of_box(size, pixel.x, pixel.y, radius));
        let hit = scene.cast(&view.ray(pixel.x, pixel.y));
        Ok(Inspection {
            photons: within(0),
            radius,
            within: within(radius),
            within_smaller: (radius > 1).then(|| within(radius - 1)),
            surface: hit.map(|hit| scene.geometry().surfaces[hit.surface as usize].clone()),
        })
    }
}
