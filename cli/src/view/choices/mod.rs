//! Everything that can be chosen in the window, as saved settings and as options of the other verbs.

mod check;

use std::fs;
use std::path::Path;

use anyhow::{Context as _, Result};
use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use varikernel::image::write_atomically;
use varikernel::settings::{
    Edges, Exactness, IrradianceSettings, Kernel, KernelRadius, Laboratory, Method, Order, Search, Settings,
};
use varikernel::view::Camera;

use crate::light::Light;
use crate::output::quoted;

/// The least and the most photons of a frame.
pub(super) const LEAST_A_FRAME: u32 = 500;
pub(super) const MOST_A_FRAME: u32 = 1_000_000;

/// What is shown and how it is made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Choices {
    /// Scene, by file or name, or map.
    pub(super) source: String,
    /// Columns and rows of a scene's picture.
    pub(super) size: [u32; 2],
    /// How a scene's photons become light; from tables, it has neither radii nor kernels to choose.
    #[serde(default = "before_tables")]
    pub(super) light: Light,
    /// Whether radii come from a search; else `fixed_radius` is that of all kernels.
    pub(super) variable: bool,
    pub(super) fixed_radius: u32,
    pub(super) min_photons: u32,
    pub(super) max_radius: u32,
    pub(super) kernel: Kernel,
    pub(super) method: Method,
    pub(super) order: Order,
    pub(super) edges: Edges,
    /// Photons of a frame; where `adapt` holds, the window changes them so that a frame takes
    /// `frame_milliseconds`.
    pub(super) photons_per_frame: u32,
    pub(super) adapt: bool,
    pub(super) frame_milliseconds: u32,
    /// Photons after which the picture is good enough.
    pub(super) photons: u64,
    /// Diffuse landings after which a photon is followed no further; nothing for its end.
    pub(super) bounces: Option<u32>,
    pub(super) seed: u64,
    /// In stops; nothing for what suits the first picture.
    pub(super) exposure: Option<f32>,
    /// Where the camera was moved to, if it was.
    pub(super) camera: Option<CameraChoice>,
}

/// The light of settings that were saved before there was a choice.
fn before_tables() -> Light {
    Light::Splat
}

/// A camera as its file holds it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraChoice {
    position: [f32; 3],
    direction: [f32; 3],
    up: [f32; 3],
    vertical_fov_degrees: f32,
}

impl From<Camera> for CameraChoice {
    fn from(camera: Camera) -> Self {
        Self {
            position: camera.position.to_array(),
            direction: camera.direction.to_array(),
            up: camera.up.to_array(),
            vertical_fov_degrees: camera.vertical_fov_degrees,
        }
    }
}

impl From<CameraChoice> for Camera {
    fn from(choice: CameraChoice) -> Self {
        Self {
            position: choice.position.into(),
            direction: choice.direction.into(),
            up: choice.up.into(),
            vertical_fov_degrees: choice.vertical_fov_degrees,
        }
    }
}

/// The file: its kind, how to get the same without a window, and the choices.
#[derive(Serialize, Deserialize)]
struct File {
    varikernel_view: u32,
    command: String,
    choices: Choices,
}

impl Choices {
    /// How radii are searched: an exact method is refused where it would not be exact.
    pub(super) fn search(&self) -> Settings {
        let exactness = if self.method.is_exact() { Exactness::Required } else { Exactness::Waived };
        let (min_photons, max_radius) = (self.min_photons, self.max_radius);
        let search = Search { min_photons, max_radius, edges: self.edges, order: self.order };
        let usual = Settings::of(self.method);
        let laboratory = Laboratory { exactness, ..usual.laboratory };
        Settings { search, limited_mask: true, laboratory, ..usual }
    }

    /// How a scene's photons become irradiance; with tables, in mirrors and through glass as `render` does.
    pub(super) fn irradiance(&self) -> IrradianceSettings {
        let estimate = self.light.estimate(false);
        if self.light == Light::Tables {
            return IrradianceSettings { estimate, ..IrradianceSettings::default() };
        }
        let radius =
            if self.variable { KernelRadius::Variable } else { KernelRadius::Fixed(self.fixed_radius) };
        IrradianceSettings { radius, radii: self.search(), kernel: self.kernel, estimate }
    }

    /// The method, with an order that it has.
    pub(super) fn set_method(&mut self, method: Method) {
        self.method = method;
        if self.order == Order::Bracketed && method != Method::SummedAreaTable {
            self.order = Settings::of(method).search.order;
        }
    }

    /// The same by another verb, as far as it has it.
    pub(super) fn command(&self, photons: u64, is_map: bool) -> String {
        let (source, n, max) = (quoted(&self.source), self.min_photons, self.max_radius);
        if is_map {
            let (method, order, edges) = (word(self.method), word(self.order), word(self.edges));
            return format!(
                "varikernel radius {source} -o radius.png -n {n} -r {max} --method {method} --search \
                 {order} --edges {edges}"
            );
        }
        let [width, height] = self.size;
        let kernel = word(self.kernel);
        let kernels = match (self.light, self.variable) {
            (Light::Tables, _) => String::new(),
            (_, true) => format!(" -n {n} -r {max} --kernel {kernel}"),
            (_, false) => format!(" --radius fixed:{} --kernel {kernel}", self.fixed_radius),
        };
        let bounces = self.bounces.map_or_else(String::new, |bounces| format!(" --bounces {bounces}"));
        let exposure = self.exposure.map_or_else(String::new, |stops| format!(" --exposure {stops:.2}"));
        format!(
            "varikernel render {source} -o picture.exr --size {width}x{height} --photons {} --light \
             {}{kernels}{bounces} --seed {}{exposure}",
            photons.max(1),
            word(self.light),
            self.seed
        )
    }

