//! Files as exporters write them that were once refused or drawn wrong.

use serde_json::json;
use varikernel::glam::Vec3;
use varikernel::scene::Scattering;

use super::{Made, corners, material, moved};

#[test]
fn an_emissive_texture_that_is_missing_makes_no_lamp() {
    let mut made = Made::square();
    made.json["images"] = json!([{"uri": "none.png"}]);
    made.json["textures"] = json!([{"source": 0}]);
    made.material(&json!({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}));
    let scene = made.load().unwrap();
    assert_eq!(material(&scene).emission, Vec3::ZERO);
    assert_eq!(scene.lights().iter().map(|light| light.name.as_str()).collect::<Vec<_>>(), ["lamp"]);
}

#[test]
fn a_pane_that_transmits_is_no_solid() {
    let mut made = Made::square();
    made.material(&json!({
        "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}},
    }));
    let expected = Scattering::ThinDielectric { index: 1.5, transmittance: Vec3::ONE };
    assert_eq!(material(&made.load().unwrap()).scattering, expected);
}

#[test]
fn a_skin_without_weights_leaves_its_mesh_as_modelled() {
    let mut made = Made::square();
    made.json["nodes"] = json!([{"mesh": 0, "skin": 0, "translation": [100, 0, 0]}, {}]);
    made.json["skins"] = json!([{"joints": [1]}]);
    assert_eq!(corners(&made.load().unwrap()), moved(|at| at));
}

#[test]
fn primitives_of_points_and_lines_are_passed_over() {
    let mut made = Made::square();
    for mode in 0..4 {
        let mut other = made.primitive().clone();
        other["mode"] = json!(mode);
        made.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(other);
    }
    assert_eq!(corners(&made.load().unwrap()), moved(|at| at));
}

#[test]
fn what_pictures_do_not_need_may_be_of_any_form() {
    let mut made = Made::square();
    made.json["animations"] =
        json!([{"channels": [{"sampler": 0, "target": {"path": "pointer"}}], "samplers": 7}]);
    made.json["cameras"] = json!([{"type": "panoramic"}]);
    made.json["extras"] = json!({"extensions": {"not one": {}}});
    made.json["asset"]["extras"] = json!([1, null]);
    let other = made.floats("VEC3", &[0.0; 12]);
    made.primitive()["attributes"]["_WIND"] = json!(other);
    made.primitive()["attributes"]["COLOUR"] = json!(99);
    assert_eq!(corners(&made.load().unwrap()), moved(|at| at));
}
