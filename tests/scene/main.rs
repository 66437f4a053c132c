//! Scenes and photons: hand-worked cases first, then physics, then what can go wrong in a file.

#![expect(clippy::unwrap_used, reason = "in the helpers of tests too, a panic is the report")]
#![expect(clippy::cast_precision_loss, reason = "counts of photons are small")]
#![expect(clippy::float_cmp, reason = "where numbers are compared without a margin, they are exact")]

mod cast;
mod direct;
mod exported;
mod files;
mod gltf;
mod lights;
mod meshes;
mod mtl;
mod obj;
mod optics;
mod physics;
mod roulette;
mod shapes;
mod smooth;
mod tracing;

use std::fs;
use std::path::Path;

use tempfile::TempDir;
use varikernel::Result;
use varikernel::photon::{Emission, Photon, Tally, TraceSettings, trace};
use varikernel::scene::Scene;

/// A scene file in a folder of its own, with other files beside it.
fn load_with(text: &str, others: &[(&str, &[u8])]) -> Result<Scene> {
    let folder = TempDir::new().unwrap();
    for (name, content) in others {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).unwrap();
    Scene::load(&path)
}

fn load(text: &str) -> Result<Scene> {
    load_with(text, &[])
}

/// The text of a shipped scene file.
fn shipped_text(file: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenes").join(file)).unwrap()
}

fn settings(photons: u32) -> TraceSettings {
    TraceSettings { photons, ..TraceSettings::default() }
}

fn traced(scene: &Scene, settings: &TraceSettings) -> (Vec<Photon>, Tally) {
    trace(scene, &Emission::new(scene, settings).unwrap())
}

/// A camera and one light, to which surfaces are added.
const BARE: &str = "
[camera]
position = [0, 0, -10]
direction = [0, 0, 1]
up = [0, 1, 0]
vertical_fov_degrees = 40
[lights.lamp]
quad = [[-1, 9, -1], [1, 9, -1], [1, 9, 1], [-1, 9, 1]]
radiance = [1, 1, 1]
[materials]
white = { lambert = [0.5, 0.5, 0.5] }
";
