//! What can be wrong with a glTF file, reported with its place.

use serde_json::json;

use super::{F32, Made, U16, refuses};

#[test]
fn what_is_no_gltf_is_told_with_its_place() {
    refuses(b"{}", "a.gltf", &["not a glTF file: missing field `asset`"]);
    refuses(b"a letter", "a.gltf", &["not a glTF file", "line 1 column 1"]);
    refuses(b"[1, 2]", "a.gltf", &["not a glTF file"]);
    let mut made = Made::square();
    made.json["accessors"][0]["count"] = json!("four");
    made.refuses(&["not a glTF file: accessors[0].count: invalid type: string \"four\""]);
    made.json["accessors"][0]["count"] = json!(-4);
    made.refuses(&["accessors[0].count", "-4"]);
    made.json["asset"]["version"] = json!("1.0");
    made.json["accessors"][0]["count"] = json!(4);
    made.refuses(&["asset.version: it is glTF 1.0, and only 2.0 is supported"]);
    made.json["asset"] = json!({"version": "2.1", "minVersion": "2.1"});
    made.refuses(&["asset.version: it is glTF 2.1"]);
}

#[test]
fn needed_extensions_are_refused_by_name_and_harmless_ones_pass() {
    for (name, words) in [
        ("KHR_draco_mesh_compression", "without compression"),
        ("EXT_meshopt_compression", "without compression"),
        ("KHR_meshopt_compression", "without compression"),
        ("ACME_voxels", "without that extension"),
    ] {
        let mut made = Made::square();
        made.json["extensionsRequired"] = json!([name]);
        made.refuses(&[&format!("it needs the extension {name}, which is not supported"), words]);
        let message = made.load().unwrap_err().to_string();
        assert!(!message.contains("not a glTF file"), "{message}");
    }
    let mut made = Made::square();
    made.json["extensionsRequired"] = json!([
        "KHR_texture_transform",
        "KHR_materials_unlit",
        "KHR_materials_variants",
        "KHR_lights_punctual",
        "KHR_mesh_quantization",
        "KHR_texture_basisu",
        "EXT_texture_webp",
        "KHR_xmp_json_ld"
    ]);
    assert!(made.load().is_ok());
}

#[test]
fn compressed_vertices_are_refused_only_where_there_are_no_others() {
    let mut made = Made::square();
    made.primitive()["extensions"] =
        json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}});
    assert!(made.load().is_ok());
    made.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    made.refuses(&["meshes[0].primitives[0]", "KHR_draco_mesh_compression"]);

    let mut made = Made::square();
    made.json["bufferViews"][0]["extensions"] = json!({"EXT_meshopt_compression":
        {"buffer": 0, "byteLength": 1, "byteStride": 4, "count": 1, "mode": "ATTRIBUTES"}});
    assert!(made.load().is_ok());
    made.json["bufferViews"][0]["buffer"] = json!(1);
    let text = made.text().replace("\"buffers\":[", "\"buffers\":[{\"byteLength\":1},");
    // The buffers change places: the one with the bytes is the second, the first is a placeholder.
    let text = text.replace("\"buffer\":1", "\"buffer\":9").replace("\"buffer\":0", "\"buffer\":1");
    let text = text.replace("\"buffer\":9", "\"buffer\":0");
    refuses(text.as_bytes(), "a.gltf", &["bufferViews[0]", "EXT_meshopt_compression", "without compression"]);
}

#[test]
fn numbers_that_are_not_there_are_told_with_place_and_extent() {
    let place = "meshes[0].primitives[0].attributes.POSITION";
    let mut made = Made::square();
    made.json["accessors"][0]["count"] = json!(5);
    made.refuses(&[place, "5 items from byte 0 on are past the end of its buffer view, which has 48"]);
    made.json["bufferViews"][0]["byteLength"] = json!(600);
    made.refuses(&["bufferViews[0]: 600 bytes from byte 0 on are past the end of its buffer, which has 60"]);
    made.json["bufferViews"][0]["byteOffset"] = json!(u64::MAX);
    made.refuses(&["bufferViews[0]", "past the end"]);
    made.json["accessors"][0]["bufferView"] = json!(70);
    made.refuses(&[place, "there is no buffer view 70"]);
    made.primitive()["attributes"]["POSITION"] = json!(70);
    made.refuses(&[place, "there is no accessor 70"]);
}

