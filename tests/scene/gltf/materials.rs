//! Materials: glass of both kinds, mirrors, and diffuse surfaces.

use serde_json::{Value, json};
use varikernel::glam::Vec3;
use varikernel::scene::{Material, Scattering};

use super::{Made, material, vertices};
use crate::{BARE, load_with};

fn made_of(entry: &Value) -> Material {
    let mut made = Made::square();
    made.material(entry);
    material(&made.load().unwrap()).clone()
}

#[test]
fn colours_metal_and_polish_say_what_happens_to_light() {
    let surface = |metal: f64, rough: f64| {
        let own =
            json!({"baseColorFactor": [0.1, 0.2, 0.3, 1], "metallicFactor": metal, "roughnessFactor": rough});
        made_of(&json!({"pbrMetallicRoughness": own})).scattering
    };
    let colour = Vec3::new(0.1, 0.2, 0.3);
    assert_eq!(surface(0.0, 0.0), Scattering::Lambert(colour));
    assert_eq!(surface(1.0, 0.5), Scattering::Lambert(colour));
    assert_eq!(surface(1.0, 0.1), Scattering::Mirror(colour));
}

#[test]
fn a_primitive_without_a_material_has_that_of_the_format() {
    let scene = Made::square().load().unwrap();
    assert_eq!(material(&scene).scattering, Scattering::Lambert(Vec3::ONE));
    assert_eq!(material(&scene).emission, Vec3::ZERO);
}

#[test]
fn transmission_is_thin_without_a_volume_and_solid_with_one() {
    let glass = |extensions: Value| {
        made_of(&json!({
            "pbrMetallicRoughness":
                {"baseColorFactor": [1, 0.5, 0.25, 1], "metallicFactor": 0, "roughnessFactor": 0},
            "extensions": extensions,
        }))
        .scattering
    };
    let transmission = json!({"transmissionFactor": 1});
    let transmittance = Vec3::new(1.0, 0.5, 0.25);
    assert_eq!(
        glass(json!({"KHR_materials_transmission": transmission})),
        Scattering::ThinDielectric { index: 1.5, transmittance }
    );
    assert_eq!(
        glass(json!({"KHR_materials_transmission": transmission, "KHR_materials_ior": {"ior": 1.33},
            "KHR_materials_volume": {"thicknessFactor": 0}})),
        Scattering::ThinDielectric { index: 1.33, transmittance }
    );
    assert_eq!(
        glass(json!({"KHR_materials_transmission": transmission, "KHR_materials_ior": {"ior": 1.33},
            "KHR_materials_volume": {"thicknessFactor": 0.1}})),
        Scattering::Dielectric { index: 1.33 }
    );
    // An index of 0 is infinite in the format: nothing is refracted.
    assert_eq!(
        glass(json!({"KHR_materials_transmission": transmission, "KHR_materials_ior": {"ior": 0}})),
        Scattering::Mirror(Vec3::ONE)
    );
    // Little of it leaves a surface as it is, whatever its index and volume.
    assert_eq!(
        glass(
            json!({"KHR_materials_transmission": {"transmissionFactor": 0.2}, "KHR_materials_ior": {"ior": 0},
            "KHR_materials_volume": {"thicknessFactor": 1}})
        ),
        Scattering::Lambert(transmittance)
    );
}

#[test]
fn emission_is_factor_times_strength() {
    let shining = json!({"emissiveFactor": [1, 0.5, 0],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 6}}});
    assert_eq!(made_of(&shining).emission, Vec3::new(6.0, 3.0, 0.0));
    assert_eq!(made_of(&json!({"emissiveFactor": [1, 0.5, 0]})).emission, Vec3::new(1.0, 0.5, 0.0));
}

#[test]
fn what_the_scene_replaces_is_not_read() {
    let mut made = Made::square();
    let colours = made.floats("VEC3", &[0.5; 12]);
    made.primitive()["attributes"]["COLOR_0"] = json!(colours);
    made.material(
        &json!({"pbrMetallicRoughness": {"baseColorFactor": [2, 0, 0, 1]}, "emissiveFactor": [9, 9, 9]}),
    );
    let text = format!("{BARE}\n[surfaces.thing]\nmaterial = \"white\"\nmesh = {{ file = \"a.gltf\" }}\n");
    let scene = load_with(&text, &[("a.gltf", made.text().as_bytes())]).unwrap();
    assert_eq!(material(&scene).scattering, Scattering::Lambert(Vec3::splat(0.5)));
    assert_eq!(material(&scene).emission, Vec3::ZERO);
    assert!(vertices(&scene).iter().all(|vertex| vertex.colour == Vec3::ONE));
}

#[test]
fn impossible_numbers_are_refused_where_the_material_is_used() {
    let mut made = Made::square();
    made.material(&json!({"name": "odd", "pbrMetallicRoughness": {"baseColorFactor": [2, 0, 0, 1]}}));
    made.refuses(&["the reflectance of material \"odd\" is [2, 0, 0]"]);
    made.json["materials"] = json!([{}, {"pbrMetallicRoughness": {"baseColorFactor": [2, 0, 0, 1]}}]);
    assert_eq!(material(&made.load().unwrap()).name, "material 1");
    made.primitive()["material"] = json!(2);
    made.refuses(&["meshes[0].primitives[0].material: there is no material 2"]);
}
