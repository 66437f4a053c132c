//! The scene file, field by field, as TOML has it; `assets/scenes/README.md` explains each.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

/// Three numbers: a place, a direction or a colour.
pub(super) type Triple = [f64; 3];

/// Entries with the places of their names in the file, sorted by name.
pub(super) type Named<T> = BTreeMap<Spanned<String>, T>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneEntry {
    #[serde(default)]
    pub(super) title: String,
    #[serde(default)]
    pub(super) units: String,
    pub(super) camera: CameraEntry,
    #[serde(default)]
    pub(super) lights: Named<LightEntry>,
    #[serde(default)]
    pub(super) materials: Named<MaterialEntry>,
    pub(super) surfaces: Named<SurfaceEntry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraEntry {
    pub(super) position: Spanned<Triple>,
    pub(super) direction: Spanned<Triple>,
    pub(super) up: Spanned<Triple>,
    pub(super) vertical_fov_degrees: Spanned<f64>,
}

/// Either `quad` with `radiance`, or `point` with `intensity` and perhaps `direction` with `angle_degrees`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightEntry {
    pub(super) quad: Option<Spanned<[Triple; 4]>>,
    pub(super) radiance: Option<Spanned<Triple>>,
    pub(super) point: Option<Spanned<Triple>>,
    pub(super) intensity: Option<Spanned<Triple>>,
    pub(super) direction: Option<Spanned<Triple>>,
    pub(super) angle_degrees: Option<Spanned<f64>>,
}

/// One of `lambert`, `mirror`, `dielectric` and `thin_dielectric`, with or without `emission`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialEntry {
    pub(super) lambert: Option<Spanned<Triple>>,
    pub(super) mirror: Option<Spanned<Triple>>,
    pub(super) dielectric: Option<Spanned<f64>>,
    pub(super) thin_dielectric: Option<Spanned<f64>>,
    pub(super) emission: Option<Spanned<Triple>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SurfaceEntry {
    /// A mesh may have its own.
    pub(super) material: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) quads: Vec<Spanned<[Triple; 4]>>,
    #[serde(default)]
    pub(super) spheres: Vec<SphereEntry>,
    pub(super) mesh: Option<MeshEntry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SphereEntry {
    pub(super) centre: Spanned<Triple>,
    pub(super) radius: Spanned<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshEntry {
    pub(super) file: Spanned<String>,
    #[serde(default)]
    pub(super) smooth: bool,
    pub(super) scale: Option<Spanned<f64>>,
    pub(super) translate: Option<Spanned<Triple>>,
}