#[test]
fn numbers_of_the_wrong_kind_are_told() {
    let place = "meshes[0].primitives[0].";
    let mut made = Made::square();
    made.json["accessors"][1]["componentType"] = json!(F32);
    made.refuses(&[place, "indices: it holds numbers with a fraction"]);
    made.json["accessors"][1]["componentType"] = json!(U16);
    made.json["accessors"][0]["type"] = json!("VEC2");
    made.refuses(&[place, "attributes.POSITION: it holds VEC2 and not 3 numbers an item"]);
    made.json["accessors"][0]["componentType"] = json!(5130);
    made.refuses(&[place, "attributes.POSITION: its type of numbers is not known"]);

    let mut made = Made::square();
    let normals = made.floats("VEC3", &[0.0, 0.0, 1.0]);
    made.primitive()["attributes"]["NORMAL"] = json!(normals);
    made.refuses(&[place, "attributes.NORMAL: there are 1 of them for 4 vertices"]);
    let infinite = made.floats("VEC3", &[0.0, f32::INFINITY, 1.0].repeat(4));
    made.primitive()["attributes"]["NORMAL"] = json!(infinite);
    made.refuses(&[place, "attributes.NORMAL: item 1 is [0.0, inf, 1.0]"]);

    let mut made = Made::square();
    let indices = made.shorts(&[0, 1, 4]);
    made.primitive()["indices"] = json!(indices);
    made.refuses(&[place, "indices: item 3 is 4, and there are 4 vertices"]);
    made.primitive()["mode"] = json!(7);
    made.refuses(&[place, "mode: it is no kind of primitive"]);
}

#[test]
fn no_few_bytes_become_gigabytes() {
    let place = "the mesh becomes too large here";
    // Zeros that are not stored.
    let mut made = Made::square();
    made.json["accessors"][0] = json!({"componentType": F32, "count": 4_000_000_000_u64, "type": "VEC3"});
    made.refuses(&["attributes.POSITION", place]);
    made.json["accessors"][0]["count"] = json!(u64::MAX);
    made.refuses(&["attributes.POSITION", place]);
    // Few bytes, overlapping at a distance of none.
    let mut made = Made::square();
    made.json["bufferViews"][0]["byteStride"] = json!(0);
    made.json["accessors"][0]["count"] = json!(4_000_000_000_u64);
    made.refuses(&["attributes.POSITION"]);
    // One mesh at very many nodes, each with very many primitives.
    let mut made = Made::square();
    let primitive = made.primitive().clone();
    made.json["meshes"][0]["primitives"] = json!(vec![primitive; 2000]);
    made.json["nodes"] = json!(vec![json!({"mesh": 0}); 2000]);
    made.json["scenes"][0]["nodes"] = json!((0..2000).collect::<Vec<_>>());
    made.refuses(&[place]);
}

#[test]
fn transforms_must_be_numbers() {
    let mut made = Made::square();
    made.json["nodes"][0] = json!({"mesh": 0, "rotation": [0, 0, 0, 0]});
    made.refuses(&["nodes[0].rotation: it is no quaternion"]);
    made.json["nodes"][0] = json!({"mesh": 0, "scale": [1e39, 1, 1]});
    made.refuses(&["nodes[0].translation", "the scale must be finite"]);
    made.json["nodes"][0] = json!({"mesh": 0, "translation": [1e30, 1, 1]});
    made.refuses(&["past 1e9"]);
}