    /// Writes the choices as JSON.
    ///
    /// # Errors
    /// If the file can't be written.
    pub(super) fn save(&self, path: &Path, command: String) -> Result<()> {
        let file = File { varikernel_view: 1, command, choices: self.clone() };
        let text = serde_json::to_string_pretty(&file)? + "\n";
        Ok(write_atomically(path, |file| std::io::Write::write_all(file, text.as_bytes()))?)
    }

    /// Reads choices that were saved.
    ///
    /// # Errors
    /// If there is no such file, it holds something else, or a number is out of its range.
    pub(super) fn load(path: &Path) -> Result<Self> {
        let text = fs::read_to_string(path).with_context(|| format!("{}: can't be read", path.display()))?;
        let file: File = serde_json::from_str(&text)
            .with_context(|| format!("{}: holds no settings of the window", path.display()))?;
        file.choices.check().with_context(|| format!("{}: settings out of their range", path.display()))?;
        Ok(file.choices)
    }
}

/// The value of an option.
pub(super) fn word(value: impl ValueEnum + Copy) -> String {
    value.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

#[cfg(test)]
mod tests {
    use varikernel::settings::Estimate;

    use super::*;

    pub(super) fn choices() -> Choices {
        Choices {
            source: "cornell-glass".to_owned(),
            size: [64, 48],
            light: Light::Splat,
            variable: true,
            fixed_radius: 3,
            min_photons: 50,
            max_radius: 16,
            kernel: Kernel::Cone,
            method: Method::SummedAreaTable,
            order: Order::Bracketed,
            edges: Edges::Scale,
            photons_per_frame: 1000,
            adapt: true,
            frame_milliseconds: 100,
            photons: 1_000_000,
            bounces: Some(8),
            seed: 1,
            exposure: None,
            camera: None,
        }
    }

    #[test]
    fn what_is_out_of_range_is_not_loaded() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("view.json");
        choices().save(&path, String::new()).expect("saved");
        let text = fs::read_to_string(&path).expect("read");
        fs::write(&path, text.replace("\"photons_per_frame\": 1000", "\"photons_per_frame\": 0"))
            .expect("written");
        let error = Choices::load(&path).expect_err("no photons");
        assert!(format!("{error:#}").contains("choices.photons_per_frame = 0"), "{error:#}");
    }

    #[test]
    fn what_is_saved_is_loaded_again() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("view.json");
        let camera = CameraChoice {
            position: [0.1, -2.5, 1e-7],
            direction: [0.0, 0.0, 1.0],
            up: [0.0, 1.0, 0.0],
            vertical_fov_degrees: 39.3,
        };
        let saved = Choices { exposure: Some(0.1), camera: Some(camera), bounces: None, ..choices() };
        saved.save(&path, "a command".to_owned()).expect("saved");
        assert_eq!(Choices::load(&path).expect("loaded"), saved);
        fs::write(&path, "{}").expect("written");
        assert!(Choices::load(&path).expect_err("no settings").to_string().contains("no settings"));
    }

    #[test]
    fn settings_of_before_tables_have_the_light_that_they_had() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("view.json");
        Choices { light: Light::Tables, ..choices() }.save(&path, String::new()).expect("saved");
        let text = fs::read_to_string(&path).expect("read");
        let old = text.replace("    \"light\": \"tables\",\n", "");
        assert!(old.len() < text.len(), "{text}");
        fs::write(&path, old).expect("written");
        assert_eq!(Choices::load(&path).expect("loaded"), choices());
    }

    #[test]
    fn light_from_tables_asks_for_no_kernels() {
        let mut choices = Choices { light: Light::Tables, ..choices() };
        let before = choices.irradiance();
        assert_eq!(before.estimate, Estimate::Tables);
        (choices.min_photons, choices.variable, choices.kernel) = (7, false, Kernel::Silverman);
        assert_eq!(choices.irradiance(), before, "the picture is not started anew");
        choices.light = Light::Gather;
        let gather = choices.irradiance();
        assert_eq!(gather.estimate, Estimate::Gather { count_correction: false });
        assert_eq!(gather.radius, KernelRadius::Fixed(3));
    }

    #[test]
    fn commands_name_what_differs() {
        let mut choices = choices();
        assert_eq!(
            choices.command(5000, false),
            "varikernel render cornell-glass -o picture.exr --size 64x48 --photons 5000 --light splat -n 50 \
             -r 16 --kernel cone --bounces 8 --seed 1"
        );
        (choices.light, choices.variable) = (Light::Gather, false);
        let command = choices.command(5000, false);
        assert!(command.contains("--light gather --radius fixed:3 --kernel cone --bounces 8"), "{command}");
        choices.light = Light::Tables;
        let command = choices.command(5000, false);
        assert!(command.ends_with("--photons 5000 --light tables --bounces 8 --seed 1"), "{command}");
        choices.bounces = None;
        assert!(!choices.command(5000, false).contains("bounces"), "photons are followed to their end");
        choices.source = "it's a map.exr".to_owned();
        assert_eq!(
            choices.command(0, true),
            "varikernel radius 'it'\\''s a map.exr' -o radius.png -n 50 -r 16 --method sat --search \
             bracketed --edges scale"
        );
        choices.set_method(Method::Pyramid);
        assert_eq!(choices.order, Order::Binary, "brackets are for the table");
    }
}
