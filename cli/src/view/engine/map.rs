//! A map of counts from a file, and its radii.

use std::path::Path;

use anyhow::Result;
use varikernel::context::window;
use varikernel::glam::UVec2;
use varikernel::image::{Attribute, Format, Picture, ReadOptions, read_counts, write_counts, write_picture};
use varikernel::reference::{Inside, Table};
use varikernel::settings::Settings;
use varikernel::{CountBounds, DensityMap, Gl, Image, RadiusPipeline};
use varikernel_lab::total_photons;

use super::Readout;
use crate::view::choices::Choices;
use crate::view::views::{Maps, round_up};
use crate::words::in_words_of_options;

pub(in crate::view) struct MapEngine {
    gl: Gl,
    title: String,
    counts: Image<u32>,
    /// Photons of any box.
    table: Table,
    /// Photons in all, and of the pixel with the most.
    photons: u64,
    most_photons: u32,
    density: DensityMap,
    /// The counts again, as the window's shader reads them.
    shown: window::Picture,
    pipeline: RadiusPipeline,
    /// Whether the radii are those of the settings.
    searched: bool,
    /// Read back for the readout.
    radii: Option<Image<u32>>,
}

impl MapEngine {
    pub(super) fn open(gl: &Gl, path: &Path, choices: &Choices) -> Result<Self> {
        let counts = read_counts(path, &ReadOptions::default())?;
        let settings = choices.search();
        let density = DensityMap::upload(gl, &counts, CountBounds::of(&counts, settings.search))?;
        let mut engine = Self {
            gl: gl.clone(),
            title: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            shown: window::Picture::values(gl, &counts.map(|count| count as f32))?,
            pipeline: RadiusPipeline::new(gl, counts.size(), density.format(), settings)
                .map_err(in_words_of_options)?,
            photons: total_photons(&counts),
            most_photons: counts.values().iter().copied().max().unwrap_or(0),
            density,
            table: Table::new(&counts),
            counts,
            searched: false,
            radii: None,
        };
        // What would not be exact is refused before the old picture is dropped.
        engine.step()?;
        engine.searched = false;
        Ok(engine)
    }

    pub(super) fn change(&mut self, choices: &Choices) -> Result<()> {
        let settings = choices.search();
        if settings == *self.pipeline.settings() {
            return Ok(());
        }
        let bounds = CountBounds::of(&self.counts, settings.search);
        let density = DensityMap::upload(&self.gl, &self.counts, bounds)?;
        let mut pipeline = RadiusPipeline::new(&self.gl, self.counts.size(), density.format(), settings)
            .map_err(in_words_of_options)?;
        pipeline.render(&density).map_err(in_words_of_options)?;
        (self.density, self.pipeline) = (density, pipeline);
        (self.searched, self.radii) = (false, None);
        Ok(())
    }

    pub(super) fn step(&mut self) -> Result<()> {
        self.pipeline.render(&self.density).map_err(in_words_of_options)?;
        (self.searched, self.radii) = (true, None);
        Ok(())
    }

    pub(super) fn title(&self) -> &str {
        &self.title
    }

    pub(super) fn photons(&self) -> u64 {
        self.photons
    }

    pub(super) fn steps(&self) -> u32 {
        u32::from(self.searched)
    }

    pub(super) fn settings(&self) -> &Settings {
        self.pipeline.settings()
    }

    pub(super) fn maps(&self) -> Maps {
        let radii = self.pipeline.radii();
        Maps {
            size: self.counts.size(),
            beauty: None,
            indirect: None,
            direct: None,
            density: Some(self.shown.texture()),
            radii: Some(radii.texture()),
            limited: radii.limited_texture(),
            widths: false,
            most_photons: round_up(self.most_photons as f32),
            max_radius: self.settings().search.max_radius,
        }
    }

    pub(super) fn inspect(&mut self, pixel: UVec2) -> Result<Readout> {
        let radii = match self.radii.take() {
            Some(radii) => radii,
            None => self.pipeline.radii().read()?,
        };
        let radius = self.radii.insert(radii).at(pixel.x, pixel.y);
        let within = |radius| self.table.count(Inside::of_box(self.counts.size(), pixel.x, pixel.y, radius));
        Ok(Readout {
            pixel,
            photons: self.counts.at(pixel.x, pixel.y).into(),
            radius,
            within: within(radius),
            within_smaller: (radius > 1).then(|| within(radius - 1)),
            surface: None,
        })
    }

    pub(super) fn save(&self, path: &Path) -> Result<()> {
        let (radii, search) = (self.pipeline.radii().read()?, self.settings().search);
        match Format::of(path)? {
            Format::Png => {
                let title = format!("Radius for n = {}, MR = {}", search.min_photons, search.max_radius);
                let range = Some(1..=search.max_radius);
                Ok(write_picture(path, &radii, &Picture { title: &title, unit: "pixels", range })?)
            }
            Format::Npy | Format::Exr => {
                let settings = Attribute::text("varikernel.settings", format!("{:?}", self.settings()));
                Ok(write_counts(path, "radius", &radii, &[settings])?)
            }
        }
    }
}
