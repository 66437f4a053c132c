//! What a glTF file holds and the picture lacks is reported in one line.

use std::io::Cursor;

use image::{ImageFormat, RgbImage};
use serde_json::{Value, json};

use crate::Workplace;

/// A square of two triangles, as a file of 60 bytes beside the mesh.
fn numbers() -> Vec<u8> {
    let corners = [-1_f32, -1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.0];
    let indices = [0_u16, 1, 2, 0, 2, 3];
    [&corners.map(f32::to_le_bytes).concat()[..], &indices.map(u16::to_le_bytes).concat()].concat()
}

/// The square with one material.
fn square(material: &Value) -> Value {
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [material],
        "buffers": [{"uri": "a.bin", "byteLength": 60}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
    })
}

const SCENE: &str = "
[camera]
position = [0, 0, 3]
direction = [0, 0, -1]
up = [0, 1, 0]
vertical_fov_degrees = 60
[lights.lamp]
point = [0, 0, 3]
intensity = [30, 30, 30]
[surfaces.s]
mesh = { file = \"a.gltf\" }
";

/// The warnings of a run on the mesh, one a line.
#[track_caller]
fn warnings(mesh: &Value, others: &[(&str, &[u8])]) -> Vec<String> {
    let place = Workplace::new();
    place.put("scene.toml", SCENE.as_bytes());
    place.put("a.gltf", mesh.to_string().as_bytes());
    place.put("a.bin", &numbers());
    for (name, content) in others {
        place.put(name, content);
    }
    let run = place.run("photons scene.toml -o a.npy --photons 100").success();
    let stderr = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
    stderr.lines().filter(|line| line.contains("WARN")).map(str::to_owned).collect()
}

/// One line that names the file, with all `words`.
#[track_caller]
fn warns(mesh: &Value, words: &[&str]) {
    let found = warnings(mesh, &[]);
    assert_eq!(found.len(), 1, "{found:#?}");
    for word in words.iter().chain(&["a.gltf: left out: "]) {
        assert!(found[0].contains(word), "{word:?} is not in: {}", found[0]);
    }
}

#[test]
fn what_is_read_whole_is_not_told() {
    let mut image = Cursor::new(Vec::new());
    RgbImage::new(2, 2).write_to(&mut image, ImageFormat::Png).unwrap();
    let mut mesh = square(&json!({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
        // Without a factor nothing shines, and the texture does not matter.
        "emissiveTexture": {"index": 7}, "alphaMode": "OPAQUE", "doubleSided": true,
    }));
    let attributes = &mut mesh["meshes"][0]["primitives"][0]["attributes"];
    (attributes["TEXCOORD_0"], attributes["TANGENT"]) = (json!(2), json!(3));
    mesh["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({"componentType": 5126, "count": 4, "type": "VEC2"}));
    mesh["images"] = json!([{"uri": "a.png"}]);
    mesh["textures"] = json!([{"source": 0}]);
    mesh["extensionsUsed"] = json!(["KHR_texture_transform", "KHR_mesh_quantization", "KHR_materials_ior"]);
    assert_eq!(warnings(&mesh, &[("a.png", image.get_ref())]), [""; 0]);
}

#[test]
fn textures_that_are_not_read_are_told() {
    let mut mesh = square(&json!({
        "pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}},
        "normalTexture": {"index": 0}, "occlusionTexture": {"index": 0},
    }));
    mesh["textures"] = json!([{"source": 0}]);
    warns(&mesh, &["1 normal texture", "1 occlusion texture", "1 metallic-roughness texture"]);

    mesh["materials"] = json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
        "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 1}}]);
    let attributes = &mut mesh["meshes"][0]["primitives"][0]["attributes"];
    attributes["TEXCOORD_0"] = json!(2);
    mesh["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({"componentType": 5126, "count": 4, "type": "VEC2"}));
    mesh["images"] = json!([{"uri": "none.png"}]);
    mesh["textures"] =
        json!([{"source": 0}, {"name": "glow", "extensions": {"KHR_texture_basisu": {"source": 0}}}]);
    warns(
        &mesh,
        &[
            "1 base colour texture (the base colour alone counts) (none.png: there is no such file)",
            "1 emissive texture (nothing shines in its place) (textures[1]: KHR_texture_basisu \
             is not supported",
        ],
    );
    let found = warnings(&mesh, &[("none.png", b"RIFF\x10\0\0\0WEBPVP8 ")]);
    assert!(
        found[0].contains("none.png: it is image/webp, and only PNG and JPEG are supported"),
        "{}",
        found[0]
    );
}

#[test]
fn extensions_that_are_not_read_are_told_by_name() {
    let mut mesh = square(&json!({"extensions": {"KHR_materials_clearcoat": {}, "KHR_materials_unlit": {}}}));
    warns(&mesh, &["2 extensions (KHR_materials_clearcoat, KHR_materials_unlit)"]);
    mesh["materials"] = json!([{}]);
    mesh["extensionsUsed"] = json!(["ACME_sparkle"]);
    warns(&mesh, &["1 extension (ACME_sparkle)"]);
}

#[test]
fn materials_that_are_simplified_are_told() {
    for (material, words) in [
        (
            json!({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}}),
            "1 alpha blend",
        ),
        (
            json!({"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}}),
            "1 alpha mask",
        ),
        (
            json!({"doubleSided": true, "emissiveFactor": [1, 1, 1]}),
            "1 light from the back of a double-sided surface",
        ),
        (
            json!({"pbrMetallicRoughness": {"metallicFactor": 0},
                "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.7}}}),
            "1 transmission between 0 and 1 (taken as the nearer); 1 roughness of glass",
        ),
        (
            json!({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
                "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
                "KHR_materials_volume":
                    {"thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": [1, 0, 0]}}}),
            "1 colour of solid glass",
        ),
    ] {
        warns(&square(&material), &[words]);
    }
}

#[test]
fn lights_cameras_animations_and_skins_are_told() {
    let mut mesh = square(&json!({}));
    mesh["nodes"] = json!([
        {"mesh": 0, "skin": 0, "children": [1, 2, 3]},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 1}}},
    ]);
    mesh["extensions"] = json!({"KHR_lights_punctual": {"lights":
        [{"type": "directional"}, {"type": "spot", "range": 5, "spot": {}}]}});
    mesh["cameras"] = json!([{"type": "perspective"}]);
    mesh["animations"] = json!([{}, {}]);
    mesh["skins"] = json!([{"joints": [1]}]);
    warns(
        &mesh,
        &[
            "2 directional lights",
            "1 end of a light's range",
            "1 soft edge of a spot",
            "1 camera",
            "2 animations (shown at rest)",
            "1 skin of a primitive without weights",
        ],
    );
}

#[test]
fn primitives_and_colours_that_are_not_drawn_are_told() {
    let mut mesh = square(&json!({}));
    mesh["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({"componentType": 5126, "count": 4, "type": "VEC3"}));
    let first = &mut mesh["meshes"][0]["primitives"][0];
    first["attributes"]["COLOR_1"] = json!(2);
    let other = |mode: u32| json!({"attributes": {"POSITION": 0}, "mode": mode});
    let primitives = mesh["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.extend([other(0), other(1), other(3), json!({"attributes": {}})]);
    warns(
        &mesh,
        &[
            "1 second set of vertex colours",
            "1 primitive of points",
            "2 primitives of lines",
            "1 primitive without positions",
        ],
    );
}
